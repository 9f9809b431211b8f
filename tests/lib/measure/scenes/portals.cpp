// What rooms are lit by elsewhere: portals, and what can be seen of tiles at cache points. That each samples by the
// pdf it returns, and finds all the light that reaches a point.
#include "tests/lib/measure/samplers/baselines.h"
#include "tests/lib/measure/samplers/light_sampler_checks.h"

#include "input/brdf/brdf.h"
#include "measure/scenes/portals.h"
#include "measure/scenes/visibility_cache.h"

namespace {

using namespace acdf::measure;
using namespace acdf_test;
using acdf::compress::Target;

/// Of 64 x 32 texels: smooth, with a lamp.
Target probe() {
    return sphere_target(64, 32, [](double phi, double z) {
        return (std::abs(phi) < 0.2 && std::abs(z - 0.3) < 0.1 ? 30.0 : 0.0) + 1.5 + z + 0.5 * std::sin(3.0 * phi);
    });
}

/// Two portals that face x, one of them in part behind an opening that is tilted: some directions go through both.
std::vector<Portal> portals() {
    return {{{2, -1.5, 0.5}, {0, 1.2, 0}, {0, 0, 1.4}},
            {{2, 0.4, 0.6}, {0, 1.5, 0}, {0, 0, 1}},
            {{1.6, -0.5, 0.9}, {0.6, 1.6, 0}, {0, 0, 1.3}}};
}

ShadingPoint point_at(const Vec3& position) {
    ShadingPoint out;
    for (std::size_t k = 0; k < 3; ++k) out.position[k] = static_cast<float>(position[k]);
    return out;
}

bool reaches(const std::vector<Portal>& all, const Vec3& from, const float w[3]) {
    for (const Portal& portal : all) {
        const Vec3 d{double{w[0]}, double{w[1]}, double{w[2]}}, out = cross(portal.across, portal.up);
        const double along = dot(d, out);
        if (!(along > 0.0)) continue;
        const Vec3 at = from + (dot(portal.corner - from, out) / along) * d - portal.corner;
        const double a = dot(at, portal.across) / dot(portal.across, portal.across),
                     b = dot(at, portal.up) / dot(portal.up, portal.up);
        if (dot(portal.corner - from, out) > 0.0 && a >= 0.0 && a <= 1.0 && b >= 0.0 && b <= 1.0) return true;
    }
    return false;
}

const Vec3 kPositions[] = {{-1, 0, 0.8}, {1.5, -1, 1}, {0.3, 2.5, -2}, {1.9, 0.5, 1.2}};

// Borders of what is seen cut bins of directions: they are summed finely.
constexpr SphereBins kBins{16, 8, 96};
const SamplerCheck kCheck{10000, 5e-3, 1e-3, sidak(0.01, 200)};

TEST(Portals, AreSampledByTheirPdf) {
    const Target target = probe();
    const LightSamplerPtr uniform = uniform_portal_sampler(portals(), false),
                          windowed = windowed_portal_sampler(target, portals(), false, 96);
    for (const Vec3& position : kPositions) {
        expect_samples_as_its_pdf(*uniform, point_at(position), kBins, "uniform", kCheck);
        expect_samples_as_its_pdf(*windowed, point_at(position), kBins, "windowed", kCheck);
    }
}

TEST(Portals, FindAllLightThatComesThroughThem) {
    const Target target = probe();
    const std::vector<Portal> all = portals();
    for (const bool is_uniform : {true, false}) {
        const LightSamplerPtr sampler =
            is_uniform ? uniform_portal_sampler(all, false) : windowed_portal_sampler(target, all, false, 128);
        for (const Vec3& position : kPositions) {
            const auto point = sampler->point_sampler();
            point->move_to(point_at(position));
            double expected = 0.0, square = 0.0;
            kBins.for_each([&](std::size_t, const float* w, double omega) {
                if (!reaches(all, position, w)) return;
                const double f = target.values[texel_of(target, w)], p = point->pdf(w);
                expected += f * omega;
                square += p > 0.0 ? f * f / p * omega : 0.0;
            });
            std::mt19937_64 random(4);
            const MonteCarlo mean = monte_carlo(20000, [&] {
                const double u = uniform(random), v = uniform(random);
                const AcdfDirectionSample s = point->sample(u, v);
                return s.pdf > 0.0f ? target.values[texel_of(target, s.direction)] / s.pdf : 0.0;
            });
            EXPECT_NEAR(mean.mean, expected, 4.0 * mean.mean_error + 5e-3 * expected) << is_uniform;
            const double relative = square / (expected * expected) - 1.0;
            if (is_uniform) EXPECT_GT(relative, 0.05); // it knows no light
            else EXPECT_LT(relative, 0.2);             // where two portals overlap it samples twice as much
        }
    }
}

// Outside, and in the plane of a portal, there is nothing to sample; meshes with y up have their own coordinates.
TEST(Portals, OfEveryPosition) {
    const Target target = probe();
    const std::vector<Portal> one{{{2, -1, 0}, {0, 2, 0}, {0, 0, 2}}};
    for (const bool is_uniform : {true, false}) {
        const auto make = [&](bool turned) {
            return is_uniform ? uniform_portal_sampler(one, turned)
                              : windowed_portal_sampler(target, one, turned, 64);
        };
        const LightSamplerPtr plain = make(false), turned = make(true);
        const auto point = plain->point_sampler(), other = turned->point_sampler();
        const float through[3] = {1, 0, 0};
        for (const double x : {2.0, 2.5, 1e9}) {
            point->move_to(point_at({x, 0.1, 1}));
            EXPECT_EQ(point->sample(0.3, 0.6).pdf, 0.0f);
            EXPECT_EQ(point->pdf(through), 0.0f);
        }
        for (const double x : {2.0 - 1e-12, 2.0 - 1e-6, -1.0, -1e6}) {
            point->move_to(point_at({x, 0.1, 1}));
            for (const double u : {0.0, 0.5, 1.0 - 0x1p-53}) {
                const AcdfDirectionSample s = point->sample(u, u);
                EXPECT_TRUE(std::isfinite(s.pdf) && s.pdf >= 0.0f) << x;
            }
        }
        point->move_to(point_at({0, 0.1, 1}));
        other->move_to(point_at({0.1, 1, 0}));
        for (const double u : {0.1, 0.6}) EXPECT_EQ(point->sample(u, 0.3).pdf, other->sample(u, 0.3).pdf);
    }
    EXPECT_THROW(uniform_portal_sampler({}, false), std::invalid_argument);
    EXPECT_THROW(windowed_portal_sampler(target, {}, false, 64), std::invalid_argument);
}

/// A floor beside a wall.
struct Yard {
    Scene scene;
    std::unique_ptr<acdf::input::Brdf> brdf = acdf::input::open_brdf("lambert");
    std::vector<ScenePoint> points;

    Yard() {
        scene.geometry.objects = {{Plane{0.0, 4.0}, 0, true}, {Box3{{-4, 0.5, 0}, {4, 0.9, 3}}, 0, false}};
        scene.camera = {{0, -5, 3}, {0, 0, 0}, 40.0, {0, 0, 1}};
        scene.width = 24;
        scene.height = 18;
        scene.materials = {{brdf.get(), {1, 1, 1}}};
        points = visible_points(scene).points;
    }
};

TEST(Visibility, IsKnownAtCachePoints) {
    const Yard yard;
    const Target target = probe();
    const TilingOnTheFly tiling(target, 16, 8);
    const VisibilityCache cache(tiling, yard.points);
    EXPECT_GT(cache.size(), 10u);
    EXPECT_LT(cache.size(), yard.points.size() / 2);
    EXPECT_GT(cache.making().shadow_rays, 10u * cache.size());
    for (const ScenePoint& point : yard.points) EXPECT_NE(cache.factors(point.shading()), nullptr);
    ShadingPoint away;
    away.position[0] = 100.0f;
    EXPECT_EQ(cache.factors(away), nullptr);
    ShadingPoint down = yard.points.front().shading();
    down.n[2] = -1.0f;
    EXPECT_EQ(cache.factors(down), nullptr);

    const LightSamplerPtr with = visibility_sampler(target, 16, 8, yard.points),
                          without = tiling_sampler(target, 16, 8);
    EXPECT_GT(with->making().shadow_rays, 0u);
    EXPECT_EQ(without->making().shadow_rays, 0u);
    const auto a = with->point_sampler(), b = without->point_sampler();
    double seen = 0.0, hidden = 0.0;
    for (std::size_t i = 0; i < yard.points.size(); i += 40) {
        const ScenePoint& point = yard.points[i];
        expect_samples_as_its_pdf(*with, point.shading(), SphereBins{64, 32, 4}, "visibility",
                                  SamplerCheck{4000, 1e-4, 0.0, 1e-4});
        a->move_to(point.shading());
        b->move_to(point.shading());
        SphereBins{32, 16}.for_each([&](std::size_t, const float* w, double omega) {
            const double p = a->pdf(w);
            EXPECT_EQ(p > 0.0, b->pdf(w) > 0.0f); // what may be hidden is still sampled
            (point.hidden({w[0], w[1], w[2]}) ? hidden : seen) += (p - b->pdf(w)) * omega;
        });
    }
    EXPECT_GT(seen, 0.0);
    EXPECT_LT(hidden, 0.0);
}

} // namespace
