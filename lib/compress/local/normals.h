// The bins of normals of a local environment map, and how often each occurs.
#pragma once

#include <acdf/local.h>

#include <array>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Either the corners of an octahedron whose edges are divided by `subdivisions`, where a normal is served by the
/// three around it, or (subdivisions 0) the cells of a lat-long grid of columns x rows.
struct NormalBins {
    std::uint32_t subdivisions = 0, columns = 0, rows = 0;
    std::vector<std::array<double, 3>> normals; ///< unit, one a bin: the corner, or the middle of the cell
    std::vector<double> weight;                 ///< one a bin, sum 1: how often it occurs; 0: it is not stored

    /// The bins that serve a normal; false where it is zero or not finite.
    bool find(const float normal[3], AcdfNormalBins& out) const;
    std::size_t stored() const;
};

/// All bins, each as often as its part of the sphere is large.
NormalBins octahedral_bins(std::uint32_t subdivisions);
NormalBins latlong_bins(std::uint32_t columns, std::uint32_t rows);

/// A normal of a scene, and how often it occurs.
struct SceneNormal {
    std::array<float, 3> normal{};
    double weight = 1.0; ///< > 0
};

/// Whether normals that are nearly the same are to be served, too, as those of renderers are rounded.
enum class Rounded { no, yes };

/// Weighs bins by the normals that they serve, and hardly, where these are rounded, by such as are tilted by a
/// thousandth: those that serve none are not stored. Throws std::invalid_argument where no normal is valid.
void weigh(NormalBins& bins, const std::vector<SceneNormal>& scene, Rounded rounded = Rounded::no);

} // namespace acdf::compress
