// Accuracy on real BRDFs: the figures of the documentation must hold.
#include "tests/lib/build/real_brdfs.h"

#include "input/brdf/rgl.h"
#include "measure/samplers/brdf_table.h"
#include "measure/samplers/rgl_sampler.h"

using namespace acdf_test;

namespace {

class MerlFile : public testing::TestWithParam<const char*> {};

TEST_P(MerlFile, at64KiBBeatsTheFullTable) {
    NEEDS(GetParam());
    const MadeBrdf& brdf = real_brdf(GetParam(), 64);
    const auto views = acdf::build::random_views(24, true);
    const auto ours = acdf::build::summary(
        acdf::build::measure_views(brdf.file, brdf.reflected, views, acdf::build::Sides::any, 201, 350));
    const acdf::measure::TabulatedBrdf table(brdf.reflected, true, acdf::measure::BrdfTableKind::mean);
    const auto theirs = acdf::build::summary(
        acdf::build::measure_views([&](const double wo[3], const double wi[3]) { return table.pdf(wo, wi); },
                                   brdf.reflected, views, 201, 350));
    EXPECT_LE(brdf.made.bytes.size(), 64u << 10);
    EXPECT_LE(ours.relative_variance, 0.008);
    EXPECT_LE(ours.relative_variance, theirs.relative_variance);
    EXPECT_EQ(ours.support_violations, 0u);
}

INSTANTIATE_TEST_SUITE_P(Files, MerlFile, testing::Values("nickel.binary"),
                         [](const auto& info) { return std::string(info.param).substr(0, 4); });

struct RglCase {
    const char* name;
    std::uint64_t kib; ///< a file of this size is enough
};

class RglFile : public testing::TestWithParam<RglCase> {};

TEST_P(RglFile, beatsItsAuthorsSampler) {
    NEEDS(GetParam().name);
    const MadeBrdf& brdf = real_brdf(GetParam().name, GetParam().kib);
    const auto& rgl = dynamic_cast<const acdf::input::RglBrdf&>(*brdf.source);
    const acdf::measure::RglSampler sampler(rgl);
    const auto views = acdf::build::random_views(16, true, std::cos(75.0 * 3.14159265358979 / 180.0), 0.996);
    const auto ours = acdf::build::summary(
        acdf::build::measure_views(brdf.file, brdf.reflected, views, acdf::build::Sides::any, 201, 350));
    const auto theirs = acdf::build::summary(acdf::build::with_lost_samples(
        acdf::build::measure_views([&](const double wo[3], const double wi[3]) { return sampler.pdf(wo, wi); },
                                   brdf.reflected, views, 201, 350)));
    EXPECT_LE(ours.relative_variance, theirs.relative_variance);
    EXPECT_EQ(ours.support_violations, 0u);
    EXPECT_LE(3 * brdf.made.bytes.size(), std::filesystem::file_size(real_brdf_path(GetParam().name)));
}

INSTANTIATE_TEST_SUITE_P(Files, RglFile,
                         testing::Values(RglCase{"cc_ibiza_sunset_rgb.bsdf", 128},
                                         RglCase{"paper_white_rgb.bsdf", 128}),
                         [](const auto& info) { return std::string(info.param.name).substr(0, 5); });

} // namespace
