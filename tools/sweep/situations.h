// The recommended file in pictures: how noisy a diffuse surface is with it, and with baselines after the same time.
#pragma once

#include "tools/sweep/sweep.h"
#include "tools/sweep/timing.h"

#include <string>
#include <vector>

namespace acdf::tools {

/// "open", "open_partner", "hidden", "hidden_partner".
const char* to_string(Situation situation);

/// "1.2 times less noise than", "1.2 times more noise than", "the same noise as" of how many times more variance
/// the other has.
std::string noise_ratio_text(double variance_ratio);

struct SituationAdvice {
    Situation situation = open_alone;
    Lit lit; ///< of the recommended file
    std::size_t best_baseline =
        0; ///< the best after the same time, or after the same samples where nothing was timed
    bool has_baseline = false;
    Interval over_reference;     ///< variance of the reference over that of the file, after the same time
    Interval over_best_baseline; ///< the same of `best_baseline`
    std::string sentence;
};

/// None for files that are not of environments.
std::vector<SituationAdvice> situations_of(const Sweep& sweep, const SweepRow& best);

} // namespace acdf::tools
