// Names: of outputs that none was given for, and of commands and options that were likely meant.
#include "tests/tools/run.h"

#include "tests/inputs/float_map.h"
#include "tools/cli/nearest.h"

#include <nlohmann/json.hpp>

#include <sys/stat.h>

namespace acdf::test {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

class Names : public testing::Test {
protected:
    Folder folder;

    std::string probe(const std::string& name, float bright = 9.0f) {
        std::vector<float> rgb(std::size_t{3} * 16 * 8, 1.0f);
        rgb[0] = bright;
        fs::create_directories(fs::path(folder / name).parent_path());
        write_float_map(folder / name, 16, 8, rgb);
        return folder / name;
    }

    void expect_refused(const std::vector<std::string>& command, int code, const std::string& part) {
        const Result result = run_acdf(command);
        EXPECT_EQ(result.code, code) << result.err;
        EXPECT_EQ(lines_in(result.err), 1u) << result.err;
        EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
    }
};

TEST_F(Names, OutputsWithoutOneLieBesideTheirInputs) {
    const std::string sky = probe("skies/sky.v2.pfm");
    const Result env = run_acdf({"env", sky, "--cells", "20"});
    ASSERT_EQ(env.code, 0) << env.err;
    EXPECT_EQ(env.out.rfind(folder / "skies/sky.v2.acdf: ", 0), 0u) << env.out;
    EXPECT_TRUE(fs::exists(folder / "skies/sky.v2.acdf"));
    expect_refused({"env", sky, "--cells", "20", "-q"}, 1, "exists already; use --force");
    ASSERT_EQ(run_acdf({"local", sky, "--budget", "12KiB", "-q"}).code, 0);
    EXPECT_TRUE(fs::exists(folder / "skies/sky.v2.local.acdf"));
    ASSERT_EQ(run_acdf({"plot", folder / "skies/sky.v2.acdf", "-q"}).code, 0);
    EXPECT_TRUE(fs::exists(folder / "skies/sky.v2.png"));
    expect_refused({"env", folder / "skies/sky.v2.acdf"}, 1, "give the source");
}

TEST_F(Names, SeveralInputsBecomeAFileEach) {
    const std::vector<std::string> both{probe("a/noon.pfm"), probe("b/dusk.pfm", 90.0f)};
    std::vector<std::string> words{"env", both[0], both[1], "--cells", "20", "--json"};
    const Result beside = run_acdf(words);
    ASSERT_EQ(beside.code, 0) << beside.err;
    const json reports = json::parse(beside.out);
    ASSERT_EQ(reports.size(), 2u);
    EXPECT_EQ(reports[0]["file"], folder / "a/noon.acdf");
    EXPECT_EQ(reports[1]["source"], both[1]);
    words.insert(words.end(), {"-o", folder / "all"});
    ASSERT_EQ(run_acdf(words).code, 0);
    EXPECT_EQ(read_text(folder / "all/noon.acdf"), read_text(folder / "a/noon.acdf"));
    EXPECT_EQ(read_text(folder / "all/dusk.acdf"), read_text(folder / "b/dusk.acdf"));
    ASSERT_EQ(run_acdf({"env", both[0], "--cells", "20", "-o", folder / "one/", "-q"}).code, 0);
    EXPECT_TRUE(fs::exists(folder / "one/noon.acdf"));
    expect_refused({"env", both[0], both[1], "-o", folder / "x.acdf"}, 2, "is one file, and there are 2 inputs");
    expect_refused({"env", both[0], both[1], "-o", "-"}, 2, "is one file, and there are 2 inputs");
    expect_refused({"env", both[0], probe("c/noon.pfm"), "-o", folder / "two"}, 2, "would both become");
    EXPECT_FALSE(fs::exists(folder / "two"));
}

TEST_F(Names, AnInputThatFailsStopsNoOther) {
    const std::string good = probe("good.pfm");
    const Result result = run_acdf({"env", folder / "none.pfm", good, "--cells", "20", "-q", "-o", folder / "out"});
    EXPECT_EQ(result.code, 1);
    EXPECT_EQ(lines_in(result.err), 1u) << result.err;
    EXPECT_NE(result.err.find("none.pfm"), std::string::npos) << result.err;
    EXPECT_TRUE(fs::exists(folder / "out/good.acdf"));
}

TEST_F(Names, ExtensionsOfOtherFilesAreRefused) {
    const std::string sky = probe("sky.pfm");
    expect_refused({"env", sky, "-o", folder / "x.exr"}, 2, "give a name such as " + (folder / "x.acdf"));
    expect_refused({"local", sky, "-o", folder / "x.png"}, 2, "ends in .png");
    expect_refused({"brdf", "lambert", "-o", folder / "x.binary"}, 2, "ends in .binary");
    EXPECT_FALSE(fs::exists(folder / "x.exr"));
    EXPECT_EQ(run_acdf({"env", sky, "--cells", "20", "-o", "/dev/null", "-q"}).code, 0);
    EXPECT_EQ(run_acdf({"env", sky, "--cells", "20", "-o", folder / "named", "-q"}).code, 0);
}

TEST_F(Names, ModelsOfBrdfsAreWrittenAsSamplersAre) {
    for (const char* model : {"ggx:0.5", "ggx:alpha=0.5"})
        ASSERT_EQ(run_acdf({"brdf", model, "-o", folder / (std::string(model) + ".acdf"), "--budget", "4KiB",
                            "--views", "4", "-q"})
                      .code,
                  0)
            << model;
    EXPECT_EQ(
        run_acdf({"diff", folder / "ggx:0.5.acdf", folder / "ggx:alpha=0.5.acdf", "--tolerance", "0", "-q"}).code,
        0);
}

TEST_F(Names, HelpExplainsACommand) {
    EXPECT_EQ(run_acdf({"help", "env"}).out, run_acdf({"env", "--help"}).out);
    EXPECT_EQ(run_acdf({"help"}).out, run_acdf({"--help"}).out);
    expect_refused({"help", "enf"}, 2, "there is no command 'enf'; did you mean env?");
}

TEST_F(Names, SuggestsWhatWasLikelyMeant) {
    expect_refused({"vaildate", "x"}, 2, "there is no command 'vaildate'; did you mean validate?");
    expect_refused({"Local", "x"}, 2, "did you mean local?");
    expect_refused({"env", "x.exr", "--buget", "64KiB"}, 2, "did you mean --budget?");
    expect_refused({"env", "x.exr", "--filtr=bilinear"}, 2, "did you mean --filter?");
    expect_refused({"batch", "x", "-o", folder / "x", "--set", "env.cell=3"}, 2, "did you mean --cells?");
    const Result none = run_acdf({"transmogrify"});
    EXPECT_EQ(none.code, 2);
    EXPECT_EQ(none.err.find("did you mean"), std::string::npos) << none.err;
}

TEST(NearestName, IsTheOneOfFewestLetters) {
    using tools::nearest_name;
    const std::vector<std::string> names{"sample", "scanline", "sweep", "pdf", "plot"};
    EXPECT_EQ(nearest_name("smaple", names), "sample");
    EXPECT_EQ(nearest_name("SWEEP", names), "sweep");
    EXPECT_EQ(nearest_name("scan", names), "scanline");
    EXPECT_EQ(nearest_name("pfd", names), "pdf");
    EXPECT_EQ(nearest_name("", names), "");
    EXPECT_EQ(nearest_name("xyz", names), "");
    EXPECT_EQ(nearest_name(std::string(100000, 's'), names), "");
}

} // namespace
} // namespace acdf::test
