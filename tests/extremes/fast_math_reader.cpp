// What holds where the reader is compiled with -ffast-math: everything but the last bits. Files are those kept from
// earlier versions, of all kinds of spheres; numbers are all that a caller might pass.
#include "tests/extremes/fast_math.h"

#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

using Vector = std::array<float, 3>;

Vector random_direction(std::mt19937_64& random) {
    const double z = 2.0 * unit(random) - 1.0, phi = 6.283185307179586 * unit(random), s = std::sqrt(1.0 - z * z);
    return {static_cast<float>(s * std::cos(phi)), static_cast<float>(s * std::sin(phi)), static_cast<float>(z)};
}

/// Sampling and pdf of a file on the sphere, as the reader has it and compiled with -ffast-math. `about` is a
/// normal or a view, of no meaning to an environment.
struct Sampler {
    std::function<AcdfDirectionSample(const Vector&about, double u0, double u1)> exact, fast;
    std::function<float(const Vector&about, const Vector&direction)> exact_pdf, fast_pdf;
};

Sampler environment(const AcdfEnvironment& env) {
    return {[env](const Vector&, double u0, double u1) { return acdf_environment_sample(&env, u0, u1); },
            [env](const Vector&, double u0, double u1) { return fast_math::environment_sample(env, u0, u1); },
            [env](const Vector&, const Vector& d) { return acdf_environment_pdf(&env, d.data()); },
            [env](const Vector&, const Vector& d) { return fast_math::environment_pdf(env, d.data()); }};
}
Sampler local(const AcdfLocal& map) {
    return {[map](const Vector& n, double u0, double u1) { return acdf_local_sample(&map, n.data(), u0, u1); },
            [map](const Vector& n, double u0, double u1) { return fast_math::local_sample(map, n.data(), u0, u1); },
            [map](const Vector& n, const Vector& d) { return acdf_local_pdf(&map, n.data(), d.data()); },
            [map](const Vector& n, const Vector& d) { return fast_math::local_pdf(map, n.data(), d.data()); }};
}
Sampler brdf(const AcdfBrdf& table) {
    return {[table](const Vector& wo, double u0, double u1) { return acdf_brdf_sample(&table, wo.data(), u0, u1); },
            [table](const Vector& wo, double u0, double u1) {
                return fast_math::brdf_sample(table, wo.data(), u0, u1);
            },
            [table](const Vector& wo, const Vector& d) { return acdf_brdf_pdf(&table, wo.data(), d.data()); },
            [table](const Vector& wo, const Vector& d) { return fast_math::brdf_pdf(table, wo.data(), d.data()); }};
}

std::vector<std::string> golden_files() {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(ACDF_TEST_DIR "/golden/v1.0"))
        if (entry.path().extension() == ".acdf") files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    return files;
}

class FastMath : public ::testing::TestWithParam<std::string> {
protected:
    void SetUp() override {
        const acdf::Status status = acdf::File::open(GetParam().c_str(), file_, acdf::with_curves());
        ASSERT_TRUE(status.ok()) << status.message;
        if (file_.kind() == ACDF_KIND_ENVIRONMENT) sampler_ = environment(file_.environment().data());
        else if (file_.kind() == ACDF_KIND_LOCAL) sampler_ = local(file_.local().data());
        else if (file_.kind() == ACDF_KIND_BRDF) sampler_ = brdf(file_.brdf().data());
        else GTEST_SKIP() << "a table has no directions";
    }
    /// Above the surface, so that it is a view too.
    static Vector about(std::mt19937_64& random) {
        Vector v = random_direction(random);
        v[2] = std::max(std::fabs(v[2]), 1e-3f);
        const float length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        return {v[0] / length, v[1] / length, v[2] / length};
    }

    acdf::File file_;
    Sampler sampler_;
};

TEST_P(FastMath, SamplesAreTheSameButForRounding) {
    std::mt19937_64 random(1);
    constexpr int kCount = 20000;
    int elsewhere = 0; // rounding at a knot: in the next cell
    for (int i = 0; i < kCount; ++i) {
        const Vector n = about(random);
        const double u0 = unit(random), u1 = unit(random);
        const AcdfDirectionSample exact = sampler_.exact(n, u0, u1), fast = sampler_.fast(n, u0, u1);
        ASSERT_TRUE(std::isfinite(fast.pdf));
        ASSERT_EQ(fast.pdf > 0.0f, exact.pdf > 0.0f);
        bool near = std::fabs(fast.pdf - exact.pdf) <= 1e-5f * exact.pdf;
        for (int k = 0; k < 3; ++k) near = near && std::fabs(fast.direction[k] - exact.direction[k]) < 1e-5f;
        elsewhere += !near;
    }
    EXPECT_LE(elsewhere, kCount / 1000);
}

TEST_P(FastMath, PdfOfASampleIsItsOwn) {
    std::mt19937_64 random(2);
    for (int i = 0; i < 20000; ++i) {
        const Vector n = about(random);
        const double u0 = unit(random), u1 = unit(random);
        const AcdfDirectionSample s = sampler_.fast(n, u0, u1);
        if (s.pdf == 0.0f) continue;
        const float pdf = sampler_.fast_pdf(n, {s.direction[0], s.direction[1], s.direction[2]});
        ASSERT_NEAR(pdf / s.pdf, 1.0f, 1e-3f) << u0 << " " << u1; // tilted cells magnify rounding
    }
}

TEST_P(FastMath, PdfsAreTheSameButForRounding) {
    std::mt19937_64 random(3);
    for (int i = 0; i < 20000; ++i) {
        const Vector n = about(random), d = random_direction(random);
        const float exact = sampler_.exact_pdf(n, d), fast = sampler_.fast_pdf(n, d);
        ASSERT_EQ(fast > 0.0f, exact > 0.0f) << "a support violation";
        ASSERT_NEAR(fast, exact, 1e-3f * exact);
    }
}

TEST_P(FastMath, AnyNumbersAreSafe) {
    const double numbers[] = {0.0, 1.0,   1.0 - 0x1p-24, 0x1p-149,     0x1p-1074,    0.5,          -1.0,
                              2.0, 1e300, -1e300,        double{kNan}, double{kInf}, -double{kInf}};
    std::mt19937_64 random(4);
    for (const double u0 : numbers)
        for (const double u1 : numbers) {
            const AcdfDirectionSample s = sampler_.fast(about(random), u0, u1);
            ASSERT_TRUE(std::isfinite(s.pdf) && s.pdf >= 0.0f);
            for (const float x : s.direction) ASSERT_TRUE(std::isfinite(x));
        }
    const float parts[] = {0.0f, 1.0f, -1.0f, 1e-30f, 3e38f, kNan, kInf, -kInf};
    for (const float x : parts)
        for (const float y : parts)
            for (const float z : parts) {
                const Vector odd{x, y, z};
                const bool finite = std::isfinite(x) && std::isfinite(y) && std::isfinite(z);
                const AcdfDirectionSample s = sampler_.fast(odd, 0.3, 0.7);
                ASSERT_TRUE(std::isfinite(s.pdf));
                if (!finite && file_.kind() != ACDF_KIND_ENVIRONMENT) {
                    ASSERT_EQ(s.pdf, 0.0f);
                }
                const float p = sampler_.fast_pdf(about(random), odd),
                            q = sampler_.fast_pdf(odd, {0.0f, 0.0f, 1.0f});
                ASSERT_TRUE(std::isfinite(p) && std::isfinite(q));
                if (!finite) {
                    ASSERT_EQ(p, 0.0f);
                }
                if (!finite && file_.kind() != ACDF_KIND_ENVIRONMENT) {
                    ASSERT_EQ(q, 0.0f);
                }
            }
}

INSTANTIATE_TEST_SUITE_P(Golden, FastMath, ::testing::ValuesIn(golden_files()),
                         [](const auto& info) { return std::filesystem::path(info.param).stem().string(); });

} // namespace
