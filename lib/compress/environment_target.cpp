// From a probe to what the fit approximates: channels, filter, solid angles.
#include "compress/parallel.h"
#include "compress/row_nodes.h"
#include "compress/sum.h"
#include "compress/target.h"
#include "compress/widths.h"

#include <acdf/sample.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace acdf::compress {
namespace {

constexpr std::size_t kChannels = 3;

/// The integrand of a probe, one plane a channel that counts.
struct Integrand {
    std::uint32_t columns, rows;
    const float* values; ///< planes x rows x columns
    bool octahedral;

    const float* row(std::size_t plane, std::uint32_t r) const {
        return values + (plane * rows + r) * std::size_t{columns};
    }
};

/// Of each texel of a row: means of f and f^2, and the largest f.
struct RowMoments {
    std::vector<double> mean, square, peak;

    void clear(std::size_t columns) {
        for (std::vector<double>* of : {&mean, &square, &peak}) of->assign(columns, 0.0);
    }
};

/// A row of texels with one more at each end: the texels that the map shows there. Across the seam that is the
/// other end of the row; across a side of the octahedral square it is the texel that mirrors it at the middle of
/// the side. Rows above the first and below the last are those that the map shows there: at a pole the row itself.
using PaddedRow = std::vector<float>;

void pad_row(const Integrand& f, std::size_t plane, std::int64_t r, PaddedRow& out) {
    const std::int64_t last = std::int64_t{f.rows} - 1;
    const bool outside = r < 0 || r > last;
    const auto row = static_cast<std::uint32_t>(std::clamp(r, std::int64_t{0}, last));
    const float* values = f.row(plane, row);
    out.resize(f.columns + std::size_t{2});
    if (f.octahedral && outside) std::reverse_copy(values, values + f.columns, out.begin() + 1);
    else std::copy_n(values, f.columns, out.begin() + 1);
    const float* ends = f.octahedral ? f.row(plane, f.rows - 1 - row) : values;
    const bool same_side = f.octahedral && !outside;
    out.front() = ends[same_side ? 0 : f.columns - 1];
    out.back() = ends[same_side ? f.columns - 1 : 0];
}

/// out = a (1 - share) + b share.
ACDF_WIDTHS void blend(const float* a, const float* b, double share, std::size_t count, double* out) {
    const double rest = 1.0 - share;
    for (std::size_t i = 0; i < count; ++i) out[i] = double{a[i]} * rest + double{b[i]} * share;
}

/// Adds moments along a line of bilinear interpolation: between neighbouring centres f is linear, so the mean of
/// f^2 over half a texel from x to y is (x^2 + xy + y^2) / 3. line[0] is the texel before the first.
ACDF_WIDTHS void add_moments(const double* line, std::size_t count, double weight, double* mean, double* square) {
    for (std::size_t c = 0; c < count; ++c) {
        const double centre = line[c + 1], x = 0.5 * (line[c] + centre), y = 0.5 * (centre + line[c + 2]);
        mean[c] += weight * (0.25 * x + 0.5 * centre + 0.25 * y);
        square[c] +=
            weight * ((x * x + x * centre + centre * centre) + (centre * centre + centre * y + y * y)) / 6.0;
    }
}

ACDF_WIDTHS void raise_peaks(const double* line, std::size_t count, double* peak) {
    for (std::size_t c = 0; c < count; ++c) {
        const double centre = line[c + 1], x = 0.5 * (line[c] + centre), y = 0.5 * (centre + line[c + 2]);
        const double ends = x > y ? x : y, here = centre > ends ? centre : ends;
        peak[c] = here > peak[c] ? here : peak[c];
    }
}

/// Moments of bilinear interpolation over the texels of a row, exact along the row.
class BilinearRows {
public:
    explicit BilinearRows(const Integrand& f) : f_(f), line_(f.columns + std::size_t{2}) {}

    void add(std::size_t plane, std::uint32_t r, RowMoments& out) {
        for (std::size_t k = 0; k < 3; ++k) pad_row(f_, plane, std::int64_t{r} + std::int64_t(k) - 1, rows_[k]);
        out.clear(f_.columns);
        for (const RowNode& node : row_nodes(f_.octahedral, f_.rows, r)) {
            form_line(node.height);
            add_moments(line_.data(), f_.columns, node.weight, out.mean.data(), out.square.data());
        }
        for (const double height : {0.0, 0.5, 1.0}) { // f is largest at a corner of a quarter of the texel
            form_line(height);
            raise_peaks(line_.data(), f_.columns, out.peak.data());
        }
    }

private:
    void form_line(double height) {
        const std::size_t upper = height < 0.5 ? 0 : 1;
        blend(rows_[upper].data(), rows_[upper + 1].data(), upper == 0 ? height + 0.5 : height - 0.5, line_.size(),
              line_.data());
    }

    const Integrand& f_;
    std::array<PaddedRow, 3> rows_; ///< above, the row itself, below
    std::vector<double> line_;
};

void nearest_row(const Integrand& f, std::size_t plane, std::uint32_t r, RowMoments& out) {
    const float* row = f.row(plane, r);
    for (std::uint32_t c = 0; c < f.columns; ++c) {
        const double value = row[c];
        out.mean[c] = out.peak[c] = value;
        out.square[c] = value * value;
    }
}

} // namespace

std::array<RowNode, 6> row_nodes(bool octahedral, std::uint32_t rows, std::uint32_t row) {
    constexpr double kOffset = 0.7745966692414834; // sqrt(3/5)
    const std::array<double, 3> x{0.5 - 0.5 * kOffset, 0.5, 0.5 + 0.5 * kOffset};
    const std::array<double, 3> w{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
    std::array<RowNode, 6> nodes{};
    double sum = 0.0;
    for (std::size_t half = 0; half < 2; ++half)
        for (std::size_t k = 0; k < 3; ++k) {
            const double height = 0.5 * (double(half) + x[k]);
            double sine = 1.0, cosine;
            if (!octahedral) acdf_sincospi((row + height) / rows, &sine, &cosine);
            nodes[3 * half + k] = {height, w[k] * sine};
            sum += w[k] * sine;
        }
    for (RowNode& node : nodes) node.weight /= sum;
    return nodes;
}

std::uint32_t planes_of(const TargetOptions& options) {
    return options.channels == ACDF_CHANNELS_SEPARATE ? kChannels : 1;
}

bool take_texels(const float* rgb, std::size_t count, const TargetOptions& options, float* out,
                 std::size_t stride) {
    const ChannelWeights& w = options.weights;
    bool finite = true;
    for (std::size_t i = 0; i < count; ++i) {
        std::array<float, kChannels> c;
        for (std::size_t k = 0; k < kChannels; ++k) {
            const float v = rgb[kChannels * i + k];
            finite = finite && std::isfinite(v);
            c[k] = std::max(v, 0.0f);
        }
        if (options.channels == ACDF_CHANNELS_SEPARATE) {
            for (std::size_t k = 0; k < kChannels; ++k) out[k * stride + i] = c[k];
            continue;
        }
        out[i] = options.channels == ACDF_CHANNELS_LARGEST
                     ? std::max({c[0], c[1], c[2]})
                     : static_cast<float>(w.r * c[0] + w.g * c[1] + w.b * c[2]);
        finite = finite && std::isfinite(out[i]);
    }
    return finite;
}

float positive_float(double value) {
    const auto rounded = static_cast<float>(value);
    return rounded > 0.0f || !(value > 0.0) ? rounded : std::numeric_limits<float>::denorm_min();
}

Target empty_target(std::uint32_t columns, std::uint32_t rows, AcdfParameterization parameterization) {
    Target target;
    target.columns = columns;
    target.rows = rows;
    target.parameterization = parameterization;
    target.column_axis = ACDF_AXIS_PHI; // or u
    target.row_axis = ACDF_AXIS_THETA;  // or v
    if (parameterization == ACDF_PARAM_OCTAHEDRAL) {
        target.column_measure.assign(columns, 2.0 * ACDF_PI / columns);
        target.row_measure.assign(rows, 2.0 / rows);
        return target;
    }
    target.column_measure.assign(columns, 2.0 * ACDF_PI / columns);
    target.row_measure.resize(rows);
    for (std::uint32_t r = 0; r < rows; ++r) target.row_measure[r] = acdf_row_z(r, rows) - acdf_row_z(r + 1, rows);
    return target;
}

EnvironmentTarget::EnvironmentTarget(std::uint32_t columns, std::uint32_t rows, const TargetOptions& options)
    : options_(options), columns_(columns), rows_(rows), planes_(planes_of(options)),
      values_(std::size_t{planes_} * columns * rows) {}

void EnvironmentTarget::take(std::uint32_t first, std::uint32_t count, const float* rgb) {
    const std::size_t texels = std::size_t{columns_} * rows_, begin = std::size_t{first} * columns_;
    std::vector<std::uint8_t> finite(count, 1);
    parallel_for(std::uint32_t{0}, count, [&](std::uint32_t row) {
        const std::size_t i = std::size_t{row} * columns_;
        finite[row] = take_texels(rgb + kChannels * i, columns_, options_, values_.data() + begin + i, texels);
    });
    if (std::find(finite.begin(), finite.end(), 0) != finite.end())
        throw std::invalid_argument("radiance that is not finite");
}

Target EnvironmentTarget::finish() {
    Target target = planes_ == 1 && options_.filter == ACDF_FILTER_NEAREST ? nearest() : moments();
    values_ = {};
    return target;
}

/// g is f.
Target EnvironmentTarget::nearest() {
    Target target = empty_target(columns_, rows_, options_.parameterization);
    target.values = std::move(values_);
    std::vector<double> row_total(rows_);
    parallel_for(std::uint32_t{0}, rows_, [&](std::uint32_t r) {
        PlainerSum sum;
        for (std::uint32_t c = 0; c < columns_; ++c) sum.add(double{target.row(r)[c]} * target.column_measure[c]);
        row_total[r] = sum.value() * target.row_measure[r];
    });
    Sum total;
    for (const double row : row_total) total.add(row);
    target.total = total.value();
    target.mean_square = target.total * target.total;
    return target;
}

Target EnvironmentTarget::moments() {
    const Integrand f{columns_, rows_, values_.data(), options_.parameterization == ACDF_PARAM_OCTAHEDRAL};
    Target target = empty_target(columns_, rows_, options_.parameterization);
    const bool bilinear = options_.filter == ACDF_FILTER_BILINEAR;
    target.values.resize(std::size_t{columns_} * rows_);
    if (bilinear) target.peaks.resize(target.values.size());
    target.means.assign(planes_, std::vector<float>(target.values.size()));
    std::vector<std::array<double, kChannels>> row_total(rows_);
    parallel_for(std::uint32_t{0}, rows_, [&](std::uint32_t r) {
        RowMoments moments;
        moments.clear(columns_);
        BilinearRows rows(f);
        std::vector<double> square(columns_, 0.0), peak(columns_, 0.0);
        for (std::size_t plane = 0; plane < planes_; ++plane) {
            bilinear ? rows.add(plane, r, moments) : nearest_row(f, plane, r, moments);
            PlainerSum sum;
            for (std::uint32_t c = 0; c < columns_; ++c) {
                sum.add(moments.mean[c] * target.column_measure[c]);
                target.means[plane][std::size_t{r} * columns_ + c] = static_cast<float>(moments.mean[c]);
                square[c] += moments.square[c];
                peak[c] = std::max(peak[c], moments.peak[c]);
            }
            row_total[r][plane] = sum.value() * target.row_measure[r];
        }
        float* values = target.values.data() + std::size_t{r} * columns_;
        for (std::uint32_t c = 0; c < columns_; ++c) values[c] = positive_float(std::sqrt(square[c]));
        if (!bilinear) return;
        float* peaks = target.peaks.data() + std::size_t{r} * columns_;
        for (std::uint32_t c = 0; c < columns_; ++c) peaks[c] = positive_float(peak[c]);
    });
    refuse_overflow(target);
    for (std::size_t plane = 0; plane < planes_; ++plane) {
        Sum sum;
        for (std::uint32_t r = 0; r < rows_; ++r) sum.add(row_total[r][plane]);
        target.total += sum.value();
        target.mean_square += sum.value() * sum.value();
    }
    return target;
}

Target environment_target(const float* rgb, std::uint32_t columns, std::uint32_t rows,
                          const TargetOptions& options) {
    EnvironmentTarget target(columns, rows, options);
    target.take(0, rows, rgb);
    return target.finish();
}

} // namespace acdf::compress
