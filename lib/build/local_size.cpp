#include "build/local_size.h"

#include <algorithm>
#include <cmath>

namespace acdf::build {

using compress::NormalBins;

namespace {

/// Subdivisions that suit a size: the denser the bins, the fewer tiles there are bytes for
/// (docs/notes/local-method.md).
std::uint32_t subdivisions_for(double bytes) {
    return static_cast<std::uint32_t>(std::clamp(std::lround(8.0 * std::pow(bytes / 262144.0, 0.3)), 3l, 64l));
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

NormalBins bins_for(const LocalOptions& o, double bytes) { return bins_as_many(o, subdivisions_for(bytes)); }

namespace {

/// Bytes of tiles and the rows of all bins that are stored.
double bytes_of_tiles(std::size_t rows, std::uint32_t tiles) {
    const double each = sizeof(AcdfSplit) + sizeof(std::uint32_t);
    return tiles * each + double(rows) * tiles;
}

std::uint32_t tiles_in(std::size_t rows, double bytes) {
    std::uint32_t low = 1, high = ACDF_MAX_TILES + 1;
    while (high - low > 1) {
        const std::uint32_t middle = low + (high - low) / 2;
        (bytes_of_tiles(rows, middle) <= bytes ? low : high) = middle;
    }
    return low;
}

/// What of a file is inside tiles: more of it, or less, and the variance rises.
constexpr double kInsideShare = 0.3;

} // namespace

compress::LocalSize size_for(const LocalOptions& o, const NormalBins& bins, double bytes) {
    constexpr double fixed = 2600.0;
    const std::size_t of_bin = sizeof(AcdfBin) + (o.mis ? sizeof(AcdfPartnerRecord) : 0);
    const double room = bytes - fixed - double(bins.normals.size() * of_bin);
    compress::LocalSize size;
    size.tiles =
        o.tiles > 0 ? std::min(o.tiles, ACDF_MAX_TILES) : tiles_in(bins.stored(), (1.0 - kInsideShare) * room);
    const double left = room - bytes_of_tiles(bins.stored(), size.tiles);
    size.inside_bytes = static_cast<std::uint64_t>(std::max(left, 256.0));
    return size;
}

double bytes_around(double inside_bytes) { return inside_bytes / kInsideShare; }

compress::LocalSize size_around(const LocalOptions& o, const NormalBins& bins, double inside_bytes) {
    compress::LocalSize size = size_for(o, bins, bytes_around(inside_bytes));
    size.inside_bytes = static_cast<std::uint64_t>(inside_bytes);
    return size;
}

} // namespace acdf::build
