#include "check/rule_codes.h"

acdf::ErrorCode acdf::code_of(int rule) noexcept {
    constexpr short unsupported[] = {2003, 2006, 2007, 3002, 3005, 5001, 5002, 5003, 5004, 5005, 5019, 5021};
    for (const int known : unsupported)
        if (rule == known) return ErrorCode::unsupported;
    if (rule == 1001) return ErrorCode::cannot_open;
    if (rule == 1002) return ErrorCode::cannot_read;
    if (rule == 1003) return ErrorCode::out_of_memory;
    if (rule == 1004 || rule == 3012) return ErrorCode::limit_exceeded;
    return rule == 6012 ? ErrorCode::none : ErrorCode::malformed;
}
