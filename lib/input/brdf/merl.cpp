#include "input/brdf/merl.h"

#include "compress/trigonometry.h"
#include "input/error.h"
#include "input/line_ends.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace acdf::input {
namespace {

constexpr double channel_scale[3] = {1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};

std::uint32_t step(double fraction, std::uint32_t steps) {
    return static_cast<std::uint32_t>(std::clamp(fraction * steps, 0.0, steps - 1.0));
}

class Merl : public Brdf {
public:
    explicit Merl(std::vector<float> table) : table_(std::move(table)) {}

    void evaluate(const double wo[3], const double wi[3], double rgb[3]) const override {
        std::fill(rgb, rgb + 3, 0.0);
        if (!(wo[2] > 0.0 && wi[2] > 0.0)) return;
        const std::size_t entry = index(wo, wi);
        for (std::size_t c = 0; c < 3; ++c) rgb[c] = static_cast<double>(table_[3 * entry + c]);
    }

private:
    /// wi seen from the half-vector: first turned about z by -phi_h, then about y by -theta_h.
    static std::size_t index(const double wo[3], const double wi[3]) {
        double h[3] = {wo[0] + wi[0], wo[1] + wi[1], wo[2] + wi[2]};
        const double length = std::sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
        for (double& x : h) x /= length;
        const double sin_theta = compress::norm(h[0], h[1]);
        const double cos_phi = sin_theta > 0.0 ? h[0] / sin_theta : 1.0;
        const double sin_phi = sin_theta > 0.0 ? h[1] / sin_theta : 0.0;
        const double turned = cos_phi * wi[0] + sin_phi * wi[1];
        const double x = h[2] * turned - sin_theta * wi[2];
        const double y = cos_phi * wi[1] - sin_phi * wi[0];
        const double z = sin_theta * turned + h[2] * wi[2];

        const double theta_h = std::atan2(sin_theta, h[2]), theta_d = std::acos(std::clamp(z, -1.0, 1.0));
        double phi_d = std::atan2(y, x);
        if (phi_d < 0.0) phi_d += compress::pi;
        const std::size_t row = step(std::sqrt(theta_h / (0.5 * compress::pi)), MerlLayout::theta_h);
        const std::size_t column = step(theta_d / (0.5 * compress::pi), MerlLayout::theta_d);
        return (row * MerlLayout::theta_d + column) * MerlLayout::phi_d +
               step(phi_d / compress::pi, MerlLayout::phi_d);
    }

    std::vector<float> table_; ///< theta_h x theta_d x phi_d x 3, in sr^-1
};

void check_header(const std::string& name, const std::uint8_t* data, std::size_t size) {
    if (size < MerlLayout::header) throw input_error(name, "it is too short for a MERL file; copy it again");
    std::int32_t steps[3];
    std::memcpy(steps, data, sizeof steps);
    if (steps[0] != MerlLayout::theta_h || steps[1] != MerlLayout::theta_d || steps[2] != MerlLayout::phi_d)
        throw input_error(name,
                          "its header says " + std::to_string(steps[0]) + " x " + std::to_string(steps[1]) + " x " +
                              std::to_string(steps[2]) +
                              " entries, a MERL file has 90 x 90 x 180; give a .binary file of that database");
    if (size != MerlLayout::bytes)
        throw input_error(name, "it has " + std::to_string(size) + " bytes, a MERL file has " +
                                    std::to_string(MerlLayout::bytes) + ": it is cut short or damaged" +
                                    maybe_converted_line_ends(name) + "; copy it again");
}

/// Mean difference between entries whose phi_d are mirrored, over their mean.
double mirror_asymmetry(const std::vector<float>& table) {
    double difference = 0.0, sum = 0.0;
    for (std::size_t row = 0; row < table.size(); row += 3 * MerlLayout::phi_d)
        for (std::size_t k = 0; k < MerlLayout::phi_d; ++k)
            for (std::size_t c = 0; c < 3; ++c) {
                const double a = static_cast<double>(table[row + 3 * k + c]);
                const double b = static_cast<double>(table[row + 3 * (MerlLayout::phi_d - 1 - k) + c]);
                difference += std::abs(a - b);
                sum += a;
            }
    return sum > 0.0 ? difference / sum : 0.0;
}

} // namespace

std::unique_ptr<Brdf> parse_merl(const std::string& name, const std::uint8_t* data, std::size_t size) {
    check_header(name, data, size);
    std::vector<float> table(3 * MerlLayout::entries);
    std::size_t negative = 0, positive = 0, bad = 0, huge = 0;
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < MerlLayout::entries; ++i) {
            double value;
            std::memcpy(&value, data + MerlLayout::header + (c * MerlLayout::entries + i) * sizeof value,
                        sizeof value);
            value *= channel_scale[c];
            if (!(std::abs(value) <= double{std::numeric_limits<float>::max()})) ++bad;
            else if (value < 0.0) ++negative;
            else {
                table[3 * i + c] = static_cast<float>(value);
                positive += table[3 * i + c] > 0.0f;
                huge += !(value < build::kMostReflectance);
            }
        }
    if (bad > 0)
        throw input_error(name, std::to_string(bad) +
                                    " of its entries are NaN or infinite in single precision; download it again");
    if (huge > 0)
        throw input_error(name, std::to_string(huge) + " of its entries are 1e18 sr^-1 or more; download it again");
    if (positive == 0) throw input_error(name, "none of its entries is above 0; download it again");
    const double asymmetry = mirror_asymmetry(table);
    auto brdf = std::make_unique<Merl>(std::move(table));
    brdf->name = name;
    brdf->asymmetry = asymmetry;
    brdf->mirror = asymmetry <= 1e-3;
    if (negative > 0)
        brdf->notes.push_back(std::to_string(negative) + " of " + std::to_string(3 * MerlLayout::entries) +
                              " entries are negative (angles that were not measured) and taken as 0");
    return brdf;
}

} // namespace acdf::input
