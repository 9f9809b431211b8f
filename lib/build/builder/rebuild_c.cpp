#include <acdf/rebuild.h>
#include <acdf/rebuild_c.h>

#include <new>

struct AcdfRebuilder {
    acdf::builder::EnvironmentRebuilder made;
    acdf::builder::Status status;
    acdf::builder::Control control;
    AcdfRebuildOptions options;
};

namespace {

namespace builder = acdf::builder;

builder::Projection projection_of(const AcdfRebuildOptions& options) {
    return options.octahedral ? builder::Projection::octahedral : builder::Projection::latlong;
}

builder::Pixels pixels_of(const AcdfRebuilder& rebuilder, const AcdfFramePixels& frame) {
    builder::Pixels out;
    out.data = frame.data;
    out.width = rebuilder.options.width;
    out.height = rebuilder.options.height;
    out.channels = frame.channels;
    out.number = frame.half ? builder::Number::float16 : builder::Number::float32;
    out.channel_stride = frame.channel_stride;
    out.pixel_stride = frame.pixel_stride;
    out.row_stride = frame.row_stride;
    out.projection = projection_of(rebuilder.options);
    return out;
}

void make(AcdfRebuilder& rebuilder) {
    const AcdfRebuildOptions& from = rebuilder.options;
    builder::EnvironmentOptions options;
    options.goal = builder::Goal::of_budget(from.budget ? from.budget : std::uint64_t{64} << 10);
    options.target.filter = from.bilinear ? ACDF_FILTER_BILINEAR : ACDF_FILTER_NEAREST;
    options.target.wrap = from.repeats ? builder::Wrap::repeat : builder::Wrap::clamp;
    options.target.uniform_if_black = from.uniform_if_black != 0;
    rebuilder.status = builder::EnvironmentRebuilder::make(
        from.width, from.height, options, rebuilder.made,
        from.best ? builder::Quality::best : builder::Quality::fast, projection_of(from));
}

} // namespace

extern "C" {

AcdfRebuilder* acdf_rebuilder_make(const AcdfRebuildOptions* options) {
    auto* out = new (std::nothrow) AcdfRebuilder;
    if (!out) return nullptr;
    out->options = *options;
    make(*out);
    return out;
}

void acdf_rebuilder_free(AcdfRebuilder* rebuilder) { delete rebuilder; }

void acdf_rebuilder_on_progress(AcdfRebuilder* rebuilder, int (*progress)(void* context, double share),
                                void* context) {
    if (!progress) rebuilder->control.progress = {};
    else
        rebuilder->control.progress = [progress, context](double share, const char*) {
            return progress(context, share) != 0;
        };
}

int acdf_rebuilder_rebuild(AcdfRebuilder* rebuilder, const AcdfFramePixels* pixels, int threads) {
    if (!rebuilder->made.ready()) return static_cast<int>(rebuilder->status.code);
    rebuilder->control.threads = threads;
    rebuilder->status = rebuilder->made.rebuild(pixels_of(*rebuilder, *pixels), rebuilder->control);
    return static_cast<int>(rebuilder->status.code);
}

int acdf_rebuilder_update(AcdfRebuilder* rebuilder, const AcdfFramePixels* pixels, const AcdfFrameRegion* region,
                          int threads) {
    if (!rebuilder->made.ready()) return static_cast<int>(rebuilder->status.code);
    rebuilder->control.threads = threads;
    rebuilder->status = rebuilder->made.update(
        pixels_of(*rebuilder, *pixels), {region->x, region->y, region->width, region->height}, rebuilder->control);
    return static_cast<int>(rebuilder->status.code);
}

const char* acdf_rebuilder_message(const AcdfRebuilder* rebuilder) { return rebuilder->status.message; }

AcdfEnvironment acdf_rebuilder_view(const AcdfRebuilder* rebuilder) {
    return rebuilder->made.empty() ? AcdfEnvironment{} : rebuilder->made.view().data();
}

const std::uint8_t* acdf_rebuilder_file(const AcdfRebuilder* rebuilder, std::size_t* size) {
    const bool empty = rebuilder->made.empty();
    *size = empty ? 0 : rebuilder->made.size();
    return empty ? nullptr : rebuilder->made.data();
}

double acdf_rebuilder_relative_variance(const AcdfRebuilder* rebuilder) {
    return rebuilder->made.empty() ? 0.0 : rebuilder->made.relative_variance();
}

} // extern "C"
