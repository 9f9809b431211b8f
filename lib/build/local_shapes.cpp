// Which shape of a local environment file.
#include "build/local.h"

#include <stdexcept>
#include <string>
#include <utility>

namespace acdf::build {

std::string shape_text(const LocalOptions& options) {
    if (options.any_shape) return "--shape auto ";
    return options.shape == compress::LocalShape::fast ? "--shape fast " : "";
}

Local build_local_in_any_shape(const compress::Target& target, const Source& source, const LocalOptions& options,
                               const Progress& progress) {
    const auto half = [&](double begin) -> Progress {
        if (!progress) return {};
        return [&progress, begin](double done, const char* what) { progress(begin + 0.5 * done, what); };
    };
    LocalOptions each = options;
    each.any_shape = true;
    each.shape = compress::LocalShape::small;
    Local small = build_local(target, source, each, half(0.0));
    each.shape = compress::LocalShape::fast;
    try {
        Local fast = build_local(target, source, each, half(0.5));
        if (fast.accuracy.relative_variance <= kFastIsWorth * small.accuracy.relative_variance) return fast;
    } catch (const std::runtime_error&) { // a variance or a budget that it does not reach
    }
    return small;
}

} // namespace acdf::build
