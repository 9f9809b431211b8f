#include "input/probe.h"

#include "build/bad_texels.h"
#include "build/resample.h"
#include "input/detect.h"
#include "input/image.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <new>

namespace acdf::input {
namespace {

/// Sees to it that rows are radiance before they are taken.
class Repair {
public:
    Repair(const ProbeOptions& options, Probe& probe, ProbeRows& rows)
        : options_(options), probe_(probe), rows_(rows) {}

    void begin(const Detected& detected, const Image& image) {
        probe_.projection = projection_of(detected.layout);
        probe_.projection_reason = detected.reason;
        probe_.source_width = probe_.width = image.width;
        probe_.source_height = probe_.height = image.height;
        probe_.source_map = {detected.layout, image.width, image.height};
    }
    /// Texels of the source: counted there.
    void repair(int first, int count, float* rgb) {
        build::repair_texels(rgb, probe_.source_width, first, count, options_.bad_pixels, options_.threads,
                             probe_.bad);
    }
    /// A map that is not lat-long. False where it is wanted as rows.
    bool take_map(std::vector<float>& rgb) {
        const bool black = std::all_of(rgb.begin(), rgb.end(), [](float v) { return v == 0.0f; });
        if (!black || !options_.uniform_if_black) return rows_.take_map(probe_.source_map, rgb);
        std::vector<float> lit(rgb.size(), std::numeric_limits<float>::min());
        const bool taken = rows_.take_map(probe_.source_map, lit);
        if (taken) probe_.warnings.push_back(black_warning);
        return taken;
    }
    void take(int first, int count, const float* rgb) {
        has_rows_ = true;
        if (black_) {
            const std::size_t values =
                std::size_t{3} * static_cast<std::size_t>(probe_.width) * static_cast<std::size_t>(count);
            black_ = std::all_of(rgb, rgb + values, [](float v) { return v == 0.0f; });
        }
        rows_.take(first, count, rgb);
    }
    /// So that what is black has a density: the smallest normal number, 0 for all that light is used for.
    void light_if_black() {
        if (!has_rows_ || !black_ || !options_.uniform_if_black) return;
        const std::vector<float> row(std::size_t{3} * static_cast<std::size_t>(probe_.width),
                                     std::numeric_limits<float>::min());
        for (int y = 0; y < probe_.height; ++y) rows_.take(y, 1, row.data());
        probe_.warnings.push_back(black_warning);
    }

private:
    const ProbeOptions& options_;
    Probe& probe_;
    ProbeRows& rows_;
    bool black_ = true, has_rows_ = false;
    static constexpr const char* black_warning = "the probe is black; all directions are equally likely";
};

/// An image that was read as a whole.
void take_whole(const std::string& path, const ProbeOptions& options, Image& image, Probe& probe, ProbeRows& rows,
                Repair& repair) {
    probe.source_width = image.width;
    probe.source_height = image.height;
    repair.repair(0, image.height, image.rgb.data());
    const Detected detected = detect_layout(path, image, options.projection);
    repair.begin(detected, image);
    const build::Map& map = probe.source_map;
    if (detected.layout != build::Layout::latlong && repair.take_map(image.rgb)) return;
    probe.width = build::latlong_width(map);
    probe.height = detected.layout == build::Layout::latlong ? image.height : probe.width / 2;
    const std::vector<float> rgb =
        detected.layout == build::Layout::latlong
            ? std::move(image.rgb)
            : build::resample_to_latlong(map, std::move(image.rgb), probe.width, options.threads);
    rows.begin(probe.width, probe.height);
    repair.take(0, probe.height, rgb.data());
}

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

std::string text(const build::BadTexels& bad) {
    return std::to_string(bad.nan) + " NaN, " + std::to_string(bad.infinite) + " infinite and " +
           std::to_string(bad.negative) + " negative texels, the first at " + std::to_string(bad.x) + "," +
           std::to_string(bad.y);
}

void refuse_bad_texels(const std::string& path, const build::BadTexels& bad) {
    if (bad.count() > 0)
        throw input_error(path, "it has " + text(bad) + "; mend it, or take --bad-pixels zero or clamp");
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
    AllRows all;
    Probe probe = read_probe(path, options, all);
    probe.rgb = std::move(all.rgb);
    return probe;
}

Probe read_probe(const std::string& path, const ProbeOptions& options, ProbeRows& rows) {
    Probe probe;
    probe.source_sha256 = file_sha256(path); // first: it tells missing files and folders apart
    probe.source_name = std::filesystem::path(path).filename().string();
    Repair repair(options, probe, rows);
    try {
        Image image = read_image(path, options.threads, [&](const Image& header) -> TakeRows {
            if (options.bad_pixels == build::BadPixels::clamp || !is_latlong(header, options.projection)) return {};
            repair.begin(detect_layout(path, header, options.projection), header);
            rows.begin(header.width, header.height);
            return [&](int first, int count, float* rgb) {
                repair.repair(first, count, rgb);
                repair.take(first, count, rgb);
            };
        });
        probe.warnings = std::move(image.warnings);
        if (!image.rgb.empty()) take_whole(path, options, image, probe, rows, repair);
        if (options.bad_pixels == build::BadPixels::error) refuse_bad_texels(path, probe.bad);
        repair.light_if_black();
    } catch (const std::bad_alloc&) {
        throw input_error(path, "there is not enough memory for its pixels; resize it");
    }
    return probe;
}

} // namespace acdf::input
