#include "check/rule_codes.h"

acdf::ErrorCode acdf::code_of(int rule) noexcept {
    switch (rule) {
    case 1001:
        return ErrorCode::cannot_open;
    case 1002:
        return ErrorCode::cannot_read;
    case 1003:
        return ErrorCode::out_of_memory;
    case 1004:
    case 3012:
        return ErrorCode::limit_exceeded;
    case 2003:
    case 2006:
    case 2007:
    case 3002:
    case 3005:
    case 5001:
    case 5002:
    case 5003:
    case 5004:
    case 5005:
    case 5019:
    case 5021:
        return ErrorCode::unsupported;
    case 6012:
        return ErrorCode::none;
    default:
        return ErrorCode::malformed;
    }
}
