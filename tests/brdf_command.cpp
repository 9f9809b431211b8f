// acdf brdf and what else reads its files, as a user calls them.
#include "tools_run.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstring>

using namespace acdf::test;
using Json = nlohmann::json;

namespace {

/// A small file of a model, made once.
const std::string& small_file() {
    static const Folder folder;
    static const std::string path = folder / "ggx.acdf";
    static const Result made = run_acdf({"brdf", "ggx:alpha=0.4", "-o", path, "--budget", "12KiB", "--json"});
    EXPECT_EQ(made.code, 0) << made.err;
    EXPECT_LT(Json::parse(made.out).at("relative_variance").get<double>(), 0.02);
    EXPECT_LE(Json::parse(made.out).at("bytes").get<std::size_t>(), 12u << 10);
    return path;
}

TEST(BrdfCommand, fileIsValidAndTellsWhatItIs) {
    EXPECT_EQ(run_acdf({"validate", small_file()}).code, 0);
    const Json info = Json::parse(run_acdf({"info", "--json", small_file()}).out);
    EXPECT_EQ(info.at("kind"), "brdf");
    EXPECT_EQ(info.at("axes").size(), 4u);
    EXPECT_EQ(info.at("source").at("name"), "ggx:alpha=0.4");
    EXPECT_GT(info.at("cells").get<int>(), 100);
    EXPECT_EQ(info.at("axes")[2].at("resolution"), info.at("bins"));
}

TEST(BrdfCommand, measureComparesWithOtherSamplers) {
    const Result measured = run_acdf({"measure", small_file(), "--against", "ggx:alpha=0.4", "--json"});
    ASSERT_EQ(measured.code, 0) << measured.err;
    const Json j = Json::parse(measured.out);
    for (const char* key : {"relative_variance", "relative_variance_median", "relative_variance_worst",
                            "relative_variance_full_cdf", "rms_pdf_error", "kl_divergence", "max_weight",
                            "support_violations", "bytes", "cells", "bins", "share_above_horizon"})
        EXPECT_TRUE(j.contains(key)) << key;
    EXPECT_EQ(j.at("support_violations"), 0);
    EXPECT_EQ(j.at("views"), 64);
    EXPECT_LT(j.at("relative_variance").get<double>(), 0.1 * j.at("relative_variance_cosine").get<double>());
    EXPECT_LE(j.at("relative_variance_median"), j.at("relative_variance_worst"));
    EXPECT_GT(j.at("share_above_horizon").get<double>(), 0.98);
}

TEST(BrdfCommand, plotsAView) {
    const Folder folder;
    const Result plotted =
        run_acdf({"plot", small_file(), "-o", folder / "a.png", "--view", "60,30", "--width", "128"});
    ASSERT_EQ(plotted.code, 0) << plotted.err;
    EXPECT_GT(read_text(folder / "a.png").size(), 1000u);
    EXPECT_EQ(run_acdf({"plot", small_file(), "-o", folder / "b.png", "--view", "95"}).code, 2);
    EXPECT_EQ(run_acdf({"plot", small_file(), "-o", folder / "b.png", "--view", "10,"}).code, 2);
    write_bytes(folder / "sky.acdf", small_environment());
    EXPECT_EQ(run_acdf({"plot", folder / "sky.acdf", "-o", folder / "b.png", "--view", "10"}).code, 2);
}

TEST(BrdfCommand, sameInputGivesTheSameBytes) {
    const Folder folder;
    for (const char* name : {"a.acdf", "b.acdf"})
        ASSERT_EQ(run_acdf({"brdf", "lambert", "-o", folder / name, "--cells", "64", "--views", "6"}).code, 0);
    EXPECT_EQ(read_text(folder / "a.acdf"), read_text(folder / "b.acdf"));
}

TEST(BrdfCommand, mistakesAreToldInOneLine) {
    const Folder folder;
    const std::string out = folder / "out.acdf";
    write_text(folder / "bad.binary", "not a BRDF");
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"brdf", folder / "bad.binary", "-o", out},
          {"brdf", folder / "missing.bsdf", "-o", out},
          {"brdf", "ggx:alpha=nothing", "-o", out},
          {"brdf", "ggx:alpha=0.4", "-o", out, "--budget", "900"}}) {
        const Result result = run_acdf(arguments);
        EXPECT_EQ(result.code, 1) << arguments[1];
        EXPECT_EQ(lines_in(result.err), 1u) << result.err;
    }
    for (const std::vector<std::string>& more : {std::vector<std::string>{"--views", "1"},
                                                 {"--views", "8x2"},
                                                 {"--views", "eight"},
                                                 {"--fit", "cdf", "--budget", "64KiB"},
                                                 {"--knots", "10x30"},
                                                 {"--cells", "64", "--budget", "64KiB"},
                                                 {"--diffuse-floor", "1"}}) {
        std::vector<std::string> arguments{"brdf", "lambert", "-o", out};
        arguments.insert(arguments.end(), more.begin(), more.end());
        EXPECT_EQ(run_acdf(arguments).code, 2) << more[0] << " " << more[1];
    }
    EXPECT_FALSE(std::filesystem::exists(out));
}

} // namespace
