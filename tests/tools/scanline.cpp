// `acdf scanline` as a user runs it.
#include "tests/inputs/paths.h"
#include "tests/tools/plot/files.h"
#include "tests/tools/run.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <sstream>

namespace acdf::test {
namespace {

using Json = nlohmann::json;

class ScanlineCommand : public testing::Test {
protected:
    Folder folder;
    std::string probe = folder / "sky.pfm";

    /// 256 x 128: every row a wave of its own height, and a narrow light in row 50.
    void SetUp() override {
        std::vector<float> rgb;
        for (int r = 0; r < 128; ++r)
            for (int c = 0; c < 256; ++c) {
                const double wave = 2.0 + (0.5 + r / 128.0) * std::sin(2.0 * acdf_test::kPi * c / 256.0);
                rgb.insert(rgb.end(), 3, static_cast<float>(r == 50 && c >= 101 && c < 103 ? 400.0 : wave));
            }
        write_rgb(probe, 256, 128, rgb);
    }
    static Json report(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "scanline");
        arguments.push_back("--json");
        const Result result = run_acdf(arguments);
        EXPECT_EQ(result.code, 0) << result.err;
        return result.code == 0 ? Json::parse(result.out) : Json();
    }
    void expect_refused(std::vector<std::string> arguments, int code, const std::string& part) {
        arguments.insert(arguments.begin(), "scanline");
        arguments.push_back("--quiet");
        const Result result = run_acdf(arguments);
        EXPECT_EQ(result.code, code) << result.err;
        EXPECT_EQ(lines_in(result.err), 1u) << result.err;
        EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
        EXPECT_EQ(result.out, "");
    }
};

TEST_F(ScanlineCommand, ReportsTheRowAskedFor) {
    const Json peaky = report({probe}), smooth = report({probe, "--row", "auto-smooth"});
    EXPECT_EQ(peaky["row"], 50);
    EXPECT_EQ(smooth["row"], 32); // the first of those that are not too near the pole
    EXPECT_EQ(report({probe, "--row", "127"})["row"], 127);
    EXPECT_EQ(peaky["columns"], 256);
    EXPECT_EQ(peaky["points"].size(), 5u); // 4, 8, ... 64 segments
    EXPECT_GT(peaky["contrast"], 10.0 * smooth["contrast"].get<double>());
    EXPECT_GT(peaky["factor"]["cdf"]["median"], 4.0);
    EXPECT_LT(smooth["factor"]["cdf"]["median"], 2.0);
}

TEST_F(ScanlineCommand, FactorsAreThoseOfTheirPoints) {
    const Json told = report({probe});
    for (const Json& point : told["points"])
        for (const char* fit : {"cdf", "pdf"}) {
            const Json& gain = point[fit];
            EXPECT_LE(gain["segments"], point["segments"]);
            EXPECT_DOUBLE_EQ(gain["factor"].get<double>(),
                             (gain["uniform_segments"].get<double>() + 1) / (gain["segments"].get<double>() + 1));
            EXPECT_LT(gain["rms_error"], point["uniform"]["rms_error"]);
        }
}

TEST_F(ScanlineCommand, CsvAndTableHaveTheSameFigures) {
    const Json json = report({probe, "--row", "9"});
    std::istringstream csv(run_acdf({"scanline", probe, "--row", "9", "--csv"}).out);
    std::string line;
    std::getline(csv, line);
    EXPECT_EQ(line.substr(0, 42), "segments,uniform_rms,cdf_segments,cdf_rms,");
    for (const Json& point : json["points"]) {
        ASSERT_TRUE(std::getline(csv, line));
        double segments = 0.0, uniform = 0.0, cdf_segments = 0.0, cdf = 0.0;
        ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &segments, &uniform, &cdf_segments, &cdf), 4);
        EXPECT_EQ(segments, point["segments"]);
        EXPECT_NEAR(uniform, point["uniform"]["rms_error"].get<double>(), 1e-8);
        EXPECT_NEAR(cdf, point["cdf"]["rms_error"].get<double>(), 1e-8);
    }
    const std::string table = run_acdf({"scanline", probe, "--row", "9"}).out;
    EXPECT_NE(table.find("row 9 of 128"), std::string::npos);
    EXPECT_NE(table.find("times fewer knots"), std::string::npos);
}

TEST_F(ScanlineCommand, RefusesRowsThatAreNone) {
    expect_refused({probe, "--row", "128"}, 2, "rows 0 to 127");
    expect_refused({probe, "--row", "-1"}, 2, "--row");
    expect_refused({probe, "--row", "3.5"}, 2, "--row");
    expect_refused({probe, "--row", "middle"}, 2, "--row");
    expect_refused({folder / "none.exr"}, 1, "none.exr");
}

// What the paper reports of Grace Cathedral: 16 times on a peaky row, little on a smooth one (Fig. 6).
TEST_F(ScanlineCommand, GraceGainsMuchWhereItIsPeaky) {
    const std::string grace = std::string(acdf_test::kTestData) + "/probes/grace_probe.hdr";
    if (!std::filesystem::exists(grace)) GTEST_SKIP() << grace << " is absent; set ACDF_TEST_DATA";
    const Json peaky = report({grace, "--projection", "angular"});
    const Json smooth = report({grace, "--projection", "angular", "--row", "auto-smooth"});
    EXPECT_GT(peaky["factor"]["cdf"]["median"], 16.0);
    EXPECT_GT(smooth["factor"]["cdf"]["median"], 1.5);
    EXPECT_LT(smooth["factor"]["cdf"]["median"], 6.0);
}

} // namespace
} // namespace acdf::test
