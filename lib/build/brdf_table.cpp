#include "build/brdf_table.h"

#include "compress/trigonometry.h"

#include <algorithm>
#include <cmath>
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
        const auto theta = [](const double w[3]) {
            return std::atan2(compress::norm(w[0], w[1]), w[2]) / (0.5 * compress::pi);
        };
        const double phi_o = std::atan2(wo[1], wo[0]) / (2.0 * compress::pi),
                     phi_h = std::atan2(h[1], h[0]) / (2.0 * compress::pi);
        const auto& shape = table_.shape;
        const Between at[4] = {clamped(theta(wo), shape[0]), periodic(phi_o, shape[1]), clamped(theta(h), shape[2]),
                               periodic(isotropic ? phi_h - phi_o : phi_h, shape[3])};
        const double value = std::min(interpolate(at) * table_.scale, std::numeric_limits<double>::max());
        std::fill(rgb, rgb + 3, value);
    }

private:
    double interpolate(const Between at[4]) const {
        double sum = 0.0;
        for (unsigned corner = 0; corner < 16; ++corner) {
            double weight = 1.0;
            std::size_t index = 0;
            for (unsigned axis = 0; axis < 4; ++axis) {
                const unsigned side = corner >> axis & 1u;
                weight *= side ? at[axis].t : 1.0 - at[axis].t;
                index = index * table_.shape[axis] + at[axis].cell[side];
            }
            if (weight > 0.0) sum += weight * static_cast<double>(table_.values[index]);
        }
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
