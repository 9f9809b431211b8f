// Files with visibility cells with portals: a room with a window, in the light of a smooth sky. Sums over the
// window judge them.
#include "tests/inputs/directions.h"
#include "tests/inputs/nearest_lookup.h"
#include "tests/inputs/sanitized.h"
#include "visibility/visible_view.h"

#include <acdf/builder.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace {

using namespace acdf;
using acdf_test::kPi;
using acdf_test::Normal;
using acdf_test::random_direction;
using acdf_test::uniform;
using builder::VisibilityPoint;

double light_from(const double d[3]) {
    return 0.4 + 0.3 * d[2] + 2.0 * std::exp(-6.0 * ((d[0] - 0.8) * (d[0] - 0.8) + (d[1] - 0.5) * (d[1] - 0.5)));
}

const builder::Target& sky() {
    constexpr std::uint32_t columns = 128, rows = 64;
    static const builder::Target made = acdf::test::nearest_target(columns, rows, [](auto c, auto r) {
        const double theta = kPi * (r + 0.5) / rows, phi = kPi - 2.0 * kPi * (c + 0.5) / columns;
        const double d[3] = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
        return light_from(d);
    });
    return made;
}

/// A hole in a wall at x = 2 (axis 0) or y = 2 (axis 1), from low to high along the other one and upwards.
struct Hole {
    int axis;
    double low[2], high[2];

    /// Whether a ray from inside of the room leaves it here.
    bool holds(const double from[3], const double d[3]) const {
        if (!(d[axis] > 0.0)) return false;
        const double t = (2.0 - from[axis]) / d[axis], side = from[1 - axis] + t * d[1 - axis],
                     z = from[2] + t * d[2];
        return side > low[0] && side < high[0] && z > low[1] && z < high[1];
    }
};
const Hole kWindow{0, {-1.0, 0.6}, {0.4, 1.6}}, kHalf{0, {-1.0, 0.6}, {-0.4, 1.6}},
    kDoor{1, {-0.5, 0.0}, {0.4, 1.5}};

/// A room from -2 to 2, 2 high, with holes.
using Room = std::vector<Hole>;

bool leaves(const Room& room, const float p[3], const float direction[3]) {
    const double from[3] = {double{p[0]}, double{p[1]}, double{p[2]}},
                 d[3] = {double{direction[0]}, double{direction[1]}, double{direction[2]}};
    return std::any_of(room.begin(), room.end(), [&](const Hole& hole) { return hole.holds(from, d); });
}

/// On the floor, the wall across from the window, and a wall beside it.
bool point_of_room(std::uint64_t index, VisibilityPoint& point) {
    acdf_test::NumbersOf numbers(index);
    const float a = 3.9f * numbers.next() - 1.95f, b = numbers.next();
    if (index % 3 == 0) point = {{-1.99f, a, 0.02f + 1.95f * b}, {1.0f, 0.0f, 0.0f}};
    else if (index % 3 == 1) point = {{a, -1.99f, 0.02f + 1.95f * b}, {0.0f, 1.0f, 0.0f}};
    else point = {{a, 3.9f * b - 1.95f, 0.01f}, {0.0f, 0.0f, 1.0f}};
    return true;
}

builder::Portal portal_of(const Hole& hole) {
    const float low[2] = {float(hole.low[0]), float(hole.low[1])},
                size[2] = {float(hole.high[0]) - low[0], float(hole.high[1]) - low[1]};
    if (hole.axis == 0) return {{2.0f, low[0], low[1]}, {0.0f, size[0], 0.0f}, {0.0f, 0.0f, size[1]}};
    return {{low[0], 2.0f, low[1]}, {0.0f, 0.0f, size[1]}, {size[0], 0.0f, 0.0f}};
}

builder::LocalOptions of_room(std::vector<builder::Portal> portals, const Room& room = {kWindow}) {
    builder::LocalOptions out;
    out.goal = builder::Goal::of_budget(64 << 10);
    out.visibility.point = point_of_room;
    out.visibility.occluded = [room](const VisibilityPoint& p, const float* d) {
        return !leaves(room, p.position, d);
    };
    out.visibility.portals = std::move(portals);
    return out;
}

struct RoomFile {
    builder::Local local;
    File file;

    explicit RoomFile(const builder::LocalOptions& options, int threads = 0) {
        builder::Control control;
        control.threads = threads;
        const builder::Status status = builder::local(sky(), options, local, control);
        EXPECT_TRUE(status.ok()) << status.message;
        EXPECT_TRUE(File::from_memory(local.bytes.data(), local.bytes.size(), file).ok());
    }
    VisibleLocalView view() const { return visible_view(file); }
};
/// Made by one thread.
const RoomFile& windowed() {
    static const RoomFile made(of_room({portal_of(kWindow)}), 1);
    return made;
}

double cosine_of(const VisibilityPoint& point, const float d[3]) {
    return double{point.normal[0]} * double{d[0]} + double{point.normal[1]} * double{d[1]} +
           double{point.normal[2]} * double{d[2]};
}

/// What arrives at a point through holes, and the variance of a sample: sums over the tangents of each.
struct Arrives {
    double irradiance = 0.0, variance = 0.0;
    int lost = 0;
};
Arrives arrives(const VisibleLocalView& view, const AcdfVisiblePoint& at, const VisibilityPoint& point,
                const Room& room) {
    constexpr int steps = 96;
    Arrives out;
    double square = 0.0;
    for (const Hole& hole : room) {
        const int other = 1 - hole.axis;
        const double x = 2.0 - double{point.position[hole.axis]},
                     low[2] = {(hole.low[0] - double{point.position[other]}) / x,
                               (hole.low[1] - double{point.position[2]}) / x},
                     size[2] = {(hole.high[0] - hole.low[0]) / x, (hole.high[1] - hole.low[1]) / x};
        for (int i = 0; i < steps; ++i)
            for (int k = 0; k < steps; ++k) {
                const double a = low[0] + size[0] * (i + 0.5) / steps, b = low[1] + size[1] * (k + 0.5) / steps,
                             length = std::sqrt(1.0 + a * a + b * b),
                             angle = size[0] * size[1] / (steps * steps * length * length * length);
                double w[3] = {};
                w[hole.axis] = 1.0 / length;
                w[other] = a / length;
                w[2] = b / length;
                const float d[3] = {float(w[0]), float(w[1]), float(w[2])};
                const double cosine = cosine_of(point, d);
                if (!(cosine > 0.0)) continue;
                const double f = light_from(w) * cosine, p = double{view.pdf(at, d)};
                out.irradiance += f * angle;
                out.lost += !(p > 0.0);
                if (p > 0.0) square += f * f / p * angle;
            }
    }
    out.variance = square - out.irradiance * out.irradiance;
    return out;
}

/// Monte Carlo against sums, in standard errors: the mean of all points, and the root of the mean square.
void expect_as_summed(const RoomFile& made, const Room& room, int count, double spread) {
    constexpr int samples = 1000;
    count = acdf_test::repeated(count);
    const VisibleLocalView view = made.view();
    std::mt19937_64 random(11);
    double sum = 0.0, square = 0.0;
    for (int i = 0; i < count; ++i) {
        VisibilityPoint point;
        point_of_room(1000003 + std::uint64_t(i), point);
        const AcdfVisiblePoint at = view.at(point.position, point.normal);
        const Arrives truth = arrives(view, at, point, room);
        EXPECT_EQ(truth.lost, 0);
        double mean = 0.0;
        for (int k = 0; k < samples; ++k) {
            const DirectionSample s = view.sample(at, uniform(random), uniform(random));
            ASSERT_GT(s.pdf, 0.0f);
            ASSERT_EQ(view.pdf(at, s.direction), s.pdf);
            const double cosine = cosine_of(point, s.direction);
            if (!(cosine > 0.0) || !leaves(room, point.position, s.direction)) continue;
            const double d[3] = {double{s.direction[0]}, double{s.direction[1]}, double{s.direction[2]}};
            mean += light_from(d) * cosine / double{s.pdf} / samples;
        }
        const double z = (mean - truth.irradiance) / std::sqrt(truth.variance / samples);
        sum += z;
        square += z * z;
    }
    EXPECT_LT(std::fabs(sum / std::sqrt(count)), 4.0);
    if (!acdf_test::kSanitized) {
        EXPECT_NEAR(std::sqrt(square / count), 1.0, spread);
    }
}

TEST(PortalFiles, AreUnbiased) {
    ACDF_NOT_SANITIZED();
    expect_as_summed(windowed(), {kWindow}, 200, 0.2);
}
TEST(PortalFiles, AreUnbiasedWhereHalfOfTheWindowIsShut) {
    ACDF_NOT_SANITIZED();
    expect_as_summed(windowed(), {kHalf}, 100, 0.3);
}
/// What comes in there is sampled rarely: means of so few samples are far from normal.
TEST(PortalFiles, AreUnbiasedWhereADoorIsOpened) { expect_as_summed(windowed(), {kWindow, kDoor}, 100, 1.0); }

double mean_variance(const RoomFile& made) {
    double sum = 0.0;
    for (int i = 0; i < 150; ++i) {
        VisibilityPoint point;
        point_of_room(2000003 + std::uint64_t(i), point);
        const Arrives at = arrives(made.view(), made.view().at(point.position, point.normal), point, {kWindow});
        sum += at.variance / (at.irradiance * at.irradiance) / 150.0;
    }
    return sum;
}

TEST(PortalFiles, HaveLessNoiseThanCellsAlone) {
    ACDF_NOT_SANITIZED();
    const RoomFile visibility(of_room({}));
    EXPECT_TRUE(visibility.view().has_cells());
    EXPECT_FALSE(visibility.view().has_portals());
    EXPECT_TRUE(windowed().view().has_portals());
    EXPECT_LE(windowed().local.bytes.size(), 64u << 10);
    const double with = mean_variance(windowed()), without = mean_variance(visibility);
    EXPECT_LT(with, 0.2);
    EXPECT_LT(3.0 * with, without);
}

TEST(PortalFiles, LoseNothingThatANormalMaySee) {
    const VisibleLocalView view = windowed().view();
    std::mt19937_64 random(7);
    for (int i = 0; i < 100000; ++i) {
        const Normal normal = random_direction(random), direction = random_direction(random);
        const float *const n = normal.data(), *const d = direction.data();
        const float x[3] = {float(4.2 * uniform(random) - 2.1), float(4.2 * uniform(random) - 2.1),
                            float(2.2 * uniform(random) - 0.1)};
        if (view.local().pdf(n, d) > 0.0f) {
            ASSERT_GT(view.pdf(view.at(x, n), d), 0.0f);
        }
    }
}

/// The first portal, as a position sees it.
AcdfVisiblePortal seen_from(const VisibleLocalView& view, const float position[3], const float normal[3]) {
    const AcdfVisibleLocal& light = view.data();
    AcdfVisiblePortal out = {};
    double x[6];
    EXPECT_TRUE(acdf_visibility_coordinates(&light.cells, position, normal, x));
    EXPECT_TRUE(acdf_portal_bounds(&light.portals, light.portals.portals, x, &out));
    return out;
}

/// In a mirrored scene of twice the size the same window has the same samples.
TEST(PortalFiles, AreThoseOfTheScenesOwnCoordinates) {
    builder::LocalOptions options = of_room({portal_of(kWindow)});
    options.goal = builder::Goal::of_budget(24 << 10);
    const float mirrored[3][4] = {{-0.5f, 0, 0, 1}, {0, 0.5f, 0, 0}, {0, 0, 0.5f, 0}};
    for (int k = 0; k < 3; ++k) std::copy_n(mirrored[k], 4, options.visibility.transform[k]);
    builder::Portal& portal = options.visibility.portals[0]; // x = 1 - x'/2
    portal.corner[0] = 2.0f * (1.0f - portal.corner[0]);
    for (int k = 1; k < 3; ++k) {
        portal.corner[k] *= 2.0f;
        portal.across[k] *= 2.0f;
        portal.up[k] *= 2.0f;
    }
    std::swap(portal.across, portal.up); // light comes from the other side
    const RoomFile other(options);
    VisibilityPoint point;
    point_of_room(17, point);
    const float there[3] = {2.0f * (1.0f - point.position[0]), 2.0f * point.position[1], 2.0f * point.position[2]};
    const AcdfVisiblePoint a = windowed().view().at(point.position, point.normal),
                           b = other.view().at(there, point.normal);
    ASSERT_EQ(a.portals, 1);
    ASSERT_EQ(b.portals, 1);
    const AcdfVisiblePortal of_a = seen_from(windowed().view(), point.position, point.normal),
                            of_b = seen_from(other.view(), there, point.normal);
    for (int k = 0; k < 2; ++k) {
        EXPECT_NEAR(of_a.low[k], of_b.low[k], 1e-5);
        EXPECT_NEAR(of_a.high[k], of_b.high[k], 1e-5);
    }
}

TEST(PortalFiles, AreTheSameForAnyNumberOfThreads) {
    builder::Local again;
    builder::Control control;
    control.threads = 3;
    ASSERT_TRUE(builder::local(sky(), of_room({portal_of(kWindow)}), again, control).ok());
    EXPECT_TRUE(again.bytes == windowed().local.bytes);
}

/// Its sides in the other order, in the scene's frame and in a mirrored one.
TEST(PortalFiles, AreTheSameWhicheverWayAWindowIsWound) {
    builder::Portal turned = portal_of(kWindow);
    std::swap(turned.across, turned.up);
    builder::Local other;
    ASSERT_TRUE(builder::local(sky(), of_room({turned}), other).ok());
    EXPECT_TRUE(other.bytes == windowed().local.bytes);
}

/// A few rays suffice: no more than those are shot.
TEST(PortalFiles, AreCheckedBeforeAnythingIsBuilt) {
    builder::Portal outside = portal_of(kWindow);
    outside.corner[1] = 50.0f;
    builder::LocalOptions options = of_room({portal_of(kWindow), outside});
    std::atomic<std::uint64_t> last{0};
    options.visibility.point = [&](std::uint64_t index, VisibilityPoint& point) {
        last = std::max<std::uint64_t>(last, index);
        return point_of_room(index, point);
    };
    double built = 0.0;
    builder::Control control;
    control.progress = [&](double share, const char*) {
        built = std::max(built, share);
        return true;
    };
    builder::Local none;
    EXPECT_NE(std::string(builder::local(sky(), options, none, control).message)
                  .find("no light arrives through portal 2"),
              std::string::npos);
    EXPECT_EQ(built, 0.0);
    EXPECT_LT(last, 1u << 18);
}

TEST(PortalFiles, MistakesAreValues) {
    using Code = builder::ErrorCode;
    const auto told = [&](builder::LocalOptions o) {
        builder::Local result;
        o.goal = builder::Goal::of_budget(16 << 10);
        const builder::Status status = builder::local(sky(), o, result);
        EXPECT_TRUE(result.bytes.empty());
        EXPECT_NE(status.code, Code::none);
        return std::string(status.message);
    };
    const builder::Portal good = portal_of(kWindow);
    builder::Portal flat = good, nan = good, skew = good, huge = good, outside = good;
    std::fill_n(flat.up, 3, 0.0f);
    nan.corner[0] = std::numeric_limits<float>::quiet_NaN();
    skew.up[1] = 0.3f;
    huge.across[1] = std::numeric_limits<float>::infinity();
    outside.corner[1] = 50.0f;
    builder::LocalOptions small = of_room({good}); // a map of its light takes 17 KiB
    builder::Local none;
    small.goal = builder::Goal::of_budget(16 << 10);
    EXPECT_EQ(builder::local(sky(), small, none).code, Code::out_of_reach);
    EXPECT_NE(told(of_room({good, flat})).find("portal 2 has no area"), std::string::npos);
    EXPECT_NE(told(of_room({nan})).find("not finite"), std::string::npos);
    EXPECT_NE(told(of_room({skew})).find("right angles"), std::string::npos);
    EXPECT_NE(told(of_room({huge})).find("not finite"), std::string::npos);
    EXPECT_NE(told(of_room({good, outside})).find("no light arrives through portal 2"), std::string::npos);
    EXPECT_NE(told(of_room(std::vector<builder::Portal>(9, good))).find("8 portals"), std::string::npos);
    builder::LocalOptions stretched = of_room({good}), alone = of_room({good});
    stretched.visibility.transform[0][0] = 2.0f;
    EXPECT_NE(told(stretched).find("keep angles"), std::string::npos);
    alone.visibility.point = {};
    alone.visibility.occluded = {};
    EXPECT_NE(told(alone).find("with visibility cells"), std::string::npos);
}

} // namespace
