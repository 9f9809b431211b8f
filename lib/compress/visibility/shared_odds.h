// What odds of a cell cost some of its points.
#pragma once

#include "compress/visibility/parts.h"

#include <acdf/visibility/cells.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace acdf::compress {

/// The odds of a cell are right for the light of all its points together. For a normal whose light lies elsewhere
/// in the sides of a column they may be far off.
class SharedOdds {
public:
    SharedOdds(const VisibilityParts& parts, const VisibilitySums& sums, const std::vector<float>& factors)
        : parts_(parts) {
        std::vector<double> all{0.0}, seen{0.0}; // of the parts before each
        for (std::size_t p = 0; p < factors.size(); ++p) {
            all.push_back(all.back() + double{sums.all[p]});
            seen.push_back(seen.back() + double{sums.all[p] * factors[p]});
        }
        const auto share = [&](std::size_t a, std::size_t b) {
            return all[b] > all[a] ? (seen[b] - seen[a]) / (all[b] - all[a]) : 1.0;
        };
        parts_.for_each_column([&](std::size_t first, std::size_t middle, std::size_t end) {
            const double lower = share(first, middle), upper = share(middle, end);
            odds_.push_back(lower / (lower + upper));
        });
    }

    /// The root of the second moment of some of its points.
    double cost(const VisibilitySums& some) {
        before_.assign(1, 0.0);
        for (const float all : some.all) before_.push_back(before_.back() + double{all});
        given_.assign(some.all.size(), before_.back()); // what of the samples the side that begins there has
        std::size_t column = 0;
        parts_.for_each_column([&](std::size_t first, std::size_t middle, std::size_t end) {
            const double odds = odds_[column++];
            const double lower = odds * (before_[middle] - before_[first]);
            const double upper = (1.0 - odds) * (before_[end] - before_[middle]);
            const double scale = lower + upper > 0.0 ? given_[first] / (lower + upper) : 0.0;
            given_[middle] = upper * scale;
            given_[first] = lower * scale;
        });
        double moment = 0.0;
        for (std::size_t p = 0; p < given_.size(); ++p)
            if (some.seen[p] > 0.0f)
                moment += double{some.seen[p]} * double{some.all[p]} /
                          ((1.0 - ACDF_UNSEEN) * given_[p] + ACDF_UNSEEN * double{some.all[p]});
        return std::sqrt(moment * before_.back());
    }

private:
    const VisibilityParts& parts_;
    std::vector<double> odds_, given_, before_;
};

} // namespace acdf::compress
