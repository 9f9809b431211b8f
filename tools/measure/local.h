// `acdf measure` for local environment maps.
#pragma once

#include "input/probe.h"

#include <acdf/reader.h>

#include <cstdint>
#include <string>

namespace acdf::tools {

struct LocalMeasureOptions {
    std::string file, source; ///< paths
    input::ProbeOptions input;
    std::uint32_t normals = 256;
    bool rivals = false, json = false, quiet = false;
};

/// Compares a local environment file with its probe over random normals, and with what a renderer could do instead
/// if asked, and prints what comes out. Throws Failure.
void measure_local(const File& file, const LocalMeasureOptions& options);

} // namespace acdf::tools
