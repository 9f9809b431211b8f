// Estimators: that none is biased, also where light is hidden, and that variances are those that theory knows.
#include "tests/lib/measure/samplers/baselines.h"
#include "tests/lib/measure/samplers/light_sampler_checks.h"

#include "measure/samplers/estimators.h"
#include "measure/samplers/light_samplers.h"
#include "measure/samplers/local_baselines.h"
#include "measure/samplers/stratification.h"
#include "measure/samplers/stratified_map.h"

#include <set>

namespace {

using namespace acdf::measure;
using acdf::compress::Target;
using acdf_test::awkward_normals;
using acdf_test::facing;
using acdf_test::irradiance_targets;
using acdf_test::NamedTarget;
using acdf_test::Normal;

constexpr double kTint[3] = {0.5, 1.0, 2.0};

/// Light of a probe on a diffuse surface; a slanted half of the sphere may be hidden.
class Lit : public Integrand {
public:
    Lit(const Target& target, const Normal& n, bool occluded) : target_(target), n_(n), occluded_(occluded) {}

    Rgb operator()(const float wi[3]) const override {
        const double value = visible(wi) ? unoccluded(wi) : 0.0;
        return {kTint[0] * value, kTint[1] * value, kTint[2] * value};
    }
    double unoccluded(const float wi[3]) const override {
        return target_.values[acdf_test::texel_of(target_, wi)] * std::max(0.0, acdf_test::dot(n_.data(), wi));
    }
    bool visible(const float wi[3]) const { return !(occluded_ && 0.6 * wi[0] - 0.5 * wi[1] + 0.4 * wi[2] > 0.3); }

    /// By brute force.
    double integral(std::uint32_t points = 8) const {
        double sum = 0.0;
        acdf_test::for_each_direction(target_, points, [&](std::size_t i, const double* d, double omega) {
            const double cosine = n_[0] * d[0] + n_[1] * d[1] + n_[2] * d[2];
            const float w[3] = {static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2])};
            if (cosine > 0.0 && visible(w)) sum += target_.values[i] * cosine * omega;
        });
        return sum;
    }

private:
    const Target& target_;
    Normal n_;
    bool occluded_;
};

struct Measured {
    acdf_test::MonteCarlo green;
    Tally tally;
};

Measured measure(const Estimator& estimator, const Lit& lit, const Normal& n, int estimates,
                 std::uint64_t seed = 41) {
    const auto own = estimator.point_estimator();
    Random random(seed);
    Measured out;
    out.green = acdf_test::monte_carlo(estimates, [&] {
        const Rgb value = own->estimate(facing(n), lit, random, out.tally);
        EXPECT_NEAR(value[0], 0.5 * value[1], 1e-9 * value[1]);
        EXPECT_NEAR(value[2], 2.0 * value[1], 1e-9 * value[1]);
        return value[1];
    });
    return out;
}

double relative_variance(const Measured& m, double mean) { return m.green.second / (mean * mean) - 1.0; }
double error_of_it(const Measured& m, double mean) { return m.green.second_error / (mean * mean); }

/// Everything that can be done with a probe, as estimators of about 16 samples.
class AllEstimators {
public:
    explicit AllEstimators(const Target& t)
        : cdf_(full_cdf_sampler(t)), cosine_(cosine_sampler()),
          tiling_(tiling_sampler(t, std::min(8u, t.columns), std::min(4u, t.rows))),
          compensated_(compensated_sampler(t)), strata_(t, 16), bright_strata_(t, 16, Jitter::radiance) {
        add("full CDF", std::make_unique<SingleEstimator>(*cdf_, 16));
        add("cosine", std::make_unique<SingleEstimator>(*cosine_, 16));
        add("tiling", std::make_unique<SingleEstimator>(*tiling_, 16));
        const std::vector<Share> two = {{cdf_.get(), 9}, {cosine_.get(), 7}};
        add("balance", std::make_unique<MisEstimator>(two, Heuristic::balance));
        add("power", std::make_unique<MisEstimator>(two, Heuristic::power));
        const std::vector<Share> three = {{tiling_.get(), 5}, {cosine_.get(), 2}, {cdf_.get(), 9}};
        add("three", std::make_unique<MisEstimator>(three, Heuristic::balance));
        const std::vector<Share> sharpened = {{compensated_.get(), 8}, {cosine_.get(), 8}};
        add("compensated", std::make_unique<MisEstimator>(sharpened, Heuristic::balance));
        add("resampled", std::make_unique<ResamplingEstimator>(*cdf_, 8, 4));
        add("resampled cosine", std::make_unique<ResamplingEstimator>(*cosine_, 3, 5));
        add("strata", std::make_unique<StratifiedEstimator>(strata_));
        add("strata by radiance", std::make_unique<StratifiedEstimator>(bright_strata_));
    }
    struct Named {
        std::string name;
        std::unique_ptr<Estimator> estimator;
    };
    const std::vector<Named>& all() const { return all_; }

private:
    void add(const char* name, std::unique_ptr<Estimator> e) { all_.push_back({name, std::move(e)}); }
    LightSamplerPtr cdf_, cosine_, tiling_, compensated_;
    StratifiedMap strata_, bright_strata_;
    std::vector<Named> all_;
};

class Estimators : public ::testing::TestWithParam<NamedTarget> {};

TEST_P(Estimators, AreUnbiasedWithAndWithoutOccluders) {
    const Target& t = GetParam().target;
    const double flux = acdf::compress::integral(t);
    const AllEstimators estimators(t);
    for (const Normal& n : awkward_normals())
        for (const bool occluded : {false, true}) {
            const Lit lit(t, n, occluded);
            const double expected = lit.integral();
            for (const auto& [name, estimator] : estimators.all()) {
                // So few samples would not meet the texel, and not know that they miss it.
                if (GetParam().name == "one_lit_texel" && name.find("cosine") != name.npos) continue;
                const Measured m = measure(*estimator, lit, n, 300);
                // 200 comparisons; the sum itself is wrong by the texels that the shadow's border crosses.
                EXPECT_NEAR(m.green.mean, expected, 5.5 * m.green.mean_error + (occluded ? 4e-3 : 1e-3) * flux)
                    << name << (occluded ? ", occluded" : "");
            }
        }
}
INSTANTIATE_TEST_SUITE_P(Targets, Estimators, ::testing::ValuesIn(acdf_test::fine_targets()),
                         [](const auto& i) { return i.param.name; });

TEST(EstimatorVariance, OfOneSamplerIsThatOfTheSampler) {
    const Target t = acdf_test::noise_target(48, 24, 3);
    const Normal n = awkward_normals()[2];
    const Lit lit(t, n, false);
    const double mean = lit.integral(), one = LocalFullCdf(t).relative_variance(n.data());
    const LightSamplerPtr cdf = full_cdf_sampler(t);
    for (const std::uint32_t samples : {1u, 5u}) {
        const Measured m = measure(SingleEstimator(*cdf, samples), lit, n, 40000);
        EXPECT_NEAR(relative_variance(m, mean), one / samples, 5.0 * error_of_it(m, mean) + 2e-3 * one);
        EXPECT_EQ(m.tally.samples, 40000u * samples);
        EXPECT_EQ(m.tally.above, m.tally.shadow_rays);
        double above = 0.0;
        acdf_test::for_each_direction(t, 8, [&](std::size_t i, const double* d, double omega) {
            if (n[0] * d[0] + n[1] * d[1] + n[2] * d[2] > 0.0) above += t.values[i] * omega;
        });
        EXPECT_NEAR(double(m.tally.above) / double(m.tally.samples), above / acdf::compress::integral(t), 0.01);
    }
}

// w = 1/2 each: the same samples give the same estimate.
TEST(EstimatorVariance, MisOfASamplerWithItselfIsThatSampler) {
    const Target t = acdf_test::noise_target(48, 24, 3);
    const LightSamplerPtr cdf = full_cdf_sampler(t);
    for (const Normal& n : awkward_normals()) {
        const Lit lit(t, n, true);
        const auto single = SingleEstimator(*cdf, 12).point_estimator();
        for (const Heuristic heuristic : {Heuristic::balance, Heuristic::power}) {
            const std::vector<Share> shares = {{cdf.get(), 6}, {cdf.get(), 6}};
            const auto mis = MisEstimator(shares, heuristic).point_estimator();
            Random a(5), b(5);
            for (int i = 0; i < 50; ++i) {
                Tally tally_a, tally_b;
                const Rgb x = single->estimate(facing(n), lit, a, tally_a);
                const Rgb y = mis->estimate(facing(n), lit, b, tally_b);
                for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(x[k], y[k], 1e-6 * x[k]);
                ASSERT_EQ(tally_a.samples, tally_b.samples);
                ASSERT_EQ(tally_a.shadow_rays, tally_b.shadow_rays);
            }
        }
    }
}

// Balance: sum over i of int w_i^2 f^2/(n_i p_i) less the squared means, by summation.
TEST(EstimatorVariance, OfMisIsTheSum) {
    const Target t = acdf_test::noise_target(48, 24, 3);
    const Normal n = awkward_normals()[1];
    const Lit lit(t, n, false);
    const double flux = acdf::compress::integral(t);
    const LightSamplerPtr cdf = full_cdf_sampler(t), cosine = cosine_sampler();
    const double count[2] = {3.0, 2.0};
    for (const Heuristic heuristic : {Heuristic::balance, Heuristic::power}) {
        double second = 0.0, first[2] = {0.0, 0.0}, mean = 0.0;
        acdf_test::for_each_direction(t, 4, [&](std::size_t i, const double* d, double omega) {
            const double c = n[0] * d[0] + n[1] * d[1] + n[2] * d[2];
            if (!(c > 0.0)) return;
            const double f = t.values[i] * c, p[2] = {t.values[i] / flux, c / acdf_test::kPi};
            const double e = heuristic == Heuristic::power ? 2.0 : 1.0;
            const double a = std::pow(count[0] * p[0], e), b = std::pow(count[1] * p[1], e);
            mean += f * omega;
            for (int k = 0; k < 2; ++k) {
                const double w = (k == 0 ? a : b) / (a + b);
                second += w * w * f * f / (count[k] * p[k]) * omega;
                first[k] += w * f * omega;
            }
        });
        const double expected =
            (second - first[0] * first[0] / count[0] - first[1] * first[1] / count[1]) / (mean * mean);
        const std::vector<Share> shares = {{cdf.get(), 3}, {cosine.get(), 2}};
        const Measured m = measure(MisEstimator(shares, heuristic), lit, n, 40000);
        EXPECT_NEAR(relative_variance(m, mean), expected, 5.0 * error_of_it(m, mean) + 2e-3 * expected);
    }
}

TEST(EstimatorVariance, OfResamplingIsThatOfAllCandidates) {
    const Target t = acdf_test::noise_target(48, 24, 3);
    const Normal n = awkward_normals()[3];
    const Lit lit(t, n, false);
    const double mean = lit.integral(), one = LocalFullCdf(t).relative_variance(n.data());
    const LightSamplerPtr cdf = full_cdf_sampler(t);
    for (const std::uint32_t kept : {1u, 4u}) {
        const Measured m = measure(ResamplingEstimator(*cdf, 8, kept), lit, n, 20000);
        EXPECT_NEAR(relative_variance(m, mean), one / (8 * kept), 5.0 * error_of_it(m, mean) + 2e-3 * one);
        EXPECT_EQ(m.tally.samples, 20000u * 8 * kept);
        EXPECT_LE(m.tally.shadow_rays, 20000u * kept);
        EXPECT_GT(m.tally.shadow_rays, 19000u * kept);
    }
}

// The sum over strata of those of one sample each.
TEST(EstimatorVariance, OfStrataIsTheSum) {
    const Target t = acdf_test::noise_target(48, 24, 3);
    const Normal n = awkward_normals()[0];
    const Lit lit(t, n, false);
    for (const std::uint32_t count : {1u, 12u}) {
        const std::vector<std::uint32_t> stratum = stratify(t, count);
        std::vector<double> angle(count), light(count), square(count), weighted(count), flux(count);
        acdf_test::for_each_direction(t, 4, [&](std::size_t i, const double* d, double omega) {
            const double f = t.values[i] * std::max(0.0, n[0] * d[0] + n[1] * d[1] + n[2] * d[2]);
            const std::uint32_t s = stratum[i];
            angle[s] += omega;
            flux[s] += t.values[i] * omega;
            light[s] += f * omega;
            square[s] += f * f * omega;
            weighted[s] += f * f / t.values[i] * omega;
        });
        double mean = 0.0, uniformly = 0.0, by_radiance = 0.0;
        for (std::uint32_t s = 0; s < count; ++s) {
            mean += light[s];
            uniformly += angle[s] * square[s] - light[s] * light[s];
            by_radiance += flux[s] * weighted[s] - light[s] * light[s];
        }
        const StratifiedMap map(t, count), bright(t, count, Jitter::radiance);
        ASSERT_EQ(map.strata(), count);
        const Measured a = measure(StratifiedEstimator(map), lit, n, 30000);
        const Measured b = measure(StratifiedEstimator(bright), lit, n, 30000);
        uniformly /= mean * mean;
        by_radiance /= mean * mean;
        EXPECT_NEAR(relative_variance(a, mean), uniformly, 5.0 * error_of_it(a, mean) + 2e-3 * uniformly);
        EXPECT_NEAR(relative_variance(b, mean), by_radiance, 5.0 * error_of_it(b, mean) + 2e-3 * by_radiance);
        EXPECT_LT(by_radiance, uniformly);
        EXPECT_EQ(a.tally.samples, 30000u * count);
    }
}

TEST(Stratification, OfAConstantSkyIsEven) {
    const Target t = acdf_test::sphere_target(128, 64, [](double, double) { return 1.0; });
    const std::vector<std::uint32_t> stratum = stratify(t, 20);
    std::vector<double> angle(20, 0.0);
    acdf_test::for_each_direction(
        t, 1, [&](std::size_t i, const double*, double omega) { angle.at(stratum[i]) += omega; });
    for (const double a : angle) {
        EXPECT_GT(a, 4.0 * acdf_test::kPi / 20.0 / 3.0);
        EXPECT_LT(a, 4.0 * acdf_test::kPi / 20.0 * 3.0);
    }
}

TEST(Stratification, ALightGetsItsShareAndKeepsItsStrata) {
    // A patch of more than 0.01 sr with half of the flux asks for half of the strata.
    const auto in_patch = [](std::size_t i) {
        return i % 128 >= 30 && i % 128 < 36 && i / 128 >= 20 && i / 128 < 26;
    };
    Target t = acdf_test::sphere_target(128, 64, [](double, double) { return 1.0; });
    double inside = 0.0, outside = 0.0;
    acdf_test::for_each_direction(
        t, 1, [&](std::size_t i, const double*, double omega) { (in_patch(i) ? inside : outside) += omega; });
    ASSERT_GT(inside, 0.01);
    for (std::size_t i = 0; i < t.values.size(); ++i)
        if (in_patch(i)) t.values[i] = static_cast<float>(outside / inside);
    const std::vector<std::uint32_t> stratum = stratify(t, 20);
    std::set<std::uint32_t> patch, sky;
    for (std::size_t i = 0; i < stratum.size(); ++i) (in_patch(i) ? patch : sky).insert(stratum[i]);
    EXPECT_EQ(patch.size(), 10u);
    EXPECT_EQ(sky.size(), 10u);
    for (const std::uint32_t s : patch) EXPECT_EQ(sky.count(s), 0u);
}

TEST(Stratification, DividesNoTexel) {
    const Target sun = acdf_test::texel_target(
        16, 8, [](std::uint32_t c, std::uint32_t r) { return c == 3 && r == 2 ? 1e6 : 1.0; });
    const std::vector<std::uint32_t> stratum = stratify(sun, 1000);
    EXPECT_EQ(std::set<std::uint32_t>(stratum.begin(), stratum.end()).size(), 128u);
    EXPECT_THROW(stratify(sun, 0), std::invalid_argument);
    const std::vector<std::uint32_t> few = stratify(sun, 4);
    EXPECT_EQ(std::count(few.begin(), few.end(), few[2 * 16 + 3]), 1);
}

TEST(EstimatorsOf, NothingAreRefused) {
    const LightSamplerPtr cosine = cosine_sampler();
    EXPECT_THROW(SingleEstimator(*cosine, 0), std::invalid_argument);
    EXPECT_THROW(ResamplingEstimator(*cosine, 0, 1), std::invalid_argument);
    EXPECT_THROW(ResamplingEstimator(*cosine, 1, 0), std::invalid_argument);
    EXPECT_THROW(MisEstimator({{cosine.get(), 0}}, Heuristic::balance), std::invalid_argument);
}

} // namespace
