#include "build/brdf_table.h"

#include "compress/trigonometry.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace acdf::build {
namespace {

/// Two cells and the weight of the second.
struct Between {
    std::size_t cell[2];
    double t;
};

Between clamped(double fraction, std::size_t cells) {
    const double x = std::clamp(fraction * static_cast<double>(cells) - 0.5, 0.0, static_cast<double>(cells - 1));
    const auto low = static_cast<std::size_t>(x);
    return {{low, std::min(low + 1, cells - 1)}, x - static_cast<double>(low)};
}

Between periodic(double fraction, std::size_t cells) {
    const double x =
        (fraction - std::floor(fraction)) * static_cast<double>(cells) + static_cast<double>(cells) - 0.5;
    const auto low = static_cast<std::size_t>(x);
    return {{low % cells, (low + 1) % cells}, x - static_cast<double>(low)};
}

/// Of a direction of any length, as fractions of what the axes of the table cover.
struct Angles {
    Angles() = default;
    explicit Angles(const double w[3])
        : of{w[0], w[1], w[2]}, theta(std::atan2(compress::norm(w[0], w[1]), w[2]) / (0.5 * compress::pi)),
          phi(std::atan2(w[1], w[0]) / (2.0 * compress::pi)) {}

    double of[3] = {0.0, 0.0, 0.0}; ///< none
    double theta = 0.0, phi = 0.0;
};

double mirror_asymmetry(const Array& table) {
    const std::size_t n = table.shape[3];
    double difference = 0.0, sum = 0.0;
    for (std::size_t row = 0; row < table.values.size(); row += n)
        for (std::size_t k = 0; k < n; ++k) {
            const double a = static_cast<double>(table.values[row + k]);
            difference += std::abs(a - static_cast<double>(table.values[row + n - 1 - k]));
            sum += a;
        }
    return sum > 0.0 ? difference / sum : 0.0;
}

class TableBrdf : public Brdf {
public:
    explicit TableBrdf(Array table) : table_(std::move(table)) {
        isotropic = table_.shape[1] == 1;
        asymmetry = mirror_asymmetry(table_);
        mirror = isotropic && asymmetry <= 1e-3;
    }

    void evaluate(const double wo[3], const double wi[3], double rgb[3]) const override {
        std::fill(rgb, rgb + 3, 0.0);
        if (!(wo[2] > 0.0 && wi[2] > 0.0)) return;
        const double h[3] = {wo[0] + wi[0], wo[1] + wi[1], wo[2] + wi[2]};
        thread_local Angles view; // most calls ask for many directions of one view
        if (std::memcmp(view.of, wo, sizeof view.of) != 0) view = Angles(wo);
        const Angles half(h);
        const auto& shape = table_.shape;
        const Between at[4] = {clamped(view.theta, shape[0]), periodic(view.phi, shape[1]),
                               clamped(half.theta, shape[2]),
                               periodic(isotropic ? half.phi - view.phi : half.phi, shape[3])};
        const double value = std::min(interpolate(at) * table_.scale, std::numeric_limits<double>::max());
        std::fill(rgb, rgb + 3, value);
    }

private:
    double interpolate(const Between at[4]) const {
        double weight[16], sum = 0.0; // of corners, whose bits are sides of the axes
        std::size_t index[16];
        weight[0] = 1.0, index[0] = 0;
        for (unsigned axis = 0, count = 1; axis < 4; ++axis, count *= 2)
            for (unsigned corner = 0; corner < count; ++corner) {
                const std::size_t row = index[corner] * table_.shape[axis];
                const double whole = weight[corner];
                index[corner] = row + at[axis].cell[0];
                index[corner + count] = row + at[axis].cell[1];
                weight[corner] = whole * (1.0 - at[axis].t);
                weight[corner + count] = whole * at[axis].t;
            }
        for (unsigned corner = 0; corner < 16; ++corner)
            if (weight[corner] > 0.0) sum += weight[corner] * static_cast<double>(table_.values[index[corner]]);
        return sum;
    }

    Array table_;
};

} // namespace

std::unique_ptr<Brdf> brdf_of_table(Array table) {
    if (table.shape.size() != 4)
        throw std::invalid_argument("it has " + std::to_string(table.shape.size()) +
                                    " axes, a BRDF has four: theta_o, phi_o, theta_h, phi_h");
    return std::make_unique<TableBrdf>(std::move(table));
}

} // namespace acdf::build
