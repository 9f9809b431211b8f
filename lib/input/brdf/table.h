// BRDFs as four-dimensional tables of numbers.
#pragma once

#include "input/brdf/brdf.h"
#include "input/npy.h"

namespace acdf::input {

/// As build::brdf_of_table, with `name`, and negative numbers (taken as 0) in `notes`. Throws Error for another
/// number of axes.
std::unique_ptr<Brdf> brdf_of_table(const std::string& name, NpyArray table);

/// The same from a file, negative numbers taken as 0 and counted in `notes`. Throws Error, also for NaN.
std::unique_ptr<Brdf> read_brdf_npy(const std::string& path, const std::string& name);

} // namespace acdf::input
