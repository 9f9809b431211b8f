// Targets of tests whose expectations are those of a renderer that looks the nearest texel up.
#pragma once

#include <acdf/builder.h>

namespace acdf::test {

inline builder::TargetOptions nearest_lookup() {
    builder::TargetOptions options;
    options.filter = ACDF_FILTER_NEAREST;
    return options;
}

} // namespace acdf::test
