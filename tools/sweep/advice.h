// What the figures of a sweep say, in words: which file to make, and where it is not the best there is.
#pragma once

#include "tools/sweep/renderers.h"
#include "tools/sweep/sweep.h"
#include "tools/sweep/timing.h"

#include <string>
#include <vector>

namespace acdf::tools {

enum class Verdict { ours, baseline, even, unknown };

/// A baseline beside the recommended file. Ratios are the baseline's over the file's.
struct BaselineComparison {
    std::size_t row = 0; ///< the baseline
    double bytes = kUnknown, variance = kUnknown;
    Interval time, equal_time;          ///< of sampling a sample; of the variance after the same time
    Verdict verdict = Verdict::unknown; ///< at equal time; even: the interval holds 1
};

struct Recommended {
    std::size_t row = 0;
    bool reached = false; ///< its noise is too small to see
};
/// Of a BRDF the smallest file whose variance is at most visible.largest_variance(), or the least noisy. There must
/// be a file of known variance.
Recommended recommended_row(const std::vector<SweepRow>& rows, const VisibleNoise& visible,
                            measure::Numbers numbers = measure::Numbers::independent);

struct Advice {
    std::vector<RendererAdvice> renderers; ///< probe
    std::string rule;                      ///< by which files were chosen
    std::vector<std::string> findings;     ///< where baselines win and where they do not; a sentence each

    // BRDF:
    Recommended recommended;
    std::string sentence; ///< which size, and what it gives
    std::string command;  ///< exactly what makes the file
    std::vector<BaselineComparison> comparisons;

    bool recommends(std::size_t row) const;
};

Advice advise(const Sweep& sweep);

/// Quoted for a shell where that is needed.
std::string shell_word(const std::string& word);

/// Of a file, and of what it takes in memory: "64 KiB (144 KiB in memory)"; of a baseline the latter alone.
std::string size_text(const SweepRow& row);

/// Three significant digits, as text for people: "0.0041", "12.3", "1230", "infinite".
std::string short_number(double value);
} // namespace acdf::tools
