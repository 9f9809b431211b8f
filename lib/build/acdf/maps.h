// Files of several maps of one size and layout, such as the hours of a day (docs/moving.md). C++17.
//
//     acdf::builder::IndexedOptions options;
//     options.axes = {{"time", {6.0, 9.0, 12.0}}, {"turbidity", {2.0, 6.0}}};
//     acdf::builder::IndexedFile made; // six maps: at 6:00 of both turbidities, at 9:00, at 12:00
//     const acdf::builder::Status status = acdf::builder::indexed(maps, options, made);
//
// acdf::IndexedEnvironment (acdf/indexed/views.h) samples them, at their coordinates and between.
#pragma once

#include <acdf/builder.h>

#include <array>

namespace acdf::builder {

/// An axis of maps: a name of 1 to 15 bytes, and at least two coordinates, which rise.
struct MapAxis {
    std::string name;
    std::vector<double> coordinates;
};

/// How several maps are fitted and stored.
struct IndexedOptions {
    TargetOptions target;
    std::vector<MapAxis> axes; ///< 1 to 3 of different names, none that of an axis of the grid (phi, theta, u, v)
    Goal goal;                 ///< a budget: bytes of the whole file
    /// Whether a small region that is much brighter than all else, as the sun, is looked for. A cone stands for it,
    /// which moves between maps. Else it is stored as any other light, and between maps there are two of it.
    bool sun = true;
    /// Where the sun of each map is, instead: of any length > 0, and zeros where it is not up. With `sun` alone.
    std::vector<std::array<double, 3>> suns;
    AcdfCodec codec = ACDF_CODEC_NONE;
    Source source; ///< of all maps together
};

/// The file of several maps, and what is known of it.
struct IndexedFile {
    std::vector<std::uint8_t> bytes;   ///< the whole file
    std::vector<MapAccuracy> accuracy; ///< of each map at its own coordinates
    std::vector<BadTexels> bad_texels; ///< what was mended in each
    double mean_variance = 0.0;        ///< of these relative variances the geometric mean
    std::size_t suns = 0;              ///< maps that have one
    std::size_t splits = 0;            ///< halvings for which each map has a probability of its own
    std::size_t cells = 0;
};

/// A file of several maps (acdf::IndexedEnvironment), of rows of the axes: the last axis changes fastest. All maps
/// have one size and layout, lat-long or octahedral, and are fitted on their own grid. ErrorCode::bad_source where
/// they do not fit together, no_energy where one is black.
Status indexed(const std::vector<Pixels>& maps, const IndexedOptions& options, IndexedFile& result,
               const Control& control = {}) noexcept;

/// As for other files.
std::string option_text(const IndexedOptions& options) noexcept;

} // namespace acdf::builder
