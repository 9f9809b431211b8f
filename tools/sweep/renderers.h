// Which file of a probe to make for which kind of renderer.
#pragma once

#include "tools/sweep/sweep.h"
#include "tools/sweep/timing.h"

#include <optional>
#include <string>
#include <vector>

namespace acdf::tools {

/// By the two questions of README.md: whether it combines samples of the light and of the BSDF by MIS, and what it
/// hands to its lights.
struct RendererKind {
    bool mis = false;
    Given given = Given::nothing;

    Estimator estimator() const { return mis ? with_mis : light_alone; }
};
/// For programs: "alone", "mis", "alone_normal", "mis_normal", "alone_position", "mis_position".
std::string to_string(const RendererKind& renderer);
/// For people: "MIS, normal".
std::string renderer_text(const RendererKind& renderer);

/// One file beside another after the same time; untimed, after the same samples.
struct Rival {
    std::size_t row = 0;
    Interval variance; ///< the rival's over the file's
};

struct RendererAdvice {
    RendererKind renderer;
    std::size_t row = 0;           ///< the file to make
    double variance = kUnknown;    ///< case_mean of it
    Interval over_reference;       ///< variance of the reference over that of the file, as in Rival
    std::optional<Rival> other;    ///< the best file of another kind
    std::optional<Rival> baseline; ///< the best baseline
    std::string sentence, command;
};

/// No file is better by more in noise than this: it would not be seen.
constexpr double kSameNoise = 1.05;

/// Relative variance of one sample, geometric mean over cases; noise too small to see counts as the least that can
/// be seen. With the numbers by which the advice goes. Infinite: biased.
double case_mean(const Sweep& sweep, const SweepRow& row, Estimator estimator);

/// One of each kind of renderer for which there is a file: of the kind of file with the least noise after the same
/// time the smallest whose noise is at most kSameNoise times that.
std::vector<RendererAdvice> advise_renderers(const Sweep& sweep);

/// What makes the file of a row: "acdf env 'my probe.exr' --budget 64KiB -o 'my probe.acdf'".
std::string command_text(const Sweep& sweep, const SweepRow& row);

/// "1.2 times less noise than", "1.2 times more noise than", "the same noise as" of how many times more variance
/// the other has.
std::string noise_ratio_text(double variance_ratio);

} // namespace acdf::tools
