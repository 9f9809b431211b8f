// Reads environment maps of any common projection into one form: lat-long radiance.
#pragma once

#include "build/probe/rows.h"
#include "input/error.h"
#include "input/probe/faces.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace acdf::input {

enum class Projection { automatic, latlong, angular, mirrorball, cube_cross, octahedral };

/// "latlong", "angular", "mirrorball", "cube-cross", "octahedral", "auto".
const char* to_string(Projection projection);

/// The grid that a probe is fitted on.
using Domain = builder::Domain;

struct ProbeOptions {
    Projection projection = Projection::automatic;
    /// Of a cube in six files, or in a strip; with Projection::automatic or cube_cross.
    std::optional<Faces> faces = {};
    /// Squares that nothing proves anything of are octahedral, but for discs: of a renderer that reads no other.
    bool squares_are_octahedral = false;
    Domain domain = Domain::source; ///< for who makes targets; read_probe alone knows lat-long maps
    build::BadPixels bad_pixels = build::BadPixels::zero;
    /// A probe without any light counts as one of the faintest constant light, so that it can be sampled.
    bool uniform_if_black = false;
    int threads = 0; ///< 0: all cores
};

/// A probe as lat-long RGB radiance in the frame of docs/conventions.md: row 0 touches +z, column 0 begins
/// at phi = +pi and phi falls along the columns (the image as seen from inside, unmirrored).
struct Probe {
    int width = 0, height = 0;
    std::vector<float> rgb;    ///< height x width x 3, finite, >= 0; empty where rows were taken as they came
    std::string source_name;   ///< file name without folders (lib/input/probe/source.h)
    std::string source_sha256; ///< of the file's bytes, hex
    int source_width = 0, source_height = 0;     ///< of six faces, of the map that they are put together to
    Projection projection = Projection::latlong; ///< what was used, never `automatic`
    build::Map source_map;                       ///< the source's layout and size
    std::string projection_reason;               ///< why, for a person: "2:1 shape", "envmap attribute"
    build::BadTexels bad;
    /// What luminance is by the primaries that the file declares; none where it is Rec. 709's.
    std::optional<builder::ChannelWeights> luminance;
    std::vector<std::string> warnings; ///< what a user should know, one line each: clipped integers, crops, ...
};

using build::ProbeRows;

/// Reads any image OpenImageIO reads; `path` may name six (lib/input/probe/source.h). Throws Error.
Probe read_probe(const std::string& path, const ProbeOptions& options = {});

/// The same without keeping `rgb`: a lat-long image is read in bands of rows, and never in memory as a whole (but
/// for BadPixels::clamp); one of another projection is, and is resampled unless `rows` takes it as it is.
Probe read_probe(const std::string& path, const ProbeOptions& options, ProbeRows& rows);

} // namespace acdf::input
