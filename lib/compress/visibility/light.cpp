#include "compress/visibility/light.h"
#include "compress/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace acdf::compress {
namespace {

constexpr double kDarkest = 0.1;    ///< of the mean of all points: what is added to the light of each
constexpr double kMuch = 2.0;       ///< of the mean of parts: one that gives as much is always asked
constexpr std::uint32_t kTries = 8; ///< directions of a part, until one is above the horizon

/// A number of a part and a point.
std::uint32_t hash(std::size_t part, std::size_t index) {
    return static_cast<std::uint32_t>(index) * 0x9E3779B1u + static_cast<std::uint32_t>(part) * 0x85EBCA6Bu;
}

/// One in four of the rays that are expected.
bool is_checked(std::size_t part, std::size_t index) { return (hash(part, index) >> 16 & 3u) == 0; }

/// Unknown: no direction is above the horizon.
Ray shoot(const VisibilityParts& parts, std::size_t part, const VisibilityPoint& point, std::size_t index,
          const Occluded& occluded) {
    for (std::uint32_t r = 0, k = hash(part, index) >> 26; r < kTries; ++r, k += 23) { // 23: all 64 in turn
        const std::array<float, 3>& d = parts.direction(part, k);
        if (d[0] * point.normal[0] + d[1] * point.normal[1] + d[2] * point.normal[2] > 0.0f)
            return occluded(point, d) ? Ray::is_met : Ray::arrives;
    }
    return Ray::unknown;
}

/// Writes what a point is given; returns what of it arrives.
double trace_point(const VisibilityParts& parts, const VisibilityPoint& point, std::size_t index,
                   const Occluded& occluded, const Ray* expected, float* given) {
    AcdfLocalPoint local;
    acdf_local_at(&parts.local(), point.normal.data(), &local);
    parts.weigh(local, given);
    const double length = local.length > 0.0 ? local.length : 1.0; // the scale of the weights
    double light = 0.0, whole = 0.0;
    for (std::size_t p = 0; p < parts.count(); ++p) whole += double{given[p]};
    const double much = kMuch * whole / double(parts.count());
    for (std::size_t p = 0; p < parts.count(); ++p) {
        if (!(given[p] > 0.0f)) continue;
        const bool is_sure =
            expected && expected[p] != Ray::unknown && double{given[p]} < much && !is_checked(p, index);
        const Ray ray = is_sure ? expected[p] : shoot(parts, p, point, index, occluded);
        const double all = double{given[p]} / length;
        if (ray == Ray::arrives) light += all;
        given[p] = ray == Ray::unknown ? 0.0f : static_cast<float>(ray == Ray::arrives ? all : -all);
    }
    return light;
}

} // namespace

void trace_visibility(const VisibilityParts& parts, const std::vector<VisibilityPoint>& points,
                      const Occluded& occluded, const ExpectedRays& expected, VisibilityLight& light, double dark,
                      const std::function<void(double)>& progress) {
    const std::size_t known = light.points(), more = points.size() - known;
    light.parts = parts.count();
    light.given.resize(points.size() * light.parts);
    light.arrives.resize(points.size(), 0.0);
    light.scale.resize(points.size(), 1.0);
    std::atomic<std::size_t> done{0};
    parallel_parts(known, points.size(), 64, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            light.arrives[i] =
                trace_point(parts, points[i], i, occluded, expected(i), &light.given[i * light.parts]);
        if (progress) progress(double(done += last - first) / double(more));
    });
    double mean = 0.0;
    for (const double l : light.arrives) mean += l / double(points.size());
    light.dark = dark < 0.0 ? kDarkest * mean : dark;
    parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) { light.rescale(i, light.arrives[i]); });
}

void VisibilityLight::rescale(std::size_t point, double light) {
    // A point that nothing reaches has no noise: it may as well be the inside of something.
    const double next = light > 0.0 ? 1.0 / std::sqrt(light * light + dark * dark) : 0.0;
    const double factor = scale[point] > 0.0 ? next / scale[point] : 0.0;
    for (std::size_t i = point * parts; i < (point + 1) * parts; ++i)
        given[i] = static_cast<float>(factor * double{given[i]});
    scale[point] = next;
}

} // namespace acdf::compress
