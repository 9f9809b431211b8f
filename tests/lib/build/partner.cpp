// Files that are made for an MIS partner: pdfs and samples agree, and are less noisy than files that are made
// to be used alone.
#include "tests/lib/build/partner.h"
#include "tests/inputs/sanitized.h"
#include "tests/lib/compress/chi_square.h"

namespace acdf {
namespace {

using namespace partner_test;

/// Water filling on texels: the least second moment with the cosine that there is.
std::vector<double> filled(const Probe& probe, const Vector& n, double ratio) {
    const Directions& all = middles();
    std::vector<double> cosine;
    for (const Vector& d : all.direction) cosine.push_back(std::max(0.0, dot(n, d.data())));
    const auto sum = [&](double threshold) {
        double out = 0.0;
        for (std::size_t i = 0; i < cosine.size(); ++i)
            out += cosine[i] * std::max(0.0, double{probe.radiance[i]} - threshold) * all.omega[i];
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

TEST(Partner, PdfsIntegrateToOneAndAreThoseOfSamples) {
    std::mt19937_64 random(5);
    const std::vector<Probe> all = probes();
    for (const Kind& kind : kinds) {
        // The same code, with other weights and shares.
        if (acdf_test::kSanitized && (kind.mis.heuristic == ACDF_HEURISTIC_POWER || kind.mis.light != 1.0))
            continue;
        Made made;
        make(all[1], kind, made);
        EXPECT_NE(made.file.partner(), nullptr);
        for (int i = 0; i < 5; ++i) {
            const Vector n = random_normal(random);
            std::vector<double> expected;
            double sum = 0.0;
            for (std::size_t texel = 0; texel < middles().direction.size(); ++texel) {
                expected.push_back(made.pdf(n, middles().direction[texel].data()) * middles().omega[texel]);
                sum += expected.back();
            }
            EXPECT_NEAR(sum, 1.0, 1e-5);
            for (double& p : expected) p /= sum;
            std::vector<std::uint32_t> observed(expected.size(), 0);
            for (int k = 0; k < 4000; ++k) {
                const DirectionSample s = made.sample(n, acdf_test::uniform(random), acdf_test::uniform(random));
                ASSERT_EQ(static_cast<double>(s.pdf), made.pdf(n, s.direction));
                ++observed[texel_of(s.direction)];
            }
            const acdf_test::ChiSquare test = acdf_test::chi_square(observed, expected);
            EXPECT_FALSE(test.impossible);
            EXPECT_GT(test.p_value, 0.01 / 40.0); // of 40 tests
        }
    }
}

TEST(Partner, BrightnessDoesNotCount) {
    ACDF_NOT_SANITIZED();
    const Vector up{0.0f, 0.0f, 1.0f};
    for (const Kind& kind : kinds) {
        Probe light = probe(
            "windows", [](std::uint32_t c, std::uint32_t r) { return c % 16 < 3 && r > 8 && r < 14 ? 64.0 : 1.0; });
        Made usual;
        make(light, kind, usual);
        // What local files have left in curves is kept in floats.
        for (const int exponent : {kind.local ? -130 : -149, -120, 121}) {
            Probe scaled = light;
            for (float& texel : scaled.radiance) texel = std::ldexp(texel, exponent);
            Made other;
            make(scaled, kind, other);
            std::mt19937_64 random(6);
            for (int i = 0; i < 200; ++i) {
                const double u0 = acdf_test::uniform(random), u1 = acdf_test::uniform(random);
                const DirectionSample a = usual.sample(up, u0, u1), b = other.sample(up, u0, u1);
                ASSERT_EQ(a.pdf, b.pdf) << exponent << ", " << kind.local << kind.mis.kind;
                for (int k = 0; k < 3; ++k) ASSERT_EQ(a.direction[k], b.direction[k]) << exponent;
            }
        }
    }
}

TEST(Partner, VarianceIsThatOfTheSlowReference) {
    const std::vector<Probe> all = probes();
    for (const std::size_t which : {std::size_t{1}, std::size_t{4}}) {
        if (acdf_test::kSanitized && which == 4) break; // the same code, of other light
        const Probe& probe = all[which];
        for (const Kind& kind : {kinds[0], kinds[1], kinds[4], kinds[5], kinds[6]}) {
            Made made;
            make(probe, kind, made);
            std::mt19937_64 engine(20051); // the normals of build::random_normals
            double sum = 0.0, lit = 0.0;
            for (int i = 0; i < (kind.local ? 256 : 64); ++i) {
                Vector n{};
                const double z = 1.0 - 2.0 * acdf_test::uniform(engine);
                acdf_test::direction_of(kPi * (2.0 * acdf_test::uniform(engine) - 1.0), z, n.data());
                const double variance = slow_variance(probe, n, kind.mis, made, sixteenths());
                if (variance < 0.0) continue;
                sum += variance;
                lit += 1.0;
            }
            EXPECT_NEAR(made.variance, sum / lit, 2e-3 * (sum / lit) + 1e-4) << probe.name;
        }
    }
}

TEST(Partner, LocalFilesComeNearWaterFillingOfEachNormal) {
    ACDF_NOT_SANITIZED();
    const std::vector<Probe> all = probes();
    for (const std::size_t i : {std::size_t{3}, std::size_t{5}}) {
        Made with, alone;
        make(all[i], kinds[4], with, 192 << 10);
        make(all[i], {true, {}}, alone, 192 << 10);
        std::mt19937_64 random(3);
        double ours = 0.0, ideal = 0.0, without = 0.0;
        for (int k = 0; k < 40; ++k) {
            const Vector n = random_normal(random);
            const std::vector<double> best = filled(all[i], n, 1.0);
            ours += slow_variance(all[i], n, kinds[4].mis, with);
            without += slow_variance(all[i], n, kinds[4].mis, alone);
            ideal += slow_variance(all[i], n, 0.5, ACDF_HEURISTIC_BALANCE,
                                   [&](std::size_t texel) { return best[texel]; });
        }
        EXPECT_LT(ours, 1.3 * ideal + 0.8) << all[i].name; // 0.02 a normal, for tiles of these wide texels
        EXPECT_LT(ours, without) << all[i].name;
    }
}

TEST(Partner, ReturnsItsKindAndShares) {
    const std::vector<Probe> all = probes();
    Made alone, with, environment;
    make(all[1], {true, {}}, alone);
    make(all[1], kinds[5], with);
    make(all[1], kinds[1], environment);
    const float up[3] = {0.0f, 0.0f, 1.0f}, side[3] = {0.6f, -0.64f, 0.48f};
    EXPECT_FALSE(alone.file.local().requires_mis());
    EXPECT_EQ(alone.file.local().recommended_light_share(up), 1.0f);
    EXPECT_TRUE(with.file.local().requires_mis());
    EXPECT_TRUE(environment.file.environment().requires_mis());
    EXPECT_EQ(environment.file.partner()->heuristic, static_cast<std::uint32_t>(ACDF_HEURISTIC_POWER));
    EXPECT_EQ(with.file.partner()->share, 0.75f);
    for (const float* n : {up, side}) {
        const float share = with.file.local().recommended_light_share(n);
        EXPECT_GT(share, 0.0f);
        EXPECT_LE(share, 1.0f);
        EXPECT_NEAR(with.file.local().irradiance(n), alone.file.local().irradiance(n),
                    0.05 * alone.file.local().irradiance(n));
    }
    const float share = environment.file.environment().recommended_light_share();
    EXPECT_GT(share, 0.0f);
    EXPECT_LT(share, 1.0f);
}

TEST(Partner, OptionsThatContradictItAreRefused) {
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
    options.mis.kind = ACDF_PARTNER_TABLE;
    EXPECT_TRUE(refused(options));
    options.mis.kind = ACDF_PARTNER_COSINE;
    options.mis.light = 0.0;
    EXPECT_TRUE(refused(options));
    options.mis.light = 1.0;
    options.fit.max_weight = 4.0;
    EXPECT_TRUE(refused(options));
    options.fit.max_weight = 0.0;
    options.goal = builder::Goal::of_variance(0.1);
    EXPECT_TRUE(refused(options));
    builder::LocalOptions local;
    local.mis.kind = ACDF_PARTNER_COSINE;
    local.cosine_share = 0.2;
    builder::Local made;
    EXPECT_EQ(builder::local(pixels, local, made).code, builder::ErrorCode::invalid_argument);
    local.cosine_share = 0.0;
    local.mis.kind = ACDF_PARTNER_BRDF;
    EXPECT_EQ(builder::local(pixels, local, made).code, builder::ErrorCode::invalid_argument);
}

} // namespace
} // namespace acdf
