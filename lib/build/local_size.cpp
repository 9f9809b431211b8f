#include "build/local_size.h"

#include "compress/local/sums.h"

#include <algorithm>
#include <cmath>

namespace acdf::build {

using compress::LocalShape;
using compress::NormalBins;

namespace {

/// Subdivisions that suit a size: the denser the bins, the fewer tiles there are bytes for (docs/local.md).
std::uint32_t subdivisions_for(double bytes) {
    return static_cast<std::uint32_t>(std::clamp(std::lround(8.0 * std::pow(bytes / 262144.0, 0.3)), 3l, 64l));
}

} // namespace

NormalBins bins_of(const LocalOptions& o, std::uint32_t subdivisions) {
    NormalBins bins =
        o.columns > 0 ? compress::latlong_bins(o.columns, o.rows) : compress::octahedral_bins(subdivisions);
    if (!o.scene.empty()) compress::weigh(bins, o.scene);
    return bins;
}

NormalBins bins_for(const LocalOptions& o, double bytes) {
    const std::uint32_t all = subdivisions_for(bytes);
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

namespace {

/// Bytes of tiles and the rows of all bins that are stored.
double bytes_of_tiles(LocalShape shape, std::size_t rows, std::uint32_t tiles) {
    const double each = sizeof(AcdfSplit) + sizeof(std::uint32_t);
    const double row = shape == LocalShape::fast ? double(compress::sums_stride(tiles)) : double(tiles);
    return tiles * each + double(rows) * row;
}

std::uint32_t tiles_in(LocalShape shape, std::size_t rows, double bytes) {
    std::uint32_t low = 1, high = ACDF_MAX_TILES + 1;
    while (high - low > 1) {
        const std::uint32_t middle = low + (high - low) / 2;
        (bytes_of_tiles(shape, rows, middle) <= bytes ? low : high) = middle;
    }
    return low;
}

} // namespace

// More of it, or less, and the variance rises.
double inside_share(LocalShape shape) { return shape == LocalShape::fast ? 0.3 : 0.3; }

double bytes_of_cell(LocalShape shape) { return shape == LocalShape::fast ? 1.1 : 4.2; }

compress::LocalSize size_for(const LocalOptions& o, const NormalBins& bins, double bytes, double inside) {
    constexpr double fixed = 2600.0;
    const std::size_t of_bin = sizeof(AcdfBin) + (o.company ? sizeof(AcdfCompanyRecord) : 0);
    const double whole = o.shape == LocalShape::fast && bins.stored() < bins.normals.size() ? bytes / 16.0 : 0.0;
    const double room = bytes - fixed - whole - double(bins.normals.size() * of_bin);
    compress::LocalSize size;
    size.shape = o.shape;
    size.whole_bytes = static_cast<std::uint64_t>(std::max(whole, 64.0));
    size.tiles =
        o.tiles > 0 ? std::min(o.tiles, ACDF_MAX_TILES) : tiles_in(o.shape, bins.stored(), (1.0 - inside) * room);
    const double left = room - bytes_of_tiles(o.shape, bins.stored(), size.tiles);
    size.inside_bytes = static_cast<std::uint64_t>(std::max(left, 256.0));
    return size;
}

compress::LocalSize size_for(const LocalOptions& o, const NormalBins& bins, double bytes) {
    return size_for(o, bins, bytes, inside_share(o.shape));
}

} // namespace acdf::build
