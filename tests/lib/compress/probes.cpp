// Every fit, both orders, on real probes, and the figures that must hold there.
#include "tests/inputs/environment_file.h"
#include "tests/inputs/paths.h"
#include "tests/lib/compress/checks.h"

#include "build/accuracy/environment.h"
#include "input/probe/probe.h"

#include <acdf/curves/curves.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <ostream>
#include <vector>

namespace {

using namespace acdf::compress;

/// Texels averaged to a map of this width: what every fit does is the same on fewer of them.
constexpr std::uint32_t kWidth = 256;

Target averaged(const Target& target) {
    const std::uint32_t by = target.columns / kWidth, rows = target.rows / by;
    std::vector<float> rgb;
    for (std::uint32_t r = 0; r < rows; ++r)
        for (std::uint32_t c = 0; c < kWidth; ++c) {
            double sum = 0.0;
            for (std::uint32_t y = 0; y < by; ++y)
                for (std::uint32_t x = 0; x < by; ++x) sum += double{target.row(r * by + y)[c * by + x]};
            rgb.insert(rgb.end(), 3, static_cast<float>(sum / (by * by)));
        }
    return environment_target(rgb.data(), kWidth, rows, TargetOptions{});
}

struct Figures {
    const char* name;
    double cdf;      ///< 64 x 64 segments, order z: relative variance, met within 5 %
    double variance; ///< 4096 cells: at most
};

void PrintTo(const Figures& figures, std::ostream* out) { *out << figures.name; } // for GoogleTest

class Probe : public ::testing::TestWithParam<Figures> {
protected:
    void SetUp() override {
        const std::string path = std::string(acdf_test::kTestData) + "/probes/" + GetParam().name + ".exr";
        if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is absent; set ACDF_TEST_DATA";
        const acdf::input::Probe probe = acdf::input::read_probe(path);
        ASSERT_EQ(probe.width, 1024);
        ASSERT_EQ(probe.height, 512);
        target_ = environment_target(probe.rgb.data(), 1024, 512, TargetOptions{});
    }

    /// What `acdf measure` would say of the stored file.
    double relative_variance(const FitOptions& options) const {
        const auto bytes = acdf_test::environment_file(target_, options);
        acdf::File file;
        const acdf::Status status = acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves());
        EXPECT_TRUE(status.ok()) << status.message;
        if (!status.ok()) return INFINITY;
        return acdf::build::measure_environment(file, target_).relative_variance;
    }

    Target target_;
};

TEST_P(Probe, EveryFitIsAPdfThatCoversIt) {
    const bool whole = std::string(GetParam().name) == "courtyard"; // one of them as large as it is
    const Target target = whole ? target_ : averaged(target_);
    for (const auto& fit : acdf_test::all_fits(64, 64, 4096)) acdf_test::check_fit(target, fit);
}

TEST_P(Probe, PaperFitMeetsItsFigure) {
    FitOptions options;
    options.fit = ACDF_FIT_CDF;
    options.order = Order::z;
    options.column_segments = options.row_segments = 64;
    EXPECT_NEAR(relative_variance(options) / GetParam().cdf, 1.0, 0.05);
}

TEST_P(Probe, VarianceFitMeetsItsFigure) {
    FitOptions options;
    options.goal.cells = 4096;
    EXPECT_LE(relative_variance(options), GetParam().variance);
}

/// A probe in a projection; the discs and squares are read in several, as any of them is a map of the sphere.
struct Projected {
    const char* name;
    const char* file;
    acdf::input::Projection projection;
};

void PrintTo(const Projected& projected, std::ostream* out) { *out << projected.name; }

class Projection : public ::testing::TestWithParam<Projected> {};

TEST_P(Projection, EveryFitIsAPdfThatCoversIt) {
    const std::string path = std::string(acdf_test::kTestData) + "/probes/" + GetParam().file;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is absent; set ACDF_TEST_DATA";
    acdf::input::ProbeOptions options;
    options.projection = GetParam().projection;
    const acdf::input::Probe probe = acdf::input::read_probe(path, options);
    const Target target = averaged(environment_target(probe.rgb.data(), static_cast<std::uint32_t>(probe.width),
                                                      static_cast<std::uint32_t>(probe.height), TargetOptions{}));
    for (const auto& fit : acdf_test::all_fits(64, 64, 4096)) acdf_test::check_fit(target, fit);
}

INSTANTIATE_TEST_SUITE_P(
    Real, Projection,
    ::testing::Values(Projected{"angular", "beach_probe.hdr", acdf::input::Projection::angular},
                      Projected{"mirrorball", "beach_probe.hdr", acdf::input::Projection::mirrorball},
                      Projected{"octahedral", "beach_probe.hdr", acdf::input::Projection::octahedral},
                      Projected{"cube_cross", "stpeters_cross.hdr", acdf::input::Projection::cube_cross}),
    [](const auto& info) { return std::string(info.param.name); });

INSTANTIATE_TEST_SUITE_P(Real, Probe,
                         ::testing::Values(Figures{"city", 0.0250, 0.0165}, Figures{"sunset", 0.0174, 0.0085},
                                           Figures{"studio", 0.0317, 0.0145}, Figures{"courtyard", 0.105, 0.046}),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace
