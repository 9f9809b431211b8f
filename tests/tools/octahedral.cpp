// Octahedral maps, and maps of other layouts, through the program: the grid, measures against any source, presets.
#include "tests/inputs/sanitized.h"
#include "tests/inputs/synthetic.h"
#include "tests/tools/plot/files.h"
#include "tests/tools/run.h"

#include "build/probe/projection.h"

#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/renderers.h>
#include <acdf/views.h>

#include <nlohmann/json.hpp>

#include <fstream>

namespace acdf::test {
namespace {

using nlohmann::json;

class OctahedralCommand : public testing::Test {
protected:
    Folder folder;
    const std::string square = folder / "square.pfm", latlong = folder / "latlong.pfm", disc = folder / "disc.pfm",
                      output = folder / "out.acdf";

    void SetUp() override {
        write_map(square, {build::Layout::octahedral, 32, 32});
        write_map(latlong, {build::Layout::latlong, 64, 32});
        write_map(disc, {build::Layout::angular, 48, 48});
    }

    static void write_map(const std::string& path, const build::Map& map) {
        std::vector<float> rgb;
        for (int y = 0; y < map.height; ++y)
            for (int x = 0; x < map.width; ++x) {
                build::Direction d;
                const bool shown = build::to_direction(map, (x + 0.5) / map.width, (y + 0.5) / map.height, d);
                const double light = !shown ? 0.0
                                     : d.x * 0.6 + d.z * 0.8 > 0.99
                                         ? 300.0
                                         : acdf_test::smooth_sky(std::atan2(d.y, d.x), d.z);
                rgb.insert(rgb.end(), 3, static_cast<float>(light));
            }
        write_rgb(path, map.width, map.height, rgb);
    }

    json made(const std::string& source, std::vector<std::string> options, const char* command = "env") {
        options.insert(options.begin(), {command, source, "-o", output, "--force", "--json"});
        const Result result = run_acdf(options);
        EXPECT_EQ(result.code, 0) << result.err;
        messages = result.err;
        return result.code == 0 ? json::parse(result.out) : json();
    }
    json measured(const std::string& source, std::vector<std::string> options = {}) {
        options.insert(options.begin(), {"measure", output, "--against", source, "--json"});
        const Result result = run_acdf(options);
        EXPECT_EQ(result.code, 0) << result.err;
        messages = result.err;
        return result.code == 0 ? json::parse(result.out) : json();
    }
    std::uint32_t parameterization() const {
        File file;
        EXPECT_TRUE(File::open(output.c_str(), file, acdf::with_curves()).ok());
        return file.description().parameterization;
    }
    std::string messages;
};

const std::vector<std::string> as_square{"--projection", "octahedral"}, as_disc{"--projection", "angular"};

TEST_F(OctahedralCommand, FitsTheMapsOwnTexels) {
    const json report = made(square, as_square);
    EXPECT_EQ(report["domain"], "octahedral");
    EXPECT_EQ(report["resolution"], json({32, 32}));
    EXPECT_EQ(report["resampling_error"], 0.0);
    EXPECT_EQ(report["support_violations"], 0);
    EXPECT_EQ(parameterization(), std::uint32_t{ACDF_PARAM_OCTAHEDRAL});
    EXPECT_EQ(messages.find("resampled"), std::string::npos) << messages;
    const json told = measured(square, as_square);
    EXPECT_EQ(told["relative_variance"], report["relative_variance"]);
    const Result valid = run_acdf({"validate", output});
    EXPECT_EQ(valid.code, 0) << valid.out << valid.err;
    const Result info = run_acdf({"info", output, "--json"});
    EXPECT_EQ(json::parse(info.out)["parameterization"], "octahedral");
    EXPECT_EQ(json::parse(info.out)["axes"][0]["name"], "u");
    const Result plot = run_acdf({"plot", output, "-o", folder / "out.png", "--width", "128"});
    EXPECT_EQ(plot.code, 0) << plot.err;
}

TEST_F(OctahedralCommand, LatLongMapsKeepTheirOwn) {
    EXPECT_EQ(made(latlong, {})["domain"], "latlong");
    const json resampled = made(latlong, {"--domain", "octahedral"});
    EXPECT_EQ(resampled["domain"], "octahedral");
    EXPECT_GT(resampled["least_variance"], 0.0);
    const json back = made(square, {"--projection", "octahedral", "--domain", "latlong"});
    EXPECT_EQ(back["domain"], "latlong");
    EXPECT_EQ(parameterization(), std::uint32_t{ACDF_PARAM_LATLONG});
}

// Which is measured in the end is the map that is looked up, whatever the file was made from.
TEST_F(OctahedralCommand, IsMeasuredAgainstAnySource) {
    made(square, as_square);
    const double own = measured(square, as_square)["relative_variance"];
    const json other = measured(latlong);
    EXPECT_NE(messages.find("SHA-256"), std::string::npos) << messages;
    EXPECT_EQ(other["support_violations"], 0);
    EXPECT_GT(other["relative_variance"], own);
    made(latlong, {});
    EXPECT_GT(measured(disc, as_disc)["relative_variance"], measured(latlong)["relative_variance"]);
    made(disc, as_disc);
    EXPECT_GT(measured(square, as_square)["relative_variance"], measured(disc, as_disc)["relative_variance"]);
}

TEST_F(OctahedralCommand, WarnsWhereResamplingIsTheLargerPart) {
    made(disc, {"--projection", "angular", "--cells", "20000"});
    EXPECT_NE(messages.find("resampling is the larger part"), std::string::npos) << messages;
    made(square, {"--projection", "octahedral", "--cells", "20000"});
    EXPECT_EQ(messages.find("resampling is the larger part"), std::string::npos) << messages;
}

TEST_F(OctahedralCommand, LocalFilesLieOnItToo) {
    const json report = made(square, {"--projection", "octahedral", "--budget", "40kB"}, "local");
    EXPECT_EQ(report["domain"], "octahedral");
    EXPECT_EQ(report["support_violations"], 0);
    EXPECT_EQ(parameterization(), std::uint32_t{ACDF_PARAM_OCTAHEDRAL});
    const json told = measured(square, {"--projection", "octahedral", "--baselines"});
    EXPECT_EQ(told["relative_variance"], report["relative_variance"]);
    const Result plot = run_acdf({"plot", output, "-o", folder / "out.png", "--width", "128", "--normal", "0,0,1"});
    EXPECT_EQ(plot.code, 0) << plot.err;
}

// A projection that was given when a file was made is stored in it; baselines use it, too.
TEST_F(OctahedralCommand, LocalBaselinesOfOtherMapsNeedNoProjection) {
    const json report = made(disc, {"--projection", "angular", "--budget", "40kB"}, "local");
    const json told = measured(disc, {"--baselines"});
    EXPECT_EQ(told["relative_variance"], report["relative_variance"]);
    EXPECT_GT(told["baselines"]["full_cdf"]["relative_variance"], 1.0);
}

// Files and baselines are compared on the map's own texels.
TEST_F(OctahedralCommand, SweepsSampleItsTexels) {
    write_map(square, {build::Layout::octahedral, 64, 64});
    const std::string out = folder / "out";
    const Result result = run_acdf({"sweep", square, "--projection", "octahedral", "--filter", "nearest", "--files",
                                    "env,local", "--budgets", "30kB", "--no-timing", "-o", out});
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err.find("resampled"), std::string::npos) << result.err;
    const json sweep = json::parse(read_text(out + "/sweep.json"));
    json full;
    for (const json& row : sweep["rows"])
        if (row["system"] == "full_cdf") full = row;
    EXPECT_LT(full["relative_variance"], 1e-9); // the pdf is the light itself
    for (const std::size_t row : {0u, 1u}) {
        const char* kind = row == 0 ? "env" : "local";
        const json file =
            made(square, {"--projection", "octahedral", "--filter", "nearest", "--budget", "30kB"}, kind);
        EXPECT_EQ(sweep["rows"][row]["file_bytes"], file["bytes"]) << kind;
    }
    EXPECT_GT(full["alone_diffuse_open"], sweep["rows"][1]["alone_diffuse_open"]);
}

// The table of docs/conventions.md is what the program does.
TEST_F(OctahedralCommand, PresetsAreDocumented) {
    std::ifstream page(std::string(ACDF_TEST_DIR) + "/../docs/conventions.md");
    std::string text((std::istreambuf_iterator<char>(page)), {});
    for (std::size_t at; (at = text.find("\xe2\x88\x92")) != std::string::npos;) text.replace(at, 3, "-"); // U+2212
    for (const builder::Renderer& renderer : builder::renderers()) {
        const builder::TargetOptions& target = renderer.target;
        const char* domain = target.domain == builder::Domain::octahedral ? "octahedral" : "latlong";
        const char* filter = target.filter == ACDF_FILTER_BILINEAR ? "bilinear" : "nearest";
        const char* wrap = target.wrap == builder::Wrap::repeat ? "repeat" : "clamp";
        const char* channel = target.channels.weights.r == target.channels.weights.g ? "average" : "luminance";
        const std::string row = std::string("| `") + renderer.name + "` | `" + domain + "` | `" + filter + "` | `" +
                                wrap + "` | `" + channel + "` | " + renderer.axes.text() + " |";
        EXPECT_NE(text.find(row), std::string::npos) << row;
    }
}

// Noise, and light that is the same all round, prove nothing; but what pbrt-v4 looks up can be nothing else.
TEST_F(OctahedralCommand, SquaresForRenderersThatReadNoOthers) {
    std::vector<float> rgb;
    for (int i = 0; i < 64 * 64; ++i) rgb.insert(rgb.end(), 3, 1.0f + static_cast<float>(i * 37 % 101));
    write_rgb(square, 64, 64, rgb);
    EXPECT_EQ(run_acdf({"env", square, "-o", output, "--force"}).code, 1);
    const json report = made(square, {"--for", "pbrt-v4"});
    EXPECT_EQ(report["projection"], "octahedral");
    EXPECT_EQ(report["resampling_error"], 0.0);
    EXPECT_EQ(measured(square)["relative_variance"], report["relative_variance"]) << "need not be told again";
    EXPECT_EQ(run_acdf({"env", square, "-o", output, "--force", "--for", "cycles"}).code, 1);
    EXPECT_EQ(run_acdf({"env", disc, "-o", output, "--force", "--for", "pbrt-v4"}).code, 1);
    EXPECT_EQ(made(disc, {"--for", "pbrt-v4", "--projection", "angular"})["projection"], "angular");
}

TEST_F(OctahedralCommand, PresetsSetDomainFilterAndChannel) {
    const json report = made(latlong, {"--for", "pbrt-v4"});
    EXPECT_EQ(report["domain"], "octahedral");
    EXPECT_NE(messages.find("(-x, y, z)"), std::string::npos) << messages;
    File file;
    ASSERT_TRUE(File::open(output.c_str(), file, acdf::with_curves()).ok());
    EXPECT_EQ(file.description().filter, std::uint32_t{ACDF_FILTER_NEAREST});
    EXPECT_DOUBLE_EQ(file.description().channel_weights[0], 1.0 / 3.0);
    made(latlong, {"--for", "mitsuba3", "--filter", "nearest"});
    ASSERT_TRUE(File::open(output.c_str(), file, acdf::with_curves()).ok());
    EXPECT_EQ(file.description().filter, std::uint32_t{ACDF_FILTER_NEAREST}) << "what is given by itself wins";
    made(latlong, {"--for", "mitsuba3"});
    ASSERT_TRUE(File::open(output.c_str(), file, acdf::with_curves()).ok());
    EXPECT_EQ(file.description().filter, std::uint32_t{ACDF_FILTER_BILINEAR});
    const Result unknown = run_acdf({"env", latlong, "-o", output, "--force", "--for", "povray"});
    EXPECT_EQ(unknown.code, 2);
    for (const char* part : {"povray", "renderman", "conventions.md"})
        EXPECT_NE(unknown.err.find(part), std::string::npos) << unknown.err;
}

// Within half a texel of the zenith these find the last row: it needs pdf there, and files say so to `measure`.
TEST_F(OctahedralCommand, PresetsCoverWhatRowsThatRepeatShowAtThePoles) {
    const int width = 20, height = 10;
    std::vector<float> rgb(3 * width * height, 0.0f);
    std::fill_n(rgb.end() - 3 * width, 3 * width, 1.0f);
    const std::string source = folder / "foot.pfm";
    write_rgb(source, width, height, rgb);
    const float zenith[3] = {0.05f, 0.03f, 0.9983f}, up[3] = {0.0f, 0.0f, 1.0f};
    for (const char* renderer : {"cycles", "pbrt-v3", "luxcore", "mitsuba3", "three"}) {
        const bool repeats = builder::find_renderer(renderer)->target.wrap == builder::Wrap::repeat;
        made(source, {"--for", renderer, "--mis", "none"});
        File file;
        ASSERT_TRUE(File::open(output.c_str(), file, acdf::with_curves()).ok());
        EXPECT_EQ(file.environment().pdf(zenith) > 0.0f, repeats) << renderer;
        const Text options = file.metadata("fit.options");
        EXPECT_EQ(std::string(options.data, options.size).find("--wrap repeat") != std::string::npos, repeats);
        EXPECT_EQ(measured(source)["support_violations"], 0);
        if (!repeats) continue;
        made(source, {"--for", renderer, "--mis", "none"}, "local");
        ASSERT_TRUE(File::open(output.c_str(), file, acdf::with_curves()).ok());
        EXPECT_GT(file.local().pdf(up, zenith), 0.0f) << renderer;
    }
    made(source, {"--for", "cycles", "--mis", "none", "--wrap", "clamp"});
    File file;
    ASSERT_TRUE(File::open(output.c_str(), file, acdf::with_curves()).ok());
    EXPECT_EQ(file.environment().pdf(zenith), 0.0f) << "what is given by itself wins";
    // On another grid than the map's own.
    const json square_file = made(source, {"--for", "cycles", "--mis", "none", "--domain", "octahedral"});
    EXPECT_EQ(square_file["support_violations"], 0);
    ASSERT_TRUE(File::open(output.c_str(), file, acdf::with_curves()).ok());
    EXPECT_GT(file.environment().pdf(zenith), 0.0f);
    EXPECT_NEAR(measured(source)["relative_variance"], square_file["relative_variance"], 1e-9);
}

TEST_F(OctahedralCommand, PresetsSayHowTheRendererTurnsAMirrorBall) {
    const std::string ball = folder / "ball.pfm";
    write_map(ball, {build::Layout::mirrorball, 64, 64});
    made(ball, {"--projection", "mirrorball", "--for", "cycles"});
    EXPECT_NE(messages.find("(y, -x, z)"), std::string::npos) << messages;
    EXPECT_NE(messages.find("(-Y, X, Z)"), std::string::npos) << messages;
    made(latlong, {"--for", "cycles"});
    EXPECT_NE(messages.find("(x, y, z) is (x, y, z)"), std::string::npos) << messages;
    made(ball, {"--projection", "mirrorball", "--for", "pbrt-v4"});
    EXPECT_NE(messages.find("once this map is made into the octahedral one"), std::string::npos) << messages;
}

} // namespace
} // namespace acdf::test
