// Fitted BRDF files: samples follow the pdf, the pdf covers the light, and it is near the light.
#include "tests/inputs/brdf_files.h"
#include "tests/inputs/directions.h"
#include "tests/inputs/sanitized.h"
#include "tests/lib/compress/chi_square.h"

#include <tbb/global_control.h>

#include <random>
#include <stdexcept>

using namespace acdf_test;
using acdf::build::Sides;
using acdf::compress::View;

namespace {

using acdf_test::Direction;

constexpr double kCosines[] = {1.0, 0.5, 0.1, 1e-3};

enum Form { isotropic, anisotropic, lopsided, floored, separate, forms };

const char* const kFormNames[forms] = {"isotropic", "anisotropic", "lopsided", "floored", "separate"};

/// Files are made once.
const MadeBrdf& made(int form) {
    static std::unique_ptr<MadeBrdf> all[forms];
    if (all[form]) return *all[form];
    acdf::build::BrdfFileOptions options = budget(form == anisotropic ? 128 << 10 : 24 << 10);
    if (form == floored) options.diffuse_share = 0.25f;
    if (form == separate) {
        options.fit.fit = ACDF_FIT_CDF;
        options.fit.theta_views = 12;
    }
    std::unique_ptr<acdf::build::Brdf> source;
    if (form == lopsided) source = std::make_unique<LopsidedBrdf>();
    else source = std::make_unique<LobeBrdf>(0.1, form == anisotropic ? 0.3 : 0.1);
    all[form] = make_brdf(std::move(source), options);
    return *all[form];
}

class BrdfPdf : public testing::TestWithParam<int> {};

View view_of(double cosine, double phi = 0.4) {
    View view;
    view.x = std::sqrt(1.0 - cosine);
    view.phi = phi;
    return view;
}

/// Bins over directions: cos(theta) and phi of wi, the whole sphere.
struct Bins {
    static constexpr std::size_t rows = 23, columns = 17;
    static std::size_t of(const double w[3]) {
        const double r = 0.5 * (1.0 - w[2]) * rows, c = (0.5 + std::atan2(w[1], w[0]) / (2.0 * kPi)) * columns;
        return std::min<std::size_t>(rows - 1, std::size_t(std::max(0.0, r))) * columns +
               std::min<std::size_t>(columns - 1, std::size_t(c));
    }
};

/// Probabilities of the bins by summation over half-vectors.
std::vector<double> expected_bins(const acdf::BrdfView& brdf, const View& view) {
    std::vector<double> out(Bins::rows * Bins::columns, 0.0);
    double wo[3];
    view.direction(wo);
    const float o[3] = {float(wo[0]), float(wo[1]), float(wo[2])};
    constexpr int rows = 500, columns = 300;
    std::array<std::array<double, 2>, columns> azimuths;
    for (int c = 0; c < columns; ++c) {
        const double phi = 2.0 * kPi * (c + 0.5) / columns;
        azimuths[std::size_t(c)] = {std::cos(phi), std::sin(phi)};
    }
    for (int r = 0; r < rows; ++r) {
        const double t = (r + 0.5) / rows, theta = 0.5 * kPi * t * t;
        const double sine = std::sin(theta), cosine = std::cos(theta);
        const double measure = sine * kPi * t / rows * 2.0 * kPi / columns;
        for (const auto& azimuth : azimuths) {
            const double h[3] = {sine * azimuth[0], sine * azimuth[1], cosine};
            const double dot = wo[0] * h[0] + wo[1] * h[1] + wo[2] * h[2];
            const double wi[3] = {2.0 * dot * h[0] - wo[0], 2.0 * dot * h[1] - wo[1], 2.0 * dot * h[2] - wo[2]};
            const float i[3] = {float(wi[0]), float(wi[1]), float(wi[2])};
            out[Bins::of(wi)] += double{brdf.pdf(o, i)} * 4.0 * std::abs(dot) * measure;
        }
    }
    double sum = 0.0;
    for (const double p : out) sum += p;
    EXPECT_NEAR(sum, 1.0, 4e-3);
    for (double& p : out) p /= sum;
    return out;
}

TEST_P(BrdfPdf, samplesByItsPdf) {
    const MadeBrdf& brdf = made(GetParam());
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> u(0.0, 1.0);
    for (const double cosine : kCosines) {
        const View view = view_of(cosine);
        const std::vector<double> expected = expected_bins(brdf.view(), view);
        const Direction wo = at_angles(cosine, view.phi);
        std::vector<std::uint32_t> counts(expected.size(), 0);
        const int side = kSanitized ? 50 : 100; // stratified
        for (int i = 0; i < side * side; ++i) {
            const auto s =
                brdf.view().sample(wo.data(), (i % side + u(random)) / side, (i / side + u(random)) / side);
            const double wi[3] = {double{s.direction[0]}, double{s.direction[1]}, double{s.direction[2]}};
            ++counts[Bins::of(wi)];
        }
        const ChiSquare test = chi_square(counts, expected);
        EXPECT_GT(test.p_value, sidak(1e-4, 4 * forms))
            << cosine << " " << test.statistic << " of " << test.degrees;
    }
}

TEST_P(BrdfPdf, sampleReturnsThePdf) {
    const MadeBrdf& brdf = made(GetParam());
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> u(0.0, 1.0);
    for (int i = 0; i < repeated(20000); ++i) {
        const Direction wo = at_angles(kCosines[i % 4], 2.0 * kPi * u(random));
        const auto s = brdf.view().sample(wo.data(), u(random), u(random));
        ASSERT_EQ(s.pdf, brdf.view().pdf(wo.data(), s.direction)) << kCosines[i % 4];
        const double length = std::hypot(s.direction[0], s.direction[1], s.direction[2]);
        ASSERT_NEAR(length, 1.0, 1e-5);
    }
}

TEST_P(BrdfPdf, coversTheLightAndIntegratesTo1) {
    const MadeBrdf& brdf = made(GetParam());
    std::vector<View> views = acdf::build::random_views(6, brdf.source->isotropic);
    for (const double cosine : {1.0, 0.5, 0.1, 0.03, 1e-3, 1e-5}) views.push_back(view_of(cosine));
    for (const auto& v : acdf::build::measure_views(brdf.file, brdf.reflected, views, Sides::any, 301, 500)) {
        EXPECT_EQ(v.support_violations, 0u) << v.view.cosine();
        EXPECT_NEAR(v.integral, 1.0, 4e-3) << v.view.cosine();
        EXPECT_LE(v.share_above_horizon, 1.0) << v.view.cosine();
        EXPECT_GT(v.share_above_horizon, v.view.cosine() > 0.05 ? 0.98 : 0.8) << v.view.cosine();
    }
}

// Nearly opposite to this view lies a direction whose half-vector floats have at right angles to both: its pdf
// has no bound.
TEST(BrdfPdfs, areMeasuredNextToTheOppositeOfTheView) {
    ACDF_NOT_SANITIZED();
    const MadeBrdf& brdf = made(anisotropic);
    const View view = acdf::build::random_views(500, false).at(335);
    const auto measured = acdf::build::measure_views(brdf.file, brdf.reflected, {view}, Sides::any);
    EXPECT_NEAR(measured.front().integral, 1.0, 4e-3);
}

// For an odd number of columns and an even one: a column may be its own mirror image.
TEST_P(BrdfPdf, onOneSideIsThatOnBothWhereBothAreAlike) {
    const MadeBrdf& brdf = made(GetParam());
    const Sides sides = acdf::build::sides(*brdf.source);
    EXPECT_EQ(sides == Sides::alike, brdf.source->isotropic && brdf.source->mirror);
    const auto views = acdf::build::random_views(5, brdf.source->isotropic);
    for (const std::uint32_t columns : {51u, 52u}) {
        const auto one = acdf::build::measure_views(brdf.file, brdf.reflected, views, sides, columns, 90),
                   both = acdf::build::measure_views(brdf.file, brdf.reflected, views, Sides::any, columns, 90);
        for (std::size_t v = 0; v < views.size(); ++v) {
            EXPECT_NEAR(one[v].relative_variance, both[v].relative_variance, 1e-6 * both[v].relative_variance);
            EXPECT_NEAR(one[v].square_error, both[v].square_error, 1e-6 * both[v].square_error);
            EXPECT_NEAR(one[v].kl_divergence, both[v].kl_divergence, 1e-6 * both[v].kl_divergence);
            EXPECT_NEAR(one[v].max_weight, both[v].max_weight, 1e-6 * both[v].max_weight);
            EXPECT_NEAR(one[v].integral, both[v].integral, 1e-9);
            EXPECT_EQ(one[v].support_violations, both[v].support_violations);
        }
    }
}

TEST_P(BrdfPdf, storesTheAlbedo) {
    const MadeBrdf& brdf = made(GetParam());
    const auto views = acdf::build::random_views(6, brdf.source->isotropic);
    for (const auto& v : acdf::build::measure_views(brdf.file, brdf.reflected, views, Sides::any, 201, 400)) {
        const double told = brdf.view().albedo(at_angles(v.view.cosine(), v.view.phi).data());
        EXPECT_NEAR(told, v.albedo, (GetParam() == anisotropic ? 0.1 : 0.03) * v.albedo) << v.view.cosine();
    }
}

INSTANTIATE_TEST_SUITE_P(Forms, BrdfPdf, testing::Range(0, int{forms}),
                         [](const auto& info) { return kFormNames[info.param]; });

TEST(BrdfFit, isNearlyFreeOfNoise) {
    ACDF_NOT_SANITIZED();
    EXPECT_LT(made(isotropic).made.accuracy.relative_variance, 0.006);
    EXPECT_LT(made(lopsided).made.accuracy.relative_variance, 0.01);
    EXPECT_LT(made(anisotropic).made.accuracy.relative_variance, 0.06);
    EXPECT_LE(made(isotropic).made.bytes.size(), 24u << 10);
    EXPECT_LE(made(anisotropic).made.bytes.size(), 128u << 10);
}

// Directions that no symmetry of the frame maps onto each other.
TEST(BrdfFit, isWhereTheLightIs) {
    ACDF_NOT_SANITIZED();
    const Direction wo = at_angles(0.8, 0.3), mirror = {-wo[0], -wo[1], wo[2]};
    const Direction back = wo, aside = {-wo[1], wo[0], wo[2]};
    const float there = made(isotropic).view().pdf(wo.data(), mirror.data());
    EXPECT_GT(there, 10.0f * made(isotropic).view().pdf(wo.data(), back.data()));
    EXPECT_GT(there, 10.0f * made(isotropic).view().pdf(wo.data(), aside.data()));
    // Width 0.1 along x, 0.3 along y.
    const Direction up = {0.0f, 0.0f, 1.0f};
    const float along_x = made(anisotropic).view().pdf(up.data(), at_angles(std::cos(0.4), 0.0).data());
    const float along_y = made(anisotropic).view().pdf(up.data(), at_angles(std::cos(0.4), 0.5 * kPi).data());
    EXPECT_GT(along_y, 3.0f * along_x);
    // More on the side of positive wo x wi.
    const Direction left = at_angles(0.7, 0.3 + 0.5 * kPi), right = at_angles(0.7, 0.3 - 0.5 * kPi);
    EXPECT_GT(made(lopsided).view().pdf(wo.data(), left.data()),
              1.3f * made(lopsided).view().pdf(wo.data(), right.data()));
}

TEST(BrdfFit, isotropicFilesKnowNoAzimuth) {
    for (const int form : {isotropic, lopsided}) {
        const acdf::BrdfView brdf = made(form).view();
        for (double turn = 0.1; turn < 6.0; turn += 0.7) {
            const float a = brdf.pdf(at_angles(0.6, 0.0).data(), at_angles(0.7, 2.5).data());
            const float b = brdf.pdf(at_angles(0.6, turn).data(), at_angles(0.7, turn + 2.5).data());
            EXPECT_NEAR(a, b, 1e-5f * a);
        }
    }
}

TEST(BrdfFit, strataOfRandomNumbersAreHalvesOfDirections) {
    const acdf::BrdfView brdf = made(isotropic).view();
    const Direction wo = at_angles(0.6, 0.0);
    for (double u = 0.01; u < 0.5; u += 0.02) {
        const auto right = brdf.sample(wo.data(), 0.5 + u, 0.3), left = brdf.sample(wo.data(), 0.5 - u, 0.3);
        EXPECT_GT(right.direction[1], 0.0f);
        EXPECT_NEAR(right.direction[0], left.direction[0], 1e-6f);
        EXPECT_NEAR(right.direction[1], -left.direction[1], 1e-6f);
        EXPECT_FLOAT_EQ(right.pdf, left.pdf);
    }
}

TEST(BrdfFit, floorIsAnExactMixture) {
    ACDF_NOT_SANITIZED();
    acdf::build::BrdfFileOptions options = roughly_measured();
    options.fit.goal.cells = 300;
    const auto plain = make_brdf(std::make_unique<LobeBrdf>(0.1, 0.1), options);
    options.diffuse_share = 0.25f;
    const auto mixture = make_brdf(std::make_unique<LobeBrdf>(0.1, 0.1), options);
    std::mt19937_64 random(21);
    std::uniform_real_distribution<double> u(0.0, 1.0);
    for (int i = 0; i < 1000; ++i) {
        const Direction wo = at_angles(0.01 + 0.98 * u(random), 6.0 * u(random)),
                        wi = at_angles(2.0 * u(random) - 1.0, 6.0 * u(random));
        const double p = plain->view().pdf(wo.data(), wi.data());
        const double mixed = 0.75 * p + 0.25 * std::max(0.0, double{wi[2]}) / kPi;
        ASSERT_NEAR(mixture->view().pdf(wo.data(), wi.data()), mixed, 1e-5 * mixed);
    }
}

TEST(BrdfFit, isTheSameForAnyNumberOfThreads) {
    if (kSanitized) GTEST_SKIP() << "tests/same_bytes.sh runs sanitized programs so";
    acdf::build::BrdfFileOptions options = budget(10 << 10);
    std::vector<std::uint8_t> first;
    for (const std::size_t threads : {1u, 3u}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const auto brdf = make_brdf(std::make_unique<LobeBrdf>(0.2, 0.2), options);
        if (first.empty()) first = brdf->made.bytes;
        else EXPECT_EQ(first, brdf->made.bytes);
    }
}

TEST(BrdfFit, smallerGoalsTakeFewerBytes) {
    acdf::build::BrdfFileOptions options = roughly_measured();
    options.fit.goal.kind = acdf::compress::Goal::Kind::variance;
    options.fit.goal.variance = 0.05;
    const auto rough = make_brdf(std::make_unique<LobeBrdf>(0.2, 0.2), options);
    EXPECT_LT(rough->made.accuracy.relative_variance, 0.06);
    EXPECT_LT(rough->made.bytes.size(), 10000u);
    EXPECT_THROW(make_brdf(std::make_unique<LobeBrdf>(0.2, 0.2), budget(1000)), std::runtime_error);
}

/// Matte, to views between two angles alone.
class RingBrdf : public acdf::build::Brdf {
public:
    static constexpr double from = 0.7, to = 0.8; ///< of cos(theta_o)
    RingBrdf() { name = "ring"; }
    void evaluate(const double wo[3], const double wi[3], double rgb[3]) const override {
        rgb[0] = rgb[1] = rgb[2] = wo[2] > from && wo[2] < to && wi[2] > 0.0 ? 0.25 : 0.0;
    }
};

// Views are stored where light is; where they may not be, those between black ones still count.
TEST(BrdfFit, servesLitViewsAmongBlackOnes) {
    for (const std::uint32_t stored : {0u, 2u}) {
        acdf::build::BrdfFileOptions options = budget(8 << 10);
        options.fit.theta_views = stored;
        const auto brdf = make_brdf(std::make_unique<RingBrdf>(), options);
        const acdf::BrdfView view = brdf->view();
        const auto [fewest, most] = stored ? std::pair{0.01, 1.0} : std::pair{0.25, 1.0};
        for (const double cosine : {0.72, 0.75, 0.78}) {
            const Direction wo = at_angles(cosine, 0.4);
            EXPECT_GT(view.albedo(wo.data()), fewest * kPi / 4.0) << stored;
            EXPECT_LT(view.albedo(wo.data()), most * kPi / 4.0 * 1.01) << stored;
            std::mt19937_64 random(5);
            std::uniform_real_distribution<double> u(0.0, 1.0);
            for (int i = 0; i < 500; ++i) {
                const Direction wi = at_angles(std::sqrt(u(random)), 6.3 * u(random));
                EXPECT_GT(view.pdf(wo.data(), wi.data()), 0.0f) << stored;
                const acdf::DirectionSample s = view.sample(wo.data(), u(random), u(random));
                EXPECT_GT(s.pdf, 0.0f) << stored;
            }
        }
        EXPECT_EQ(brdf->made.accuracy.support_violations, 0u);
        if (!stored) {
            EXPECT_LT(brdf->made.accuracy.relative_variance, 0.3);
        }
    }
}

TEST(BrdfFit, nothingToReflectIsRefused) {
    EXPECT_THROW(make_brdf(std::make_unique<LobeBrdf>(1e200, 1e200, 0.0), budget(24 << 10)), std::invalid_argument);
}

} // namespace
