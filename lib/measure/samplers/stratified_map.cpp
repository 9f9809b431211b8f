#include "measure/samplers/stratified_map.h"

#include "compress/sum.h"
#include "measure/samplers/stratification.h"

#include <algorithm>

namespace acdf::measure {
namespace {

class Stratified final : public PointEstimator {
public:
    explicit Stratified(const StratifiedMap& map) : map_(map) {}

    Rgb estimate(const ShadingPoint& point, const Integrand& f, Random& random, Tally& tally) override {
        Rgb sum{};
        tally.samples += map_.strata();
        for (std::size_t i = 0; i < map_.strata(); ++i) {
            const double choice = uniform(random), u0 = uniform(random), u1 = uniform(random);
            const AcdfDirectionSample s = map_.sample(i, choice, u0, u1);
            const double cosine = double{point.n[0]} * s.direction[0] + double{point.n[1]} * s.direction[1] +
                                  double{point.n[2]} * s.direction[2];
            if (!(s.pdf > 0.0f && cosine > 0.0)) continue;
            ++tally.above;
            ++tally.shadow_rays;
            const Rgb value = f(s.direction);
            for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += value[k] / double{s.pdf};
        }
        return sum;
    }

private:
    const StratifiedMap& map_;
};

} // namespace

StratifiedMap::StratifiedMap(const compress::Target& target, std::uint32_t strata, Jitter jitter) : grid_(target) {
    const std::vector<std::uint32_t> stratum = stratify(target, strata);
    first_.assign(*std::max_element(stratum.begin(), stratum.end()) + std::size_t{2}, 0);
    for (const std::uint32_t s : stratum) ++first_[s + 1];
    for (std::size_t s = 1; s < first_.size(); ++s) first_[s] += first_[s - 1];

    texels_.resize(stratum.size());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < stratum.size(); ++i) texels_[next[stratum[i]]++] = {i, 0.0f};

    cumulative_.resize(texels_.size());
    for (std::size_t s = 0; s + 1 < first_.size(); ++s) {
        compress::Sum sum;
        const auto density = [&](std::size_t k) {
            return jitter == Jitter::radiance ? double{target.values[texels_[k].index]} : 1.0;
        };
        for (std::size_t k = first_[s]; k < first_[s + 1]; ++k) {
            const std::uint32_t i = texels_[k].index;
            sum.add(density(k) * target.column_measure[i % target.columns] *
                    target.row_measure[i / target.columns]);
            cumulative_[k] = sum.value();
        }
        const double scale = sum.value() > 0.0 ? 1.0 / sum.value() : 0.0;
        for (std::size_t k = first_[s]; k < first_[s + 1]; ++k) {
            texels_[k].pdf = static_cast<float>(density(k) * scale);
            cumulative_[k] *= scale;
        }
    }
}

AcdfDirectionSample StratifiedMap::sample(std::size_t stratum, double choice, double u0, double u1) const {
    const double* const begin = cumulative_.data() + first_[stratum];
    const double* const end = cumulative_.data() + first_[stratum + 1];
    const double* const at = std::upper_bound(begin, end, choice * end[-1]);
    if (at == end) return {{0.0f, 0.0f, 1.0f}, 0.0f}; // black
    const Texel& texel = texels_[first_[stratum] + static_cast<std::size_t>(at - begin)];
    return grid_.place(texel.index % grid_.columns(), texel.index / grid_.columns(), u0, u1, texel.pdf);
}

std::uint64_t StratifiedMap::bytes() const {
    return first_.size() * sizeof(std::size_t) + texels_.size() * sizeof(Texel) +
           cumulative_.size() * sizeof(double);
}

std::unique_ptr<PointEstimator> StratifiedEstimator::point_estimator() const {
    return std::make_unique<Stratified>(map_);
}

} // namespace acdf::measure
