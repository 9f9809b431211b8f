// What acdf batch refuses before it starts: manifests, settings and outputs that are wrong, each with one line.
#include "tests/inputs/sanitized.h"
#include "tests/tools/batch/command.h"

namespace acdf::test {
namespace {

namespace fs = std::filesystem;

TEST_F(BatchCommand, RefusesManifestsBeforeAnythingStarts) {
    write_small_probe((fs::create_directory(probes), probes + "/a.pfm"), 1);
    const std::string good = "{\"source\": \"probes/a.pfm\"}\n", at2 = manifest + ":2: ";
    expect_refused(good + "{\"source\": \"probes/a.pfm\", \"colour\": 1}\n", at2 + "has an unknown key 'colour'");
    expect_refused(good + "{\"source\": []}\n", at2 + "'source' must be one file, or six");
    expect_refused(good + good, at2 + "is the same job as " + manifest + ":1; leave");
    expect_refused(good + "{\"source\": \"probes/a.pfm\", \"output\": \"./a.acdf\"}\n", at2 + "is the same job");
    expect_refused(good + "{\"source\": \"probes/a.pfm\", \"options\": {\"cells\": 5}}\n",
                   at2 + "writes a.acdf, as does " + manifest + ":1; give");
    expect_refused(good + "{\"source\": \"probes/b.pfm\"}\n", at2 + "there is no file");
    expect_refused(good + "{\"source\": \"probes\"}\n", at2);
    expect_refused(good + "{\"source\": \"\xff\"}\n", at2 + "is not UTF-8");
    expect_refused(good + "{\"source\": \"probes/a.pfm\", \"output\": \"../a.acdf\"}\n", at2);
    expect_refused(good + "{\"source\": \"probes/a.pfm\", \"output\": \"a.acdf/b.acdf\"}\n", at2);
    expect_refused(good + "{\"source\": \"probes/a.pfm\", \"output\": \"b.acdf\", \"options\": {\"cell\": 5}}\n",
                   at2 + "options of env: ");
    expect_refused(good + "{\"source\": \"probes/a.pfm\", \"output\": \"b.acdf\", \"options\": {\"threads\": 5}}\n",
                   at2 + "options of env: ");
    expect_refused(good + "{\"source\": \"probes/a.pfm\", \"output\": \"b.acdf\", "
                          "\"options\": {\"cells\": 5, \"budget\": \"1KiB\"}}\n",
                   at2 + "options of env: ");
    expect_refused(good + "{\"source\": \"probes/a.pfm\", \"kind\": \"local\", \"options\": {\"tiles\": true}}\n",
                   at2 + "options of local: --tiles: needs a value");
    const std::string two = "{\"maps\": [\"probes/a.pfm\", \"probes/a.pfm\"], \"output\": \"m.acdf\"";
    expect_refused(good + two + "}\n",
                   at2 + "options of env: several maps in one file are for env, and need an axis");
    expect_refused(good + two + ", \"options\": {\"axis\": \"time=1,2,3\"}}\n", at2 + "options of env: --axis");
    expect_refused(good + two + ", \"kind\": \"local\"}\n", at2 + "options of local: several maps");
    expect_refused(good + "{\"maps\": [\"probes/a.##.pfm\"], \"output\": \"m.acdf\"}\n", at2);
    expect_refused("\n", "has no jobs");
}

TEST_F(BatchCommand, ReportsTheOneWrongLineOfHundredThousand) {
    fs::create_directory(probes);
    write_small_probe(probes + "/a.pfm", 1);
    std::string text;
    const int lines = acdf_test::kSanitized ? 10000 : 100000, wrong = lines - 1;
    for (int i = 1; i <= lines; ++i)
        text += "{\"source\":\"probes/a.pfm\",\"output\":\"" + std::to_string(i == wrong ? 5 : i) + ".acdf\"}\n";
    expect_refused(text, manifest + ":" + std::to_string(wrong) + ": is the same job as " + manifest + ":5");
}

TEST_F(BatchCommand, OutputsDoNotFollowLinksOut) {
    write_small_probe((fs::create_directory(probes), probes + "/a.pfm"), 1);
    fs::create_directory(out);
    fs::create_directory(folder / "elsewhere");
    fs::create_directory_symlink(folder / "elsewhere", out + "/link");
    fs::create_symlink(folder / "elsewhere/new", out + "/file.acdf");
    for (const char* name : {"link/a.acdf", "file.acdf"}) {
        write_text(manifest, std::string("{\"source\": \"probes/a.pfm\", \"output\": \"") + name + "\"}\n");
        const Result result = batch({manifest});
        EXPECT_EQ(result.code, 1);
        EXPECT_NE(result.err.find("symbolic link"), std::string::npos) << result.err;
    }
    EXPECT_TRUE(fs::is_empty(folder / "elsewhere"));
}

TEST_F(BatchCommand, DoesNotReplaceFilesThatAreNotItsOwn) {
    write_small_probes(probes, 2);
    fs::create_directory(out);
    write_text(out + "/probe001.acdf", "my notes");
    const Result result = batch({probes});
    EXPECT_EQ(result.code, 1);
    EXPECT_NE(result.err.find("is not an .acdf file"), std::string::npos) << result.err;
    EXPECT_EQ(files_in(out).size(), 1u);
    EXPECT_EQ(batch({probes, "--force"}).code, 0);
    EXPECT_EQ(files_in(out).size(), 2u);
}

TEST_F(BatchCommand, TwoSourcesOfOneOutputAreRefused) {
    write_small_probe((fs::create_directory(probes), probes + "/a.pfm"), 1);
    fs::copy_file(probes + "/a.pfm", probes + "/a.hdr");
    const Result result = batch({probes});
    EXPECT_EQ(result.code, 1);
    EXPECT_NE(result.err.find("a.pfm: writes a.acdf, as does"), std::string::npos) << result.err;
    const Result twice = batch({probes + "/a.pfm", probes + "/a.pfm"});
    EXPECT_EQ(twice.code, 1);
    EXPECT_NE(twice.err.find("a.pfm: is given twice"), std::string::npos) << twice.err;
    EXPECT_FALSE(fs::exists(out));
    EXPECT_EQ(batch({probes + "/*.pfm"}).code, 0) << "a glob";
    EXPECT_EQ(batch({probes + "/*.png"}).code, 1);
}

TEST_F(BatchCommand, LinksInACircleAreNoSources) {
    write_small_probe((fs::create_directory(probes), probes + "/a.pfm"), 1);
    fs::create_symlink("circle", probes + "/circle");
    fs::create_directory_symlink("../probes", probes + "/self");
    EXPECT_EQ(batch({probes}).code, 0);
    EXPECT_EQ(files_in(out).size(), 1u);
    fs::create_symlink("b.pfm", probes + "/b.pfm");
    const Result result = batch({probes});
    EXPECT_EQ(result.code, 1);
    EXPECT_EQ(lines_in(result.err), 1u) << result.err;
    EXPECT_EQ(result.err.rfind("acdf: " + probes + "/b.pfm: ", 0), 0u) << result.err;
}

TEST_F(BatchCommand, AFolderThatCannotBeMadeIsNamed) {
    write_small_probe((fs::create_directory(probes), probes + "/a.pfm"), 1);
    for (const std::string& wrong : {std::string("/proc/acdf/out"), probes + "/a.pfm/out"})
        for (const char* way : {"--gallery", "--emit=ninja"}) {
            const Result result = run_acdf({"batch", probes, "-o", wrong, way});
            EXPECT_EQ(result.code, 1);
            EXPECT_EQ(result.err.rfind("acdf: " + wrong, 0), 0u) << result.err;
            EXPECT_EQ(lines_in(result.err), 1u) << result.err;
        }
}

TEST_F(BatchCommand, WrongUsageIsReported) {
    write_small_probe((fs::create_directory(probes), probes + "/a.pfm"), 1);
    for (const std::vector<std::string>& wrong : {std::vector<std::string>{probes, "--shard", "0/3"},
                                                  {probes, "--shard", "slurm"},
                                                  {probes, "--memory", "much"},
                                                  {probes, "--set", "env.colour=1"},
                                                  {probes, "--set", "env"},
                                                  {probes, "--kind", "brdf"},
                                                  {probes, "--emit", "make"},
                                                  {probes, "--emit", "ninja", "--json"},
                                                  {}}) {
        const Result result = batch(wrong);
        EXPECT_EQ(result.code, 2) << result.err;
        EXPECT_EQ(lines_in(result.err), 1u) << result.err;
    }
}

} // namespace
} // namespace acdf::test
