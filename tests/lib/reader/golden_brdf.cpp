// The frozen BRDFs of every version (format/make_golden.cpp makes those of the present one).
#include "tests/lib/reader/golden_numbers.h"

#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

const std::string kGoldenBrdfs = ACDF_TEST_DIR "/golden/v1.0/";

class GoldenBrdf : public acdf_test::GoldenSamples {};

TEST_P(GoldenBrdf, SamplesTheSameSamples) {
    for (const acdf_test::GoldenSample& line : lines_) {
        const auto s = file_.brdf().sample(line.given, line.u[0], line.u[1]);
        for (int i = 0; i < 3; ++i) EXPECT_EQ(s.direction[i], line.direction[i]);
        EXPECT_EQ(s.pdf, line.pdf);
    }
}

TEST_P(GoldenBrdf, HasThatPdfThere) {
    for (const acdf_test::GoldenSample& line : lines_) {
        EXPECT_GT(line.pdf, 0.0f);
        EXPECT_EQ(file_.brdf().pdf(line.given, line.direction), line.pdf);
    }
}

INSTANTIATE_TEST_SUITE_P(V1_0, GoldenBrdf,
                         ::testing::Values("brdf", "brdf_mirrored", "brdf_anisotropic", "brdf_floor",
                                           "brdf_separate"),
                         [](const auto& info) { return std::string(info.param); });

TEST(GoldenBrdfContents, EachFileHasWhatItIsFor) {
    const auto opened = [](const char* name) {
        acdf::File file;
        EXPECT_TRUE(acdf::File::open((kGoldenBrdfs + name + ".acdf").c_str(), file, acdf::with_curves()).ok());
        return file;
    };
    const acdf::File brdf = opened("brdf"), mirrored = opened("brdf_mirrored"), turned = opened("brdf_anisotropic"),
                     floored = opened("brdf_floor"), separate = opened("brdf_separate");
    EXPECT_FALSE(acdf_brdf_mirrored(&brdf.brdf().data()));
    EXPECT_TRUE(acdf_brdf_mirrored(&mirrored.brdf().data()));
    EXPECT_EQ(turned.brdf().data().views->phi_count, 4u);
    EXPECT_EQ(floored.brdf().data().views->diffuse_share, 0.25f);
    EXPECT_NE(brdf.brdf().data().halved, nullptr);
    EXPECT_EQ(separate.brdf().data().halved, nullptr);
}

} // namespace
