#include "input/probe.h"

#include "input/bad_texels.h"
#include "input/detect.h"
#include "input/image.h"
#include "input/resample.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <new>

namespace acdf::input {
namespace {

void to_latlong(const Detected& detected, Image& image, int threads, Probe& probe) {
    const Map map{detected.layout, image.width, image.height};
    probe.width = latlong_width(map);
    probe.height = detected.layout == Layout::latlong ? image.height : probe.width / 2;
    probe.rgb = detected.layout == Layout::latlong
                    ? std::move(image.rgb)
                    : resample_to_latlong(map, std::move(image.rgb), probe.width, threads);
}

/// So that what is black has a density: the smallest normal number, 0 for all that light is used for.
void light_if_black(Probe& probe) {
    const bool black = std::all_of(probe.rgb.begin(), probe.rgb.end(), [](float v) { return v == 0.0f; });
    if (!black) return;
    std::fill(probe.rgb.begin(), probe.rgb.end(), std::numeric_limits<float>::min());
    probe.warnings.push_back("the probe is black; all directions are equally likely");
}

} // namespace

const char* to_string(Projection projection) {
    switch (projection) {
    case Projection::automatic:
        return "auto";
    case Projection::latlong:
        return "latlong";
    case Projection::angular:
        return "angular";
    case Projection::mirrorball:
        return "mirrorball";
    case Projection::cube_cross:
        return "cube-cross";
    case Projection::octahedral:
        return "octahedral";
    }
    return "unknown";
}

Probe read_probe(const std::string& path, const ProbeOptions& options) {
    Probe probe;
    probe.source_sha256 = file_sha256(path); // first: it tells missing files and folders apart
    probe.source_name = std::filesystem::path(path).filename().string();
    try {
        Image image = read_image(path, options.threads);
        probe.source_width = image.width;
        probe.source_height = image.height;
        probe.bad = repair_texels(path, image, options.bad_pixels, options.threads);
        const Detected detected = detect_layout(path, image, options.projection);
        probe.projection = projection_of(detected.layout);
        probe.projection_reason = detected.reason;
        to_latlong(detected, image, options.threads, probe);
        probe.warnings = std::move(image.warnings);
        if (options.uniform_if_black) light_if_black(probe);
    } catch (const std::bad_alloc&) {
        throw input_error(path, "there is not enough memory for its pixels; resize it");
    }
    return probe;
}

} // namespace acdf::input
