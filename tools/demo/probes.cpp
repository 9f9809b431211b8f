#include "tools/demo/probes.h"

#include "images/openexr.h"
#include "tools/cli/output.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace acdf::tools {
namespace {

constexpr double pi = 3.14159265358979323846;
using Color = std::array<double, 3>;
using Vector = std::array<double, 3>;

Vector direction(double column, double row) {
    const double phi = pi * (1.0 - 2.0 * column), theta = pi * row;
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Color scaled(const Color& c, double s) { return {c[0] * s, c[1] * s, c[2] * s}; }

Color sky(const Vector& w) {
    const Vector sun = direction(0.62, 0.21);
    const double cosine = dot(w, sun);
    if (cosine > std::cos(0.27 * pi / 180.0 * 2.0)) return scaled({1.0, 0.95, 0.85}, 50000.0);
    if (w[2] < 0.0) return scaled({0.08, 0.07, 0.05}, 1.0 + 0.5 * std::max(0.0, cosine));
    const double haze = std::pow(1.0 - w[2], 4.0), glow = std::exp(20.0 * (cosine - 1.0));
    return {0.25 + 0.6 * haze + 3.0 * glow, 0.4 + 0.5 * haze + 2.6 * glow, 0.9 + 0.2 * haze + 2.0 * glow};
}

Color room(const Vector& w) {
    // Four windows on the walls, two lamps below the ceiling, walls that get darker downwards.
    const double phi = std::atan2(w[1], w[0]), elevation = std::asin(w[2]);
    const double window = std::abs(std::remainder(phi - 0.4, pi / 2.0));
    if (window < 0.17 && elevation > 0.05 && elevation < 0.5) {
        const bool frame = std::abs(window - 0.085) < 0.008 || std::abs(elevation - 0.27) < 0.01;
        return frame ? Color{0.05, 0.04, 0.03} : Color{6.0, 7.5, 9.0};
    }
    if (dot(w, direction(0.3, 0.08)) > std::cos(0.05) || dot(w, direction(0.85, 0.14)) > std::cos(0.03))
        return {400.0, 330.0, 220.0};
    return scaled({0.5, 0.42, 0.33}, 0.12 + 0.3 * (1.0 + w[2]) * (1.0 + w[2]));
}

Color two_lights(const Vector& w) {
    // Over rows the lights overlap, and have different azimuths: the marginal alone does not show it.
    const double phi = std::atan2(w[1], w[0]), z = w[2];
    const bool left = phi > 1.0 && phi < 2.0 && z > 0.1 && z < 0.5;
    const bool right = phi > -2.0 && phi < -1.0 && z > -0.3 && z < 0.1;
    return left || right ? Color{1.0, 1.0, 1.0} : Color{0.0, 0.0, 0.0};
}

DemoProbe make(const char* name, const char* what, int width, Color (*radiance)(const Vector&)) {
    DemoProbe probe{name, what, width, width / 2, {}};
    probe.rgb.reserve(static_cast<std::size_t>(probe.width) * static_cast<std::size_t>(probe.height) * 3);
    for (int r = 0; r < probe.height; ++r)
        for (int c = 0; c < probe.width; ++c)
            for (double value : radiance(direction((c + 0.5) / probe.width, (r + 0.5) / probe.height)))
                probe.rgb.push_back(static_cast<float>(value));
    return probe;
}

} // namespace

std::vector<DemoProbe> demo_probes() {
    return {make("sky", "a clear sky, its sun 50,000 times as bright, over dark ground", 1024, sky),
            make("room", "a room with four windows and two lamps", 1024, room),
            make("two-lights", "two area lights at different heights and azimuths (Lawrence et al. 2005, Fig. 4)",
                 512, two_lights)};
}

void write_probe(const DemoProbe& probe, const std::string& path, bool force) {
    Output output(path, force);
    images::Picture picture(probe.width, probe.height);
    picture.values = probe.rgb;
    const std::vector<std::uint8_t> bytes = images::encode_exr(picture, {"R", "G", "B"}, {});
    output.write(bytes.data(), bytes.size());
    output.commit();
}

} // namespace acdf::tools
