#include "input/probe/probe.h"

#include "build/builder/pixels.h"
#include "build/probe/rows.h"
#include "input/error.h"
#include "input/probe/detect.h"
#include "input/probe/image.h"
#include "input/probe/latlong_check.h"
#include "input/probe/source.h"

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
        throw input_error(path, "it has " + build::text(bad) + "; repair it, or use --bad-pixels zero or clamp");
}

/// The reading of one probe.
class Reading {
public:
    Reading(const std::string& path, const ProbeOptions& options, ProbeRows& rows, Probe& probe)
        : path_(path), options_(options), probe_(probe),
          repaired_({options.bad_pixels, options.uniform_if_black, options.threads}, rows) {}

    void run() {
        const std::vector<std::string> files = probe_files(path_);
        if (!options_.faces && files.size() > 1)
            throw input_error(path_,
                              "six files are the faces of a cube; --faces says which is which: directx, opengl "
                              "or openexr, or a list such as +x,-x,+y,-y,+z,-z");
        Image image = options_.faces ? take_cube(files) : take_image();
        probe_.warnings = std::move(image.warnings);
        probe_.source_width = image.width;
        probe_.source_height = image.height;
        probe_.width = repaired_.width();
        probe_.height = repaired_.height();
        probe_.bad = repaired_.bad();
        if (options_.bad_pixels == build::BadPixels::error) refuse_bad_texels(path_, probe_.bad);
        if (repaired_.light_if_black())
            probe_.warnings.push_back("the probe is black; all directions are equally likely");
    }

private:
    // Both return the image without its pixels, which are taken.
    Image take_image() {
        std::optional<LatlongCheck> check;
        Image image = read_image(path_, options_.threads, [&](const Image& header) -> TakeRows {
            take_luminance(header);
            if (is_latlong_by_shape(header, options_.projection)) check.emplace(header.width, header.height);
            const bool clamp = options_.bad_pixels == build::BadPixels::clamp;
            if ((clamp && !header.half) || !is_latlong(header, options_.projection)) return {};
            tell(detect_layout(path_, header, options_), header);
            repaired_.begin(header.width, header.height);
            return [&](int first, int count, float* rgb) {
                repaired_.take(first, count, rgb, &build::largest_half);
                if (check) check->take(first, count, rgb);
            };
        });
        if (!image.rgb.empty()) {
            repair(image);
            if (check) check->take(0, image.height, image.rgb.data());
            const Detected detected = detect_layout(path_, image, options_);
            if (detected.back_is_upright) hang_back_face(image);
            take(detected, image);
        }
        if (check) refuse_latlong(path_, image, *check);
        return image;
    }

    Image take_cube(const std::vector<std::string>& files) {
        if (options_.projection != Projection::automatic && options_.projection != Projection::cube_cross)
            throw input_error(path_, std::string("it cannot be ") + to_string(options_.projection) +
                                         " and have --faces, which cubes have");
        std::vector<Image> images;
        for (const std::string& file : files) images.push_back(read_image(file, options_.threads));
        if (images.size() == 1) images = cut_strip(path_, images[0]);
        Detected detected{build::Layout::latlong, "--faces " + options_.faces->name};
        Image image = assemble(files, std::move(images), *options_.faces, detected.layout);
        take_luminance(image);
        repair(image);
        take(detected, image);
        return image;
    }

    void take_luminance(const Image& image) {
        if (image.luminance) repaired_.set_luminance(*image.luminance);
        probe_.luminance = image.luminance;
    }
    void repair(Image& image) {
        repaired_.repair_whole(image.width, image.height, image.rgb.data(),
                               image.half ? &build::largest_half : nullptr);
    }

    void tell(const Detected& detected, const Image& image) {
        probe_.source_map = {detected.layout, image.width, image.height};
        probe_.projection = projection_of(detected.layout);
        probe_.projection_reason = detected.reason;
    }

    /// Its pixels are used up.
    void take(const Detected& detected, Image& image) {
        tell(detected, image);
        repaired_.take_whole(probe_.source_map, std::move(image.rgb));
    }

    const std::string& path_;
    const ProbeOptions& options_;
    Probe& probe_;
    build::RepairedRows repaired_;
};

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
    probe.source_sha256 = probe_sha256(path); // first: its errors distinguish missing files from folders
    probe.source_name = probe_name(path);
    try {
        Reading(path, options, rows, probe).run();
    } catch (const std::bad_alloc&) {
        throw input_error(path, "there is not enough memory for its pixels; resize it");
    }
    return probe;
}

} // namespace acdf::input
