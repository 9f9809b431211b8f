// `acdf measure` for local environment maps.
#pragma once

#include "input/normals/scene.h"
#include "input/probe/probe.h"

#include <acdf/reader.h>
#include <acdf/views.h>

#include <cstdint>
#include <optional>
#include <string>

namespace acdf::tools {

struct LocalMeasureOptions {
    std::string file, source; ///< paths
    input::ProbeOptions input;
    std::uint32_t normals = 256;
    std::string
        mesh; ///< a path: positions on it are measured, too; of files without visibility cells, only its normals
    input::UpAxis up = input::UpAxis::z;
    std::uint32_t points = 64; ///< on the mesh
    bool baselines = false, json = false, quiet = false;
    std::optional<AcdfFilter> filter; ///< of another lookup than the file was made for
};

/// Compares a local environment file with its probe over random normals, or a scene's, and with what a renderer
/// could do instead if asked, and over points of a mesh where there is one, and prints what comes out. Throws
/// Failure.
void measure_local(const File& file, const LocalMeasureOptions& options);

} // namespace acdf::tools
