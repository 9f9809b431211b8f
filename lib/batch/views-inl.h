// Which rows of a BRDF file serve views, and with which weights: acdf_brdf_view, as many as vectors hold. Compiled
// once for each set of instructions, as vectors-inl.h.
#if defined(ACDF_BATCH_VIEWS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ACDF_BATCH_VIEWS_INL_H
#undef ACDF_BATCH_VIEWS_INL_H
#else
#define ACDF_BATCH_VIEWS_INL_H
#endif

#include "batch/mixtures-inl.h"

#include <acdf/brdf.h>

HWY_BEFORE_NAMESPACE();
namespace acdf {
namespace batch {
namespace HWY_NAMESPACE {
#if !ACDF_BATCH_SINGLY

struct ViewPlaces {
    HWY_ALIGN double elevation[kBlock], azimuth[kBlock]; // coordinates of nodes, and in columns; NaN: it is no view
};

inline void place_views(const AcdfBrdf& brdf, const Mixtures& mixtures, std::size_t count, ViewPlaces& places) {
    for (std::size_t i = 0; i < count; i += hn::Lanes(Doubles())) {
        Double x, y, z;
        load_vectors(mixtures.vectors + 3 * i, x, y, z);
        const Double one = set(1.0);
        const Double length2 = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
        const auto valid = hn::And(is_unit_square(length2), hn::Gt(z, set(0.0)));
        const Double elevation = hn::Sqrt(hn::IfThenElseZero(hn::Lt(z, one), hn::Sub(one, z)));
        const Double turn = hn::Add(set(0.5), hn::Mul(set(0.5), atan2pi(y, x)));
        hn::Store(hn::IfThenElse(valid, elevation, hn::NaN(Doubles())), Doubles(), places.elevation + i);
        hn::Store(hn::Mul(set(brdf.views->phi_count), turn), Doubles(), places.azimuth + i);
    }
}

// acdf_view_lower, each search a step in turn.
inline void find_nodes(const AcdfBrdf& brdf, std::size_t count, const ViewPlaces& places, std::uint32_t* node) {
    const std::uint32_t nodes = brdf.views->theta_count, last = nodes > 1 ? nodes - 2 : 0;
    std::uint32_t step = 1;
    while (step <= last) step *= 2;
    std::fill(node, node + count, 0u);
    while (step /= 2)
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t next = node[i] + step, at = std::min(next, last);
            const bool below = static_cast<double>(brdf.nodes[at]) <= places.elevation[i];
            node[i] += step & (0u - static_cast<std::uint32_t>(below & (next <= last)));
        }
}

// The bins around a view at a node, and their weights.
template <int most>
void take_bins(const AcdfBrdf& brdf, const ViewPlaces& places, std::uint32_t node, std::size_t i,
               Mixtures& mixtures) {
    const std::uint32_t nodes = brdf.views->theta_count, columns = brdf.views->phi_count;
    const std::uint32_t upper = nodes > 1 ? node + 1 : node;
    const double low = static_cast<double>(brdf.nodes[node]), high = static_cast<double>(brdf.nodes[upper]);
    const double t = upper == node ? 0.0 : (places.elevation[i] - low) / (high - low);
    const double above = t > 0.0 ? (t < 1.0 ? t : 1.0) : 0.0;
    if (most == 2) {
        mixtures.row[0][i] = node;
        mixtures.row[1][i] = upper;
        mixtures.weight[0][i] = 1.0 - above;
        mixtures.weight[1][i] = above;
        return;
    }
    const auto whole = static_cast<std::uint32_t>(places.azimuth[i]);
    const double part = places.azimuth[i] - static_cast<double>(whole);
    const std::uint32_t column = whole % columns, next = column + 1 < columns ? column + 1 : 0;
    for (int k = 0; k < 4; ++k) {
        mixtures.row[k][i] = (k < 2 ? node : upper) * columns + (k % 2 ? next : column);
        mixtures.weight[k][i] = (k < 2 ? 1.0 - above : above) * (k % 2 ? part : 1.0 - part);
    }
}

template <int most>
void mix_views(const AcdfBrdf& brdf, std::size_t count, Mixtures& mixtures) {
    ViewPlaces places;
    std::uint32_t node[kBlock];
    place_views(brdf, mixtures, count, places);
    find_nodes(brdf, count, places, node);
    for (std::size_t i = 0; i < count; ++i) {
        const bool valid = places.elevation[i] >= 0.0;
        if (valid) take_bins<most>(brdf, places, node[i], i, mixtures);
        else
            for (int k = 0; k < most; ++k) mixtures.row[k][i] = 0, mixtures.weight[k][i] = 0.0;
        mixtures.take_rows<most>(brdf.bins, i, valid);
    }
    make_whole<most>(count, mixtures);
}

#endif
} // namespace HWY_NAMESPACE
} // namespace batch
} // namespace acdf
HWY_AFTER_NAMESPACE();

#endif
