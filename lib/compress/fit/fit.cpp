#include "compress/fit/fit.h"

#include "compress/fit/tree.h"

#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace acdf::compress {
namespace {

Cascade fit_two_levels(const Target& target, const FitOptions& options) {
    if (options.order == Order::z) return fit_regional(target, options);
    FitOptions turned = options;
    std::swap(turned.column_segments, turned.row_segments);
    return fit_regional(transposed(target), turned);
}

/// The trees are fitted to g. What the options say of f, relative to f's mean, is so translated.
FitOptions of_best_pdf(const Target& target, FitOptions options) {
    const double least = least_second_moment(target);
    if (options.goal.kind == Goal::Kind::variance) {
        if (1.0 + options.goal.variance <= least) {
            char text[120];
            std::snprintf(text, sizeof text, "a relative variance of %g is out of reach: texels alone have %.3g",
                          options.goal.variance, least - 1.0);
            throw std::runtime_error(text);
        }
        options.goal.variance = (1.0 + options.goal.variance) / least - 1.0;
    }
    options.max_weight /= std::sqrt(least);
    return options;
}

} // namespace

Fitted fit(const Target& target, const FitOptions& options) {
    if (!has_energy(target)) throw std::invalid_argument("a target without energy");
    if (options.fit == ACDF_FIT_VARIANCE && options.goal.kind == Goal::Kind::cells && options.goal.cells == 0)
        throw std::invalid_argument("a goal of 0 cells");
    if (options.fit == ACDF_FIT_VARIANCE) return fit_trees({grid_of(target)}, of_best_pdf(target, options));
    Fitted out;
    out.cascade = fit_two_levels(target, options);
    out.tree = encode_tree(out.cascade);
    if (options.progress) options.progress(1.0);
    return out;
}

} // namespace acdf::compress
