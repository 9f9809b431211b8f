#include "input/probe/probe.h"

#include "build/builder/pixels.h"
#include "build/probe/rows.h"
#include "input/error.h"
#include "input/file_name.h"
#include "input/probe/detect.h"
#include "input/probe/image.h"
#include "input/sha256.h"

#include <algorithm>
#include <new>

namespace acdf::input {
namespace {

class AllRows : public ProbeRows {
public:
    void begin(int width, int height) override {
        row_ = std::size_t{3} * static_cast<std::size_t>(width);
        rgb.resize(row_ * static_cast<std::size_t>(height));
    }
    void take(int first, int count, const float* values) override {
        std::copy_n(values, row_ * static_cast<std::size_t>(count),
                    rgb.data() + row_ * static_cast<std::size_t>(first));
    }
    std::vector<float> rgb;

private:
    std::size_t row_ = 0;
};

void refuse_bad_texels(const std::string& path, const build::BadTexels& bad) {
    if (bad.count() > 0)
        throw input_error(path, "it has " + build::text(bad) + "; mend it, or take --bad-pixels zero or clamp");
}

} // namespace

const char* to_string(Projection projection) {
    using Of = builder::Projection;
    constexpr Of of[] = {Of::latlong, Of::latlong, Of::angular, Of::mirrorball, Of::vertical_cross, Of::octahedral};
    return projection == Projection::automatic ? "auto"
                                               : builder::name_of(of[static_cast<std::size_t>(projection)]);
}

Probe read_probe(const std::string& path, const ProbeOptions& options) {
    AllRows all;
    Probe probe = read_probe(path, options, all);
    probe.rgb = std::move(all.rgb);
    return probe;
}

Probe read_probe(const std::string& path, const ProbeOptions& options, ProbeRows& rows) {
    Probe probe;
    probe.source_sha256 = file_sha256(path); // first: it tells missing files and folders apart
    probe.source_name = file_name(path);
    build::RepairedRows repaired({options.bad_pixels, options.uniform_if_black, options.threads}, rows);
    const auto tell = [&](const Detected& detected, const Image& image) {
        probe.source_map = {detected.layout, image.width, image.height};
        probe.projection = projection_of(detected.layout);
        probe.projection_reason = detected.reason;
    };
    try {
        Image image = read_image(path, options.threads, [&](const Image& header) -> TakeRows {
            if (header.luminance) repaired.set_luminance(*header.luminance);
            probe.luminance = header.luminance;
            const bool clamp = options.bad_pixels == build::BadPixels::clamp;
            if ((clamp && !header.half) || !is_latlong(header, options.projection)) return {};
            tell(detect_layout(path, header, options.projection), header);
            repaired.begin(header.width, header.height);
            return
                [&](int first, int count, float* rgb) { repaired.take(first, count, rgb, &build::largest_half); };
        });
        probe.warnings = std::move(image.warnings);
        probe.source_width = image.width;
        probe.source_height = image.height;
        if (!image.rgb.empty()) {
            repaired.repair_whole(image.width, image.height, image.rgb.data(),
                                  image.half ? &build::largest_half : nullptr);
            const Detected detected = detect_layout(path, image, options.projection);
            tell(detected, image);
            repaired.take_whole(probe.source_map, std::move(image.rgb));
        }
        probe.width = repaired.width();
        probe.height = repaired.height();
        probe.bad = repaired.bad();
        if (options.bad_pixels == build::BadPixels::error) refuse_bad_texels(path, probe.bad);
        if (repaired.light_if_black())
            probe.warnings.push_back("the probe is black; all directions are equally likely");
    } catch (const std::bad_alloc&) {
        throw input_error(path, "there is not enough memory for its pixels; resize it");
    }
    return probe;
}

} // namespace acdf::input
