// acdf local and acdf measure of what it makes, as a user runs them.
#include "tests/inputs/sanitized.h"
#include "tests/inputs/synthetic.h"
#include "tests/tools/plot/files.h"
#include "tests/tools/run.h"

#include <acdf/reader.h>
#include <acdf/views.h>

#include <nlohmann/json.hpp>

namespace acdf::test {
namespace {

using nlohmann::json;

class LocalCommand : public testing::Test {
protected:
    Folder folder;
    const std::string probe = folder / "probe.pfm", output = folder / "probe.acdf";

    void SetUp() override {
        write_probe(probe, [](double phi, double z) {
            return std::hypot(phi - 0.6, z - 0.4) < 0.06 ? 300.0 : acdf_test::smooth_sky(phi, z);
        });
    }

    static void write_probe(const std::string& path, const std::function<double(double, double)>& light) {
        std::vector<float> rgb;
        for (std::uint32_t r = 0; r < 32; ++r)
            for (std::uint32_t c = 0; c < 64; ++c)
                rgb.insert(rgb.end(), 3,
                           static_cast<float>(light(acdf_test::centre_phi(c, 64), acdf_test::centre_z(r, 32))));
        write_rgb(path, 64, 32, rgb);
    }

    json made(std::vector<std::string> options, const std::string& source = "") {
        options.insert(options.begin(),
                       {"local", source.empty() ? probe : source, "-o", output, "--force", "--json"});
        const Result result = run_acdf(options);
        EXPECT_EQ(result.code, 0) << result.err;
        messages = result.err;
        return result.code == 0 ? json::parse(result.out) : json();
    }
    std::string messages;

    void expect_usage(std::vector<std::string> options, const std::string& part) {
        options.insert(options.begin(), {"local", probe, "-o", output});
        const Result result = run_acdf(options);
        EXPECT_EQ(result.code, 2) << result.err;
        EXPECT_EQ(lines_in(result.err), 1u) << result.err;
        EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(output));
    }
};

TEST_F(LocalCommand, OfAPartnerReportsIt) {
    const json report = made({"--budget", "48KiB", "--mis", "cosine", "--shares", "2:1"});
    EXPECT_TRUE(report.at("combined").get<bool>());
    EXPECT_LT(report.at("relative_variance").get<double>(), report.at("relative_variance_full_cdf").get<double>());
    const json info = json::parse(run_acdf({"info", "--json", output}).out);
    EXPECT_EQ(info.at("partner").at("kind"), "cosine");
    EXPECT_NEAR(info.at("partner").at("share").get<double>(), 2.0 / 3.0, 1e-6);
    EXPECT_GT(info.at("partner").at("recommended_light_share").get<double>(), 0.0);
    EXPECT_EQ(info.at("options"), "--mis cosine --shares 2:1 --budget 49152");
    const json measured = json::parse(run_acdf({"measure", output, "--against", probe, "--json"}).out);
    EXPECT_TRUE(measured.at("combined").get<bool>());
    EXPECT_EQ(measured.at("support_violations"), 0);
    EXPECT_EQ(run_acdf({"validate", output}).code, 0);
    const Result sampled = run_acdf({"sample", output, "-n", "1", "--normal", "0,0,1"});
    EXPECT_EQ(sampled.code, 0);
    EXPECT_NE(sampled.err.find("not to be used alone"), std::string::npos) << sampled.err;
    EXPECT_EQ(run_acdf({"sample", output, "-n", "1", "--normal", "0,0,1", "--quiet"}).err, "");
    for (const std::vector<std::string>& wrong : {std::vector<std::string>{"--shares", "2:1"},
                                                  {"--heuristic", "power"},
                                                  {"--mis", "mean"},
                                                  {"--mis", "cosine", "--shares", "0:1"},
                                                  {"--mis", "cosine", "--cosine-share", "0.2"},
                                                  {"--mis", "cosine", "--no-sharing"}}) {
        std::vector<std::string> options{"local", probe, "-o", output, "--force"};
        options.insert(options.end(), wrong.begin(), wrong.end());
        EXPECT_EQ(run_acdf(options).code, 2) << wrong.front();
    }
}

TEST_F(LocalCommand, ReportsTheFiguresOfMeasure) {
    const json report = made({"--budget", "40kB", "--filter", "nearest"});
    EXPECT_LE(report["bytes"], 40000);
    EXPECT_EQ(report["bytes"], std::filesystem::file_size(output));
    EXPECT_EQ(report["support_violations"], 0);
    const Result measured = run_acdf({"measure", output, "--against", probe, "--json", "--baselines"});
    ASSERT_EQ(measured.code, 0) << measured.err;
    const json accuracy = json::parse(measured.out);
    for (const char* key :
         {"file", "source", "bytes", "bins", "normals", "relative_variance", "relative_variance_full_cdf", "gain",
          "max_weight", "share_above_horizon", "least_share_above_horizon", "support_violations"})
        EXPECT_EQ(report.at(key), accuracy.at(key)) << key;
    for (const char* baseline : {"full_cdf", "resampling_32", "tiling_512", "cosine"})
        EXPECT_GT(accuracy["baselines"][baseline]["relative_variance"], accuracy["relative_variance"]) << baseline;
    EXPECT_NEAR(accuracy["baselines"]["full_cdf"]["relative_variance"].get<double>(),
                accuracy["relative_variance_full_cdf"].get<double>(), 1e-6);
}

TEST_F(LocalCommand, TheSameBytesForAnyNumberOfThreads) {
    ACDF_NOT_SANITIZED();
    made({"--budget", "40kB", "--threads", "1"});
    const std::string one = read_text(output);
    for (const char* threads : {"2", "7"}) {
        made({"--budget", "40kB", "--threads", threads});
        EXPECT_EQ(read_text(output), one) << threads;
    }
}

// The budget holds for the stored bytes.
TEST_F(LocalCommand, CompressedFilesFillTheirBudget) {
    ACDF_NOT_SANITIZED();
    const int bytes = made({"--budget", "30000", "--compress", "zlib"})["bytes"];
    EXPECT_LE(bytes, 30000);
    EXPECT_GE(bytes, 27000);
    EXPECT_NE(run_acdf({"info", output}).out.find("--budget 30000"), std::string::npos);
}

TEST_F(LocalCommand, ScenesAreRead) {
    write_text(folder / "normals.txt", "0 0 1\n0.1 0 1 3\n# a remark\n");
    const json all = made({"--budget", "40kB", "--filter", "nearest"}),
               scene = made({"--budget", "40kB", "--filter", "nearest", "--scene", folder / "normals.txt"});
    EXPECT_NE(messages.find("a list with 2 different normals"), std::string::npos) << messages;
    EXPECT_LT(scene["relative_variance"], all["relative_variance"]);
    const auto measured = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words{"measure", output, "--against", probe, "--json"};
        words.insert(words.end(), more.begin(), more.end());
        return json::parse(run_acdf(words).out)["relative_variance"];
    };
    EXPECT_EQ(measured({"--scene", folder / "normals.txt"}), scene["relative_variance"]);
    EXPECT_GT(measured({}), scene["relative_variance"]); // of other normals it knows nothing
    EXPECT_EQ(
        run_acdf({"measure", output, "--against", probe, "--scene", folder / "normals.txt", "--points", "3"}).code,
        2);
    const Result missing = run_acdf({"local", probe, "-o", folder / "x.acdf", "--scene", folder / "none.obj"});
    EXPECT_EQ(missing.code, 1);
    EXPECT_EQ(lines_in(missing.err), 1u) << missing.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "x.acdf"));
}

TEST_F(LocalCommand, SaysWhereTheNormalGainsNothing) {
    made({"--budget", "40kB"});
    EXPECT_EQ(messages.find("acdf env"), std::string::npos) << messages;
    // One light straight above a floor: its own CDF is as good.
    write_probe(folder / "lamp.pfm", [](double, double z) { return z > 0.95 ? 1.0 : 0.0; });
    write_text(folder / "floor.txt", "0 0 1\n");
    const json report =
        made({"--budget", "40kB", "--scene", folder / "floor.txt", "--cosine-share", "0.5"}, folder / "lamp.pfm");
    EXPECT_LT(report["gain"], 1.5);
    EXPECT_NE(messages.find("`acdf env` does about as well"), std::string::npos) << messages;
}

TEST_F(LocalCommand, TreesOfTheirOwn) {
    const json report = made({"--no-sharing", "--normals", "8x4", "--fit", "cdf", "--eps", "0.01"});
    EXPECT_EQ(report["bins"], 32);
    EXPECT_EQ(report["tiles"], 0);
    EXPECT_EQ(report["support_violations"], 0);
    EXPECT_EQ(made({"--no-sharing", "--normals", "3", "--knots", "12x12"})["bins"], 38);
}

TEST_F(LocalCommand, WrongUsageIsOneLine) {
    expect_usage({"--budget", "much"}, "--budget");
    expect_usage({"--budget", "64KiB", "--cells", "100"}, "is enough");
    expect_usage({"--normals", "0"}, "--normals");
    expect_usage({"--normals", "8x4"}, "--no-sharing");
    expect_usage({"--fit", "cdf"}, "--no-sharing");
    expect_usage({"--no-sharing", "--fit", "cdf", "--cells", "100"}, "--cells");
    expect_usage({"--no-sharing", "--fit", "variance"}, "--fit");
    expect_usage({"--no-sharing", "--target-variance", "0.1"}, "--target-variance");
    expect_usage({"--cosine-share", "1"}, "--cosine-share");
    expect_usage({"--mis", "brdf"}, "--mis");
}

TEST_F(LocalCommand, IsOneTreeOfHalvings) {
    const Result result = run_acdf({"local", probe, "-o", output, "--json", "--budget", "48KiB"});
    ASSERT_EQ(result.code, 0) << result.err;
    const json report = json::parse(result.out);
    EXPECT_GT(report["tiles"], 20);
    EXPECT_LE(report["bytes"], 48 << 10);
    EXPECT_GE(report["bytes"], 40 << 10); // the map has no more texels
    EXPECT_EQ(report["support_violations"], 0);
    const json info = json::parse(run_acdf({"info", output, "--json"}).out);
    EXPECT_EQ(info["local"]["tiles"], report["tiles"]);
    const Result measured = run_acdf({"measure", output, "--against", probe, "--json"});
    EXPECT_EQ(json::parse(measured.out)["relative_variance"], report["relative_variance"]);
    EXPECT_EQ(run_acdf({"validate", output}).code, 0);
    EXPECT_LE(made({"--budget", "24KiB", "--max-weight", "50"})["max_weight"], 50.0);
    EXPECT_EQ(made({"--budget", "48KiB", "--mis", "cosine", "--heuristic", "power"})["support_violations"], 0);
}

TEST_F(LocalCommand, TheSmallestSizeThatIsReportedIsPossible) {
    ACDF_NOT_SANITIZED();
    const std::string told = "the smallest possible is about ";
    for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{
             {}, {"--normals", "20"}, {"--mis", "cosine"}, {"--compress", "zlib"}}) {
        std::vector<std::string> words{"local", probe, "-o", output, "-q", "--force"};
        words.insert(words.end(), options.begin(), options.end());
        words.insert(words.end(), {"--budget", "600"});
        const Result refused = run_acdf(words);
        const std::size_t at = refused.err.find(told);
        ASSERT_NE(at, std::string::npos) << refused.err;
        words.back() = std::to_string(std::stoul(refused.err.substr(at + told.size())));
        EXPECT_EQ(run_acdf(words).code, 0) << words.back() << " bytes";
    }
}

TEST_F(LocalCommand, GoalsOutOfReachAreReportedAndLeaveNothing) {
    for (const std::vector<std::string>& goal : std::vector<std::vector<std::string>>{
             {"--budget", "1kB"}, {"--target-variance", "1e-7", "--normals", "2"}}) {
        std::vector<std::string> words{"local", probe, "-o", output, "-q"};
        words.insert(words.end(), goal.begin(), goal.end());
        const Result result = run_acdf(words);
        EXPECT_EQ(result.code, 1);
        EXPECT_EQ(lines_in(result.err), 1u) << result.err;
        EXPECT_NE(result.err.find("out of reach"), std::string::npos) << result.err;
        EXPECT_EQ(folder.entries(), 1u);
    }
}

} // namespace
} // namespace acdf::test
