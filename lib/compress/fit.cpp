#include "compress/fit.h"

#include <stdexcept>

namespace acdf::compress {
namespace {

Cascade fit_rows_first(const Target& target, const FitOptions& options) {
    return options.fit == ACDF_FIT_VARIANCE ? fit_variance(target, options) : fit_regional(target, options);
}

} // namespace

Cascade fit(const Target& target, const FitOptions& options) {
    if (!(integral(target) > 0.0)) throw std::invalid_argument("a target without energy");
    if (options.order == Order::z) return fit_rows_first(target, options);
    FitOptions turned = options;
    std::swap(turned.column_segments, turned.row_segments);
    return fit_rows_first(transposed(target), turned);
}

} // namespace acdf::compress
