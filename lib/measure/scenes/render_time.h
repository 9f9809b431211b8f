// How long estimators take on this machine.
#pragma once

#include "measure/scenes/scene_points.h"

#include <vector>

namespace acdf::measure {

struct TimingOptions {
    std::uint32_t rounds = 8;      ///< at least 2
    double seconds_a_round = 0.01; ///< for each estimator, about
    Numbers numbers = Numbers::independent;
};

/// Nanoseconds of processor time of one estimate at one point, everything included: moving to the point, sampling,
/// looking up light and BRDF, shadow rays. [estimator][round]. Of points spread evenly over those given. One
/// thread; in each round the estimators take turns, so that what else the machine does meets all of them.
/// `estimators` as for render(), one list an entry.
std::vector<std::vector<double>> time_estimates(const std::vector<ScenePoint>& points,
                                                const std::vector<std::vector<const Estimator*>>& estimators,
                                                const TimingOptions& options = {});

} // namespace acdf::measure
