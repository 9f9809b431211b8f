// What --for sets beyond the lookup, and acdf make: the kind of file, the MIS partner and the heuristic.
#include "tests/tools/plot/files.h"
#include "tests/tools/run.h"

#include <acdf/reader.h>
#include <acdf/renderers.h>
#include <acdf/views.h>

#include <nlohmann/json.hpp>

#include <algorithm>

namespace acdf::test {
namespace {

using nlohmann::json;

class Make : public testing::Test {
protected:
    Folder folder;
    const std::string probe = folder / "probe.pfm", output = folder / "out.acdf";

    void SetUp() override {
        std::vector<float> rgb(3 * 32 * 16, 0.5f);
        for (int k = 0; k < 3; ++k) rgb[static_cast<std::size_t>(3 * (4 * 32 + 10) + k)] = 900.0f;
        write_rgb(probe, 32, 16, rgb);
    }

    /// What `info` says of the file that the words make, which begin with a command; a small one if they say no
    /// size.
    json made(std::vector<std::string> words) {
        const auto has = [&](const char* word) {
            return std::find(words.begin(), words.end(), word) != words.end();
        };
        if (!has("--budget") && !has("--target-variance") && !has("--max-weight") && !has("--fit") &&
            !has("--no-sharing"))
            words.insert(words.end(), {"--budget", "32KiB"});
        words.insert(words.begin() + 1, {probe, "-o", output, "--force"});
        const Result result = run_acdf(words);
        messages = result.err;
        EXPECT_EQ(result.code, 0) << result.err;
        return result.code == 0 ? json::parse(run_acdf({"info", "--json", output}).out) : json();
    }
    static std::string partner(const json& info) {
        const json partner = info.value("partner", json());
        return partner.is_null()
                   ? "none"
                   : partner.at("kind").get<std::string>() + " " + partner.at("heuristic").get<std::string>();
    }
    std::string messages;
};

TEST_F(Make, PresetsSetThePartnerAndTheHeuristic) {
    EXPECT_EQ(partner(made({"env", "--for", "pbrt-v4"})), "mean power");
    EXPECT_NE(messages.find("--mis mean --heuristic power"), std::string::npos) << messages;
    EXPECT_NE(messages.find("never use it alone"), std::string::npos) << messages;
    EXPECT_EQ(partner(made({"local", "--for", "mitsuba3"})), "cosine power");
    write_text(folder / "up.txt", "0 0 1\n");
    EXPECT_EQ(partner(made({"env", "--for", "cycles", "--scene", folder / "up.txt"})), "cosine power");
    EXPECT_EQ(partner(made({"env", "--for", "renderman"})), "none");
    EXPECT_EQ(messages.find("never use it alone"), std::string::npos) << messages;
}

TEST_F(Make, OptionsThatAreGivenWin) {
    EXPECT_EQ(partner(made({"env", "--for", "pbrt-v4", "--mis", "none"})), "none");
    EXPECT_EQ(partner(made({"env", "--for", "pbrt-v4", "--heuristic", "balance"})), "mean balance");
    EXPECT_EQ(partner(made({"env", "--for", "pbrt-v4", "--mis", "cosine"})), "cosine power");
    const std::vector<std::vector<std::string>> alone = {
        {"env", "--max-weight", "9"},   {"env", "--target-variance", "2"},  {"env", "--fit", "cdf"},
        {"local", "--max-weight", "9"}, {"local", "--cosine-share", "0.2"}, {"local", "--no-sharing"}};
    for (std::vector<std::string> words : alone) {
        words.insert(words.end(), {"--for", "luxcore"});
        EXPECT_EQ(partner(made(words)), "none") << words[1];
    }
}

TEST_F(Make, ChoosesTheKindAndSaysWhy) {
    for (const builder::Renderer& renderer : builder::renderers()) {
        const json info = made({"make", "--for", renderer.name, "--budget", "16KiB"});
        const bool local = renderer.kind() == ACDF_KIND_LOCAL;
        EXPECT_EQ(info["kind"], local ? "local" : "environment") << renderer.name;
        EXPECT_LE(info["bytes"].get<std::size_t>(), 16384u);
        EXPECT_NE(messages.find(std::string("`acdf ") + (local ? "local" : "env") + "`: " + renderer.why),
                  std::string::npos)
            << messages;
        EXPECT_EQ(partner(info) != "none", renderer.adds_bsdf_samples) << renderer.name;
    }
}

TEST_F(Make, MakesWhatTheChosenCommandMakes) {
    made({"make", "--for", "cycles"});
    const std::string chosen = read_text(output);
    made({"env", "--for", "cycles"});
    EXPECT_EQ(read_text(output), chosen);
    const Result quiet = run_acdf({"make", probe, "-q", "--for=pbrt-v3", "-o", folder / "quiet.acdf"});
    EXPECT_EQ(quiet.code, 0) << quiet.err;
    EXPECT_EQ(quiet.err, "");
    EXPECT_EQ(quiet.out, "");
}

TEST_F(Make, RefusesWhatTheChosenCommandRefuses) {
    EXPECT_EQ(run_acdf({"make", probe, "-o", output}).code, 2);
    EXPECT_EQ(run_acdf({"make", probe, "-o", output, "--for", "povray"}).code, 2);
    EXPECT_EQ(run_acdf({"make", "--for", "cycles"}).code, 2);
    const Result unknown = run_acdf({"make", probe, "-o", output, "--for", "cycles", "--colour", "red"});
    EXPECT_EQ(unknown.code, 2);
    EXPECT_NE(unknown.err.find("--colour"), std::string::npos) << unknown.err;
    EXPECT_EQ(run_acdf({"make", folder / "missing.exr", "-o", output, "--for", "cycles"}).code, 1);
}

} // namespace
} // namespace acdf::test
