#include "build/probe/repeated_rows.h"

#include "compress/sum.h"
#include "compress/trigonometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace acdf::build {
namespace {

/// Means, over the solid angle of a texel at a pole, of the weight that the row beyond has, and of its square. It
/// is a half at the pole and falls to 0 at the middle of the row.
struct BeyondPole {
    double mean = 0.0, square = 0.0;
};

BeyondPole beyond_pole(std::uint32_t rows) {
    constexpr double kOffset = 0.7745966692414834; // sqrt(3/5): three points of Gauss and Legendre in each half
    constexpr double x[3] = {0.5 - 0.5 * kOffset, 0.5, 0.5 + 0.5 * kOffset}, w[3] = {5.0, 8.0, 5.0};
    BeyondPole out;
    double whole = 0.0;
    for (int half = 0; half < 2; ++half)
        for (int k = 0; k < 3; ++k) {
            const double height = 0.5 * (half + x[k]), share = std::max(0.5 - height, 0.0);
            const double omega = w[k] * compress::sine_cosine(height / rows).sine;
            out.mean += omega * share;
            out.square += omega * share * share;
            whole += omega;
        }
    return {out.mean / whole, out.square / whole};
}

/// A row of the map, which is linear between the middles of texels, within one of them: at its left side, in its
/// middle, and at its right side.
using Points = std::array<double, 3>;
Points points_of(const std::vector<float>& row, std::size_t column) {
    const std::size_t count = row.size();
    const double middle = row[column];
    return {0.5 * (double{row[(column + count - 1) % count]} + middle), middle,
            0.5 * (middle + double{row[(column + 1) % count]})};
}

double mean(const Points& f) { return 0.25 * f[0] + 0.5 * f[1] + 0.25 * f[2]; }

double mean_product(const Points& f, const Points& g) {
    double sum = 0.0;
    for (std::size_t k = 0; k < 2; ++k)
        sum += 2.0 * (f[k] * g[k] + f[k + 1] * g[k + 1]) + f[k] * g[k + 1] + f[k + 1] * g[k];
    return sum / 12.0;
}

/// Blends one row of a target, of one channel, with the row beyond.
class Blend {
public:
    Blend(compress::Target& target, std::uint32_t row)
        : target_(target), begin_(std::size_t{row} * target.columns), weight_(beyond_pole(target.rows)),
          squares_(target.columns) {}

    void add(std::size_t plane, const std::vector<float>& own, const std::vector<float>& beyond) {
        for (std::size_t column = 0; column < squares_.size(); ++column) {
            const Points f = points_of(own, column), g = points_of(beyond, column);
            const Points more{g[0] - f[0], g[1] - f[1], g[2] - f[2]};
            float& mean_of_f = target_.means[plane][begin_ + column];
            mean_of_f = static_cast<float>(std::max(double{mean_of_f} + weight_.mean * mean(more), 0.0));
            squares_[column] +=
                2.0 * weight_.mean * mean_product(f, more) + weight_.square * mean_product(more, more);
            float& peak = target_.peaks[begin_ + column];
            for (std::size_t k = 0; k < 3; ++k)
                peak = std::max(peak, compress::positive_float(0.5 * (f[k] + g[k])));
        }
    }
    /// Once, after all channels.
    void finish() {
        for (std::size_t column = 0; column < squares_.size(); ++column) {
            float& g = target_.values[begin_ + column];
            g = compress::positive_float(std::sqrt(std::max(double{g} * double{g} + squares_[column], 0.0)));
        }
    }

private:
    compress::Target& target_;
    std::size_t begin_;
    BeyondPole weight_;
    std::vector<double> squares_; ///< of each texel, what is added to the mean of f^2
};

void total(compress::Target& target) {
    target.total = target.mean_square = 0.0;
    for (const std::vector<float>& means : target.means) {
        compress::Sum sum;
        for (std::size_t i = 0; i < means.size(); ++i)
            sum.add(double{means[i]} * target.row_measure[i / target.columns] *
                    target.column_measure[i % target.columns]);
        target.total += sum.value();
        target.mean_square += sum.value() * sum.value();
    }
}

} // namespace

void repeat_rows(compress::Target& target, const float* first, const float* last,
                 const compress::TargetOptions& options) {
    const std::size_t columns = target.columns, planes = compress::planes_of(options);
    std::vector<float> rows[2] = {std::vector<float>(planes * columns), std::vector<float>(planes * columns)};
    compress::take_texels(first, columns, options, rows[0].data(), columns); // they are finite: `target` has them
    compress::take_texels(last, columns, options, rows[1].data(), columns);
    Blend top(target, 0), foot(target, target.rows - 1);
    for (std::size_t plane = 0; plane < planes; ++plane) {
        std::vector<float> of_plane[2];
        for (std::size_t k = 0; k < 2; ++k)
            of_plane[k].assign(rows[k].data() + plane * columns, rows[k].data() + (plane + 1) * columns);
        top.add(plane, of_plane[0], of_plane[1]);
        foot.add(plane, of_plane[1], of_plane[0]);
    }
    top.finish();
    if (target.rows > 1) foot.finish();
    compress::refuse_overflow(target);
    total(target);
}

} // namespace acdf::build
