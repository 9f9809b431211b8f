#include "build/local_size.h"

#include "compress/local/sums.h"

#include <algorithm>
#include <cmath>

namespace acdf::build {

using compress::LocalShape;
using compress::NormalBins;

namespace {

/// Subdivisions that suit a size: the denser the bins, the fewer tiles there are bytes for
/// (docs/notes/local-method.md).
std::uint32_t subdivisions_for(LocalShape shape, double bytes) {
    const double at_256k = shape == LocalShape::fast ? 6.7 : 8.0;
    return static_cast<std::uint32_t>(std::clamp(std::lround(at_256k * std::pow(bytes / 262144.0, 0.3)), 3l, 64l));
}

} // namespace

NormalBins bins_of(const LocalOptions& o, std::uint32_t subdivisions) {
    NormalBins bins =
        o.columns > 0 ? compress::latlong_bins(o.columns, o.rows) : compress::octahedral_bins(subdivisions);
    if (!o.scene.empty()) compress::weigh(bins, o.scene, compress::Rounded::yes);
    return bins;
}

NormalBins bins_as_many(const LocalOptions& o, std::uint32_t all) {
    NormalBins bins = bins_of(o, o.subdivisions > 0 ? o.subdivisions : all);
    if (o.subdivisions > 0 || o.columns > 0 || o.scene.empty()) return bins;
    const std::size_t rows = 4 * std::size_t{all} * all + 2;
    for (std::uint32_t finer = all + 1; finer <= 2 * all; ++finer) {
        NormalBins next = bins_of(o, finer);
        if (next.stored() > rows) break;
        bins = std::move(next);
    }
    return bins;
}

NormalBins bins_for(const LocalOptions& o, double bytes) {
    return bins_as_many(o, subdivisions_for(o.shape, bytes));
}

namespace {

/// Bytes of tiles and the rows of all bins that are stored.
double bytes_of_tiles(LocalShape shape, std::size_t rows, std::uint32_t tiles) {
    const double each = sizeof(AcdfSplit) + sizeof(std::uint32_t);
    const bool fast = shape == LocalShape::fast;
    return tiles * each + (fast ? double(compress::Sums{rows, tiles}.bytes()) : double(rows) * tiles);
}

std::uint32_t tiles_in(LocalShape shape, std::size_t rows, double bytes) {
    std::uint32_t low = 1, high = ACDF_MAX_TILES + 1;
    while (high - low > 1) {
        const std::uint32_t middle = low + (high - low) / 2;
        (bytes_of_tiles(shape, rows, middle) <= bytes ? low : high) = middle;
    }
    return low;
}

/// What of a file is inside tiles: more of it, or less, and the variance rises. Grids come to an end.
double inside_share(LocalShape shape, double bytes) {
    if (shape == LocalShape::small) return 0.3;
    return std::clamp(0.25 * std::pow(1048576.0 / bytes, 0.16), 0.15, 0.45);
}

constexpr double kInsideOfCells = 0.3; // of files that are asked for by their cells

} // namespace

compress::LocalSize size_for(const LocalOptions& o, const NormalBins& bins, double bytes, double inside) {
    constexpr double fixed = 2600.0;
    const std::size_t of_bin = sizeof(AcdfBin) + (o.mis ? sizeof(AcdfPartnerRecord) : 0);
    const double room = bytes - fixed - double(bins.normals.size() * of_bin);
    compress::LocalSize size;
    size.shape = o.shape;
    size.tiles =
        o.tiles > 0 ? std::min(o.tiles, ACDF_MAX_TILES) : tiles_in(o.shape, bins.stored(), (1.0 - inside) * room);
    const double left = room - bytes_of_tiles(o.shape, bins.stored(), size.tiles);
    size.inside_bytes = static_cast<std::uint64_t>(std::max(left, 256.0));
    return size;
}

compress::LocalSize size_for(const LocalOptions& o, const NormalBins& bins, double bytes) {
    return size_for(o, bins, bytes, inside_share(o.shape, bytes));
}

double bytes_of_cell(LocalShape shape) { return shape == LocalShape::fast ? 1.1 : 4.2; }

double bytes_around(double inside_bytes) { return inside_bytes / kInsideOfCells; }

compress::LocalSize size_around(const LocalOptions& o, const NormalBins& bins, double inside_bytes) {
    compress::LocalSize size = size_for(o, bins, bytes_around(inside_bytes), kInsideOfCells);
    // Small grids leave no bytes for rows beside what all files have.
    const double cells = inside_bytes / bytes_of_cell(o.shape);
    if (o.tiles == 0 && o.shape == LocalShape::fast)
        size.tiles = std::max(size.tiles, static_cast<std::uint32_t>(std::min(cells / 8.0, 128.0)));
    size.inside_bytes = static_cast<std::uint64_t>(inside_bytes);
    return size;
}

} // namespace acdf::build
