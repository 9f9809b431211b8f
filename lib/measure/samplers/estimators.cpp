#include "measure/samplers/estimators.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace acdf::measure {
namespace {

using PointSamplerPtr = std::unique_ptr<PointSampler>;

double cosine(const ShadingPoint& point, const float wi[3]) {
    return double{point.n[0]} * wi[0] + double{point.n[1]} * wi[1] + double{point.n[2]} * wi[2];
}

/// Counts a sample. True where it may contribute: above the horizon.
bool counts(const AcdfDirectionSample& s, const ShadingPoint& point, Tally& tally) {
    ++tally.samples;
    if (!(s.pdf > 0.0f && cosine(point, s.direction) > 0.0)) return false;
    ++tally.above;
    return true;
}

/// Samples n samples of the set of numbers that has begun: use(sample) of those that may contribute.
template <class Use>
void draw(const PointSampler& sampler, const ShadingPoint& point, std::uint64_t n, Random& random, Tally& tally,
          const Use& use) {
    for (; n > 0; --n) {
        const std::array<double, 2> u = random.pair();
        const AcdfDirectionSample s = sampler.sample(u[0], u[1]);
        if (counts(s, point, tally)) use(s);
    }
}

/// sum += weight * f(wi), which costs a shadow ray.
void add(const Integrand& f, const float wi[3], double weight, Rgb& sum, Tally& tally) {
    const Rgb value = f(wi);
    ++tally.shadow_rays;
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += weight * value[k];
}

class Single final : public PointEstimator {
public:
    Single(PointSamplerPtr sampler, std::uint32_t n) : sampler_(std::move(sampler)), n_(n) {}

    Rgb estimate(const ShadingPoint& point, const Integrand& f, Random& random, Tally& tally) override {
        sampler_->move_to(point);
        random.begin_set();
        Rgb sum{};
        draw(*sampler_, point, n_, random, tally,
             [&](const AcdfDirectionSample& s) { add(f, s.direction, 1.0 / (n_ * double{s.pdf}), sum, tally); });
        return sum;
    }

private:
    PointSamplerPtr sampler_;
    std::uint32_t n_;
};

class Mis final : public PointEstimator {
public:
    Mis(const std::vector<Share>& shares, Heuristic heuristic) : power_(heuristic == Heuristic::power) {
        for (const Share& share : shares) {
            if (share.automatic) automatic_ = parts_.size();
            parts_.push_back({share.sampler->point_sampler(), double(share.n)});
            given_.push_back(share.n);
        }
    }

    Rgb estimate(const ShadingPoint& point, const Integrand& f, Random& random, Tally& tally) override {
        for (const Part& part : parts_) part.sampler->move_to(point);
        if (automatic_ < parts_.size()) divide_samples();
        Rgb sum{};
        for (const Part& part : parts_) {
            random.begin_set();
            draw(*part.sampler, point, static_cast<std::uint64_t>(part.n), random, tally,
                 [&](const AcdfDirectionSample& s) { add(f, s.direction, weight(part, s), sum, tally); });
        }
        return sum;
    }

private:
    struct Part {
        PointSamplerPtr sampler;
        double n;
    };
    /// Whole numbers that depend on the point alone: the estimate stays unbiased.
    void divide_samples() {
        std::uint32_t all = 0;
        for (const std::uint32_t n : given_) all += n;
        const std::uint32_t others = all - given_[automatic_];
        const auto least = static_cast<double>(parts_.size() - 1);
        const double own =
            std::round(static_cast<double>(parts_[automatic_].sampler->recommended_light_share()) * all);
        parts_[automatic_].n = std::clamp(own, 1.0, std::max(1.0, all - least));
        const double left = all - parts_[automatic_].n;
        std::uint32_t before = 0; // sums are rounded, not what each gets: together it is all that is left
        double given = 0.0;
        for (std::size_t i = 0; i < parts_.size(); ++i) {
            if (i == automatic_) continue;
            before += given_[i];
            const double upto = std::round((left - least) * before / others);
            parts_[i].n = 1.0 + upto - given;
            given = upto;
        }
    }
    /// w_i / (n_i p_i).
    double weight(const Part& own, const AcdfDirectionSample& s) const {
        const double own_pdf = own.n * s.pdf;
        double others = 0.0; // relative to the sample's own, so that squares stay in range
        for (const Part& part : parts_) {
            if (&part == &own) continue;
            const double ratio = part.n * part.sampler->pdf(s.direction) / own_pdf;
            others += power_ ? ratio * ratio : ratio;
        }
        return 1.0 / (own_pdf * (1.0 + others));
    }

    std::vector<Part> parts_;
    std::vector<std::uint32_t> given_;
    std::size_t automatic_ = SIZE_MAX;
    bool power_;
};

class Resampled final : public PointEstimator {
public:
    Resampled(PointSamplerPtr sampler, std::uint32_t candidates, std::uint32_t n)
        : sampler_(std::move(sampler)), candidates_(candidates), n_(n) {}

    Rgb estimate(const ShadingPoint& point, const Integrand& f, Random& random, Tally& tally) override {
        sampler_->move_to(point);
        random.begin_set(); // candidates of all samples; which of them are kept is left to independent numbers
        Rgb sum{};
        for (std::uint32_t i = 0; i < n_; ++i) {
            const Kept kept = keep_one(point, f, random, tally);
            if (kept.weight > 0.0) add(f, kept.direction, kept.weight / (n_ * double(candidates_)), sum, tally);
        }
        return sum;
    }

private:
    struct Kept {
        float direction[3];
        double weight = 0.0; ///< sum of w_i / g
    };
    Kept keep_one(const ShadingPoint& point, const Integrand& f, Random& random, Tally& tally) const {
        Kept kept{};
        double sum = 0.0, g_kept = 0.0;
        for (std::uint32_t i = 0; i < candidates_; ++i) {
            const std::array<double, 2> u = random.pair();
            const AcdfDirectionSample s = sampler_->sample(u[0], u[1]);
            if (!counts(s, point, tally)) continue;
            const double g = f.unoccluded(s.direction), w = g / s.pdf;
            if (!(w > 0.0)) continue;
            sum += w;
            if (uniform(random) * sum >= w) continue;
            std::copy_n(s.direction, 3, kept.direction);
            g_kept = g;
        }
        if (sum > 0.0) kept.weight = sum / g_kept;
        return kept;
    }

    PointSamplerPtr sampler_;
    std::uint32_t candidates_, n_;
};

void check_count(std::uint64_t n) {
    if (n == 0) throw std::invalid_argument("an estimate needs at least one sample");
}

} // namespace

SingleEstimator::SingleEstimator(const LightSampler& sampler, std::uint32_t n) : sampler_(sampler), n_(n) {
    check_count(n);
}

std::unique_ptr<PointEstimator> SingleEstimator::point_estimator() const {
    return std::make_unique<Single>(sampler_.point_sampler(), n_);
}

MisEstimator::MisEstimator(const std::vector<Share>& shares, Heuristic heuristic) : heuristic_(heuristic) {
    for (const Share& share : shares)
        if (share.n > 0) shares_.push_back(share);
    check_count(shares_.size());
    std::size_t automatic = 0;
    for (const Share& share : shares_) automatic += share.automatic;
    if (automatic > 1 || (automatic == 1 && shares_.size() < 2))
        throw std::invalid_argument("one sampler beside others divides the samples itself");
}

std::unique_ptr<PointEstimator> MisEstimator::point_estimator() const {
    return std::make_unique<Mis>(shares_, heuristic_);
}

std::uint64_t MisEstimator::bytes() const {
    std::uint64_t sum = 0;
    for (const Share& share : shares_) sum += share.sampler->bytes();
    return sum;
}

ResamplingEstimator::ResamplingEstimator(const LightSampler& sampler, std::uint32_t candidates, std::uint32_t n)
    : sampler_(sampler), candidates_(candidates), n_(n) {
    check_count(std::uint64_t{candidates} * n);
}

std::unique_ptr<PointEstimator> ResamplingEstimator::point_estimator() const {
    return std::make_unique<Resampled>(sampler_.point_sampler(), candidates_, n_);
}

} // namespace acdf::measure
