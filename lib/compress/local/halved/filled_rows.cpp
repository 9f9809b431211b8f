#include "compress/local/halved/filled_rows.h"

#include "compress/parallel.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace acdf::compress {
namespace {

constexpr int kDescents = 2; // towards the minimum
constexpr int kShareSteps = 7;
constexpr float kLeastKept = 0.25f; // of a bin's own best part
constexpr float kMostChange = 4.0f; // in a step
// Tables have four steps an octave, and are linear in between: the bits of a float are their numbers.
constexpr int kFirstOctave = -10, kOctaves = 32;
constexpr std::size_t kKnots = std::size_t{4} * kOctaves + 1;
constexpr std::uint32_t kFirstKnot = (127 + kFirstOctave) * 4;

struct Knot {
    std::size_t at;
    float between;
};

Knot knot_of(float y) {
    y = std::clamp(y, std::ldexp(1.0f, kFirstOctave), std::ldexp(0.999f, kFirstOctave + kOctaves));
    std::uint32_t bits;
    std::memcpy(&bits, &y, sizeof bits);
    return {(bits >> 21) - kFirstKnot, float(bits & 0x1FFFFFu) * 0x1p-21f};
}
float value_at(const float* table, float y) {
    const Knot k = knot_of(y);
    return table[k.at] + k.between * (table[k.at + 1] - table[k.at]);
}
/// The share in (0.02, 0.98) of which `moment(share)`, which is convex, is least: by golden-section search.
template <class Moment>
float least_share(const Moment& moment) {
    constexpr double golden = 0.6180339887498949;
    double low = 0.02, high = 0.98;
    for (int step = 0; step < kShareSteps; ++step) {
        const double left = high - golden * (high - low), right = low + golden * (high - low);
        if (moment(left) < moment(right)) high = right;
        else low = left;
    }
    return static_cast<float>(0.5 * (low + high));
}

double knot(std::size_t k) { return std::ldexp(1.0 + 0.25 * double(k % 4), kFirstOctave + int(k / 4)); }

} // namespace

FilledRows::FilledRows(const BlockMoments& light, const std::vector<HalvedBox>& tiles,
                       const std::vector<std::vector<FilledCell>>& cells, const NormalBins& bins,
                       const Radiances& radiances, double ratio, AcdfHeuristic heuristic)
    : tiles_(tiles), bins_(bins), mixtures_(bins), ratio_(ratio), lit_(bins.normals.size()),
      lit_mixture_(mixtures_.of.size()), place_(bins.normals.size()), scale_(tiles.size()),
      moment_(tiles.size() * kKnots), fall_(tiles.size() * kKnots) {
    Normals stored;
    for (std::size_t b = 0; b < bins.normals.size(); ++b) {
        place_[b] = stored.size();
        if (bins.weight[b] > 0.0) stored.add(bins.normals[b]);
    }
    parallel_for(std::size_t{0}, lit_.size(), [&](std::size_t b) {
        if (bins.weight[b] > 0.0) lit_[b] = radiances.seen(bins.normals[b], ratio);
    });
    parallel_for(std::size_t{0}, lit_mixture_.size(), [&](std::size_t j) {
        for (std::size_t i = 0; i < 3; ++i) // nearly linear between bins
            lit_mixture_[j].irradiance +=
                double{mixtures_.of[j].weight[i]} * lit_[mixtures_.of[j].bin[i]].irradiance;
        lit_mixture_[j].irradiance /= double{mixtures_.of[j].length};
    });
    of_mixtures_ = cosines(light, mixtures_.normals);
    of_bins_ = cosines(light, stored);
    parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t t) {
        double measure = 0.0;
        for (const FilledCell& cell : cells[t]) measure += cell.measure;
        // At P / c = y measure / pi a tile of even density has as much of ours as of the partner's where y is 1.
        scale_[t] = static_cast<float>(ACDF_PI * ratio / std::max(measure, 1e-30));
        for (const FilledCell& cell : cells[t]) {
            if (!(cell.square > 0.0)) continue;
            const double density = cell.share / cell.measure * measure;
            for (std::size_t k = 0; k < kKnots; ++k) {
                const double ours = knot(k) * density / ACDF_PI, theirs = 1.0 / ACDF_PI;
                moment_[t * kKnots + k] += static_cast<float>(cell.square * second_moment(ours, theirs, heuristic));
                fall_[t * kKnots + k] +=
                    static_cast<float>(cell.square * density / measure * moment_fall(ours, theirs, heuristic));
            }
        }
    });
    own_ = own(cells);
}

/// Root mean squares over the light of tiles, above the horizon.
std::vector<float> FilledRows::cosines(const BlockMoments& light, const Normals& normals) const {
    std::vector<float> out(normals.size() * tiles_.size());
    parallel_parts(0, tiles_.size(), 16, [&](std::size_t first, std::size_t last) {
        std::vector<float> seen(normals.size());
        for (std::size_t t = first; t < last; ++t) {
            const float sum = light[tiles_[t]].sum;
            if (!(sum > 0.0f)) continue;
            light.seen(tiles_[t], normals, seen.data());
            for (std::size_t i = 0; i < seen.size(); ++i) out[i * tiles_.size() + t] = std::sqrt(seen[i] / sum);
        }
    });
    return out;
}

RowParts FilledRows::own(const std::vector<std::vector<FilledCell>>& cells) const {
    RowParts out(bins_.normals.size());
    for (std::size_t b = 0; b < out.size(); ++b)
        if (bins_.weight[b] > 0.0) out[b].resize(tiles_.size());
    parallel_for(std::size_t{0}, tiles_.size(), [&](std::size_t t) {
        struct Above {
            double light, measure;
        };
        std::vector<Above> sorted; // from the brightest on, summed
        for (const FilledCell& cell : cells[t])
            if (cell.square > 0.0 && cell.share > 0.0)
                sorted.push_back({std::sqrt(cell.square / cell.measure), cell.measure});
        std::sort(sorted.begin(), sorted.end(), [](const Above& a, const Above& b) { return a.light > b.light; });
        std::vector<double> flux{0.0}, measure{0.0};
        for (const Above& above : sorted) {
            flux.push_back(flux.back() + above.light * above.measure);
            measure.push_back(measure.back() + above.measure);
        }
        for (std::size_t b = 0; b < out.size(); ++b) {
            if (out[b].empty() || !(lit_[b].irradiance > 0.0)) continue;
            const double threshold = lit_[b].threshold;
            const auto end = std::partition_point(sorted.begin(), sorted.end(),
                                                  [&](const Above& above) { return above.light > threshold; });
            const auto count = static_cast<std::size_t>(end - sorted.begin());
            const double cosine = double{of_bins_[place_[b] * tiles_.size() + t]};
            out[b][t] = static_cast<float>(std::max(0.0, flux[count] - threshold * measure[count]) * cosine);
        }
    });
    return out;
}

/// How fast the moment falls with each tile's part, and the mean of that over samples.
void FilledRows::add_mixture(std::size_t mixture, const RowParts& rows, float* falls, float& mean) const {
    const Mixture& m = mixtures_.of[mixture];
    const float *a = rows[m.bin[0]].data(), *b = rows[m.bin[1]].data(), *c = rows[m.bin[2]].data();
    const float* cosine = of_mixtures_.data() + mixture * tiles_.size();
    double sum = 0.0, of_samples = 0.0;
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
        falls[t] = m.weight[0] * a[t] + m.weight[1] * b[t] + m.weight[2] * c[t];
        sum += double{falls[t]};
    }
    const auto whole = static_cast<float>(sum > 0.0 ? 1.0 / sum : 0.0);
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
        const float part = falls[t] * whole;
        falls[t] = part > 0.0f && cosine[t] > 0.0f
                       ? value_at(fall_.data() + t * kKnots, part / cosine[t] * scale_[t])
                       : 0.0f;
        of_samples += double{part * falls[t]};
    }
    const double irradiance = lit_mixture_[mixture].irradiance;
    const double scale = irradiance > 0.0 ? m.frequency / (irradiance * irradiance) * double{whole} : 0.0;
    for (std::size_t t = 0; t < tiles_.size(); ++t) falls[t] *= static_cast<float>(scale);
    mean = static_cast<float>(of_samples * scale);
}

RowParts FilledRows::parts() const {
    RowParts rows = own_;
    std::vector<float> falls(mixtures_.of.size() * tiles_.size()), means(mixtures_.of.size());
    for (int step = 0; step < kDescents; ++step) {
        parallel_for(std::size_t{0}, means.size(),
                     [&](std::size_t j) { add_mixture(j, rows, &falls[j * tiles_.size()], means[j]); });
        parallel_for(std::size_t{0}, rows.size(), [&](std::size_t b) {
            if (rows[b].empty()) return;
            std::vector<float> raise(tiles_.size(), 0.0f);
            float lower = 0.0f;
            for (const std::uint32_t j : mixtures_.near[b]) {
                float weight = 0.0f;
                for (std::size_t i = 0; i < 3; ++i)
                    weight += mixtures_.of[j].bin[i] == b ? mixtures_.of[j].weight[i] : 0.0f;
                const float* of = &falls[j * tiles_.size()];
                for (std::size_t t = 0; t < raise.size(); ++t) raise[t] += weight * of[t];
                lower += weight * means[j];
            }
            double before = 0.0, after = 0.0;
            std::vector<float>& row = rows[b];
            for (std::size_t t = 0; t < row.size(); ++t) {
                before += double{own_[b][t]};
                if (row[t] > 0.0f && lower > 0.0f)
                    row[t] *=
                        std::clamp(std::sqrt(std::max(raise[t], 0.0f) / lower), 1.0f / kMostChange, kMostChange);
                after += double{row[t]};
            }
            const auto scale = static_cast<float>(after > 0.0 ? before / after : 1.0);
            for (std::size_t t = 0; t < row.size(); ++t)
                row[t] = own_[b][t] > 0.0f ? std::max(row[t] * scale, kLeastKept * own_[b][t]) : 0.0f;
        });
    }
    return rows;
}

AcdfPartnerRecord FilledRows::record(std::size_t bin, const std::vector<float>& row, double all) const {
    const float* cosine = of_bins_.data() + place_[bin] * tiles_.size();
    double sum = 0.0;
    for (const float part : row) sum += double{part};
    const auto irradiance = static_cast<float>(lit_[bin].irradiance / all);
    if (!(sum > 0.0)) return {1.0f, irradiance};
    const auto moment = [&](double share) {
        double out = 0.0;
        const double ours = share / (1.0 - share) / ratio_ / sum;
        for (std::size_t t = 0; t < row.size(); ++t)
            if (cosine[t] > 0.0f)
                out += double{cosine[t] * value_at(moment_.data() + t * kKnots,
                                                   static_cast<float>(ours) * row[t] / cosine[t] * scale_[t])};
        return out / (1.0 - share);
    };
    return {least_share(moment), irradiance};
}

} // namespace acdf::compress
