// Which shape of a local environment file.
#include "build/local.h"

#include <stdexcept>
#include <string>
#include <utility>

namespace acdf::build {

namespace {

// `bytes`: how many times those of small it may take.
bool is_worth(const Local& fast, const Local& small, double bytes) {
    return fast.accuracy.relative_variance <= kFastIsWorth * small.accuracy.relative_variance &&
           static_cast<double>(fast.bytes.size()) <= bytes * static_cast<double>(small.bytes.size());
}

} // namespace

std::string shape_text(const LocalOptions& options) {
    if (options.shape_from != ShapeFrom::request) return "";
    return options.shape == compress::LocalShape::fast ? "--shape fast " : "--shape small ";
}

Local build_local_in_any_shape(const compress::Target& target, const Source& source, const LocalOptions& options,
                               const Progress& progress) {
    const auto half = [&](double begin) -> Progress {
        if (!progress) return {};
        return [&progress, begin](double done, const char* what) { progress(begin + 0.5 * done, what); };
    };
    const bool smallest = options.goal.kind == compress::Goal::Kind::variance;
    LocalOptions each = options;
    each.shape_from = ShapeFrom::comparison;
    each.shape = compress::LocalShape::small;
    Local small = build_local(target, source, each, half(0.0));
    each.shape = compress::LocalShape::fast;
    try {
        Local fast = build_local(target, source, each, half(0.5));
        if (is_worth(fast, small, smallest ? 1.0 : kFastIsWorth)) return fast;
    } catch (const std::runtime_error&) { // a variance or a budget that it does not reach
    }
    return small;
}

} // namespace acdf::build
