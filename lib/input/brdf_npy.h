// BRDFs as four-dimensional tables of numbers.
#pragma once

#include "input/brdf.h"
#include "input/npy.h"

namespace acdf::input {

/// A table of shape (theta_o, phi_o, theta_h, phi_h) of rho in sr^-1, the same for all channels. Value (i, j, k, l)
/// stands at the centre of a cell; cells divide theta in [0, pi/2] and phi in [0, 2 pi) equally. With a single
/// phi_o the BRDF is isotropic and phi_h counts from phi_o. Between centres linear in each angle: phi goes round,
/// theta is constant beyond the first and the last centre. Throws Error for another number of axes.
std::unique_ptr<Brdf> brdf_of_table(const std::string& name, NpyArray table);

/// The same from a file, negative numbers taken as 0 and counted in `notes`. Throws Error, also for NaN.
std::unique_ptr<Brdf> read_brdf_npy(const std::string& path, const std::string& name);

} // namespace acdf::input
