// BRDFs as four-dimensional tables of numbers.
#pragma once

#include "build/array.h"
#include "build/reflectance.h"

#include <memory>

namespace acdf::build {

/// A table of shape (theta_o, phi_o, theta_h, phi_h) of rho in sr^-1, the same for all channels. Value (i, j, k, l)
/// stands at the centre of a cell; cells divide theta in [0, pi/2] and phi in [0, 2 pi) equally. With a single
/// phi_o the BRDF is isotropic and phi_h counts from phi_o. Between centres linear in each angle: phi goes round,
/// theta is constant beyond the first and the last centre. Throws std::invalid_argument for another number of axes.
std::unique_ptr<Brdf> brdf_of_table(Array table);

} // namespace acdf::build
