#include "compress/fit/division.h"

#include "compress/fit/join.h"

#include <algorithm>
#include <cmath>

namespace acdf::compress {
namespace {

// A split into k parts is worth its gain per knot, but not quite: with half a knot on top, a bright spot is cut
// out by two knots at once even where the first one alone gains little more per knot.
constexpr double kKnotOffset = 0.5;
// Of the cost of the whole. Where each slice is left to the partner no border is better than any other, though what
// lies within the slices may differ.
constexpr double kNoGain = 1e-12;

/// The last joins: the borders that vanish with them, and the sum of costs before each.
struct LastJoins {
    std::array<std::uint32_t, Division::most_parts - 1> border;
    std::array<double, Division::most_parts - 1> cost;
    std::size_t count = 0;
};

template <bool Partner>
LastJoins join_slices(const Slices& slices, DivisionScratch& s) {
    const std::size_t n = slices.size();
    s.measure = slices.measure;
    s.energy = slices.energy;
    if (Partner) s.left = slices.left;
    const auto cost = [](double alone, double left) { return Partner ? cell_cost(alone, left) : alone; };
    s.alone.resize(n);
    s.joined.resize(n);
    double total = 0.0;
    for (std::size_t i = 0; i < n; ++i)
        total += s.alone[i] = cost(std::sqrt(s.measure[i] * s.energy[i]), Partner ? s.left[i] : 0.0);
    LastJoins last;
    std::size_t left = n - 1;
    join_neighbours(
        n, left,
        [&](std::size_t a, std::size_t b) {
            s.joined[a] = cost(std::sqrt((s.measure[a] + s.measure[b]) * (s.energy[a] + s.energy[b])),
                               Partner ? s.left[a] + s.left[b] : 0.0);
            return s.joined[a] - s.alone[a] - s.alone[b];
        },
        [&](std::size_t a, std::size_t b, double raise) {
            if (left-- < Division::most_parts) {
                last.border[last.count] = static_cast<std::uint32_t>(b);
                last.cost[last.count++] = total;
            }
            total += raise;
            s.measure[a] += s.measure[b];
            s.energy[a] += s.energy[b];
            if (Partner) s.left[a] += s.left[b];
            s.alone[a] = s.joined[a];
        });
    return last;
}

} // namespace

Division divide(const Slices& slices, double undivided, DivisionScratch& scratch) {
    Division division;
    if (slices.size() < 2) return division;
    const LastJoins last =
        slices.left.empty() ? join_slices<false>(slices, scratch) : join_slices<true>(slices, scratch);
    division.knots = 1;
    for (std::size_t knots = 1; knots <= last.count; ++knots) {
        const double gain = (undivided - last.cost[last.count - knots]) / (double(knots) + kKnotOffset);
        if (gain <= division.gain_per_knot) continue;
        division.gain_per_knot = gain;
        division.knots = knots;
    }
    if (!slices.left.empty() && division.gain_per_knot <= kNoGain * undivided) {
        division.knots = 1;
        division.cuts[0] = static_cast<std::uint32_t>(slices.size() / 2);
        return division;
    }
    std::copy(last.border.begin() + std::ptrdiff_t(last.count - division.knots),
              last.border.begin() + std::ptrdiff_t(last.count), division.cuts.begin());
    std::sort(division.cuts.begin(), division.cuts.begin() + std::ptrdiff_t(division.knots));
    return division;
}

} // namespace acdf::compress
