#include "measure/samplers/full_cdf.h"

#include "compress/sum.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace acdf::measure {
namespace {

/// Fills cdf[0 .. n] from masses and returns their sum; a row without energy gets a uniform CDF.
template <class Mass>
double make_cdf(std::size_t n, const Mass& mass, float* cdf) {
    compress::Sum total, running;
    for (std::size_t i = 0; i < n; ++i) total.add(mass(i));
    cdf[0] = 0.0f;
    for (std::size_t i = 0; i < n; ++i) {
        running.add(mass(i));
        cdf[i + 1] =
            static_cast<float>(total.value() > 0.0 ? running.value() / total.value() : double(i + 1) / double(n));
    }
    cdf[n] = 1.0f;
    return total.value();
}

/// The step that holds u and how far into it u reaches.
double invert(const float* cdf, std::size_t n, float u) {
    const auto after = std::upper_bound(cdf, cdf + n + 1, u) - cdf;
    const std::size_t i = std::clamp<std::size_t>(static_cast<std::size_t>(after), 1, n) - 1;
    const double width = double{cdf[i + 1]} - double{cdf[i]};
    return double(i) + (width > 0.0 ? std::min((double{u} - double{cdf[i]}) / width, 1.0 - 1e-9) : 0.5);
}

} // namespace

FullCdf::FullCdf(const compress::Target& target)
    : columns_(target.columns), rows_(target.rows), function_(target.values), row_integral_(target.rows),
      conditional_(std::size_t{target.rows} * (target.columns + 1)), marginal_(target.rows + 1) {
    // Times a power of two, which is exact, sums of rows are in the range of floats whatever the light is.
    int exponent = 0;
    if (!target.values.empty())
        std::frexp(*std::max_element(target.values.begin(), target.values.end()), &exponent);
    for (std::size_t r = 0; r < rows_; ++r) {
        const float* row = target.row(static_cast<std::uint32_t>(r));
        const auto mass = [&](std::size_t c) { return std::ldexp(row[c] * target.column_measure[c], -exponent); };
        row_integral_[r] = static_cast<float>(make_cdf(columns_, mass, conditional_.data() + r * (columns_ + 1)));
    }
    const auto mass = [&](std::size_t r) { return row_integral_[r] * target.row_measure[r]; };
    total_ = std::ldexp(make_cdf(rows_, mass, marginal_.data()), exponent);
}

FullCdf::Draw FullCdf::sample(float u0, float u1) const {
    Draw draw;
    draw.row = invert(marginal_.data(), rows_, u1);
    const auto r = static_cast<std::uint32_t>(draw.row);
    draw.column = invert(conditional_.data() + std::size_t{r} * (columns_ + 1), columns_, u0);
    draw.pdf = pdf(static_cast<std::uint32_t>(draw.column), r);
    return draw;
}

double FullCdf::pdf(std::uint32_t column, std::uint32_t row) const {
    return total_ > 0.0 ? double{function_[std::size_t{row} * columns_ + column]} / total_ : 0.0;
}

std::uint64_t FullCdf::bytes() const {
    return (function_.size() + row_integral_.size() + conditional_.size() + marginal_.size()) * sizeof(float);
}

double full_cdf_relative_variance(const compress::Target& target) {
    const FullCdf cdf(target);
    const double perfect = compress::integral(target);
    compress::Sum variance; // around that of the perfect pdf, so that a small one keeps its digits
    for (std::uint32_t r = 0; r < target.rows; ++r)
        for (std::uint32_t c = 0; c < target.columns; ++c) {
            const double f = target.row(r)[c] / perfect, p = cdf.pdf(c, r);
            if (f > 0.0 && !(p > 0.0)) return std::numeric_limits<double>::infinity();
            if (p > 0.0) variance.add(target.row_measure[r] * target.column_measure[c] * (f - p) * (f - p) / p);
        }
    const double least = compress::least_second_moment(target);
    return variance.value() * least + (least - 1.0);
}

} // namespace acdf::measure
