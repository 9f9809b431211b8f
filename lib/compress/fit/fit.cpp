#include "compress/fit/fit.h"

#include <stdexcept>
#include <utility>

namespace acdf::compress {
namespace {

Cascade fit_two_levels(const Target& target, const FitOptions& options) {
    if (options.order == Order::z) return fit_regional(target, options);
    FitOptions turned = options;
    std::swap(turned.column_segments, turned.row_segments);
    return fit_regional(transposed(target), turned);
}

} // namespace

Fitted fit(const Target& target, const FitOptions& options) {
    if (!has_energy(target)) throw std::invalid_argument("a target without energy");
    if (options.fit == ACDF_FIT_VARIANCE) throw std::invalid_argument("the variance fit is a tree of halvings");
    Fitted out;
    out.cascade = fit_two_levels(target, options);
    out.tree = encode_tree(out.cascade);
    if (options.progress) options.progress(1.0);
    return out;
}

} // namespace acdf::compress
