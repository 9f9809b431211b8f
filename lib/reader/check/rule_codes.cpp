#include "check/rule_codes.h"

AcdfErrorCode acdf::code_of(int rule) noexcept {
    constexpr short unsupported[] = {2003, 2006, 2007, 3002, 3005, 5001, 5002, 5003, 5004, 5005, 5019, 5021};
    for (const int known : unsupported)
        if (rule == known) return ACDF_UNSUPPORTED;
    if (rule == 1001) return ACDF_CANNOT_OPEN;
    if (rule == 1002) return ACDF_CANNOT_READ;
    if (rule == 1003) return ACDF_OUT_OF_MEMORY;
    if (rule == 1004 || rule == 3012) return ACDF_LIMIT_EXCEEDED;
    return rule == 6012 ? ACDF_OK : ACDF_MALFORMED;
}
