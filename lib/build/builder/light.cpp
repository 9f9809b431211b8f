// Environments and local environments, of targets, pixels and rows.
#include "build/builder/guard.h"
#include "build/builder/options.h"
#include "build/builder/sources.h"
#include "build/builder/target.h"

namespace acdf::builder {
namespace {

/// What a target knows of itself goes into the file with the rest.
template <class Options>
build::Source source_of(const Options& options, const Target& target) {
    build::Source source = options.source;
    if (source.projection.empty()) source.projection = target.data()->projection;
    source.reading += wrap_text(target.data()->map.repeats);
    return source;
}

Environment make(const Target& target, const EnvironmentOptions& given, const build::Progress& progress) {
    build::EnvironmentOptions options = internal(given);
    options.target = target.data()->options;
    build::Environment made =
        build::build_environment(target.data()->grid, source_of(given, target), options, progress);
    Environment out;
    out.bytes = std::move(made.bytes);
    out.accuracy = made.accuracy;
    out.bad_texels = target.data()->bad;
    if (made.order) out.order = *made.order == compress::Order::phi ? Order::phi : Order::z;
    return out;
}

Local make(const Target& target, const LocalOptions& given, const build::Progress& progress) {
    build::LocalOptions options = internal(given);
    options.target = target.data()->options;
    build::Local made = build::build_local(target.data()->grid, source_of(given, target), options, progress);
    Local out;
    out.bytes = std::move(made.bytes);
    out.accuracy = made.accuracy;
    out.normals = made.normals;
    out.bad_texels = target.data()->bad;
    return out;
}

template <class Options, class Result>
Status make_of_target(const Target& target, const Options& options, Result& result,
                      const Control& control) noexcept {
    return make_into(result, control, [&](Gate& gate) {
        require(!target.empty(), "the target is empty");
        check(options);
        return make(target, options, gate.part(0.0, 1.0));
    });
}

template <class Image, class Options, class Result>
Status make_of(const Image& image, const Options& options, Result& result, const Control& control) noexcept {
    constexpr double reading = 0.2; // of the time, about
    return make_into(result, control, [&](Gate& gate) {
        check(options);
        const Target target = make_target(image, options.target, control.threads, gate.part(0.0, reading));
        return make(target, options, gate.part(reading, 1.0 - reading));
    });
}

} // namespace

Status environment(const Target& target, const EnvironmentOptions& options, Environment& result,
                   const Control& control) noexcept {
    return make_of_target(target, options, result, control);
}
Status environment(const Pixels& pixels, const EnvironmentOptions& options, Environment& result,
                   const Control& control) noexcept {
    return make_of(pixels, options, result, control);
}
Status environment(const Rows& rows, const EnvironmentOptions& options, Environment& result,
                   const Control& control) noexcept {
    return make_of(rows, options, result, control);
}

Status local(const Target& target, const LocalOptions& options, Local& result, const Control& control) noexcept {
    return make_of_target(target, options, result, control);
}
Status local(const Pixels& pixels, const LocalOptions& options, Local& result, const Control& control) noexcept {
    return make_of(pixels, options, result, control);
}
Status local(const Rows& rows, const LocalOptions& options, Local& result, const Control& control) noexcept {
    return make_of(rows, options, result, control);
}

} // namespace acdf::builder
