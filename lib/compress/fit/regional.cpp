// The paper's cascade: marginal, then one conditional for each region of the
// marginal.
#include "compress/fit/curve.h"
#include "compress/fit/fit.h"
#include "compress/parallel.h"
#include "compress/sum.h"

#include <algorithm>
#include <cmath>

namespace acdf::compress {
namespace {

Curve fit_curve(AcdfFit fit, const Distribution& distribution, const CurveBudget& budget) {
    switch (fit) {
    case ACDF_FIT_UNIFORM:
        return fit_curve_uniform(distribution, budget);
    case ACDF_FIT_PDF:
        return fit_curve_pdf(distribution, budget);
    default:
        return fit_curve_cdf(distribution, budget);
    }
}

/// Energy of each row: the marginal pdf times the row's measure.
Distribution marginal_distribution(const Target& target) {
    Distribution marginal{std::vector<double>(target.rows), target.row_measure};
    parallel_for(std::uint32_t{0}, target.rows, [&](std::uint32_t r) {
        const float* row = target.row(r);
        Sum sum;
        for (std::uint32_t c = 0; c < target.columns; ++c) sum.add(row[c] * target.column_measure[c]);
        marginal.mass[r] = sum.value() * target.row_measure[r];
    });
    return marginal;
}

/// How much f changes across each border between rows: the integral of |df/dx|
/// dy over that step (eq. 5).
std::vector<double> gradient(const Target& target) {
    std::vector<double> g(target.rows - 1);
    parallel_for(std::uint32_t{1}, target.rows, [&](std::uint32_t r) {
        const float *above = target.row(r - 1), *row = target.row(r);
        Sum sum;
        for (std::uint32_t c = 0; c < target.columns; ++c)
            sum.add(std::abs(double{row[c]} - double{above[c]}) * target.column_measure[c]);
        g[r - 1] = sum.value();
    });
    return g;
}

/// `count` stratified samples of the gradient's CDF, as row borders; some may
/// coincide.
std::vector<std::uint32_t> gradient_knots(const Target& target, std::uint32_t count) {
    std::vector<std::uint32_t> knots;
    if (target.rows < 2 || count == 0) return knots;
    std::vector<double> cdf = gradient(target);
    Sum sum;
    for (double& value : cdf) {
        sum.add(value);
        value = sum.value();
    }
    if (!(cdf.back() > 0.0)) return knots;
    for (std::uint32_t k = 0; k < count; ++k) {
        const double u = (k + 0.5) / count * cdf.back();
        const auto at = std::lower_bound(cdf.begin(), cdf.end(), u) - cdf.begin();
        knots.push_back(static_cast<std::uint32_t>(at) + 1);
    }
    return knots;
}

/// The same curve with more knots.
Curve with_knots(const Distribution& distribution, Curve curve, const std::vector<std::uint32_t>& extra) {
    const bool tilted = !curve.tilts.empty();
    std::vector<std::uint32_t> knots = std::move(curve.knots);
    knots.insert(knots.end(), extra.begin(), extra.end());
    std::sort(knots.begin(), knots.end());
    knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
    curve = curve_through(distribution, std::move(knots));
    for (std::size_t s = 0; tilted && s < curve.segments(); ++s) {
        const std::uint32_t begin = s == 0 ? 0 : curve.knots[s - 1];
        const std::uint32_t end =
            s < curve.knots.size() ? curve.knots[s] : static_cast<std::uint32_t>(distribution.mass.size());
        curve.tilts.push_back(best_tilt(distribution, begin, end));
    }
    return curve;
}

/// The mean over the region's rows of their conditional pdfs, each
/// weighted by its energy or (eq. 4) by its extent alone; dark rows have no
/// conditional and are left out.
Distribution regional_conditional(const Target& target, const Distribution& marginal, Conditional weighting,
                                  std::uint32_t begin, std::uint32_t end) {
    Distribution conditional{std::vector<double>(target.columns, 0.0), target.column_measure};
    for (std::uint32_t r = begin; r < end; ++r) {
        if (!(marginal.mass[r] > 0.0)) continue;
        const double extent = target.row_measure[r];
        const double weight = weighting == Conditional::energy ? extent : extent * extent / marginal.mass[r];
        const float* row = target.row(r);
        for (std::uint32_t c = 0; c < target.columns; ++c)
            conditional.mass[c] += row[c] * target.column_measure[c] * weight;
    }
    return conditional;
}

bool is_flat(const Curve& curve) {
    return curve.segments() == 1 && (curve.tilts.empty() || curve.tilts.front() == 0.0);
}

} // namespace

Cascade fit_regional(const Target& target, const FitOptions& options) {
    const Distribution marginal = marginal_distribution(target);
    Curve root = fit_curve(options.fit, marginal, {options.row_segments, options.epsilon});
    if (options.gradient_knots > 0)
        root = with_knots(marginal, std::move(root), gradient_knots(target, options.gradient_knots));
    root.axis = target.row_axis;

    const std::size_t regions = root.segments();
    std::vector<Curve> conditionals(regions);
    parallel_for(std::size_t{0}, regions, [&](std::size_t s) {
        if (!(root.probability[s] > 0.0)) return;
        const std::uint32_t begin = s == 0 ? 0 : root.knots[s - 1];
        const std::uint32_t end = s < root.knots.size() ? root.knots[s] : target.rows;
        conditionals[s] =
            fit_curve(options.fit, regional_conditional(target, marginal, options.conditional, begin, end),
                      {options.column_segments, options.epsilon});
        conditionals[s].axis = target.column_axis;
    });

    Cascade cascade;
    cascade.roots = {0};
    root.children.assign(regions, -1);
    cascade.curves.emplace_back();
    for (std::size_t s = 0; s < regions; ++s) {
        if (conditionals[s].probability.empty() || is_flat(conditionals[s])) continue;
        root.children[s] = static_cast<std::int32_t>(cascade.curves.size());
        cascade.curves.push_back(std::move(conditionals[s]));
    }
    cascade.curves.front() = std::move(root);
    if (options.progress) options.progress(1.0);
    return cascade;
}

} // namespace acdf::compress
