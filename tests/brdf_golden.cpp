// The frozen BRDFs of every version (format/make_golden.cpp makes those of the present one), and that calls for
// many views at once tell the same.
#include "golden_numbers.h"

#include <acdf/reader.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

namespace {

const std::string kGolden = ACDF_TEST_DIR "/golden/v1.0/";

/// A line `wo  u0 u1  wi  pdf` beside a golden file.
struct Line {
    float wo[3];
    double u[2];
    float wi[3], pdf;
};

class GoldenBrdf : public ::testing::TestWithParam<const char*> {
protected:
    void SetUp() override {
        const acdf::Status status = acdf::File::open((kGolden + GetParam() + ".acdf").c_str(), file_);
        ASSERT_TRUE(status.ok()) << status.message;
        for (const auto& v : acdf_test::golden_numbers<9>(kGolden + GetParam() + ".txt"))
            lines_.push_back(parse(v));
        ASSERT_EQ(lines_.size(), 96u);
    }

    static Line parse(const std::array<double, 9>& v) {
        return {{float(v[0]), float(v[1]), float(v[2])},
                {v[3], v[4]},
                {float(v[5]), float(v[6]), float(v[7])},
                float(v[8])};
    }

    acdf::File file_;
    std::vector<Line> lines_;
};

TEST_P(GoldenBrdf, DrawsTheSameSamples) {
    for (const Line& line : lines_) {
        const auto s = file_.brdf().sample(line.wo, line.u[0], line.u[1]);
        for (int i = 0; i < 3; ++i) EXPECT_EQ(s.direction[i], line.wi[i]);
        EXPECT_EQ(s.pdf, line.pdf);
    }
}

TEST_P(GoldenBrdf, HasThatDensityThere) {
    for (const Line& line : lines_) {
        EXPECT_GT(line.pdf, 0.0f);
        EXPECT_EQ(file_.brdf().pdf(line.wo, line.wi), line.pdf);
    }
}

/// Views of all kinds, those that are refused among them.
struct Wave {
    explicit Wave(std::size_t count) : wo(3 * count), wi(3 * count), u(2 * count) {
        std::mt19937_64 random(5);
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        for (std::size_t i = 0; i < count; ++i) {
            direction(&wo[3 * i], i % 7 == 3 ? -0.5 : std::pow(uniform(random), 1.0 + double(i % 3)),
                      7.0 * uniform(random));
            direction(&wi[3 * i], 2.0 * uniform(random) - 1.0, 7.0 * uniform(random));
            if (i % 11 == 5) wi[3 * i] = std::nanf("");
            for (std::size_t k = 0; k < 2; ++k) u[2 * i + k] = i % 13 == 0 ? double(i % 2) : uniform(random);
        }
    }
    static void direction(float* out, double z, double phi) {
        const double r = std::sqrt(1.0 - z * z);
        out[0] = float(r * std::cos(phi));
        out[1] = float(r * std::sin(phi));
        out[2] = float(z);
    }
    std::vector<float> wo, wi;
    std::vector<double> u;
};

TEST_P(GoldenBrdf, ManyAtOnceAreTheSameBitForBit) {
    const acdf::BrdfView view = file_.brdf();
    for (const std::size_t count : {0u, 1u, 11u, 12u, 13u, 1000u}) {
        const Wave wave(count);
        const auto* wo = reinterpret_cast<const float(*)[3]>(wave.wo.data());
        const auto* wi = reinterpret_cast<const float(*)[3]>(wave.wi.data());
        const auto* u = reinterpret_cast<const double(*)[2]>(wave.u.data());
        std::vector<acdf::DirectionSample> samples(count);
        std::vector<float> pdfs(count);
        view.sample_many(wo, u, count, samples.data());
        view.pdf_many(wo, wi, count, pdfs.data());
        for (std::size_t i = 0; i < count; ++i) {
            const acdf::DirectionSample s = view.sample(wo[i], u[i][0], u[i][1]);
            ASSERT_EQ(std::memcmp(&s, &samples[i], sizeof s), 0) << i << " of " << count;
            ASSERT_EQ(view.pdf(wo[i], wi[i]), pdfs[i]) << i << " of " << count;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(V1_0, GoldenBrdf,
                         ::testing::Values("brdf", "brdf_mirrored", "brdf_anisotropic", "brdf_floor",
                                           "brdf_separate"),
                         [](const auto& info) { return std::string(info.param); });

TEST(GoldenBrdfContents, EachFileHasWhatItIsFor) {
    const auto opened = [](const char* name) {
        acdf::File file;
        EXPECT_TRUE(acdf::File::open((kGolden + name + ".acdf").c_str(), file).ok());
        return file;
    };
    const acdf::File brdf = opened("brdf"), mirrored = opened("brdf_mirrored"), turned = opened("brdf_anisotropic"),
                     floored = opened("brdf_floor"), separate = opened("brdf_separate");
    EXPECT_FALSE(acdf_brdf_mirrored(&brdf.brdf().data()));
    EXPECT_TRUE(acdf_brdf_mirrored(&mirrored.brdf().data()));
    EXPECT_EQ(turned.brdf().data().views->phi_count, 4u);
    EXPECT_EQ(floored.brdf().data().views->diffuse_share, 0.25f);
    EXPECT_NE(brdf.blend().tiles, nullptr);
    EXPECT_EQ(separate.blend().tiles, nullptr);
}

} // namespace
