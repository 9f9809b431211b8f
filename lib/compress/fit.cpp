#include "compress/fit.h"

#include "compress/fit_tree.h"

#include <stdexcept>

namespace acdf::compress {
namespace {

Cascade fit_rows_first(const Target& target, const FitOptions& options) {
    return options.fit == ACDF_FIT_VARIANCE ? fit_variance_cascade(target, options) : fit_regional(target, options);
}

Cascade fit_two_levels(const Target& target, const FitOptions& options) {
    if (options.order == Order::z) return fit_rows_first(target, options);
    FitOptions turned = options;
    std::swap(turned.column_segments, turned.row_segments);
    return fit_rows_first(transposed(target), turned);
}

} // namespace

Fitted fit(const Target& target, const FitOptions& options) {
    if (!(integral(target) > 0.0)) throw std::invalid_argument("a target without energy");
    if (options.fit == ACDF_FIT_VARIANCE && options.shape == Shape::tree)
        return fit_trees({grid_of(target)}, options);
    Fitted out;
    out.cascade = fit_two_levels(target, options);
    out.tree = encode_tree(out.cascade);
    return out;
}

} // namespace acdf::compress
