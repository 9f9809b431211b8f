#include "compress/fit/refusals.h"

#include <cstdio>

namespace acdf::compress {

std::runtime_error out_of_reach(const char* what, double wanted, double least) {
    char text[160];
    std::snprintf(text, sizeof text, "%s of %.9g is out of reach; the smallest possible is %.6g", what, wanted,
                  least);
    return std::runtime_error(text);
}

std::runtime_error variance_beyond(std::uint64_t bytes, double wanted, double reached) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "a relative variance of %.9g takes more than about %.4g MiB, which have %.4g; for a larger file "
                  "give a budget",
                  wanted, double(bytes) / 1048576.0, reached);
    return std::runtime_error(text);
}

} // namespace acdf::compress
