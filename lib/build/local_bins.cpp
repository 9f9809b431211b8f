#include "build/local_bins.h"

#include <cstddef>
#include <utility>

namespace acdf::build {

using compress::NormalBins;

NormalBins bins_of(const LocalOptions& o, std::uint32_t subdivisions) {
    NormalBins bins =
        o.columns > 0 ? compress::latlong_bins(o.columns, o.rows) : compress::octahedral_bins(subdivisions);
    if (!o.scene.empty()) compress::weigh(bins, o.scene, compress::Rounded::yes);
    return bins;
}

NormalBins bins_as_many(const LocalOptions& o, std::uint32_t all, std::size_t most) {
    NormalBins bins = bins_of(o, o.subdivisions > 0 ? o.subdivisions : all);
    if (o.subdivisions > 0 || o.columns > 0 || o.scene.empty()) return bins;
    const std::size_t rows = 4 * std::size_t{all} * all + 2;
    for (std::uint32_t finer = all + 1; finer <= 2 * all; ++finer) {
        NormalBins next = bins_of(o, finer);
        if (next.stored() > rows || next.normals.size() > most) break;
        bins = std::move(next);
    }
    return bins;
}

} // namespace acdf::build
