#include "build/indexed/sun.h"

#include "build/indexed/texels.h"
#include "compress/parallel.h"

#include <acdf/indexed/cone.h>
#include <acdf/indexed/indexed.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace acdf::build {
namespace {

constexpr double kDegree = ACDF_PI / 180.0;
constexpr std::uint32_t kSunParts = 4; // of a texel along each axis, where the cone is fitted
constexpr std::uint32_t kMostRoots = ACDF_MOST_SUN - 1;
constexpr double kRadiusStep = 1.08;     // of the radii that are tried
constexpr int kNear = 6;                 // maps on both sides whose suns count for a radius
constexpr double kSpareRadius = 1.06;    // for how the sun lies among the texels between maps
constexpr double kStill = 0.1 * kDegree; // what moves less between maps stands still

double angle_between(const SunDirection& a, const SunDirection& b) {
    const double away = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    return 2.0 * std::asin(std::min(1.0, 0.5 * away));
}

/// A point of the disc about a sun, its light and its solid angle.
struct Point {
    SunDirection direction;
    double light, measure;
};

/// A sun that was found.
struct Found {
    SunDirection middle;
    double around = 0.0; ///< radiance of the sky about it
    double share = 0.0;  ///< of the light of the map
    double reach = 0.0;  ///< no texel farther from the middle is much brighter than the sky
    double total = 0.0;  ///< light of the map
    std::vector<Point> points;
};

class SunFinder {
public:
    explicit SunFinder(const SunMap& map)
        : map_(map), texels_(*map.texels), texel_(ACDF_PI / std::min(texels_.rows, texels_.columns)),
          inner_(std::max(4.0 * kDegree, 5.0 * texel_)), outer_(std::max(6.0 * kDegree, 8.0 * texel_)) {}

    std::optional<Found> find(const SunDirection* given) {
        Found out;
        std::size_t brightest = given ? nearest(*given) : brightest_texel();
        out.middle = direction_of(brightest);
        if (!(sum_around(out) > 0.0)) return {};
        const double peak = peak_;
        if (!given && !(peak > kSunContrast * out.around && peak > 4.0 * elsewhere_)) return {};
        const double excess = move_to_middle(out);
        if (!(excess > 1e-4 * out.total)) return {};
        out.share = excess / out.total;
        out.reach = reach_of(out, std::max(2.0 * out.around, 1e-3 * peak));
        if (!given &&
            reach_of(out, out.around + 0.05 * (peak - out.around)) > std::max(3.0 * kDegree, 3.0 * texel_))
            return {};
        add_points(out);
        return out;
    }

private:
    double value(std::size_t i) const { return double{texels_.values[i]}; }
    double measure(std::size_t i) const {
        return texels_.row_measure[i / texels_.columns] * texels_.column_measure[i % texels_.columns];
    }
    SunDirection direction_of(std::size_t i) const {
        float d[3];
        grid_direction(texels_, double(i % texels_.columns) + 0.5, double(i / texels_.columns) + 0.5, d);
        return {double{d[0]}, double{d[1]}, double{d[2]}};
    }
    std::size_t brightest_texel() const {
        return std::size_t(std::max_element(texels_.values.begin(), texels_.values.end()) - texels_.values.begin());
    }
    std::size_t nearest(const SunDirection& given) const {
        const AcdfGrid grid = {texels_.columns, texels_.rows, std::uint32_t(texels_.parameterization)};
        const float d[3] = {float(given[0]), float(given[1]), float(given[2])};
        std::uint32_t square[2] = {0, 0};
        double position[2];
        acdf_grid_square(&grid, d, square, position);
        return std::size_t{square[1]} * texels_.columns + square[0];
    }

    /// What lies near the middle; the light of the ring around it and of the whole.
    double sum_around(Found& out) {
        double ring = 0.0, ring_measure = 0.0;
        near_.clear();
        peak_ = elsewhere_ = out.total = 0.0;
        for (std::size_t i = 0; i < texels_.values.size(); ++i) {
            out.total += value(i) * measure(i);
            const double angle = angle_between(direction_of(i), out.middle);
            if (angle > outer_) {
                elsewhere_ = std::max(elsewhere_, value(i));
                continue;
            }
            peak_ = std::max(peak_, value(i));
            near_.push_back(i);
            if (angle <= inner_) continue;
            ring += value(i) * measure(i);
            ring_measure += measure(i);
        }
        out.around = ring_measure > 0.0 ? ring / ring_measure : 0.0;
        return out.total;
    }

    /// The middle of what is brighter than the sky; how much that is.
    double move_to_middle(Found& out) {
        double excess = 0.0;
        SunDirection sum{};
        for (const std::size_t i : near_) {
            const SunDirection d = direction_of(i);
            if (angle_between(d, out.middle) > inner_ || !(value(i) > 2.0 * out.around)) continue;
            const double light = (value(i) - out.around) * measure(i);
            excess += light;
            for (std::size_t k = 0; k < 3; ++k) sum[k] += light * d[k];
        }
        const double length = std::hypot(sum[0], sum[1], sum[2]);
        if (!(length > 0.0)) return 0.0;
        for (std::size_t k = 0; k < 3; ++k) out.middle[k] = sum[k] / length;
        return excess;
    }

    double reach_of(const Found& sun, double least) const {
        double reach = 0.0;
        for (const std::size_t i : near_)
            if (value(i) > least) reach = std::max(reach, angle_between(direction_of(i), sun.middle));
        return reach + (map_.filter == ACDF_FILTER_BILINEAR ? 1.5 : 0.75) * texel_;
    }

    void add_points(Found& out) const {
        const TexelLookup lookup(texels_, map_.filter);
        for (const std::size_t i : near_) {
            if (angle_between(direction_of(i), out.middle) > out.reach + 2.0 * texel_) continue;
            const auto row = std::uint32_t(i / texels_.columns), column = std::uint32_t(i % texels_.columns);
            for (std::uint32_t k = 0; k < kSunParts * kSunParts; ++k) {
                const double x = column + (k % kSunParts + 0.5) / kSunParts,
                             y = row + (k / kSunParts + 0.5) / kSunParts;
                float d[3];
                grid_direction(texels_, x, y, d);
                out.points.push_back({{double{d[0]}, double{d[1]}, double{d[2]}},
                                      lookup.at(x, y),
                                      part_of_row(texels_, row, k / kSunParts, kSunParts) *
                                          texels_.column_measure[column] / kSunParts});
            }
        }
    }

    const SunMap& map_;
    const compress::Target& texels_;
    double texel_, inner_, outer_, peak_ = 0.0, elsewhere_ = 0.0;
    std::vector<std::size_t> near_;
};

/// The second moment that a cone at `middle` leaves in the points of a sun.
double moment_of(const Found& sun, const SunDirection& middle, double radius, std::uint32_t roots) {
    const double half = std::sin(0.5 * radius), reach = 2.0 * half * half;
    const double peak = sun.share * double(1u << roots) / (2.0 * ACDF_PI * reach);
    const double sky = sun.around / sun.total; // what the tree has there, times its share of samples
    double sum = 0.0;
    for (const Point& point : sun.points) {
        double square = 0.0, cone = 0.0;
        for (std::size_t k = 0; k < 3; ++k) square += std::pow(point.direction[k] - middle[k], 2);
        if (const double y = 1.0 - 0.5 * square / reach; y > 0.0) {
            double power = 1.0;
            for (std::uint32_t i = 0; i < roots; ++i) power = power * power * y;
            cone = peak * power;
        }
        sum += point.measure * point.light * point.light / std::max(cone + sky, 1e-9 * peak);
    }
    return sum / (sun.total * sun.total);
}

/// The same where the cone is at its place and, as between maps, `off` it.
double moment_about(const Found& sun, double off, double radius, std::uint32_t roots) {
    double moment = moment_of(sun, sun.middle, radius, roots);
    if (!(off > 0.02 * radius)) return moment;
    AcdfCone frame;
    acdf_cone_about(sun.middle.data(), radius, 0, &frame);
    for (int side = 0; side < 4; ++side) {
        SunDirection moved = sun.middle;
        for (std::size_t k = 0; k < 3; ++k) moved[k] += (side % 2 ? off : -off) * frame.side[side / 2][k];
        moment += 0.25 * moment_of(sun, moved, radius, roots);
    }
    return 0.5 * moment;
}

/// What cones of several radii and profiles leave of a sun: fourth powers, so that the worst of several counts
/// most.
struct Fits {
    std::vector<std::array<double, kMostRoots + 1>> of_radius;

    Fits(const Found& sun, double off, const std::vector<double>& radii) : of_radius(radii.size()) {
        for (std::size_t i = 0; i < radii.size(); ++i)
            for (std::uint32_t roots = 0; roots <= kMostRoots; ++roots)
                of_radius[i][roots] = std::pow(moment_about(sun, off, radii[i], roots), 4.0);
    }
};

std::vector<double> radii_for(const std::vector<std::optional<Found>>& found) {
    double least = 1.0, most = 0.0;
    for (const auto& sun : found) {
        if (!sun) continue;
        least = std::min(least, sun->reach);
        most = std::max(most, sun->reach);
    }
    std::vector<double> out;
    for (double radius = std::max(0.4 * least, 0x1p-9); radius < std::min(2.5 * most, 0.5); radius *= kRadiusStep)
        out.push_back(radius);
    return out;
}

/// Maps that follow each other along an axis.
struct Line {
    std::size_t step; ///< from one map to the next
    std::uint32_t count;
    std::uint32_t index(std::size_t map) const { return static_cast<std::uint32_t>(map / step % count); }
};

std::vector<Line> lines_of(const std::vector<std::uint32_t>& counts) {
    std::vector<Line> out;
    std::size_t step = 1;
    for (std::size_t axis = counts.size(); axis-- > 0; step *= counts[axis])
        out.insert(out.begin(), {step, counts[axis]});
    return out;
}

bool is_known(const AcdfMap& map) { return map.radius > 0.0f; }
SunDirection direction_of(const AcdfMap& map) {
    return {double{map.sun[0]}, double{map.sun[1]}, double{map.sun[2]}};
}

/// How far the sun moves between neighbours along a line, mean.
double motion_along(const std::vector<AcdfMap>& maps, const Line& line) {
    double sum = 0.0, count = 0.0;
    for (std::size_t map = 0; map + line.step < maps.size(); ++map) {
        const std::size_t next = map + line.step;
        if (line.index(map) + 1 == line.count || !is_known(maps[map]) || !is_known(maps[next])) continue;
        sum += angle_between(direction_of(maps[map]), direction_of(maps[next]));
        count += 1.0;
    }
    return count > 0.0 ? sum / count : 0.0;
}

/// The place of a sun in a map from those of two that follow each other, the nearer one first.
void go_on(const AcdfMap& near, const AcdfMap& far, AcdfMap& out) {
    const SunDirection a = direction_of(far), b = direction_of(near);
    const double cosine = acdf_cone_dot(a.data(), b.data());
    for (std::size_t k = 0; k < 3; ++k) out.sun[k] = static_cast<float>(2.0 * cosine * b[k] - a[k]);
    out.radius = near.radius;
}

/// Maps in which the sun is not seen get the place where it would be: that of a neighbour, where it does not move
/// along an axis, else that to which it moves on.
void add_hidden(std::vector<AcdfMap>& maps, const std::vector<std::uint32_t>& counts) {
    std::vector<Line> lines = lines_of(counts);
    std::stable_sort(lines.begin(), lines.end(),
                     [&](const Line& a, const Line& b) { return motion_along(maps, a) < motion_along(maps, b); });
    for (const Line& line : lines) {
        const bool still = motion_along(maps, line) < kStill;
        const std::vector<AcdfMap> before = maps;
        const auto known = [&](std::size_t map, int steps) -> const AcdfMap* {
            const std::int64_t index = std::int64_t{line.index(map)} + steps;
            if (index < 0 || index >= std::int64_t{line.count}) return nullptr;
            const AcdfMap& at = before[map + std::size_t(steps) * line.step];
            return is_known(at) ? &at : nullptr;
        };
        for (std::size_t map = 0; map < maps.size(); ++map)
            for (const int way : {-1, 1}) {
                const AcdfMap *near = known(map, way), *far = known(map, 2 * way);
                if (is_known(maps[map]) || !near) continue;
                if (!still && far) go_on(*near, *far, maps[map]);
                if (!still) continue;
                std::copy(near->sun, near->sun + 3, maps[map].sun);
                maps[map].radius = near->radius;
            }
    }
}

/// What cones leave of the suns of a map and of those near it: between maps the sun lies otherwise among the texels
/// than in any of them.
Fits fits_about(const std::vector<std::optional<Fits>>& fits, const std::vector<AcdfMap>& suns,
                const std::vector<std::uint32_t>& counts, std::size_t map) {
    Fits out = *fits[map];
    for (const Line& line : lines_of(counts)) {
        if (motion_along(suns, line) < kStill) continue;
        for (int steps = -kNear; steps <= kNear; ++steps) {
            const std::int64_t index = std::int64_t{line.index(map)} + steps;
            if (steps == 0 || index < 0 || index >= std::int64_t{line.count}) continue;
            const auto& other = fits[map + std::size_t(steps) * line.step];
            for (std::size_t i = 0; other && i < out.of_radius.size(); ++i)
                for (std::uint32_t roots = 0; roots <= kMostRoots; ++roots)
                    out.of_radius[i][roots] += other->of_radius[i][roots];
        }
    }
    return out;
}

/// How far the sun is off the great circle between its neighbours, in the middle between two maps.
double off_path(const std::vector<std::optional<Found>>& found, const std::vector<std::uint32_t>& counts,
                std::size_t map) {
    double off = 0.0;
    for (const Line& line : lines_of(counts)) {
        const std::uint32_t index = line.index(map);
        if (index == 0 || index + 1 == line.count || !found[map - line.step] || !found[map + line.step]) continue;
        SunDirection middle;
        acdf_between_suns(found[map - line.step]->middle.data(), found[map + line.step]->middle.data(), 0.5,
                          middle.data());
        off = std::max(off, 0.25 * angle_between(middle, found[map]->middle));
    }
    return off;
}

/// The target without its sun: no brighter there than what is around.
std::vector<float> without_sun(const SunMap& map, const Found& sun) {
    std::vector<float> out = map.target->values;
    const auto around = static_cast<float>(sun.around);
    for (std::size_t i = 0; i < out.size(); ++i) {
        float d[3];
        grid_direction(*map.target, double(i % map.target->columns) + 0.5, double(i / map.target->columns) + 0.5,
                       d);
        if (angle_between({double{d[0]}, double{d[1]}, double{d[2]}}, sun.middle) < sun.reach)
            out[i] = std::min(out[i], around);
    }
    return out;
}

} // namespace

Suns no_suns(const std::vector<SunMap>& maps) {
    Suns out;
    out.of_maps.resize(maps.size(), AcdfMap{});
    for (const SunMap& map : maps) out.rest.push_back(map.target->values);
    return out;
}

Suns find_suns(const std::vector<SunMap>& maps, const std::vector<std::uint32_t>& counts,
               const std::vector<SunDirection>* given) {
    Suns out = no_suns(maps);
    std::vector<std::optional<Found>> found(maps.size());
    compress::parallel_for(std::size_t{0}, maps.size(), [&](std::size_t i) {
        const bool up = !given || std::hypot((*given)[i][0], (*given)[i][1], (*given)[i][2]) > 0.5;
        if (up) found[i] = SunFinder(maps[i]).find(given ? &(*given)[i] : nullptr);
    });
    const auto count = std::count_if(found.begin(), found.end(), [](const auto& sun) { return sun.has_value(); });
    if (count == 0 || (!given && 2 * std::size_t(count) < maps.size())) return out;
    const std::vector<double> radii = radii_for(found);
    std::vector<std::optional<Fits>> fits(maps.size());
    compress::parallel_for(std::size_t{0}, maps.size(), [&](std::size_t i) {
        if (!found[i]) return;
        fits[i].emplace(*found[i], off_path(found, counts, i), radii);
        AcdfMap& map = out.of_maps[i];
        map.radius = 1.0f; // known
        map.sun_share = static_cast<float>(std::min(found[i]->share, 0.999));
        for (std::size_t k = 0; k < 3; ++k) map.sun[k] = static_cast<float>(found[i]->middle[k]);
        out.rest[i] = without_sun(maps[i], *found[i]);
    });
    out.any = true;
    std::vector<std::optional<Fits>> about(maps.size());
    std::array<double, kMostRoots + 1> sums{};
    const auto best_of = [&](const Fits& fit, std::uint32_t roots) {
        return std::min_element(fit.of_radius.begin(), fit.of_radius.end(),
                                [roots](const auto& a, const auto& b) { return a[roots] < b[roots]; }) -
               fit.of_radius.begin();
    };
    for (std::size_t i = 0; i < maps.size(); ++i) {
        if (!found[i]) continue;
        about[i] = fits_about(fits, out.of_maps, counts, i);
        for (std::uint32_t roots = 0; roots <= kMostRoots; ++roots)
            sums[roots] += about[i]->of_radius[std::size_t(best_of(*about[i], roots))][roots];
    }
    out.roots = static_cast<std::uint32_t>(std::min_element(sums.begin(), sums.end()) - sums.begin());
    for (std::size_t i = 0; i < maps.size(); ++i)
        if (about[i])
            out.of_maps[i].radius =
                static_cast<float>(kSpareRadius * radii[std::size_t(best_of(*about[i], out.roots))]);
    add_hidden(out.of_maps, counts);
    return out;
}

} // namespace acdf::build
