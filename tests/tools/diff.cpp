// acdf diff: bytes, and what is sampled.
#include "tests/tools/run.h"

#include "tests/inputs/float_map.h"

#include <nlohmann/json.hpp>

namespace acdf::test {
namespace {

using nlohmann::json;

class Diff : public testing::Test {
protected:
    Folder folder;

    void SetUp() override {
        std::vector<float> rgb(std::size_t{3} * 32 * 16, 1.0f);
        for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] += static_cast<float>(i * i % 97);
        write_float_map(folder / "sky.pfm", 32, 16, rgb);
    }

    std::string made(const std::string& name, std::vector<std::string> words) {
        words.insert(words.end(), {"-o", folder / name, "-q"});
        const Result result = run_acdf(words);
        EXPECT_EQ(result.code, 0) << result.err;
        return folder / name;
    }

    json report(const std::string& a, const std::string& b, std::vector<std::string> more = {}) {
        more.insert(more.begin(), {"diff", a, b, "--json"});
        const Result result = run_acdf(more);
        EXPECT_EQ(result.err, "");
        json out = json::parse(result.out);
        EXPECT_EQ(result.code, out["same"] ? 0 : 3);
        return out;
    }
};

TEST_F(Diff, FindsTheSameBytes) {
    const std::string a = made("a.acdf", {"env", folder / "sky.pfm", "--cells", "50"});
    const json same = report(a, a);
    EXPECT_EQ(same["same_bytes"], true);
    EXPECT_EQ(same["distance"], 0.0);
    EXPECT_EQ(run_acdf({"diff", a, a}).out, "the same bytes\n");
    EXPECT_EQ(run_acdf({"diff", a, a, "-q"}).out, "");
}

TEST_F(Diff, CompressionChangesBytesAndNoSample) {
    const std::string a = made("a.acdf", {"env", folder / "sky.pfm", "--cells", "400"}),
                      b = made("b.acdf", {"env", folder / "sky.pfm", "--cells", "400", "--compress", "zlib"});
    EXPECT_EQ(report(a, b)["same"], false);
    const json by_distance = report(a, b, {"--tolerance", "0"});
    EXPECT_EQ(by_distance["same"], true) << by_distance;
    EXPECT_EQ(by_distance["same_bytes"], false);
    EXPECT_EQ(by_distance["largest_ratio"], 1.0);
    EXPECT_TRUE(by_distance["metadata"].contains("fit.options")) << by_distance;
}

TEST_F(Diff, MeasuresHowFarFilesAreFromEachOther) {
    for (const std::string kind : {"env", "local", "brdf"}) {
        const std::string source = kind == "brdf" ? "ggx:alpha=0.4" : folder / "sky.pfm";
        const auto of = [&](const std::string& name, const std::string& budget) {
            std::vector<std::string> words{kind, source, "--budget", budget};
            if (kind == "brdf") words.insert(words.end(), {"--views", "4"});
            return made(kind + name, words);
        };
        const std::string small = of("1.acdf", kind == "env" ? "1KiB" : "9KiB"),
                          large = of("2.acdf", kind == "env" ? "3KiB" : "40KiB");
        const json far = report(small, large);
        EXPECT_GT(far["distance"], 1e-4) << kind << far;
        EXPECT_LT(far["distance"], 0.6) << kind << far;
        EXPECT_LE(far["mean_distance"], far["distance"]);
        EXPECT_EQ(report(small, large, {"--tolerance", "0.7"})["same"], true) << far;
        EXPECT_NEAR(report(large, small)["distance"].get<double>(), far["distance"].get<double>(), 1e-9)
            << "in any order";
        const Result text = run_acdf({"diff", small, large});
        EXPECT_EQ(text.code, 3);
        EXPECT_NE(text.out.find("of the samples fall elsewhere"), std::string::npos) << text.out;
        EXPECT_NE(text.out.find("fit.options: "), std::string::npos) << text.out;
    }
}

TEST_F(Diff, HalfOfALightThatMovedIsHalfOfTheSamples) {
    const auto lit = [&](const std::string& name, std::size_t first, std::size_t second) {
        std::vector<float> rgb(std::size_t{3} * 32 * 16, 0.0f); // two texels of a row
        for (const std::size_t x : {first, second})
            for (std::size_t c = 0; c < 3; ++c) rgb[3 * (32 * 8 + x) + c] = 1.0f;
        write_float_map(folder / (name + ".pfm"), 32, 16, rgb);
        return made(name + ".acdf", {"env", folder / (name + ".pfm"), "--cells", "100"});
    };
    const json far = report(lit("a", 3, 20), lit("b", 3, 25));
    EXPECT_NEAR(far["distance"].get<double>(), 0.5, 0.01);
    EXPECT_TRUE(far["largest_ratio"].is_null());
}

TEST_F(Diff, OtherKindsDifferAndWhatIsNoFileFails) {
    const std::string a = made("a.acdf", {"env", folder / "sky.pfm", "--cells", "50"}),
                      b = made("b.acdf", {"local", folder / "sky.pfm", "--budget", "12KiB"});
    const Result kinds = run_acdf({"diff", a, b, "--tolerance", "1"});
    EXPECT_EQ(kinds.code, 3);
    EXPECT_NE(kinds.out.find("one is of kind environment, the other of kind local"), std::string::npos)
        << kinds.out;
    EXPECT_EQ(run_acdf({"diff", a, folder / "none.acdf"}).code, 1);
    EXPECT_EQ(run_acdf({"diff", a}).code, 2);
    EXPECT_EQ(run_acdf({"diff", a, b, "--tolerance", "2"}).code, 2);
}

} // namespace
} // namespace acdf::test
