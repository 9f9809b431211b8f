// `acdf sweep` of several maps.
#include "tests/tools/plot/files.h"
#include "tests/tools/run.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace acdf::test {
namespace {

/// Maps of 32 x 16 texels; a bright texel moves from one to the next.
std::vector<std::string> three_maps(const Folder& folder) {
    std::vector<std::string> out;
    for (int map = 0; map < 3; ++map) {
        std::vector<float> rgb(32 * 16 * 3);
        for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<float>(1 + (i / 3 * 37) % 523);
        for (int c = 0; c < 3; ++c) rgb[3 * (32 * 5 + 7 + 4 * map) + c] = 9000.0f;
        out.push_back(folder / ("map.000" + std::to_string(map + 1) + ".pfm"));
        write_rgb(out.back(), 32, 16, rgb);
    }
    return out;
}

TEST(SweepOfMaps, RowsAreTheFilesThatAreMade) {
    const Folder folder;
    const std::vector<std::string> maps = three_maps(folder);
    const std::string sequence = folder / "map.####.pfm";
    const Result swept = run_acdf(
        {"sweep", sequence, "-o", folder / "out", "--budgets", "6000,12000", "--no-timing", "--json", "--quiet"});
    ASSERT_EQ(swept.code, 0) << swept.err;
    EXPECT_EQ(swept.out, read_text(folder / "out/sweep.json"));
    EXPECT_FALSE(std::filesystem::exists(folder / "out/report.html"));
    const auto json = nlohmann::json::parse(swept.out);
    EXPECT_EQ(json["kind"], "maps");
    EXPECT_EQ(json["maps"], 3);
    ASSERT_EQ(json["rows"].size(), 4u);
    for (const auto& row : json["rows"]) {
        const std::uint64_t budget = row["budget"];
        EXPECT_LE(row["bytes"], budget);
        std::vector<std::vector<std::string>> commands = {{sequence}};
        if (row["file"] == "each") commands = {{maps[0]}, {maps[1]}, {maps[2]}};
        double logarithms = 0.0;
        std::uint64_t bytes = 0;
        for (std::vector<std::string> words : commands) {
            words.insert(words.begin(), "env");
            words.insert(words.end(), {"--budget", std::to_string(budget / commands.size()), "-o",
                                       folder / "made.acdf", "--json", "--quiet", "--force"});
            const Result made = run_acdf(words);
            ASSERT_EQ(made.code, 0) << made.err;
            const auto report = nlohmann::json::parse(made.out);
            logarithms += std::log(report["relative_variance"].get<double>()) / double(commands.size());
            bytes += report["bytes"].get<std::uint64_t>();
        }
        const double variance = row["relative_variance"];
        EXPECT_NEAR(variance, std::exp(logarithms), 1e-6 * variance) << row;
        EXPECT_LE(variance, row["worst"]);
        // A file names its source in its metadata, which a sweep leaves out of files for each map.
        if (row["file"] == "one") {
            EXPECT_EQ(row["bytes"], bytes);
        }
    }
    const std::string csv = read_text(folder / "out/sweep.csv");
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
}

TEST(SweepOfMaps, AdvisesTheSmallestSizeWithoutVisibleNoise) {
    const Folder folder;
    const std::vector<std::string> maps = three_maps(folder);
    const auto advised = [&](const std::string& visible) {
        const Result made = run_acdf({"sweep", maps[0], maps[1], maps[2], "--axis", "time=6,9,12", "-o",
                                      folder / "out", "--budgets", "6000,12000", "--visible", visible,
                                      "--no-timing", "--json", "--quiet", "--force"});
        EXPECT_EQ(made.code, 0) << made.err;
        return nlohmann::json::parse(made.out)["recommendation"];
    };
    const auto small = advised("90"), large = advised("0.001");
    EXPECT_TRUE(small["reached"]);
    EXPECT_FALSE(large["reached"]);
    const std::string words =
        "acdf env " + maps[0] + " " + maps[1] + " " + maps[2] + " --axis time=6,9,12 -o maps.acdf";
    EXPECT_EQ(small["command"], words + " --budget 6kB");
    EXPECT_EQ(large["command"], words + " --budget 12kB");
}

TEST(SweepOfMaps, RefusesWhatDoesNotFit) {
    const Folder folder;
    const std::vector<std::string> maps = three_maps(folder);
    const auto code_of = [&](std::vector<std::string> more) {
        more.insert(more.begin(), "sweep");
        more.insert(more.end(), {"-o", folder / "out", "--quiet"});
        const Result result = run_acdf(more);
        EXPECT_FALSE(result.err.empty());
        EXPECT_FALSE(std::filesystem::exists(folder / "out")) << result.err;
        return result.code;
    };
    EXPECT_EQ(code_of({maps[0], maps[1]}), 2); // without --axis
    EXPECT_EQ(code_of({maps[0], maps[1], "--axis", "time=1,2,3"}), 2);
    EXPECT_EQ(code_of({maps[0], "--no-sun"}), 2);
    EXPECT_EQ(code_of({folder / "map.####.pfm", "--files", "env"}), 2);
    EXPECT_EQ(code_of({folder / "none.####.pfm"}), 1);
    EXPECT_EQ(code_of({folder / "map.####.pfm", "--budgets", "100"}), 1);
}

} // namespace
} // namespace acdf::test
