// The lookup that files are made for: which it is by default, and what a file for one is worth to the other.
#include "tests/inputs/float_map.h"
#include "tests/tools/run.h"

#include "compress/target.h"
#include "measure/map_lookup.h"
#include "measure/sequences.h"

#include <acdf/reader.h>
#include <acdf/views.h>

#include <nlohmann/json.hpp>

#include <cmath>

namespace acdf::test {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr std::uint32_t kColumns = 64, kRows = 32;

/// A sun of one texel and a lamp on black, half of it below a faint sky.
std::vector<float> pixels() {
    std::vector<float> rgb(std::size_t{3} * kColumns * kRows, 0.0f);
    for (std::uint32_t i = 0; i < 3 * kColumns * kRows / 2; ++i) rgb[i] = 0.01f * static_cast<float>(i / 3 % 7);
    for (std::size_t k = 0; k < 3; ++k) {
        rgb[3 * (10 * kColumns + 20) + k] = 900.0f;
        rgb[3 * (25 * kColumns + 0) + k] = 20.0f;
    }
    return rgb;
}

class Filters : public testing::Test {
protected:
    Folder folder;
    std::string probe = folder / "probe.pfm";

    void SetUp() override { write_float_map(probe, kColumns, kRows, pixels()); }

    std::string made(const std::string& name, std::vector<std::string> words) {
        const std::string path = folder / name;
        words.insert(words.end(), {"-o", path, "-q", "-f"});
        const Result result = run_acdf(words);
        EXPECT_EQ(result.code, 0) << result.err;
        return path;
    }
    static std::string filter_of(const std::string& file) {
        return json::parse(run_acdf({"info", "--json", file}).out)["filter"];
    }
    static json measured(const std::string& file, const std::string& source, std::vector<std::string> more = {}) {
        std::vector<std::string> words{"measure", file, "--against", source, "--json", "-q"};
        words.insert(words.end(), more.begin(), more.end());
        const Result result = run_acdf(words);
        EXPECT_EQ(result.code, 0) << result.err;
        return json::parse(result.out);
    }
};

TEST_F(Filters, AreBilinearWhereNothingElseIsAskedFor) {
    EXPECT_EQ(filter_of(made("a.acdf", {"env", probe, "--budget", "4KiB"})), "bilinear");
    EXPECT_EQ(filter_of(made("b.acdf", {"local", probe, "--budget", "16KiB"})), "bilinear");
    EXPECT_EQ(filter_of(made("c.acdf", {"make", probe, "--for", "storm", "--budget", "4KiB"})), "bilinear");
    EXPECT_EQ(filter_of(made("d.acdf", {"env", probe, "--budget", "4KiB", "--filter", "nearest"})), "nearest");
    EXPECT_EQ(filter_of(made("e.acdf", {"env", probe, "--budget", "4KiB", "--for", "pbrt-v4"})), "nearest");
    write_text(folder / "jobs.jsonl", "{\"source\": \"probe.pfm\", \"options\": {\"budget\": \"4KiB\"}}\n");
    const Result batch = run_acdf({"batch", folder / "jobs.jsonl", "-o", folder / "out", "-q"});
    ASSERT_EQ(batch.code, 0) << batch.err;
    EXPECT_EQ(filter_of(folder / "out/probe.acdf"), "bilinear");
    EXPECT_EQ(read_text(folder / "out/probe.acdf"), read_text(folder / "a.acdf"));
}

// Its pdf covers what the nearest texel has, too: exactly, and in what its samples sum to.
TEST_F(Filters, ABilinearFileServesNearestLookups) {
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"env", probe, "--budget", "4KiB"}, {"local", probe, "--budget", "24KiB"}}) {
        const std::string file = made("file.acdf", words);
        const json own = measured(file, probe), nearest = measured(file, probe, {"--filter", "nearest"});
        EXPECT_EQ(own, measured(file, probe, {"--filter", "bilinear"}));
        EXPECT_EQ(nearest["support_violations"], 0) << words[0];
        EXPECT_GT(nearest["relative_variance"], 0.0) << words[0];
        EXPECT_LT(nearest["max_weight"], 100.0) << words[0];
    }
    File file;
    ASSERT_TRUE(File::open(made("env.acdf", {"env", probe, "--budget", "4KiB"}).c_str(), file).ok());
    const std::vector<float> rgb = pixels();
    const compress::Target texels = compress::environment_target(rgb.data(), kColumns, kRows, {});
    const measure::MapLight light(texels);
    const EnvironmentView view = file.environment();
    double sum = 0.0;
    constexpr std::uint32_t count = 1 << 18;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto u = measure::sobol_point(i);
        const DirectionSample s = view.sample((u[0] + 0.5) * 0x1p-32, (u[1] + 0.5) * 0x1p-32);
        sum += light.radiance(s.direction) / double{s.pdf};
    }
    EXPECT_NEAR(sum / count, texels.total, 2e-3 * texels.total);
}

// The other way round light is lost, and `measure` says so.
TEST_F(Filters, ANearestFileIsBiasedUnderBilinearLookups) {
    const std::string file = made("nearest.acdf", {"env", probe, "--filter", "nearest", "--budget", "4KiB"});
    EXPECT_EQ(measured(file, probe)["support_violations"], 0);
    const Result bilinear = run_acdf({"measure", file, "--against", probe, "--filter", "bilinear", "--json", "-q"});
    EXPECT_EQ(bilinear.code, 1);
    EXPECT_NE(bilinear.err.find("its pdf is 0 where"), std::string::npos) << bilinear.err;
    EXPECT_GT(json::parse(bilinear.out)["support_violations"], 0);
}

/// What a bilinear file of 64 KiB costs under nearest lookups: E[(f/p)^2] of a sample, over that by a nearest file
/// of as many bytes. Samples of light on a surface have about that factor at most, too; its root is noise.
struct Cost {
    const char* probe;
    double most;
};
void PrintTo(const Cost& cost, std::ostream* out) { *out << cost.probe; } // for GoogleTest

class FilterCosts : public testing::TestWithParam<Cost> {};

TEST_P(FilterCosts, OfNearestLookupsAreSmall) {
    ACDF_NOT_SANITIZED();
    const std::string source = std::string(acdf_test::kTestData) + "/probes/" + GetParam().probe;
    if (!fs::exists(source)) GTEST_SKIP() << source << " is absent; set ACDF_TEST_DATA";
    const Folder folder;
    const auto report = [&](std::vector<std::string> words) {
        words.insert(words.end(), {"--json", "-q"});
        const Result result = run_acdf(words);
        EXPECT_EQ(result.code, 0) << result.err;
        return json::parse(result.out);
    };
    const std::string bilinear = folder / "bilinear.acdf", nearest = folder / "nearest.acdf";
    report({"env", source, "-o", bilinear});
    const json own = report({"env", source, "-o", nearest, "--filter", "nearest"});
    const json other = report({"measure", bilinear, "--against", source, "--filter", "nearest"});
    EXPECT_EQ(other["support_violations"], 0);
    const double least = own["relative_variance"], had = other["relative_variance"];
    std::printf("%s: relative variance %.4g by a nearest file, %.4g by a bilinear one\n", GetParam().probe, least,
                had);
    EXPECT_LE((1.0 + had) / (1.0 + least), GetParam().most);
}

INSTANTIATE_TEST_SUITE_P(Probes, FilterCosts,
                         testing::Values(Cost{"city.exr", 1.09}, Cost{"courtyard.exr", 1.011},
                                         Cost{"noon_grass_1k.hdr", 1.12}, Cost{"studio.exr", 1.03},
                                         Cost{"sunset.exr", 1.012}, Cost{"venice_sunset_1k.hdr", 1.012}));

} // namespace
} // namespace acdf::test
