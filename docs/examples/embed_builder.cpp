// embed_builder.cpp: a renderer that holds a sky's pixels gets a pdf of 64 KiB to sample its directions from,
// while it loads: one call of the builder, one of the reader, and no file.
//
//     embed_builder [WIDTH]     pixels of the lat-long map, 4096 x 2048 by default
#include <acdf/builder.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

constexpr float pi = 3.14159265f;

// Stands for the renderer's own map: a sky with a sun of 3 degrees in the direction (0.6, 0, 0.8). +z is up.
float radiance(const float w[3]) {
    const float to_sun = 0.6f * w[0] + 0.8f * w[2];
    return (w[2] > 0 ? 0.5f + 0.5f * w[2] : 0.1f) + (to_sun > 0.99966f ? 5e3f : 0.0f);
}

// RGBA, as renderers have it: row 0 touches +z, the middle column shows +x.
std::vector<float> pixels_of(int width, int height) {
    std::vector<float> rgba(std::size_t(4) * width * height, 1.0f);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float theta = pi * (y + 0.5f) / height, phi = pi * (1 - 2 * (x + 0.5f) / width);
            const float w[3] = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
            for (int k = 0; k < 3; ++k) rgba[4 * (std::size_t(y) * width + x) + k] = radiance(w);
        }
    return rgba;
}

// The renderer's lookup: the nearest pixel.
float lookup(const std::vector<float>& rgba, int width, const float w[3]) {
    const int height = width / 2;
    const int x = int(0.5f * (1 - std::atan2(w[1], w[0]) / pi) * float(width));
    const int y = int(std::acos(std::fmax(-1.0f, std::fmin(1.0f, w[2]))) / pi * float(height));
    return rgba[4 * (std::size_t(y < height ? y : height - 1) * width + (x < width ? x : width - 1))];
}

int main(int argc, char** argv) {
    const int width = argc > 1 ? std::atoi(argv[1]) : 4096, height = width / 2;
    if (width < 2 || width > 32768) return std::fprintf(stderr, "a width from 2 to 32768 is needed\n"), 2;
    const std::vector<float> rgba = pixels_of(width, height);

    acdf::builder::Pixels pixels;
    pixels.data = rgba.data();
    pixels.width = std::uint32_t(width), pixels.height = std::uint32_t(height);
    pixels.channels = 4;
    acdf::builder::EnvironmentOptions options;
    options.goal = acdf::builder::Goal::of_budget(64 << 10); // as by default
    options.target.filter = ACDF_FILTER_NEAREST;             // as lookup() has it
    acdf::builder::Control control;                          // a user who grows impatient may cancel
    control.progress = [](double share, const char* what) { return share <= 1.0 && what != nullptr; };

    const auto start = std::chrono::steady_clock::now();
    acdf::builder::Environment made;
    const acdf::builder::Status built = acdf::builder::environment(pixels, options, made, control);
    if (!built.ok()) return std::fprintf(stderr, "%s\n", built.message), 1;
    acdf::File file; // reads made.bytes in place: keep both
    const acdf::Status read = acdf::File::from_memory(made.bytes.data(), made.bytes.size(), file);
    if (!read.ok()) return std::fprintf(stderr, "%s\n", read.message), 1;
    const acdf::EnvironmentView sky = file.environment();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

    // The irradiance on the ground, by 256 x 256 stratified directions.
    double sum = 0;
    const int n = 256;
    for (int i = 0; i < n * n; ++i) {
        const acdf::DirectionSample s = sky.sample((i % n + 0.5) / n, (i / n + 0.5) / n);
        if (s.direction[2] > 0)
            sum += double(lookup(rgba, width, s.direction)) * double(s.direction[2]) / double(s.pdf);
    }
    std::printf("%zu bytes in %.2f s, relative variance %.3g; irradiance %.4f, the map's integral %.4f\n",
                made.bytes.size(), seconds, made.accuracy.relative_variance, sum / (n * n), sky.total());
}
