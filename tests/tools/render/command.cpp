// `acdf render` as a user runs it.
#include "tests/inputs/sanitized.h"
#include "tests/tools/render/scenes.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <set>

namespace acdf::test {
namespace {

using Json = nlohmann::json;

struct RenderCommand : testing::Test {
    SceneFolder folder{small_scene("\"full-cdf\", \"cosine\", \"mis(full-cdf,cosine)\"")};

    Result render(const std::string& output, std::vector<std::string> more = {}) {
        std::vector<std::string> arguments{"render",        "--scene",   folder / "scene.json",
                                           "--data",        folder / "", "-o",
                                           folder / output, "--seeds",   "4"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_acdf(arguments);
    }
    /// What is the same with both kinds of numbers.
    Result render_once(const std::string& output, std::vector<std::string> more = {}) {
        more.insert(more.end(), {"--sequence", "independent"});
        return render(output, more);
    }
    std::set<std::string> files(const std::string& output) const {
        std::set<std::string> out;
        for (const auto& entry : std::filesystem::directory_iterator(folder / output))
            out.insert(entry.path().filename().string());
        return out;
    }
};

TEST_F(RenderCommand, WritesWhatItSays) {
    const Result result = render_once("out", {"--images"});
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(files("out"),
              (std::set<std::string>{"index.html", "render.json", "reference.exr", "reference.png", "full-cdf.exr",
                                     "full-cdf.png", "full-cdf-variance.png", "full-cdf-above.png", "cosine.exr",
                                     "cosine.png", "cosine-variance.png", "cosine-above.png", "cosine-gain.png",
                                     "mis-full-cdf-cosine.exr", "mis-full-cdf-cosine.png",
                                     "mis-full-cdf-cosine-variance.png", "mis-full-cdf-cosine-above.png",
                                     "mis-full-cdf-cosine-gain.png"}));
    for (const char* part : {"mis(full-cdf,cosine)", "of the sky is hidden", "without occluders", "Ranking"})
        EXPECT_NE(result.out.find(part), std::string::npos) << part << "\n" << result.out;
    const LoadedImage image = load_image(folder / "out/reference.exr");
    EXPECT_EQ(image.width, 8);
    EXPECT_EQ(image.height, 6);
    EXPECT_EQ(image.channels, 3);
    EXPECT_TRUE(image.floating && image.sample_bytes == 4);
    EXPECT_EQ(load_image(folder / "out/cosine.png").width, 8);
    EXPECT_GT(load_image(folder / "out/cosine-variance.png").width, 384);
}

// Pictures beside each other with zoom and difference, the table and the advice, in one file.
TEST_F(RenderCommand, ThePageHoldsAll) {
    ASSERT_EQ(render_once("out").code, 0);
    EXPECT_EQ(files("out"), (std::set<std::string>{"index.html", "render.json"}));
    const std::string page = read_text(folder / "out/index.html");
    const Json json = Json::parse(read_text(folder / "out/render.json"));
    std::size_t frames = 0;
    for (std::size_t at = 0; (at = page.find("<div class=\"frame\">", at)) != std::string::npos; ++at) ++frames;
    EXPECT_EQ(frames, 1 + json["samplers"].size()); // and the reference
    for (const Json& one : json["samplers"])
        EXPECT_NE(page.find("<td>" + one["sampler"].get<std::string>() + "</td>"), std::string::npos);
    for (const char* part : {"id=\"difference\"", "id=\"part8\"", "--reference:url(data:image/png",
                             "relative variance", "nothing hidden", "gain, equal time"})
        EXPECT_NE(page.find(part), std::string::npos) << part;
    ASSERT_EQ(
        render_once("files", {"--sampler", "full-cdf", "--sampler", "mis(local:32KiB --mis cosine,cosine)"}).code,
        0);
    EXPECT_NE(read_text(folder / "files/index.html").find("acdf local PROBE --budget 32KiB --mis cosine<"),
              std::string::npos); // what makes the file
    std::string advice = json["verdict"][0];
    for (std::size_t at = 0; (at = advice.find('\'', at)) != std::string::npos; at += 5)
        advice.replace(at, 1, "&#39;");
    EXPECT_NE(page.find(advice), std::string::npos) << advice;
    for (const char* what : {"http:", "https:", "<script", "<link", "@import"})
        EXPECT_EQ(page.find(what), std::string::npos) << what;
}

TEST_F(RenderCommand, JsonHasTheFigures) {
    const Result result = render("out", {"--json", "--samples", "5", "--size", "7x5"});
    ASSERT_EQ(result.code, 0) << result.err;
    const Json json = Json::parse(result.out);
    EXPECT_EQ(json, Json::parse(read_text(folder / "out/render.json")));
    EXPECT_EQ(json["samples"], 5);
    EXPECT_EQ(json["seeds"], 4);
    EXPECT_EQ(json["width"], 7);
    EXPECT_GT(json["sky_hidden"], 0.05);
    ASSERT_EQ(json["samplers"].size(), 3u);
    EXPECT_EQ(json["sequence"], "independent");
    for (const Json& all : {json["samplers"], json["nothing_hidden"]["samplers"], json["sobol"]["samplers"],
                            json["sobol"]["nothing_hidden"]["samplers"]})
        for (const Json& one : all) {
            for (const char* key : {"relative_variance", "equal_samples_gain", "equal_time_gain", "nanoseconds"})
                for (const char* part : {"value", "low", "high"})
                    EXPECT_TRUE(one[key].contains(part)) << key << " " << one;
            const double variance = one["relative_variance"]["value"], noise = one["noise_percent"].begin().value();
            EXPECT_GT(variance, 0.0);
            EXPECT_TRUE(one["relative_variance_median"].is_number() && one["resolved"].is_boolean());
            // for the fewest samples that are reported: 16, or with Sobol' points those that were sampled, 5
            const double samples = std::stod(one["noise_percent"].begin().key());
            EXPECT_NEAR(noise, 100.0 * std::sqrt(variance * 5.0 / samples), 1e-3 * noise);
            EXPECT_GT(one["share_above_horizon"], 0.1);
            EXPECT_FALSE(one["ours"]);
        }
    EXPECT_EQ(json["samplers"][1]["sampler"], "cosine");
    EXPECT_EQ(json["samplers"][1]["bytes"], 0);
    EXPECT_EQ(json["ranking"].size(), 3u);
    EXPECT_EQ(json["verdict"].size(), 2u);
}

TEST_F(RenderCommand, SequencesAreChosen) {
    const auto json = [&](const std::string& output, const char* sequence) {
        EXPECT_EQ(render(output, {"--sequence", sequence, "--no-timing", "--no-reference"}).code, 0);
        return Json::parse(read_text(folder / (output + "/render.json")));
    };
    const Json independent = json("a", "independent"), sobol = json("b", "sobol"), both = json("c", "both");
    EXPECT_EQ(independent["sequence"], "independent");
    EXPECT_EQ(sobol["sequence"], "sobol");
    EXPECT_FALSE(independent.contains("sobol"));
    EXPECT_FALSE(sobol.contains("sobol"));
    EXPECT_EQ(both["samplers"], independent["samplers"]);
    EXPECT_NE(sobol["samplers"], independent["samplers"]);
    EXPECT_EQ(both["sobol"]["samplers"].size(), 3u);
    const Result wrong = render("d", {"--sequence", "halton"});
    EXPECT_EQ(wrong.code, 2);
    EXPECT_NE(wrong.err.find("sobol"), std::string::npos) << wrong.err;
}

TEST_F(RenderCommand, WritesTheSameBytesForAnyNumberOfThreads) {
    ASSERT_EQ(render("one", {"--no-timing", "--images", "--threads", "1"}).code, 0);
    ASSERT_EQ(render("two", {"--no-timing", "--images", "--threads", "2"}).code, 0);
    for (const std::string& name : files("one"))
        EXPECT_EQ(read_text(folder / ("one/" + name)), read_text(folder / ("two/" + name))) << name;
}

TEST_F(RenderCommand, OverwritesOnlyWithForce) {
    ASSERT_EQ(render_once("out", {"--no-reference", "--no-timing"}).code, 0);
    const Result again = render("out");
    EXPECT_EQ(again.code, 1);
    EXPECT_EQ(lines_in(again.err), 1u) << again.err;
    EXPECT_NE(again.err.find("--force"), std::string::npos);
    EXPECT_EQ(render_once("out", {"--force", "--no-reference", "--no-timing"}).code, 0);
}

TEST_F(RenderCommand, RefusesOutputsBeforeAnyLongWork) {
    const auto refused = [&](const Result& result, const std::string& part) {
        EXPECT_EQ(result.code, 1) << result.err;
        EXPECT_EQ(lines_in(result.err), 1u) << result.err;
        EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
    };
    for (const char* name : {"index.html", "reference.exr", "reference.png", "full-cdf.png", "cosine-gain.png"}) {
        std::filesystem::create_directory(folder / "out");
        write_text(folder / ("out/" + std::string(name)), "mine");
        refused(render("out", {"--images", "--samples", "65536", "--size", "4096x4096"}),
                std::string(name) + ": exists already");
        EXPECT_EQ(files("out"), std::set<std::string>{name});
        std::filesystem::remove_all(folder / "out");
    }
    std::filesystem::create_directories(folder / "out/cosine.png");
    refused(render("out", {"--images", "--force"}), "cosine.png: is a folder");
    EXPECT_EQ(files("out"), std::set<std::string>{"cosine.png"});
    // Inputs are not overwritten, either.
    std::filesystem::copy(folder / "scene.json", folder / "render.json");
    refused(run_acdf(
                {"render", "--scene", folder / "render.json", "--data", folder / "", "-o", folder / "", "--force"}),
            "render.json: input and output are the same file");
    EXPECT_EQ(read_text(folder / "render.json"), read_text(folder / "scene.json"));
    std::filesystem::copy(folder / "probe.pfm", folder / "reference.exr");
    refused(render("", {"--images", "--force", "--sampler", "mis(file:reference.exr,cosine)"}),
            "reference.exr: input and output are the same file");
}

TEST_F(RenderCommand, SaysWhatIsWrong) {
    const auto refused = [&](const std::vector<std::string>& more, int code, const std::string& part) {
        const Result result = render("never", more);
        EXPECT_EQ(result.code, code) << result.err;
        EXPECT_EQ(lines_in(result.err), 1u) << result.err;
        EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
        EXPECT_EQ(result.out, "");
    };
    refused({"--sampler", "nonsense"}, 2, "is none of full-cdf");
    refused({"--size", "8"}, 2, "--size");
    refused({"--seeds", "2"}, 2, "--seeds");
    refused({"--sampler", "mis(full-cdf,cosine)", "--samples", "1"}, 1, "at least 2 samples");
    refused({"--sampler", "file:none.acdf"}, 1, "none.acdf");
    refused({"--sampler", "tiles:64x64"}, 1, "tiles:64x64");
    write_text(folder / "scene.json", "{}");
    refused({}, 1, "scene.json: the scene: lacks 'camera'");
    write_text(folder / "scene.json", small_scene("\"nonsense\""));
    refused({}, 1, "samplers: sampler 'nonsense'");
    const auto write = [&](const std::string& was, const std::string& is) {
        std::string scene = small_scene("\"cosine\"");
        scene.replace(scene.find(was), was.size(), is);
        write_text(folder / "scene.json", scene);
    };
    write("\"to\": [0, 0, 0.7]", "\"to\": [4, -1, 9]");
    refused({}, 1, "scene.json: camera: has no direction");
    write("\"to\": [0, 0, 0.7]", "\"to\": [9, -1, 9]");
    refused({}, 1, "scene.json: camera: no object is in view");
    write("\"probe\": \"probe.pfm\"", "\"built_in\": \"moon\"");
    refused({}, 1, "scene.json: light.built_in: 'moon' is none of");
    write("lambert:albedo=0.5", std::string(300, 'x'));
    refused({}, 1, "no model of this name");
    write_text(folder / "scene.json", std::string(std::size_t{1} << 25, ' '));
    refused({}, 1, "scene.json: it is longer than 16 MiB");
    std::filesystem::remove(folder / "probe.pfm");
    write_text(folder / "scene.json", small_scene("\"cosine\""));
    refused({}, 1, "probe.pfm");
}

// As most renderers have it; samplers and the exact sum see the same light.
TEST_F(RenderCommand, LightIsInterpolatedUnlessTheSceneSaysOtherwise) {
    ACDF_NOT_SANITIZED();
    const auto brightness = [&](const std::string& filter, const std::string& output) {
        std::string scene = small_scene("\"cosine\", \"full-cdf\", \"env:4KiB\", \"local:32KiB\"");
        const std::string was = ", \"filter\": \"nearest\"";
        scene.replace(scene.find(was), was.size(), filter);
        write_text(folder / "scene.json", scene);
        const Result result = render_once(output, {"--no-timing", "--images", "--json"});
        EXPECT_EQ(result.code, 0) << result.err;
        for (const Json& one : Json::parse(result.out)["samplers"])
            EXPECT_LT(std::abs(one["bias_standard_errors"].get<double>()), 4.5) << filter << one;
        return read_text(folder / (output + "/reference.exr"));
    };
    const std::string by_default = brightness("", "a");
    EXPECT_EQ(brightness(", \"filter\": \"bilinear\"", "b"), by_default);
    EXPECT_NE(brightness(", \"filter\": \"nearest\"", "c"), by_default);
}

TEST_F(RenderCommand, ScenesHaveSeedsAndReferences) {
    std::string scene = small_scene("\"full-cdf\", \"cosine\"");
    scene.insert(scene.rfind('}'), ", \"seeds\": 5, \"reference\": false");
    write_text(folder / "scene.json", scene);
    const auto json = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words{"render",      "--scene", folder / "scene.json", "--data",
                                       folder / "",   "-o",      folder / "out",        "--force",
                                       "--no-timing", "--json"};
        words.insert(words.end(), more.begin(), more.end());
        return Json::parse(run_acdf(words).out);
    };
    const Json own = json({});
    EXPECT_EQ(own["seeds"], 5);
    EXPECT_EQ(own["reference"], "mean of all samplers");
    EXPECT_EQ(json({"--seeds", "4"})["seeds"], 4);
}

TEST_F(RenderCommand, TakesFiles) {
    ASSERT_EQ(run_acdf({"env", folder / "probe.pfm", "-o", folder / "sky.acdf", "--cells", "64", "-q"}).code, 0);
    const Result result =
        render_once("out", {"--sampler", "cosine", "--sampler", "file:sky.acdf", "--json", "--no-timing"});
    ASSERT_EQ(result.code, 0) << result.err;
    const Json json = Json::parse(result.out);
    EXPECT_TRUE(json["samplers"][1]["ours"]);
    const Json info = Json::parse(run_acdf({"info", "--json", folder / "sky.acdf"}).out);
    const std::uint64_t bytes = info["bytes"], tables = info["table_bytes"];
    EXPECT_EQ(bytes, std::filesystem::file_size(folder / "sky.acdf"));
    EXPECT_GT(tables, 0u);
    EXPECT_EQ(json["samplers"][1]["bytes"], bytes + tables) << "what a renderer's memory holds";
}

TEST_F(RenderCommand, TakesTheSkyAtCoordinates) {
    const std::string probe = folder / "probe.pfm";
    ASSERT_EQ(run_acdf({"env", probe, "-o", folder / "sky.acdf", "--budget", "4KiB", "-q"}).code, 0);
    const Result made =
        run_acdf({"env", probe, probe, "-o", folder / "day.acdf", "--axis", "time=6,18", "--budget", "4KiB"});
    ASSERT_EQ(made.code, 0) << made.err;
    const std::vector<std::string> samplers = {"--sampler",     "file:sky.acdf", "--sampler",
                                               "file:day.acdf", "--json",        "--no-timing"};
    std::vector<std::string> at = samplers;
    at.insert(at.end(), {"--at", "time=9"});
    const Result result = render_once("out", at);
    ASSERT_EQ(result.code, 0) << result.err;
    const Json json = Json::parse(result.out);
    const double own = json["samplers"][0]["relative_variance"]["value"],
                 day = json["samplers"][1]["relative_variance"]["value"];
    EXPECT_GT(day, 0.3 * own);
    EXPECT_LT(day, 3.0 * own);
    EXPECT_LT(std::fabs(json["samplers"][1]["bias_standard_errors"].get<double>()), 5.0);
    const Result refused = render_once("none", samplers);
    EXPECT_EQ(refused.code, 1);
    EXPECT_NE(refused.err.find("choose with --at time=VALUE"), std::string::npos) << refused.err;
}

} // namespace
} // namespace acdf::test
