// Real probes, where they are at hand (ACDF_TEST_DATA).
#include "tests/inputs/paths.h"
#include "tests/lib/input/write.h"

#include <gtest/gtest.h>

#include <cctype>

namespace {

using namespace acdf::input;
using namespace acdf::test;

struct Known {
    const char* name;
    Projection projection;
    bool automatic; // auto finds it
    int width;
    const char* reason;
    bool negatives;
};

const Known known[] = {
    {"city.exr", Projection::latlong, true, 1024, "2:1 shape", true},
    {"sunset.exr", Projection::latlong, true, 1024, "2:1 shape", true},
    {"studio.exr", Projection::latlong, true, 1024, "2:1 shape", true},
    {"courtyard.exr", Projection::latlong, true, 1024, "2:1 shape", true},
    {"grace_probe.hdr", Projection::angular, false, 1024, "--projection angular", false},
    {"beach_probe.hdr", Projection::angular, false, 1024, "--projection angular", false},
    {"stpeters_cross.hdr", Projection::cube_cross, true, 1024, "3:4 shape", false},
    {"venice_sunset_1k.hdr", Projection::latlong, true, 1024, "2:1 shape", false},
    {"noon_grass_1k.hdr", Projection::latlong, true, 1024, "2:1 shape", false},
    {"studio_small_05_1k.hdr", Projection::latlong, true, 1024, "2:1 shape", false},
    {"spruit_sunrise_4k.exr", Projection::latlong, true, 4096, "2:1 shape", false},
    {"KernerEnvLatLong.exr", Projection::latlong, true, 1024, "envmap attribute", false},
    {"sunflow_sky_small.hdr", Projection::latlong, true, 1024, "2:1 shape", false},
    {"furnace-4k.hdr", Projection::latlong, true, 4096, "2:1 shape", false},
};

class InputProbes : public testing::TestWithParam<Known> {
protected:
    std::string path() const { return std::string(acdf_test::kTestData) + "/probes/" + GetParam().name; }
    void SetUp() override {
        if (!std::filesystem::exists(path())) GTEST_SKIP() << path() << " is not here (set ACDF_TEST_DATA)";
    }
};

TEST_P(InputProbes, Loads) {
    const Known& k = GetParam();
    ProbeOptions options;
    if (!k.automatic) {
        const std::string text = refusal(path());
        EXPECT_CONTAINS(text, "angular");
        EXPECT_CONTAINS(text, "mirrorball");
        options.projection = k.projection;
    }
    const Probe probe = read_probe(path(), options);
    EXPECT_EQ(probe.projection, k.projection);
    EXPECT_CONTAINS(probe.projection_reason, k.reason);
    EXPECT_EQ(probe.width, k.width);
    EXPECT_EQ(probe.height, k.width / 2);
    EXPECT_EQ(probe.source_name, k.name);
    EXPECT_EQ(probe.source_sha256.size(), 64u);
    EXPECT_EQ(probe.bad.nan + probe.bad.infinite, 0u);
    EXPECT_EQ(probe.bad.negative > 0, k.negatives) << probe.bad.negative;
    ASSERT_EQ(probe.rgb.size(), static_cast<std::size_t>(3 * probe.width * probe.height));
    for (const float v : probe.rgb) ASSERT_TRUE(std::isfinite(v) && v >= 0.0f);
    for (int c = 0; c < 3; ++c) EXPECT_GT(latlong_integral(probe.width, probe.height, probe.rgb, c), 0.0);
}

std::string test_name(const testing::TestParamInfo<Known>& info) {
    std::string name = info.param.name;
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return name;
}

INSTANTIATE_TEST_SUITE_P(Data, InputProbes, testing::ValuesIn(known), test_name);

// St Peter's dome: the lantern at the zenith is brighter than the pavement at the nadir, in every column.
TEST(InputProbesUpright, StPetersDomeIsOnTop) {
    const std::string path = std::string(acdf_test::kTestData) + "/probes/stpeters_cross.hdr";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here (set ACDF_TEST_DATA)";
    const Probe probe = read_probe(path);
    const auto row_mean = [&](int row) {
        double sum = 0.0;
        for (int x = 0; x < probe.width; ++x)
            sum += static_cast<double>(probe.rgb[3 * static_cast<std::size_t>(row * probe.width + x) + 1]);
        return sum / probe.width;
    };
    double top = 0.0, bottom = 0.0;
    for (int row = 0; row < probe.height / 4; ++row) {
        top += row_mean(row);
        bottom += row_mean(probe.height - 1 - row);
    }
    EXPECT_GT(top, 2.0 * bottom);
}

// No seam: steps between neighbouring columns across the image's ends and the cube's face borders are like
// those elsewhere.
TEST(InputProbesUpright, NoSeamsInStPeters) {
    const std::string path = std::string(acdf_test::kTestData) + "/probes/stpeters_cross.hdr";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here (set ACDF_TEST_DATA)";
    const Probe probe = read_probe(path);
    const auto step = [&](int column) { // mean |log ratio| to the next column, on the faces around the horizon
        double sum = 0.0;
        for (int y = probe.height * 3 / 8; y < probe.height * 5 / 8; ++y) {
            const float* row = probe.rgb.data() + 3 * static_cast<std::size_t>(y * probe.width);
            sum += std::abs(std::log((row[3 * column] + 1e-3) / (row[3 * ((column + 1) % probe.width)] + 1e-3)));
        }
        return sum;
    };
    double typical = 0.0;
    for (int c = 0; c < probe.width; ++c) typical += step(c) / probe.width;
    for (const int border : {127, 383, 639, 895, 1023}) EXPECT_LT(step(border), 4.0 * typical) << border;
}

} // namespace
