// The noise of a file and its partner together, by multiple importance sampling (Veach and Guibas, SIGGRAPH 1995).
#pragma once

#include "compress/sum.h"
#include "compress/target.h"

#include <acdf/layout.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace acdf::build {

/// The shares of a file that may be recommended: steps of 1/32, neither none nor all.
constexpr std::size_t recommendable_shares = 31;
inline double recommendable_share(std::size_t k) {
    return (double(k) + 1.0) / (double(recommendable_shares) + 1.0);
}

/// Sums over texels of an integrand f, for pdfs p of the file and b of its partner. Of N samples a `share` is
/// sampled from the file, the others from the partner.
class Combination {
public:
    Combination(double share, AcdfHeuristic heuristic) : share_(share), power_(heuristic == ACDF_HEURISTIC_POWER) {}

    /// A texel of measure `omega`.
    void add(double f, double omega, double p, double b) { add(f, &f, 1, omega, p, b); }
    /// The same of several channels: f is their root mean square in the texel, `means` what they are on average.
    void add(double f, const double* means, std::size_t channels, double omega, double p, double b) {
        if (!(f > 0.0)) return;
        const double ours = share_ * p, theirs = (1.0 - share_) * b, most = std::max(ours, theirs);
        if (!(most > 0.0)) {
            ++violations_;
            return;
        }
        // What weights multiply, over the larger pdf so that squares stay in range: 1 and `less`.
        const double less = std::min(ours, theirs) / most, weighed = power_ ? less * less : less;
        const double of_larger = 1.0 / (1.0 + weighed), of_other = weighed * of_larger;
        const double ratio = f / most;
        second_ += ratio * f * omega * (power_ ? (1.0 + less * weighed) * of_larger : 1.0) * of_larger;
        ours_.add(means, channels, (ours < theirs ? of_other : of_larger) * omega);
        theirs_.add(means, channels, (ours < theirs ? of_larger : of_other) * omega);
        largest_ = std::max(largest_, ratio * of_larger);
    }
    /// Adds the sums of other texels.
    void add(const Combination& other) {
        second_ += other.second_;
        ours_.add(other.ours_);
        theirs_.add(other.theirs_);
        largest_ = std::max(largest_, other.largest_);
        violations_ += other.violations_;
    }

    /// Of several channels the root of the sum of their squares.
    double integral() const {
        compress::ChannelSums all = ours_;
        all.add(theirs_);
        return all.length();
    }
    std::uint64_t violations() const { return violations_; }
    double max_weight() const { return integral() > 0.0 ? largest_ / integral() : 0.0; }
    /// N times the variance of an estimate of N samples, over the square of the integral: comparable with that of
    /// one sample alone. Infinite with a violation.
    double relative_variance() const {
        if (violations_ > 0) return std::numeric_limits<double>::infinity();
        const double e = integral();
        const double ours = ours_.length() / e, theirs = theirs_.length() / e;
        const double means =
            (share_ > 0.0 ? ours * ours / share_ : 0.0) + (share_ < 1.0 ? theirs * theirs / (1.0 - share_) : 0.0);
        return std::max(0.0, second_ / e / e - means);
    }

private:
    double share_;
    bool power_;
    double second_ = 0.0, largest_ = 0.0;
    compress::ChannelSums ours_, theirs_;
    std::uint64_t violations_ = 0;
};

} // namespace acdf::build
