// Reads MERL BRDF files: Matusik, Pfister, Brand, McMillan, "A Data-Driven Reflectance Model", ACM TOG 22(3), 2003.
#pragma once

#include "input/brdf/brdf.h"

#include <cstddef>
#include <cstdint>

namespace acdf::input {

/// Three int32 (90, 90, 180: steps of theta_h, theta_d and phi_d), then for red, green and blue as many doubles,
/// phi_d fastest, scaled by 1500, 1500 / 1.15 and 1500 / 1.66. All little-endian.
struct MerlLayout {
    static constexpr std::uint32_t theta_h = 90, theta_d = 90, phi_d = 180;
    static constexpr std::size_t entries = std::size_t{theta_h} * theta_d * phi_d;
    static constexpr std::size_t header = 12, bytes = header + 3 * entries * sizeof(double);
};

/// Evaluates as the reader published with the data: the entry whose cell holds (theta_h, theta_d, phi_d), with no
/// interpolation; row i of theta_h begins at (i/90)^2 pi/2, those of the others are of equal size; phi_d in [-pi,
/// 0) means phi_d + pi (reciprocity). Negative entries, which mark angles that were not measured, are 0 and counted
/// in `notes`. `name` goes into messages. Throws Error for anything but a whole file of finite numbers
/// below 1e18 sr^-1, of which at least one is above 0.
std::unique_ptr<Brdf> parse_merl(const std::string& name, const std::uint8_t* data, std::size_t size);

} // namespace acdf::input
