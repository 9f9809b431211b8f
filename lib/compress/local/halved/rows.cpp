#include "compress/local/halved/rows.h"

#include "compress/parallel.h"
#include "compress/widths.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace acdf::compress {
namespace {

constexpr int kSteps = 2; // towards the minimum: most of what is gained comes with the first
/// Of a bin's own best part, what stays at least, and the cosine below which all stays, times the subdivisions:
/// both bound weights.
constexpr float kKeptPart = 0.25f, kKeptCosine = 0.06f;
constexpr std::size_t kTogether = 16; // tiles whose costs are written at once
constexpr float kLeast = std::numeric_limits<float>::min();

ACDF_WIDTHS void mix_rows(const float* a, const float* b, const float* c, const float w[3], std::size_t count,
                          float* out) {
    const float wa = w[0], wb = w[1], wc = w[2];
    for (std::size_t i = 0; i < count; ++i) out[i] = wa * a[i] + wb * b[i] + wc * c[i];
}

ACDF_WIDTHS void add_ratios(const float* cost, const float* mixed, float scale, std::size_t count, float* out) {
    for (std::size_t i = 0; i < count; ++i) {
        const float ratio = cost[i] / (mixed[i] > kLeast ? mixed[i] : kLeast);
        out[i] += scale * ratio * ratio;
    }
}

struct MixtureSums {
    double cost = 0.0, moments = 0.0, mixed = 0.0;
};

ACDF_WIDTHS MixtureSums add_up(const float* cost, const float* mixed, std::size_t count) {
    constexpr std::size_t kLanes = 8;
    double sums[3][kLanes] = {};
    const std::size_t even = count / kLanes * kLanes;
    for (std::size_t i = 0; i < even; i += kLanes)
        for (std::size_t k = 0; k < kLanes; ++k) {
            const float c = cost[i + k], m = mixed[i + k];
            sums[0][k] += double{c};
            sums[1][k] += double{c * (c / (m > kLeast ? m : kLeast))};
            sums[2][k] += double{m};
        }
    MixtureSums out;
    for (std::size_t k = 0; k < kLanes; ++k) {
        out.cost += sums[0][k];
        out.moments += sums[1][k];
        out.mixed += sums[2][k];
    }
    for (std::size_t i = even; i < count; ++i) {
        const float m = mixed[i] > kLeast ? mixed[i] : kLeast;
        out.cost += double{cost[i]};
        out.moments += double{cost[i] * (cost[i] / m)};
        out.mixed += double{mixed[i]};
    }
    return out;
}

/// What is positive stays so.
float kept_positive(float value) { return value > 0.0f ? std::max(value, kLeast) : 0.0f; }

} // namespace

MixedRows::MixedRows(const BlockMoments& light, const std::vector<HalvedBox>& tiles, const NormalBins& bins)
    : tiles_(tiles), bins_(bins), mixtures_(bins), costs_(mixtures_.of.size() * tiles.size()), whole_(tiles.size()),
      own_(bins.normals.size()) {
    Normals stored;
    std::vector<std::size_t> bin_of;
    for (std::size_t b = 0; b < own_.size(); ++b) {
        if (!(bins.weight[b] > 0.0)) continue;
        own_[b].resize(tiles.size());
        stored.add(bins.normals[b]);
        bin_of.push_back(b);
    }
    parallel_parts(0, (tiles.size() + kTogether - 1) / kTogether, 1, [&](std::size_t first, std::size_t last) {
        std::vector<float> seen(std::max(mixtures_.of.size(), bin_of.size())),
            of_tiles(mixtures_.of.size() * kTogether);
        for (std::size_t group = first; group < last; ++group) {
            const std::size_t begin = group * kTogether, count = std::min(kTogether, tiles.size() - begin);
            for (std::size_t k = 0; k < count; ++k) {
                const HalvedBox box = tiles[begin + k];
                whole_[begin + k] = std::sqrt(light[box].sum);
                light.seen(box, stored, seen.data());
                for (std::size_t i = 0; i < bin_of.size(); ++i)
                    own_[bin_of[i]][begin + k] = kept_positive(std::sqrt(seen[i]));
                light.seen(box, mixtures_.normals, seen.data());
                for (std::size_t j = 0; j < mixtures_.of.size(); ++j)
                    of_tiles[j * kTogether + k] = mixtures_.of[j].length * std::sqrt(seen[j]);
            }
            for (std::size_t j = 0; j < mixtures_.of.size(); ++j)
                std::copy_n(&of_tiles[j * kTogether], count, &costs_[j * tiles.size() + begin]);
        }
    });
}

void MixedRows::mix(std::size_t mixture, const RowParts& rows, float* out) const {
    const Mixture& m = mixtures_.of[mixture];
    mix_rows(rows[m.bin[0]].data(), rows[m.bin[1]].data(), rows[m.bin[2]].data(), m.weight.data(), tiles_.size(),
             out);
}

std::vector<MixedRows::Scales> MixedRows::scales(const RowParts& rows) const {
    std::vector<Scales> out(mixtures_.of.size());
    parallel_parts(0, out.size(), 8, [&](std::size_t first, std::size_t last) {
        std::vector<float> mixed(tiles_.size());
        for (std::size_t j = first; j < last; ++j) {
            mix(j, rows, mixed.data());
            const MixtureSums sums = add_up(cost(j), mixed.data(), mixed.size());
            if (!(sums.cost > 0.0)) continue;
            const double scale = mixtures_.of[j].frequency / (sums.cost * sums.cost);
            out[j] = {static_cast<float>(scale * sums.mixed), static_cast<float>(scale * sums.moments)};
        }
    });
    return out;
}

void MixedRows::step(std::size_t bin, const RowParts& rows, const std::vector<Scales>& scales,
                     const std::vector<float>& own, std::vector<float>& out) const {
    std::vector<float> raise(tiles_.size(), 0.0f), mixed(tiles_.size());
    double lower = 0.0, before = 0.0, after = 0.0;
    for (const std::uint32_t j : mixtures_.near[bin]) {
        const Mixture& m = mixtures_.of[j];
        float weight = 0.0f;
        for (std::size_t i = 0; i < 3; ++i) weight += m.bin[i] == bin ? m.weight[i] : 0.0f;
        mix(j, rows, mixed.data());
        add_ratios(cost(j), mixed.data(), weight * scales[j].raise, mixed.size(), raise.data());
        lower += double{weight * scales[j].lower};
    }
    if (!(lower > 0.0)) return;
    for (std::size_t t = 0; t < out.size(); ++t) {
        out[t] = rows[bin][t] * std::sqrt(raise[t] / static_cast<float>(lower));
        before += double{own[t]};
        after += double{out[t]};
    }
    if (!(after > 0.0)) return out = rows[bin], void();
    const auto scale = static_cast<float>(before / after);
    const float least_cosine = kKeptCosine / static_cast<float>(bins_.subdivisions);
    for (std::size_t t = 0; t < out.size(); ++t) {
        const float least = std::max(kKeptPart * own[t], std::min(own[t], least_cosine * whole_[t]));
        out[t] = own[t] > 0.0f ? kept_positive(std::max(out[t] * scale, least)) : 0.0f;
    }
}

RowParts MixedRows::parts() const {
    RowParts rows = own_, next = own_;
    for (int i = 0; i < kSteps; ++i) {
        const std::vector<Scales> of = scales(rows);
        parallel_for(std::size_t{0}, rows.size(), [&](std::size_t bin) {
            if (!rows[bin].empty()) step(bin, rows, of, own_[bin], next[bin]);
        });
        std::swap(rows, next);
    }
    return rows;
}

std::vector<float> MixedRows::surplus(const RowParts& rows) const {
    std::vector<float> of_mixtures(mixtures_.of.size());
    parallel_parts(0, of_mixtures.size(), 8, [&](std::size_t first, std::size_t last) {
        std::vector<float> mixed(tiles_.size());
        for (std::size_t j = first; j < last; ++j) {
            mix(j, rows, mixed.data());
            const MixtureSums sums = add_up(cost(j), mixed.data(), mixed.size());
            if (sums.cost > 0.0) of_mixtures[j] = static_cast<float>(sums.mixed / sums.cost);
        }
    });
    std::vector<float> out(rows.size(), 1.0f);
    for (std::size_t b = 0; b < out.size(); ++b)
        for (const std::uint32_t j : mixtures_.near[b]) out[b] = std::max(out[b], of_mixtures[j]);
    return out;
}

double MixedRows::variance(const RowParts& rows) const {
    double sum = 0.0, weight = 0.0;
    std::vector<float> mixed(tiles_.size());
    for (std::size_t j = 0; j < mixtures_.of.size(); ++j) {
        mix(j, rows, mixed.data());
        const MixtureSums sums = add_up(cost(j), mixed.data(), mixed.size());
        if (!(sums.cost > 0.0)) continue;
        const double frequency = mixtures_.of[j].frequency;
        sum += frequency * (sums.moments * sums.mixed / (sums.cost * sums.cost) - 1.0);
        weight += frequency;
    }
    return weight > 0.0 ? sum / weight : 0.0;
}

} // namespace acdf::compress
