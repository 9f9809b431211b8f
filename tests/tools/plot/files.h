// Environment files and images for the tests of plots.
#pragma once

#include "tests/inputs/environment_file.h"
#include "tests/inputs/synthetic.h"
#include "tests/inputs/write_rgb.h"

#include "build/probe/projection.h"
#include "images/image_file.h"

#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace acdf::test {

/// A file in memory and the view of it.
struct StoredEnvironment {
    std::vector<std::uint8_t> bytes;
    File file;

    explicit StoredEnvironment(std::vector<std::uint8_t> b) : bytes(std::move(b)) {
        const Status status = File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves());
        EXPECT_TRUE(status.ok()) << status.message;
    }
    StoredEnvironment(const compress::Target& target, const compress::FitOptions& options)
        : StoredEnvironment(acdf_test::environment_file(target, options)) {}
    EnvironmentView view() const { return file.environment(); }
};

inline compress::FitOptions fit_options(AcdfFit fit, std::uint32_t column_segments, std::uint32_t row_segments) {
    compress::FitOptions options;
    options.fit = fit;
    options.column_segments = column_segments;
    options.row_segments = row_segments;
    options.goal.cells = column_segments * row_segments;
    return options;
}

/// Noise of which a fifth is dark: some cells have pdf 0.
inline compress::Target dark_noise() { return acdf_test::noise_target(64, 32, 7, 1.5, 0.2); }

/// Direction at the centre of pixel (x, y) of a lat-long image, from the formula.
inline void latlong_direction(int width, int height, int x, int y, float direction[3]) {
    const double phi = acdf_test::kPi * (1.0 - 2.0 * (x + 0.5) / width),
                 theta = acdf_test::kPi * (y + 0.5) / height;
    acdf_test::direction_of(phi, std::cos(theta), direction);
}

/// The same of an angular map; false outside of the disc. P. Debevec, "Rendering Synthetic Objects into Real
/// Scenes", 1998: turn the forward direction (+x, up is +z) by pi r towards (a, b). Which side +y is on is up to
/// the convention for probes: plots are to look like them.
inline bool angular_direction(int width, int x, int y, float direction[3]) {
    const double a = 2.0 * (x + 0.5) / width - 1.0, b = 1.0 - 2.0 * (y + 0.5) / width, r = std::hypot(a, b);
    if (r > 1.0) return false;
    const double side = build::to_image({build::Layout::angular, 2, 2}, {0.0, 1.0, 0.0}).u > 0.5 ? 1.0 : -1.0;
    const double sine = r > 0.0 ? std::sin(acdf_test::kPi * r) / r : 0.0;
    direction[0] = static_cast<float>(std::cos(acdf_test::kPi * r));
    direction[1] = static_cast<float>(side * sine * a);
    direction[2] = static_cast<float>(sine * b);
    return true;
}

/// All channels of an image file.
struct LoadedImage : images::Picture {
    std::string description, date;
    bool floating = false;
    int sample_bytes = 0;
};

inline LoadedImage load_image(const std::string& path) {
    images::ImageFile file(path);
    if (!file.is_open()) throw std::runtime_error(path + ": " + file.error()); // fails the test
    const images::Header& header = file.header();
    LoadedImage image;
    static_cast<images::Picture&>(image) = {header.data.width, header.data.height, header.channel_count};
    image.description = file.text("ImageDescription");
    image.date = file.text("DateTime");
    image.floating = header.floating;
    image.sample_bytes = header.sample_bytes;
    const std::ptrdiff_t pixel = header.channel_count * static_cast<std::ptrdiff_t>(sizeof(float));
    EXPECT_TRUE(
        file.read({0, image.height, 0, header.channel_count, pixel, pixel * image.width}, image.values.data()))
        << path << ": " << file.error();
    return image;
}

} // namespace acdf::test
