#include "input/normals/histogram.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace acdf::input {
namespace {

constexpr std::uint32_t kSide = 1024; // cells of about 0.1 degree

/// The cell of a direction with |x| + |y| + |z| = 1 (octahedral map: Praun and Hoppe, SIGGRAPH 2003).
std::uint32_t cell_of(double x, double y, double z) {
    const double a = z >= 0.0 ? x : std::copysign(1.0 - std::abs(y), x);
    const double b = z >= 0.0 ? y : std::copysign(1.0 - std::abs(x), y);
    // The axes lie in the middle of cells: what a flat floor's normals round to must not fall into four.
    const auto step = [](double t) {
        return std::min(static_cast<std::uint32_t>(std::max((0.5 + 0.5 * t) * (kSide - 1) + 0.5, 0.0)), kSide - 1);
    };
    return step(b) * kSide + step(a);
}

} // namespace

void NormalHistogram::add(double x, double y, double z, double weight) {
    const double largest = std::max({std::abs(x), std::abs(y), std::abs(z)});
    if (!(std::isfinite(x) && std::isfinite(y) && std::isfinite(z) && largest > 0.0)) return skip();
    x /= largest; // squares neither overflow nor vanish
    y /= largest;
    z /= largest;
    if (up_ == UpAxis::y) {
        std::swap(x, y); // (x, y, z) -> (z, x, y)
        std::swap(x, z);
    }
    const double manhattan = std::abs(x) + std::abs(y) + std::abs(z);
    const double scale = weight / std::sqrt(x * x + y * y + z * z);
    Cell& cell = cells_[cell_of(x / manhattan, y / manhattan, z / manhattan)];
    cell.x += x * scale;
    cell.y += y * scale;
    cell.z += z * scale;
    cell.weight += weight;
}

std::vector<WeightedNormal> NormalHistogram::normals() const {
    std::vector<WeightedNormal> out;
    const std::map<std::uint32_t, Cell> in_order(cells_.begin(), cells_.end());
    for (const auto& [number, cell] : in_order) {
        const double x = cell.x / cell.weight, y = cell.y / cell.weight, z = cell.z / cell.weight;
        const double length = std::sqrt(x * x + y * y + z * z);
        out.push_back(
            {{static_cast<float>(x / length), static_cast<float>(y / length), static_cast<float>(z / length)},
             cell.weight});
    }
    return out;
}

} // namespace acdf::input
