// Analytic BRDFs against their formulas written in angles, and against what physics asks of all of them.
#include "input/brdf/models.h"
#include "tests/lib/input/brdf/brdf.h"

#include <algorithm>
#include <complex>

namespace {

using namespace acdf::input;
using namespace acdf::test;

const char* const all_models[] = {
    "lambert",
    "lambert:albedo=0.2,0.5,0.8",
    "ggx:alpha=0.1",
    "ggx:alpha=0.1,0.3",
    "ggx:alpha=0.5,f0=0.04",
    "ggx:alpha=1",
    "ggx:alpha=0.01",
    "cook-torrance:m=0.2,n=1.5,k=0",
    "cook-torrance:m=0.35,n=0.2,0.9,1.2,k=3.9,2.4,2.2",
    "cook-torrance:m=0.6,n=100,k=100",
    "blinn:e=0",
    "blinn:e=10",
    "blinn:e=1000",
};

double dot(const Direction& a, const Direction& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Direction half_of(const Direction& a, const Direction& b) {
    Direction h = {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
    const double length = std::sqrt(dot(h, h));
    return {h[0] / length, h[1] / length, h[2] / length};
}

double slow_ggx(const Direction& wo, const Direction& wi, double ax, double ay, double f0) {
    const Direction h = half_of(wo, wi);
    const auto slope2 = [&](const Direction& w, double sx, double sy) { // tan^2 of the stretched direction
        const double phi = std::atan2(w[1], w[0]), tan = std::tan(std::acos(w[2]));
        return tan * tan * (std::pow(std::cos(phi) * sx, 2) + std::pow(std::sin(phi) * sy, 2));
    };
    const double d = 1.0 / (kPi * ax * ay * std::pow(h[2], 4) * std::pow(1.0 + slope2(h, 1.0 / ax, 1.0 / ay), 2));
    const auto lambda = [&](const Direction& w) { return 0.5 * (std::sqrt(1.0 + slope2(w, ax, ay)) - 1.0); };
    const double f = f0 + (1.0 - f0) * std::pow(1.0 - dot(wi, h), 5);
    return d * f / (1.0 + lambda(wo) + lambda(wi)) / (4.0 * wo[2] * wi[2]);
}

double slow_cook_torrance(const Direction& wo, const Direction& wi, double m, std::complex<double> index) {
    const Direction h = half_of(wo, wi);
    const double delta = std::acos(h[2]);
    const double d = std::exp(-std::pow(std::tan(delta) / m, 2)) / (kPi * m * m * std::pow(std::cos(delta), 4));
    const double g = std::min({1.0, 2.0 * h[2] * wo[2] / dot(wo, h), 2.0 * h[2] * wi[2] / dot(wo, h)});
    const double c = dot(wo, h); // Fresnel's amplitudes with Snell's law in complex numbers
    const std::complex<double> t = std::sqrt(1.0 - (1.0 - c * c) / (index * index));
    const double s = std::norm((c - index * t) / (c + index * t)), p = std::norm((index * c - t) / (index * c + t));
    return d * g * 0.5 * (s + p) / (4.0 * wo[2] * wi[2]);
}

TEST(InputBrdfModels, EqualTheirFormulas) {
    const auto isotropic = model_brdf("ggx:alpha=0.3"), anisotropic = model_brdf("ggx:alpha=0.1,0.3,f0=0.5");
    const auto metal = model_brdf("cook-torrance:m=0.35,n=0.2,0.9,1.2,k=3.9,2.4,2.2");
    const auto glass = model_brdf("cook-torrance:m=0.2");
    const auto blinn = model_brdf("blinn:e=10,albedo=0.5");
    const double n[3] = {0.2, 0.9, 1.2}, k[3] = {3.9, 2.4, 2.2};
    std::mt19937_64 random(1);
    for (int i = 0; i < 2000; ++i) {
        const Direction wo = random_direction(random), wi = random_direction(random);
        const auto near = [](double value, double expected) {
            EXPECT_NEAR(value, expected, 1e-8 * expected + 1e-300);
        };
        near(rho(*isotropic, wo, wi)[0], slow_ggx(wo, wi, 0.3, 0.3, 1.0));
        near(rho(*anisotropic, wo, wi)[1], slow_ggx(wo, wi, 0.1, 0.3, 0.5));
        for (std::size_t c = 0; c < 3; ++c)
            near(rho(*metal, wo, wi)[c], slow_cook_torrance(wo, wi, 0.35, {n[c], k[c]}));
        near(rho(*glass, wo, wi)[2], slow_cook_torrance(wo, wi, 0.2, 1.5));
        const double e = 10.0, scale = (e + 2) * (e + 4) / (8 * kPi * (std::pow(2.0, -e / 2) + e));
        near(rho(*blinn, wo, wi)[0], 0.5 * scale * std::pow(half_of(wo, wi)[2], e));
    }
}

TEST(InputBrdfModels, ValuesByHand) {
    const Direction up = {0.0, 0.0, 1.0};
    EXPECT_DOUBLE_EQ(rho(*model_brdf("lambert"), up, up)[0], 1.0 / kPi);
    EXPECT_EQ(rho(*model_brdf("lambert:albedo=0.2,0.5,0.8"), up, at_angles(1.0, 2.0))[1], 0.5 / kPi);
    // At the normal D is 1 / (pi alpha^2), masking 1.
    EXPECT_NEAR(rho(*model_brdf("ggx:alpha=0.1,f0=0.04"), up, up)[0], 0.04 / (4.0 * kPi * 0.01), 1e-12);
    EXPECT_NEAR(rho(*model_brdf("ggx:alpha=0.1,0.3"), up, up)[0], 1.0 / (4.0 * kPi * 0.03), 1e-12);
    EXPECT_NEAR(rho(*model_brdf("cook-torrance:m=0.2,n=1.5,k=0"), up, up)[0], 0.04 / (4.0 * kPi * 0.04), 1e-12);
    EXPECT_DOUBLE_EQ(rho(*model_brdf("blinn:e=0"), up, up)[0], 1.0 / kPi);
}

TEST(InputBrdfModels, ReciprocalBitForBit) {
    std::mt19937_64 random(2);
    for (const char* name : all_models) {
        const auto brdf = model_brdf(name);
        for (int i = 0; i < 500; ++i) {
            const Direction wo = random_direction(random), wi = random_direction(random);
            EXPECT_EQ(rho(*brdf, wo, wi), rho(*brdf, wi, wo)) << name;
        }
    }
}

TEST(InputBrdfModels, ReflectNoMoreThanTheyReceive) {
    for (const char* name : all_models) {
        const auto brdf = model_brdf(name);
        for (const double theta : {0.0, 0.5, 1.0, 1.3, 1.5}) {
            const Rgb reflected = albedo(*brdf, at_angles(theta, 0.7), 200);
            for (const double a : reflected) {
                EXPECT_LE(a, 1.0 + 2e-3) << name << " at " << theta;
                EXPECT_GT(a, 0.001) << name << " at " << theta;
            }
        }
    }
    for (const char* name : {"blinn:e=0", "blinn:e=10", "blinn:e=1000"}) // exactly 1 at normal incidence
        EXPECT_NEAR(albedo(*model_brdf(name), {0.0, 0.0, 1.0})[0], 1.0, 1e-3) << name;
    // Little is lost where the surface is nearly a mirror.
    EXPECT_NEAR(albedo(*model_brdf("ggx:alpha=0.01"), at_angles(0.5, 0.0))[0], 1.0, 5e-3);
}

TEST(InputBrdfModels, TurnAndMirrorAsTheySay) {
    std::mt19937_64 random(3);
    for (const char* name : all_models) {
        const auto brdf = model_brdf(name);
        EXPECT_EQ(brdf->name, name);
        int differ = 0;
        const auto same = [](double a, double b) { return std::abs(a - b) <= 1e-6 * a + 1e-12; };
        for (int i = 0; i < 200; ++i) {
            const Direction wo = random_direction(random), wi = random_direction(random);
            differ += !same(mean_of(rho(*brdf, wo, wi)), mean_of(rho(*brdf, turned(wo, 0.8), turned(wi, 0.8))));
            const Direction on_x = {std::hypot(wo[0], wo[1]), 0.0, wo[2]};
            EXPECT_TRUE(same(mean_of(rho(*brdf, on_x, wi)), mean_of(rho(*brdf, on_x, mirrored(wi))))) << name;
        }
        EXPECT_EQ(differ == 0, brdf->isotropic) << name << ' ' << differ;
        EXPECT_EQ(brdf->mirror, brdf->isotropic);
        EXPECT_EQ(brdf->isotropic, std::string(name) != "ggx:alpha=0.1,0.3");
    }
}

TEST(InputBrdfModels, FiniteEverywhere) {
    const Direction grazing = {std::sqrt(1.0 - 1e-20), 0.0, 1e-10}, least = {1.0, 0.0, 5e-324};
    for (const std::string name : {"ggx:alpha=1e-4", "ggx:alpha=10", "cook-torrance:m=1e-4,n=0.01,k=0",
                                   "cook-torrance:m=10,n=1,k=0", "blinn:e=1e7", "lambert"}) {
        const auto brdf = model_brdf(name);
        for (const Direction& wo : {grazing, least, at_angles(0.3, 1.0), Direction{0.0, 0.0, 1.0}})
            for (const Direction& wi : {grazing, least, Direction{-1.0, 0.0, 5e-324}, at_angles(0.3, 1.0),
                                        at_angles(0.3, 1.0 + kPi), Direction{0.0, 0.0, 1.0}})
                for (const double v : rho(*brdf, wo, wi))
                    EXPECT_TRUE(std::isfinite(v) && v >= 0.0) << name << ' ' << v;
        EXPECT_EQ(rho(*brdf, grazing, {0.0, 1.0, 0.0}), (Rgb{0.0, 0.0, 0.0}));
        EXPECT_EQ(rho(*brdf, {0.0, 1.0, -1e-9}, grazing), (Rgb{0.0, 0.0, 0.0}));
    }
}

TEST(InputBrdfModels, WrongTextsAreRefused) {
    const std::pair<const char*, const char*> cases[] = {
        {"phong", "no model of this name"},
        {"ggx:alpha=0", "'alpha' is not from 0.0001 to 10"},
        {"ggx:alpha=-1", "'alpha' is not from"},
        {"ggx:alpha=nan", "'alpha' is not from"},
        {"ggx:alpha=0.1,0.2,0.3", "at most 2"},
        {"ggx:alpha=", "'' is not a number"},
        {"ggx:alpha=0.1x", "'0.1x' is not a number"},
        {"ggx:alpha= 0.1", "is not a number"},
        {"ggx:alpha=0.1,alpha=0.2", "'alpha' comes twice"},
        {"ggx:", "is not a number"},
        {"ggx:0.1,alpha=0.2", "'alpha' comes twice"},
        {"ggx:0.1,0.2,0.3", "at most 2 numbers"},
        {"ggx:beta=1", "no parameter 'beta'"},
        {"ggx:f0=1,2", "'f0' is not from 0 to 1"},
        {"ggx:f0=1,1", "one number or three"},
        {"blinn:e=1e9", "'e' is not from"},
        {"cook-torrance:n=0", "'n' is not from"},
        {"lambert:albedo=1.5", "'albedo' is not from"},
    };
    for (const auto& wrong : cases) EXPECT_REFUSED(model_brdf(wrong.first), wrong.second);
}

} // namespace
