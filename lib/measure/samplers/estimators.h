// What is done with samplers: one, several, or candidates of one that are resampled.
//
// Each sampler samples one set of numbers an estimate (Random). The integrand is 0 below the horizon: it is
// evaluated above it alone.
#pragma once

#include "measure/samplers/estimator.h"

#include <vector>

namespace acdf::measure {

/// The mean of f/p over n samples; those below the horizon and those that sample nothing count as 0. With the full
/// CDF this is its use "with rejection below the horizon": rejected samples are lost. To sample others instead one
/// would have to know each normal's share of the flux above its horizon, by which their pdf grows.
class SingleEstimator : public Estimator {
public:
    /// Throws std::invalid_argument for n = 0.
    SingleEstimator(const LightSampler& sampler, std::uint32_t n);
    std::unique_ptr<PointEstimator> point_estimator() const override;
    std::uint64_t bytes() const override { return sampler_.bytes(); }

private:
    const LightSampler& sampler_;
    std::uint32_t n_;
};

/// A sampler and how many samples it gives.
struct Share {
    const LightSampler* sampler = nullptr;
    std::uint32_t n = 0;
    /// At each point it gives what it recommends itself of all samples instead, at least one and not all of them;
    /// others share the rest in proportion.
    bool automatic = false;
};

enum class Heuristic {
    balance, ///< weights n_i p_i / sum of n_k p_k
    power,   ///< (n_i p_i)^2 / sum of (n_k p_k)^2
};

/// Multi-sample multiple importance sampling (Veach and Guibas, SIGGRAPH 1995): the sum over samplers i and their
/// samples x of w_i(x) f(x) / (n_i p_i(x)). Unbiased where at least one pdf is > 0 wherever f is.
class MisEstimator : public Estimator {
public:
    /// Samplers with n = 0 are left out. Throws std::invalid_argument where none remains, or several are automatic,
    /// or one that has no other beside it.
    MisEstimator(const std::vector<Share>& shares, Heuristic heuristic);
    std::unique_ptr<PointEstimator> point_estimator() const override;
    std::uint64_t bytes() const override; ///< of all samplers

private:
    std::vector<Share> shares_;
    Heuristic heuristic_;
};

/// Resampled importance sampling (Talbot, Cline, Egbert, EGSR 2005): n times M candidates x_i of the sampler, one
/// of them kept with probability proportional to w_i = g(x_i)/p(x_i), g the unoccluded luminance; its estimate is
/// f/g * (1/M sum of w_i). One shadow ray for each that is kept. Where f/g is constant its variance is that of the
/// sampler with n M samples; never less.
class ResamplingEstimator : public Estimator {
public:
    /// Throws std::invalid_argument for n = 0 or M = 0.
    ResamplingEstimator(const LightSampler& sampler, std::uint32_t candidates, std::uint32_t n);
    std::unique_ptr<PointEstimator> point_estimator() const override;
    std::uint64_t bytes() const override { return sampler_.bytes(); }

private:
    const LightSampler& sampler_;
    std::uint32_t candidates_, n_;
};

} // namespace acdf::measure
