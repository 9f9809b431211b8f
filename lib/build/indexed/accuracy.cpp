#include "build/indexed/accuracy.h"

#include "build/indexed/texels.h"
#include "compress/parallel.h"
#include "compress/sum.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace acdf::build {
namespace {

constexpr std::uint32_t kPointsAcross = 8; // of a texel in the cone, along each axis

struct RowSums {
    compress::Sum moment;
    double largest = 0.0;
    std::uint64_t violations = 0;
};

class MixedSummer {
public:
    MixedSummer(const AcdfMixed& sky, const SunMap& map)
        : sky_(sky), target_(*map.target), lookup_(*map.texels, map.filter),
          of_one_channel_(map.target->means.size() < 2),
          near_(sky.cone.reach > 0.0
                    ? std::cos(std::min(3.0, std::acos(1.0 - sky.cone.reach) + texel_reach(*map.target)))
                    : 2.0) {}

    void add_row(std::uint32_t row, RowSums& sums) const {
        for (std::uint32_t column = 0; column < target_.columns; ++column) {
            const std::size_t i = std::size_t{row} * target_.columns + column;
            const double f = target_.values[i], peak = target_.peaks.empty() ? f : target_.peaks[i];
            if (!(f > 0.0)) continue;
            const std::uint32_t position[2] = {column, row};
            AcdfSpan box[2];
            const double of_tree = (1.0 - sky_.sun_share) * acdf_mixed_cell(&sky_, position, box);
            float d[3];
            grid_direction(target_, column + 0.5, row + 0.5, d);
            const double cosine = d[0] * sky_.cone.axis[0] + d[1] * sky_.cone.axis[1] + d[2] * sky_.cone.axis[2];
            if (near_ < 2.0 && cosine > near_) add_parts(column, row, of_tree, f, peak, sums);
            else add(f * f, peak, target_.row_measure[row] * target_.column_measure[column], of_tree, sums);
        }
    }

private:
    static void add(double square, double peak, double measure, double pdf, RowSums& sums) {
        if (!(pdf > 0.0)) {
            ++sums.violations;
            return;
        }
        sums.moment.add(measure * square / pdf);
        sums.largest = std::max(sums.largest, peak / pdf);
    }

    void add_parts(std::uint32_t column, std::uint32_t row, double of_tree, double f, double peak,
                   RowSums& sums) const {
        for (std::uint32_t k = 0; k < kPointsAcross * kPointsAcross; ++k) {
            const double x = column + (k % kPointsAcross + 0.5) / kPointsAcross,
                         y = row + (k / kPointsAcross + 0.5) / kPointsAcross;
            float d[3];
            grid_direction(target_, x, y, d);
            const double pdf = of_tree + sky_.sun_share * acdf_cone_pdf(&sky_.cone, acdf_cone_place(&sky_.cone, d));
            const double measure = part_of_row(target_, row, k / kPointsAcross, kPointsAcross) *
                                   target_.column_measure[column] / kPointsAcross;
            const double light = of_one_channel_ ? lookup_.at(x, y) : f;
            if (light > 0.0) add(light * light, of_one_channel_ ? light : peak, measure, pdf, sums);
        }
    }

    const AcdfMixed& sky_;
    const compress::Target& target_;
    TexelLookup lookup_;
    bool of_one_channel_;
    double near_;
};

} // namespace

builder::MapAccuracy measure_mixed(const MixedEnvironment& environment, const SunMap& map) {
    const MixedSummer summer(environment.data(), map);
    std::vector<RowSums> rows(map.target->rows);
    compress::parallel_for(std::uint32_t{0}, map.target->rows,
                           [&](std::uint32_t row) { summer.add_row(row, rows[row]); });
    builder::MapAccuracy out;
    compress::Sum moment;
    double largest = 0.0;
    for (const RowSums& row : rows) {
        moment.add(row.moment.value());
        largest = std::max(largest, row.largest);
        out.support_violations += row.violations;
    }
    const double integral = compress::integral(*map.target);
    const double mean_square = map.target->mean_square > 0.0 ? map.target->mean_square : integral * integral;
    constexpr double infinite = std::numeric_limits<double>::infinity();
    out.total = map.target->total > 0.0 ? map.target->total : integral;
    out.relative_variance =
        out.support_violations > 0 ? infinite : std::max(0.0, moment.value() / mean_square - 1.0);
    out.max_weight = out.support_violations > 0 ? infinite : largest / std::sqrt(mean_square);
    return out;
}

} // namespace acdf::build
