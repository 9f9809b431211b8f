// How far a stored pdf is from its target, by summation over every texel: no samples, no noise.
#pragma once

#include "compress/target.h"

#include <acdf/accuracy.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <cstdint>

namespace acdf::build {

using Accuracy = builder::EnvironmentAccuracy;

/// Compares an environment file with a target of the same grid (rows are theta and columns phi, or v and u). Throws
/// std::invalid_argument where the grids differ or the target has no energy.
Accuracy measure_environment(const File& file, const compress::Target& target);

/// The same of what points without a normal sample from in a local environment file: its environment(), used alone
/// whatever the partner of the file.
Accuracy measure_whole(const File& file, const compress::Target& target);

} // namespace acdf::build
