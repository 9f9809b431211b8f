// The file that a fit makes of a target: halvings of the variance fit, curves of the others.
#pragma once

#include "compress/fit/fit.h"
#include "compress/halvings/fit.h"
#include "compress/store/store.h"
#include "compress/target.h"

#include <cstdint>
#include <vector>

namespace acdf_test {

inline std::vector<std::uint8_t> environment_file(const acdf::compress::Target& target,
                                                  const acdf::compress::FitOptions& options,
                                                  AcdfCodec codec = ACDF_CODEC_NONE) {
    using namespace acdf::compress;
    Description description = environment_description(target.columns, target.rows, target.parameterization);
    description.fit = options.fit;
    description.total = integral(target);
    if (options.fit != ACDF_FIT_VARIANCE) return store(fit(target, options).tree, description, codec);
    HalvingsOptions halvings;
    halvings.goal = options.goal;
    halvings.max_weight = options.max_weight;
    return store(fit_halvings(target, halvings), description, codec);
}

} // namespace acdf_test
