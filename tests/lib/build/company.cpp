// Files that are made for a company: unbiased with it, and less noisy than files that are made to be used alone.
// What is measured is compared with a slow reference that shares no code with it.
#include "tests/inputs/synthetic.h"
#include "tests/lib/compress/chi_square.h"

#include <acdf/builder.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace acdf {
namespace {

using acdf_test::kPi;
using Vector = std::array<float, 3>;

constexpr std::uint32_t kColumns = 64, kRows = 32;

double dot(const Vector& a, const float b[3]) {
    return double{a[0]} * b[0] + double{a[1]} * b[1] + double{a[2]} * b[2];
}

Vector random_normal(std::mt19937_64& random) {
    Vector n{};
    const double z = 2.0 * acdf_test::uniform(random) - 1.0;
    acdf_test::direction_of(kPi * (2.0 * acdf_test::uniform(random) - 1.0), z, n.data());
    return n;
}

/// Grey radiance, and what it makes of a surface.
struct Probe {
    std::string name;
    std::vector<float> radiance;

    double at(const float d[3]) const {
        const double phi = std::atan2(double{d[1]}, double{d[0]}),
                     theta = std::acos(std::clamp(double{d[2]}, -1.0, 1.0));
        const auto c = std::min(static_cast<std::uint32_t>((kPi - phi) / (2.0 * kPi) * kColumns), kColumns - 1);
        const auto r = std::min(static_cast<std::uint32_t>(theta / kPi * kRows), kRows - 1);
        return double{radiance[r * kColumns + c]};
    }
    double irradiance(const Vector& n) const { // with 3 x 3 points a texel
        constexpr std::uint32_t parts = 3;
        double sum = 0.0;
        for (std::uint32_t r = 0; r < parts * kRows; ++r)
            for (std::uint32_t c = 0; c < parts * kColumns; ++c) {
                const double z0 = std::cos(kPi * r / (parts * kRows)),
                             z1 = std::cos(kPi * (r + 1) / (parts * kRows));
                float d[3];
                acdf_test::direction_of(acdf_test::centre_phi(c, parts * kColumns), 0.5 * (z0 + z1), d);
                sum += double{radiance[r / parts * kColumns + c / parts]} * std::max(0.0, dot(n, d)) * (z0 - z1);
            }
        return sum * 2.0 * kPi / (parts * kColumns);
    }
};

Probe probe(const std::string& name, double (*f)(std::uint32_t column, std::uint32_t row)) {
    Probe out{name, {}};
    for (std::uint32_t r = 0; r < kRows; ++r)
        for (std::uint32_t c = 0; c < kColumns; ++c) out.radiance.push_back(static_cast<float>(f(c, r)));
    return out;
}

std::vector<Probe> probes() {
    using u32 = std::uint32_t;
    return {
        probe("even", [](u32, u32) { return 1.0; }),
        probe("sun", [](u32 c, u32 r) { return c == 40 && r == 6 ? 4000.0
                                               : r < 16          ? 1.0
                                                                 : 0.2; }),
        probe("two suns", [](u32 c, u32 r) { return (c == 9 && r == 12) || (c == 50 && r == 3) ? 900.0 : 0.5; }),
        probe("gradient", [](u32 c, u32 r) { return 0.1 + r + 0.3 * ((c * 7 + r * 13) % 11); }),
        probe("dark ground", [](u32 c, u32 r) { return r < 16 ? 1.0 + (c % 8 == 0 ? 30.0 : 0.0) : 0.0; }),
        probe("windows", [](u32 c, u32 r) { return c % 16 < 3 && r > 8 && r < 14 ? 50.0 : 0.05; }),
        probe("noise", [](u32 c, u32 r) { return (c * 2654435761u ^ r * 40503u) % 97 < 4 ? 40.0 : 0.3; }),
        probe("one lamp", [](u32 c, u32 r) { return c == 20 && r == 20 ? 100.0 : 0.0; })};
}

/// A file, as what it draws at a normal.
struct Made {
    std::vector<std::uint8_t> bytes;
    File file;
    double variance = 0.0;

    bool local() const { return file.kind() == ACDF_KIND_LOCAL; }
    DirectionSample sample(const Vector& n, double u0, double u1) const {
        return local() ? file.local().sample(n.data(), u0, u1) : file.environment().sample(u0, u1);
    }
    double pdf(const Vector& n, const float d[3]) const {
        return static_cast<double>(local() ? file.local().pdf(n.data(), d) : file.environment().pdf(d));
    }
};

struct Kind {
    bool local;
    builder::Company company;
};
const std::vector<Kind> kinds{{false, {ACDF_COMPANY_COSINE, ACDF_HEURISTIC_BALANCE, 1.0, 1.0}},
                              {false, {ACDF_COMPANY_COSINE, ACDF_HEURISTIC_POWER, 1.0, 1.0}},
                              {false, {ACDF_COMPANY_BRDF, ACDF_HEURISTIC_BALANCE, 1.0, 1.0}},
                              {false, {ACDF_COMPANY_MEAN, ACDF_HEURISTIC_BALANCE, 1.0, 1.0}},
                              {true, {ACDF_COMPANY_COSINE, ACDF_HEURISTIC_BALANCE, 1.0, 1.0}},
                              {true, {ACDF_COMPANY_COSINE, ACDF_HEURISTIC_BALANCE, 3.0, 1.0}},
                              {true, {ACDF_COMPANY_COSINE, ACDF_HEURISTIC_POWER, 1.0, 1.0}},
                              {true, {ACDF_COMPANY_BRDF, ACDF_HEURISTIC_BALANCE, 1.0, 1.0}}};

void make(const Probe& probe, const Kind& kind, std::uint64_t budget, Made& out) {
    builder::Pixels pixels;
    pixels.data = probe.radiance.data();
    pixels.width = kColumns;
    pixels.height = kRows;
    pixels.channels = 1;
    builder::Status status;
    if (kind.local) {
        builder::LocalOptions options;
        options.goal = builder::Goal::of_budget(budget);
        options.company = kind.company;
        builder::Local made;
        status = builder::local(pixels, options, made);
        out.bytes = std::move(made.bytes);
        out.variance = made.accuracy.relative_variance;
    } else {
        builder::EnvironmentOptions options;
        options.goal = builder::Goal::of_budget(budget);
        options.company = kind.company;
        builder::Environment made;
        status = builder::environment(pixels, options, made);
        out.bytes = std::move(made.bytes);
        out.variance = made.accuracy.relative_variance;
    }
    ASSERT_TRUE(status.ok()) << probe.name << ": " << status.message;
    ASSERT_LE(out.bytes.size(), budget) << probe.name;
    ASSERT_TRUE(File::from_memory(out.bytes.data(), out.bytes.size(), out.file).ok());
}

double share_of(const builder::Company& company) { return company.light / (company.light + company.other); }

/// Weight over number of samples and density, of a sample that was drawn with `own` beside `other`, both densities
/// times the share of their samples.
double weight(double own, double other, AcdfHeuristic heuristic) {
    return heuristic == ACDF_HEURISTIC_POWER ? own / (own * own + other * other) : 1.0 / (own + other);
}

/// N times the variance of N samples over the squared integral: for each sampler the variance of what one of its
/// samples adds, texel by texel. `density(texel, direction)` is ours.
template <class Density>
double slow_variance(const Probe& probe, const Vector& n, double share, AcdfHeuristic heuristic,
                     const Density& density) {
    double mean[2] = {0.0, 0.0}, square[2] = {0.0, 0.0};
    for (std::uint32_t r = 0; r < kRows; ++r)
        for (std::uint32_t c = 0; c < kColumns; ++c) {
            float d[3];
            acdf_test::direction_of(acdf_test::centre_phi(c, kColumns), acdf_test::centre_z(r, kRows), d);
            const double cosine = dot(n, d),
                         omega =
                             2.0 * kPi / kColumns * (std::cos(kPi * r / kRows) - std::cos(kPi * (r + 1.0) / kRows));
            const double f = double{probe.radiance[r * kColumns + c]} * cosine;
            if (!(f > 0.0)) continue;
            const double p[2] = {density(r * kColumns + c, d), cosine / kPi};
            const double a[2] = {share * p[0], (1.0 - share) * p[1]};
            for (int i = 0; i < 2; ++i) {
                if (!(p[i] > 0.0)) continue;
                const double x = f * weight(a[i], a[1 - i], heuristic);
                mean[i] += p[i] * omega * x;
                square[i] += p[i] * omega * x * x;
            }
        }
    const double e = share * mean[0] + (1.0 - share) * mean[1];
    if (!(e > 0.0)) return -1.0; // it sees no light
    return (share * (square[0] - mean[0] * mean[0]) + (1.0 - share) * (square[1] - mean[1] * mean[1])) / (e * e);
}

double slow_variance(const Probe& probe, const Vector& n, const builder::Company& company, const Made& made) {
    return slow_variance(probe, n, share_of(company), company.heuristic,
                         [&](std::size_t, const float d[3]) { return made.pdf(n, d); });
}

/// Water filling on texels: the least second moment with the cosine that there is.
std::vector<double> filled(const Probe& probe, const Vector& n, double ratio) {
    std::vector<double> cosine, omega;
    for (std::uint32_t r = 0; r < kRows; ++r)
        for (std::uint32_t c = 0; c < kColumns; ++c) {
            float d[3];
            acdf_test::direction_of(acdf_test::centre_phi(c, kColumns), acdf_test::centre_z(r, kRows), d);
            cosine.push_back(std::max(0.0, dot(n, d)));
            omega.push_back(2.0 * kPi / kColumns * (std::cos(kPi * r / kRows) - std::cos(kPi * (r + 1.0) / kRows)));
        }
    const auto sum = [&](double threshold) {
        double out = 0.0;
        for (std::size_t i = 0; i < cosine.size(); ++i)
            out += cosine[i] * std::max(0.0, double{probe.radiance[i]} - threshold) * omega[i];
        return out;
    };
    double low = 1e-9, high = 1e6;
    for (int step = 0; step < 100; ++step) {
        const double middle = std::sqrt(low * high);
        (sum(middle) > ratio * kPi * middle ? low : high) = middle;
    }
    std::vector<double> out;
    for (std::size_t i = 0; i < cosine.size(); ++i)
        out.push_back(cosine[i] * std::max(0.0, double{probe.radiance[i]} - low) / sum(low));
    return out;
}

TEST(Company, EstimatesWithItAreUnbiased) {
    constexpr int normals = 200, estimates = 16;
    for (const Probe& probe : probes()) {
        std::mt19937_64 random(77);
        std::vector<Vector> at;
        std::vector<double> wanted;
        for (int i = 0; i < normals; ++i) {
            at.push_back(random_normal(random));
            wanted.push_back(probe.irradiance(at.back()));
        }
        for (const Kind& kind : kinds) {
            Made made;
            make(probe, kind, kind.local ? 48 << 10 : 4 << 10, made);
            double error = 0.0, variance = 0.0; // of the mean over normals
            for (std::size_t i = 0; i < at.size(); ++i) {
                double sum = 0.0, square = 0.0;
                for (int k = 0; k < estimates; ++k) {
                    double estimate = 0.0;
                    const auto add = [&](const float d[3], double own, double other) {
                        const double cosine = dot(at[i], d);
                        if (cosine > 0.0 && own > 0.0)
                            estimate += probe.at(d) * cosine * weight(own, other, kind.company.heuristic);
                    };
                    const DirectionSample s =
                        made.sample(at[i], acdf_test::uniform(random), acdf_test::uniform(random));
                    add(s.direction, double{s.pdf}, std::max(0.0, dot(at[i], s.direction)) / kPi);
                    float d[3];
                    acdf_cosine_direction(at[i].data(), acdf_test::uniform(random), acdf_test::uniform(random), d);
                    add(d, dot(at[i], d) / kPi, made.pdf(at[i], d));
                    sum += estimate;
                    square += estimate * estimate;
                }
                const double mean = sum / estimates, scale = std::max(wanted[i], 1e-3);
                error += (mean - wanted[i]) / scale;
                variance += std::max(0.0, square / estimates - mean * mean) / (estimates - 1) / (scale * scale);
            }
            EXPECT_LT(std::abs(error), 4.0 * std::sqrt(variance) + 5e-3 * normals)
                << probe.name << ", " << (kind.local ? "local" : "env") << " company " << kind.company.kind
                << " heuristic " << kind.company.heuristic;
        }
    }
}

TEST(Company, DensitiesIntegrateToOneAndAreThoseOfSamples) {
    std::mt19937_64 random(5);
    const std::vector<Probe> all = probes();
    for (const Kind& kind : kinds) {
        Made made;
        make(all[1], kind, kind.local ? 48 << 10 : 4 << 10, made);
        EXPECT_NE(made.file.company(), nullptr);
        for (int i = 0; i < 5; ++i) {
            const Vector n = random_normal(random);
            std::vector<double> expected;
            double sum = 0.0;
            for (std::uint32_t r = 0; r < kRows; ++r)
                for (std::uint32_t c = 0; c < kColumns; ++c) {
                    float d[3];
                    acdf_test::direction_of(acdf_test::centre_phi(c, kColumns), acdf_test::centre_z(r, kRows), d);
                    expected.push_back(made.pdf(n, d) * 2.0 * kPi / kColumns *
                                       (std::cos(kPi * r / kRows) - std::cos(kPi * (r + 1.0) / kRows)));
                    sum += expected.back();
                }
            EXPECT_NEAR(sum, 1.0, 1e-5);
            for (double& p : expected) p /= sum;
            std::vector<std::uint32_t> observed(expected.size(), 0);
            for (int k = 0; k < 4000; ++k) {
                const DirectionSample s = made.sample(n, acdf_test::uniform(random), acdf_test::uniform(random));
                ASSERT_EQ(static_cast<double>(s.pdf), made.pdf(n, s.direction));
                const double phi = std::atan2(double{s.direction[1]}, double{s.direction[0]});
                const double theta = std::acos(std::clamp(double{s.direction[2]}, -1.0, 1.0));
                ++observed[std::min(static_cast<std::uint32_t>(theta / kPi * kRows), kRows - 1) * kColumns +
                           std::min(static_cast<std::uint32_t>((kPi - phi) / (2.0 * kPi) * kColumns),
                                    kColumns - 1)];
            }
            const acdf_test::ChiSquare test = acdf_test::chi_square(observed, expected);
            EXPECT_FALSE(test.impossible);
            EXPECT_GT(test.p_value, 0.01 / 40.0); // of 40 tests
        }
    }
}

TEST(Company, VarianceIsThatOfTheSlowReference) {
    for (const Probe& probe : {probes()[1], probes()[4]})
        for (const Kind& kind : {kinds[0], kinds[1], kinds[4], kinds[5], kinds[6]}) {
            Made made;
            make(probe, kind, kind.local ? 48 << 10 : 4 << 10, made);
            std::mt19937_64 engine(20051); // the normals of build::random_normals
            const auto uniform = [&] { return double(engine() >> 11) * 0x1p-53; };
            double sum = 0.0, lit = 0.0;
            for (int i = 0; i < (kind.local ? 256 : 64); ++i) {
                Vector n{};
                const double z = 1.0 - 2.0 * uniform();
                acdf_test::direction_of(kPi * (2.0 * uniform() - 1.0), z, n.data());
                const double variance = slow_variance(probe, n, kind.company, made);
                if (variance < 0.0) continue;
                sum += variance;
                lit += 1.0;
            }
            EXPECT_NEAR(made.variance, sum / lit, 2e-3 * (sum / lit) + 1e-4) << probe.name;
        }
}

TEST(Company, LocalFilesComeNearWaterFillingOfEachNormal) {
    const std::vector<Probe> all = probes();
    for (const std::size_t i : {std::size_t{3}, std::size_t{5}}) {
        Made with, alone;
        make(all[i], kinds[4], 192 << 10, with);
        make(all[i], {true, {}}, 192 << 10, alone);
        std::mt19937_64 random(3);
        double ours = 0.0, ideal = 0.0, without = 0.0;
        for (int k = 0; k < 40; ++k) {
            const Vector n = random_normal(random);
            const std::vector<double> best = filled(all[i], n, 1.0);
            ours += slow_variance(all[i], n, kinds[4].company, with);
            without += slow_variance(all[i], n, kinds[4].company, alone);
            ideal += slow_variance(all[i], n, 0.5, ACDF_HEURISTIC_BALANCE,
                                   [&](std::size_t texel, const float*) { return best[texel]; });
        }
        EXPECT_LT(ours, 1.3 * ideal + 0.8) << all[i].name; // 0.02 a normal, for tiles of these wide texels
        EXPECT_LT(ours, without) << all[i].name;
    }
}

TEST(Company, TellsWhatItIsAndWhatToDraw) {
    const std::vector<Probe> all = probes();
    Made alone, with, environment;
    make(all[1], {true, {}}, 48 << 10, alone);
    make(all[1], kinds[5], 48 << 10, with);
    make(all[1], kinds[1], 4 << 10, environment);
    const float up[3] = {0.0f, 0.0f, 1.0f}, side[3] = {0.6f, -0.64f, 0.48f};
    EXPECT_FALSE(alone.file.local().needs_company());
    EXPECT_EQ(alone.file.local().recommended_share(up), 1.0f);
    EXPECT_TRUE(with.file.local().needs_company());
    EXPECT_TRUE(environment.file.environment().needs_company());
    EXPECT_EQ(environment.file.company()->heuristic, static_cast<std::uint32_t>(ACDF_HEURISTIC_POWER));
    EXPECT_EQ(with.file.company()->share, 0.75f);
    for (const float* n : {up, side}) {
        const float share = with.file.local().recommended_share(n);
        EXPECT_GT(share, 0.0f);
        EXPECT_LE(share, 1.0f);
        EXPECT_NEAR(with.file.local().irradiance(n), alone.file.local().irradiance(n),
                    0.05 * alone.file.local().irradiance(n));
    }
    const float share = environment.file.environment().recommended_share();
    EXPECT_GT(share, 0.0f);
    EXPECT_LT(share, 1.0f);
}

TEST(Company, OptionsThatContradictItAreRefused) {
    const std::vector<float> grey(8 * 4, 1.0f);
    builder::Pixels pixels;
    pixels.data = grey.data();
    pixels.width = 8;
    pixels.height = 4;
    pixels.channels = 1;
    const auto refused = [&](builder::EnvironmentOptions options) {
        builder::Environment made;
        return builder::environment(pixels, options, made).code == builder::ErrorCode::invalid_argument;
    };
    builder::EnvironmentOptions options;
    options.company.kind = ACDF_COMPANY_TABLE;
    EXPECT_TRUE(refused(options));
    options.company.kind = ACDF_COMPANY_COSINE;
    options.company.light = 0.0;
    EXPECT_TRUE(refused(options));
    options.company.light = 1.0;
    options.fit.max_weight = 4.0;
    EXPECT_TRUE(refused(options));
    options.fit.max_weight = 0.0;
    options.goal = builder::Goal::of_variance(0.1);
    EXPECT_TRUE(refused(options));
    builder::LocalOptions local;
    local.company.kind = ACDF_COMPANY_COSINE;
    local.cosine_share = 0.2;
    builder::Local made;
    EXPECT_EQ(builder::local(pixels, local, made).code, builder::ErrorCode::invalid_argument);
}

} // namespace
} // namespace acdf
