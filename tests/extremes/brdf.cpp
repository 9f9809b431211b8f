// BRDFs at their ends: mirrors, nothing but diffuse, light at grazing angles alone, and views that graze.
#include "tests/inputs/brdf_files.h"
#include "tests/inputs/sanitized.h"
#include "tests/inputs/synthetic.h"

#include "input/brdf/brdf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <string>

namespace {

using namespace acdf_test;
using acdf::input::Brdf;

/// rho = value exp(-(cos(theta_i) / width)^2).
class GrazingBrdf : public Brdf {
public:
    GrazingBrdf(double width, double value) : width_(width), value_(value) { name = "grazing"; }
    void evaluate(const double wo[3], const double wi[3], double rgb[3]) const override {
        const double x = wi[2] / width_;
        rgb[0] = rgb[1] = rgb[2] = wo[2] > 0.0 && wi[2] > 0.0 ? value_ * std::exp(-x * x) : 0.0;
    }
    static double albedo(double width, double value) {
        return kPi * value * width * width * -std::expm1(-1.0 / (width * width));
    }

private:
    double width_, value_;
};

struct ExtremeBrdf {
    std::string name;
    std::function<std::unique_ptr<Brdf>()> make;
    double albedo; ///< exact, for views with cos(theta_o) >= `from`; 0: not known
    double from = 0.0;
    double variance = 1.0; ///< the most there may be
};

void PrintTo(const ExtremeBrdf& brdf, std::ostream* out) { *out << brdf.name; } // for GoogleTest

std::vector<ExtremeBrdf> extreme_brdfs() {
    const auto model = [](const char* text) { return [text] { return acdf::input::open_brdf(text); }; };
    const auto grazing = [](const char* name, double width, double value) {
        const auto make = [=]() -> std::unique_ptr<Brdf> { return std::make_unique<GrazingBrdf>(width, value); };
        // A tenth of what cosine-weighted samples have where the lobe is narrow: 1 / (2 width^2) - 1.
        return ExtremeBrdf{name, make, GrazingBrdf::albedo(width, value), 0.0,
                           std::max(1.0, 0.05 / (width * width))};
    };
    return {
        {"lambert", model("lambert"), 1.0},
        {"mirror_like_ggx", model("ggx:alpha=1e-4"), 1.0, 0.1},
        {"mirror_like_blinn", model("blinn:e=1e7"), 1.0, 0.9999},
        {"brushed_mirror", model("ggx:alpha=1e-4,0.5"), 0.0},
        grazing("hardly_anything", 1e3, 1e-30),
        grazing("very_much", 1e3, 1e15),
        grazing("only_grazing", 0.03, 1.0),
    };
}

class ExtremeBrdfs : public ::testing::TestWithParam<ExtremeBrdf> {
protected:
    /// Each file is made once a process.
    void SetUp() override {
        static std::map<std::string, std::unique_ptr<MadeBrdf>> made;
        std::unique_ptr<MadeBrdf>& brdf = made[GetParam().name];
        if (!brdf) {
            std::unique_ptr<Brdf> source = GetParam().make();
            acdf::build::BrdfFileOptions options = roughly_measured();
            options.codec = ACDF_CODEC_ZLIB;
            // About 16 KiB; a budget would be searched for.
            options.fit.goal = {acdf::compress::Goal::Kind::cells, source->isotropic ? 900u : 450u, 0, 0.0};
            options.fit.theta_views = source->isotropic ? 12 : 5;
            brdf = make_brdf(std::move(source), options);
        }
        brdf_ = brdf.get();
    }
    const MadeBrdf* brdf_ = nullptr;
};

TEST_P(ExtremeBrdfs, SamplesAreSoundForEveryView) {
    std::mt19937_64 random(4);
    const int samples = repeated(500);
    for (const double cosine : {1.0, 0.5, 0.1, 1e-3, 1e-6, 1e-20, 1e-45})
        for (const double phi : {0.0, 2.5, -kPi}) {
            const Direction wo = at_angles(cosine, phi);
            for (int i = 0; i < samples; ++i) {
                const bool edge = i < 9;
                const double u0 = edge ? 0.5 * (i % 3) : uniform(random),
                             u1 = edge ? 0.5 * (i / 3) : uniform(random);
                const acdf::DirectionSample s = brdf_->view().sample(wo.data(), u0, u1);
                ASSERT_TRUE(std::isfinite(s.pdf) && s.pdf > 0.0f) << cosine << " " << u0 << " " << u1;
                const float* d = s.direction;
                ASSERT_NEAR(double{d[0]} * d[0] + double{d[1]} * d[1] + double{d[2]} * d[2], 1.0, 1e-5);
                if (cosine > 1e-3) {
                    ASSERT_EQ(s.pdf, brdf_->view().pdf(wo.data(), d)) << cosine;
                }
                const double o[3] = {wo[0], wo[1], wo[2]}, w[3] = {d[0], d[1], d[2]};
                ASSERT_TRUE(std::isfinite(brdf_->reflected(o, w) / s.pdf)) << cosine;
            }
        }
}

TEST_P(ExtremeBrdfs, EstimatesHaveTheRightMean) {
    if (GetParam().albedo == 0.0) GTEST_SKIP() << "no closed form of its albedo";
    std::mt19937_64 random(5);
    const int samples = repeated(40000);
    for (const double cosine : {1.0, 0.7, 0.25}) {
        if (cosine < GetParam().from) continue;
        const Direction wo = at_angles(cosine, 0.3);
        const double o[3] = {wo[0], wo[1], wo[2]};
        double sum = 0.0, square = 0.0;
        for (int i = 0; i < samples; ++i) {
            const double u0 = uniform(random), u1 = uniform(random);
            const acdf::DirectionSample s = brdf_->view().sample(wo.data(), u0, u1);
            const double w[3] = {s.direction[0], s.direction[1], s.direction[2]};
            const double x = brdf_->reflected(o, w) / s.pdf / GetParam().albedo;
            sum += x;
            square += x * x;
        }
        const double mean = sum / samples, error = std::sqrt((square / samples - mean * mean) / samples);
        EXPECT_NEAR(mean, 1.0, 4.5 * error + 1e-5) << cosine;
        EXPECT_LT(square / samples / (mean * mean) - 1.0, GetParam().variance) << cosine;
    }
}

INSTANTIATE_TEST_SUITE_P(All, ExtremeBrdfs, ::testing::ValuesIn(extreme_brdfs()),
                         [](const auto& info) { return info.param.name; });

} // namespace
