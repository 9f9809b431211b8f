// acdf batch as a user runs it: resume, failures, shards, Ninja.
#include "tests/tools/batch/command.h"
#include "tests/inputs/sanitized.h"

#include <cctype>
#include <csignal>
#include <cstdlib>
#include <random>
#include <thread>

namespace acdf::test {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

TEST_F(BatchCommand, MakesTheSameBytesAsTheSubcommands) {
    write_small_probes(probes + "/sub", 2);
    const json all =
        report({probes, "--kind", "env,local", "--set", "env.cells=50", "--set", "local.budget=12KiB"});
    EXPECT_EQ(all["done"], 4);
    EXPECT_EQ(files_in(out).size(), 4u);
    const std::string probe = probes + "/sub/probe001.pfm", one = folder / "one.acdf";
    ASSERT_EQ(run_acdf({"env", probe, "-o", one, "--cells", "50"}).code, 0);
    EXPECT_EQ(read_text(out + "/sub/probe001.acdf"), read_text(one));
    ASSERT_EQ(run_acdf({"local", probe, "-o", one, "--budget", "12288", "--force"}).code, 0);
    EXPECT_EQ(read_text(out + "/sub/probe001.local.acdf"), read_text(one));
    for (const json& job : all["jobs"]) {
        EXPECT_EQ(job["bytes"], fs::file_size(out + "/" + job["output"].get<std::string>()));
        EXPECT_GT(job["relative_variance"], 0.0);
        EXPECT_GE(job["seconds"], 0.0);
        EXPECT_TRUE(job["error"].is_null());
    }
}

TEST_F(BatchCommand, SkipsWhatIsUpToDateAndSaysWhyTheRestIsNot) {
    write_small_probes(probes, 6);
    const std::vector<std::string> run = {probes, "--set", "env.cells=40"};
    EXPECT_EQ(report(run)["done"], 6);
    EXPECT_EQ(report(run)["up_to_date"], 6);

    write_small_probe(probes + "/probe000.pfm", 99);           // another source
    fs::rename(probes + "/probe001.pfm", probes + "/new.pfm"); // another name
    fs::resize_file(out + "/probe002.acdf", 600);              // cut short
    std::string bytes = read_text(out + "/probe003.acdf");
    bytes[bytes.size() / 2] ^= 1;
    write_text(out + "/probe003.acdf", bytes); // damaged
    ASSERT_EQ(run_acdf({"env", probes + "/probe004.pfm", "-o", out + "/probe004.acdf", "-f", "--cells", "41"}).code,
              0);

    std::vector<std::string> dry = run;
    dry.push_back("--dry-run");
    std::map<std::string, std::string> reasons;
    for (const json& job : report(dry)) reasons[job["output"]] = job["reason"];
    EXPECT_EQ(reasons["probe000.acdf"], "its source changed");
    EXPECT_EQ(reasons["new.acdf"], "new");
    EXPECT_NE(reasons["probe002.acdf"].find("not valid"), std::string::npos) << reasons["probe002.acdf"];
    EXPECT_NE(reasons["probe003.acdf"].find("not valid"), std::string::npos) << reasons["probe003.acdf"];
    EXPECT_EQ(reasons["probe004.acdf"], "its options changed from --cells 41");
    EXPECT_EQ(reasons["probe005.acdf"], "up to date");

    const json again = report(run);
    EXPECT_EQ(again["done"], 5);
    EXPECT_EQ(again["up_to_date"], 1);
    for (const json& job : again["jobs"]) EXPECT_GT(job["relative_variance"], 0.0) << "also of what was skipped";
    std::vector<std::string> forced = run;
    forced.push_back("--force");
    EXPECT_EQ(report(forced)["done"], 6);
}

/// As often as nothing has changed it is skipped.
TEST_F(BatchCommand, MakesOneFileOfSeveralMaps) {
    write_small_probes(probes, 4);
    const std::string one = folder / "one.acdf";
    std::vector<std::string> env = {"env"};
    for (int i = 0; i < 4; ++i) env.push_back(probes + "/probe00" + std::to_string(i) + ".pfm");
    env.insert(env.end(), {"-o", one, "--budget", "3KiB", "--axis", "x=1,2", "--axis", "y=3,4"});
    ASSERT_EQ(run_acdf(env).code, 0);
    const std::string
        line = "{\"maps\": [\"probes/probe000.pfm\", \"probes/probe001.pfm\", \"probes/probe002.pfm\", "
               "\"probes/probe003.pfm\"], \"output\": \"a/maps.acdf\", \"options\": {\"budget\": \"3KiB\", "
               "\"axis\": [\"x=1,2\", \"y=3,4\"]}}\n",
        frames = "{\"maps\": [\"probes/probe###.pfm\"], \"output\": \"frames.acdf\"}\n";
    write_text(manifest, line + frames);
    EXPECT_EQ(report({manifest, "--gallery"})["done"], 2);
    EXPECT_EQ(read_text(out + "/a/maps.acdf"), read_text(one));
    EXPECT_NE(read_text(out + "/gallery.html").find("pdf of a/maps.acdf, its first map"), std::string::npos);
    const Files made = files_in(out);
    EXPECT_EQ(report({manifest})["up_to_date"], 2);

    write_small_probe(probes + "/probe002.pfm", 99);
    for (const json& job : report({manifest, "--dry-run"})) EXPECT_EQ(job["reason"], "its source changed");
    write_small_probe(probes + "/probe002.pfm", 2);
    write_small_probe(probes + "/probe004.pfm", 4); // a frame more
    EXPECT_EQ(report({manifest, "--dry-run"})[1]["reason"].get<std::string>().find("its options changed"), 0u);
    fs::remove(probes + "/probe004.pfm");

    ASSERT_EQ(batch({manifest, "--emit", "ninja"}).code, 0);
    if (std::system("command -v ninja >/dev/null") != 0) return;
    fs::remove_all(out + "/a");
    EXPECT_EQ(std::system(("ninja -C '" + out + "' a/maps.acdf >'" + (folder / "log") + "'").c_str()), 0)
        << read_text(folder / "log");
    EXPECT_EQ(read_text(out + "/a/maps.acdf"), made.at("a/maps.acdf"));
}

TEST_F(BatchCommand, OptionsAreComparedAsMeantNotAsSpelled) {
    ACDF_NOT_SANITIZED();
    write_small_probe((fs::create_directory(probes), probes + "/a.pfm"), 1);
    EXPECT_EQ(report({probes, "--set", "env.budget=2KiB"})["done"], 1);
    EXPECT_EQ(report({probes, "--set", "env.budget=2048"})["up_to_date"], 1);
    for (const char* other : {"env.filter=nearest", "env.channel=rgb", "env.compress=zlib",
                              "env.projection=latlong", "env.max-weight=50", "env.bad-pixels=clamp"}) {
        const std::vector<std::string> run = {probes, "--set", "env.budget=2048", "--set", other};
        EXPECT_EQ(report(run)["done"], 1) << other;
        EXPECT_EQ(report(run)["up_to_date"], 1) << other;
    }
    const std::vector<std::string> local = {probes, "--kind", "local", "--set", "local.budget=12KiB"};
    EXPECT_EQ(report(local)["done"], 1);
    EXPECT_EQ(report(local)["up_to_date"], 1);
    for (const char* other : {"local.normals=3", "local.tiles=9", "local.cosine-share=0.2"}) {
        std::vector<std::string> run = local;
        run.insert(run.end(), {"--set", other});
        EXPECT_EQ(report(run)["done"], 1) << other;
        EXPECT_EQ(report(run)["up_to_date"], 1) << other;
    }
}

TEST_F(BatchCommand, AChangedSceneIsAnotherOption) {
    write_small_probe((fs::create_directory(probes), probes + "/a.pfm"), 1);
    write_text(folder / "scene.txt", "0 0 1\n0 1 0\n");
    write_text(manifest, "{\"source\": \"probes/a.pfm\", \"kind\": \"local\", "
                         "\"options\": {\"budget\": \"12KiB\", \"scene\": \"scene.txt\"}}\n");
    EXPECT_EQ(report({manifest})["done"], 1);
    EXPECT_EQ(report({manifest})["up_to_date"], 1);
    write_text(folder / "scene.txt", "0 0 1\n1 0 0\n");
    EXPECT_EQ(report({manifest})["done"], 1);
}

/// Visibility of a scene, given by a manifest or by --set: the bytes of `acdf local`, again where the scene
/// changes.
TEST_F(BatchCommand, VisibilityIsThatOfTheScene) {
    write_small_probe((fs::create_directory(probes), probes + "/a.pfm"), 1);
    const std::string mesh = folder / "roof.obj",
                      roof = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv -1 -1 1\nv 1 -1 1\nv 1 0 1\nv -1 0 1\n"
                             "f 1 2 3 4\nf 5 6 7 8\n";
    write_text(mesh, roof);
    const std::string scene = folder / "roofs.instances"; // one of them elsewhere
    write_text(scene, "1 0 0 0 0 1 0 0 0 0 1 0 roof.obj\n-1 0 0 5 0 1 0 0 0 0 1 0 roof.obj\n");
    write_text(manifest,
               "{\"source\": \"probes/a.pfm\", \"kind\": \"local\", \"output\": \"a.local.acdf\", "
               "\"options\": {\"budget\": \"24KiB\", \"visibility\": true, \"scene\": \"roofs.instances\"}}\n");
    EXPECT_EQ(report({manifest})["done"], 1);
    EXPECT_EQ(report({manifest})["up_to_date"], 1);
    ASSERT_EQ(run_acdf({"local", probes + "/a.pfm", "-o", folder / "alone.acdf", "--budget", "24KiB",
                        "--visibility", "--scene", scene})
                  .code,
              0);
    const std::vector<std::string> set{probes,
                                       "--kind",
                                       "local",
                                       "--set",
                                       "local.budget=24KiB",
                                       "--set",
                                       "local.visibility",
                                       "--set",
                                       "local.scene=" + scene};
    EXPECT_EQ(report(set)["up_to_date"], 1); // the same options by another way
    EXPECT_EQ(read_text(folder / "alone.acdf"), read_text(folder / "out/a.local.acdf"));
    write_text(mesh, roof + "f 1 2 6 5\n");
    EXPECT_EQ(report({manifest})["done"], 1);
}

TEST_F(BatchCommand, GoesOnPastFailures) {
    write_small_probes(probes, 3);
    write_text(probes + "/broken.exr", "no image");
    fs::resize_file(probes + "/probe001.pfm", 200);
    write_text(manifest,
               "{\"source\": \"lambert\", \"options\": {\"views\": 4, \"budget\": \"16KiB\"}}\n"
               "{\"source\": \"probes/probe000.pfm\", \"options\": {\"budget\": 100}, \"output\": \"b.acdf\"}\n");
    const json all = report({probes, manifest}, 1);
    EXPECT_EQ(all["done"], 3);
    EXPECT_EQ(all["failed"], 3);
    EXPECT_EQ(lines_in(messages), 3u) << messages;
    for (const char* part : {"broken.exr: ", "probe001.pfm: ", "out of reach"})
        EXPECT_NE(messages.find(part), std::string::npos) << messages;
    EXPECT_EQ(files_in(out).size(), 3u) << "and no litter";
}

TEST_F(BatchCommand, SettingsForPatternsOfSources) {
    write_small_probes(probes + "/sun", 1);
    write_small_probes(probes + "/sky", 1);
    const json all = report({probes, "--set", "env.cells=40", "--set", "sun/*:env.cells=20"});
    EXPECT_EQ(all["done"], 2);
    const auto cells = [&](const std::string& name) {
        return json::parse(run_acdf({"info", "--json", out + name}).out)["cells"].get<int>();
    };
    EXPECT_LE(cells("/sun/probe000.acdf"), 20);
    EXPECT_GT(cells("/sky/probe000.acdf"), 20);
    for (const char* wrong : {"env", ":env.cells=3", "*:tables.cells=3", "*:env.", "*:env.--cells=3"})
        EXPECT_EQ(batch({probes, "--set", wrong}).code, 2) << wrong;
}

TEST_F(BatchCommand, SaysWhatToWriteForSourcesOfUnknownKind) {
    fs::create_directories(probes);
    std::ofstream square(probes + "/disc.pfm", std::ios::binary); // black corners: an angular map or a mirror ball
    square << "PF\n32 32\n-1.0\n";
    for (int i = 0; i < 32 * 32 * 3; ++i) {
        const int x = i / 3 % 32 - 16, y = i / 96 - 16;
        const float value = x * x + y * y < 230 ? 1.0f : 0.0f;
        square.write(reinterpret_cast<const char*>(&value), sizeof value);
    }
    square.close();
    report({probes}, 1);
    EXPECT_NE(messages.find("--set 'angular/*:env.projection=angular'"), std::string::npos) << messages;
    EXPECT_EQ(report({probes, "--set", "d*:env.projection=angular"})["done"], 1);
    report({probes, "--kind", "local", "--set", "local.budget=12KiB"}, 1);
    EXPECT_NE(messages.find("--set 'angular/*:local.projection=angular'"), std::string::npos) << messages;
    EXPECT_NE(messages.find("\"kind\": \"local\""), std::string::npos) << messages;
    EXPECT_EQ(report({probes, "--kind", "local", "--set", "local.budget=12KiB", "--set",
                      "d*:local.projection=angular"})["done"],
              1);
}

/// A remark on several sources is one line at the end of the table, and none with --quiet.
TEST_F(BatchCommand, RemarksEndTheTableOnceAKind) {
    fs::create_directories(probes);
    for (const int bad : {1, 2, 3, 0}) write_mended_probe(probes + "/bad" + std::to_string(bad) + ".pfm", bad);
    const Result result =
        batch({probes, "--kind", "env,local", "--set", "env.cells=20", "--set", "local.budget=12KiB"});
    ASSERT_EQ(result.code, 0) << result.err;
    const auto probe = [&](int bad) { return probes + "/bad" + std::to_string(bad) + ".pfm"; };
    const std::string what = " negative texels set to 0",
                      remark = probe(1) + ", " + probe(2) + ", " + probe(3) + ": 0 NaN, 0 infinite and 1" + what;
    EXPECT_NE(result.out.find(remark), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("(numbers of " + probe(1) + ")"), std::string::npos) << result.out;
    EXPECT_GT(result.out.find(remark), result.out.find("noise at 16, 64, 256"));
    EXPECT_EQ(result.out.find(what), result.out.rfind(what)) << result.out;
    EXPECT_EQ(batch({probes, "--force", "--quiet"}).out, "");
}

/// The same in reports, also once they are merged, and in those of the subcommands.
TEST_F(BatchCommand, RemarksAreInReports) {
    fs::create_directories(probes);
    write_mended_probe(probes + "/bad.pfm", 1);
    const std::string what = "1 negative texels set to 0", path = folder / "report.json";
    const json all = report({probes});
    EXPECT_NE(all["jobs"][0]["notes"].dump().find(what), std::string::npos) << all;
    write_text(path, all.dump());
    EXPECT_NE(run_acdf({"batch", "--merge-reports", path}).out.find(what), std::string::npos);
    for (const char* kind : {"env", "local"}) {
        const Result one = run_acdf({kind, probes + "/bad.pfm", "-o", folder / "one.acdf", "--force", "--json"});
        ASSERT_EQ(one.code, 0) << one.err;
        EXPECT_NE(json::parse(one.out)["notes"].dump().find(what), std::string::npos) << one.out;
    }
}

TEST_F(BatchCommand, RunningOutOfMemoryIsAFailureLikeOthers) {
    if (acdf_test::kSanitized) GTEST_SKIP() << "sanitizers reserve all address space";
    write_small_probes(probes, 2, 16);
    std::vector<int> sizes; // of address space, in KiB
    for (int kib = 40000; kib < 100000; kib += 3000) sizes.push_back(kib);
    for (int kib = 100000; kib <= 1000000; kib += 100000) sizes.push_back(kib);
    for (const int kib : sizes)
        for (const char* threads : {"1", "8"}) {
            const std::string run = "ulimit -c 0; ulimit -v " + std::to_string(kib) + "; exec timeout 60 '" +
                                    acdf_test::kProgram + "' batch '" + probes + "' -o '" + out +
                                    "' -f -q --threads " + threads + " >/dev/null 2>'" + (folder / "err") + "'";
            const int status = std::system(run.c_str());
            ASSERT_TRUE(WIFEXITED(status)) << run;
            const int code = WEXITSTATUS(status); // 127: not even the program's own libraries are loaded
            EXPECT_TRUE(code <= 1 || code == 127) << code << ": " << run << ": " << read_text(folder / "err");
            if (kib >= 500000) {
                EXPECT_EQ(code, 0) << run << ": " << read_text(folder / "err");
            }
        }
}

TEST_F(BatchCommand, ABuildFileHoldsNoNameOfTwoLines) {
    write_small_probes(folder / "two\nlines", 1);
    const Result result = batch({folder / "two\nlines", "--emit", "ninja"});
    EXPECT_EQ(result.code, 1);
    EXPECT_EQ(lines_in(result.err), 1u) << result.err;
    EXPECT_NE(result.err.find("has a line end in its name"), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(out + "/build.ninja"));
}

TEST_F(BatchCommand, PicturesOfRendersAreNoProbes) {
    write_small_probes(probes, 1);
    for (const char* name : {"/render.json", "/full.png"}) write_text(probes + name, "{}");
    write_text(probes + "/full.exr", "a picture");
    const json all = report({probes});
    EXPECT_EQ(all["done"], 1);
    EXPECT_EQ(all["failed"], 0);
}

TEST_F(BatchCommand, TheSummaryHasARowAFile) {
    write_small_probes(probes, 2);
    const Result result = batch({probes});
    for (const char* part : {"file ", "probe000.acdf ", "probe001.acdf ", "env "})
        EXPECT_NE(result.out.find(part), std::string::npos) << result.out;
}

TEST_F(BatchCommand, RefusalsOfOneKindAreOneLine) {
    write_text(manifest, "{\"source\": \"a.pfm\"}\n{\"source\": \"a.pfm\", \"output\": \"b.acdf\"}\n");
    const Result result = batch({manifest});
    EXPECT_EQ(result.code, 1);
    EXPECT_EQ(lines_in(result.err), 1u) << result.err;
    EXPECT_NE(result.err.find("library.jsonl:1, "), std::string::npos) << result.err;
}

TEST_F(BatchCommand, KeepsWithinMemory) {
    write_small_probes(probes, 2);
    write_small_probe(probes + "/large.pfm", 1, 400);
    const json all = report({probes, "--memory", "17MiB", "--set", "env.cells=50"}, 1);
    EXPECT_EQ(all["done"], 2);
    EXPECT_EQ(all["failed"], 1);
    EXPECT_NE(messages.find("large.pfm: needs about"), std::string::npos) << messages;
}

TEST_F(BatchCommand, FilesAreTheSameForAnyThreadsAndJobs) {
    if (acdf_test::kSanitized)
        GTEST_SKIP() << "tests/same_bytes.sh runs sanitized programs on any number of threads";
    const std::uint32_t count = 5;
    write_small_probes(probes, count, 16);
    const std::vector<std::string> run = {probes, "--kind", "env,local", "--set", "local.budget=12KiB", "--force"};
    Files expected;
    for (const auto& [threads, jobs] : {std::pair{"1", "1"}, {"4", "1"}, {"3", "3"}, {"2", "7"}}) {
        std::vector<std::string> arguments = run;
        arguments.insert(arguments.end(), {"--threads", threads, "--jobs", jobs});
        EXPECT_EQ(report(arguments)["done"], 2 * count);
        EXPECT_EQ(messages, "");
        if (expected.empty()) expected = files_in(out);
        else EXPECT_EQ(files_in(out), expected) << threads << " threads, " << jobs << " jobs";
    }
}

TEST_F(BatchCommand, ShardsTogetherAreTheWholeAndReportsMerge) {
    write_small_probes(probes, 9);
    std::vector<std::string> merge = {"batch", "--merge-reports", "--json"};
    for (const char* shard : {"1/3", "2/3", "3/3"}) {
        const std::string path = folder / ("report" + std::string(1, shard[0]) + ".json");
        write_text(path, report({probes, "--set", "env.cells=40", "--shard", shard}).dump());
        merge.push_back(path);
    }
    EXPECT_EQ(report({probes, "--set", "env.cells=40"})["up_to_date"], 9);
    const Result whole = run_acdf(merge);
    EXPECT_EQ(whole.code, 0) << whole.err;
    EXPECT_EQ(json::parse(whole.out)["done"], 9);
    merge.pop_back();
    const Result part = run_acdf(merge);
    EXPECT_EQ(part.code, 1);
    EXPECT_NE(part.err.find("shard 3/3 has no report"), std::string::npos) << part.err;
}

TEST_F(BatchCommand, KilledAtAnyTimeItEndsWithTheSameBytes) {
    const std::size_t share = acdf_test::kSanitized ? 6 : 15; // of the files, until a kill
    write_small_probes(probes, static_cast<std::uint32_t>(10 * share / 3));
    std::vector<std::string> run = {probes, "--kind", "env,local"};
    for (const char* set : {"env.cells=40", "local.budget=8KiB", "local.normals=2"})
        run.insert(run.end(), {"--set", set});
    std::vector<std::string> arguments = run;
    arguments.insert(arguments.begin(), "batch");
    const auto with_output = [&](const std::string& path) {
        std::vector<std::string> all = arguments;
        all.insert(all.end(), {"-o", path, "--quiet"});
        return all;
    };
    ASSERT_EQ(run_acdf(with_output(folder / "undisturbed")).code, 0);

    std::mt19937 random(2005);
    const std::size_t jobs = 20 * share / 3;
    for (int kill_number = 1; kill_number <= 5; ++kill_number) {
        const pid_t pid = start_acdf(with_output(out), "/dev/null", folder / "stdout", folder / "stderr");
        ASSERT_GT(pid, 0);
        // By progress, not by the clock: after some share of the files that are still missing.
        std::size_t at_most = share * static_cast<std::size_t>(kill_number) + random() % (2 * share / 3);
        while (true) {
            std::size_t made = 0;
            std::error_code ignored;
            for (fs::directory_iterator i(out, ignored), end; !ignored && i != end; i.increment(ignored)) ++made;
            if (made >= at_most) break;
            ASSERT_EQ(kill(pid, 0), 0);
            std::this_thread::sleep_for(std::chrono::microseconds(200 + random() % 2000));
        }
        kill(pid, SIGKILL);
        ASSERT_EQ(wait_for(pid), 128 + SIGKILL) << "it ended before it was killed";
        EXPECT_LT(files_in(out).size(), jobs + 50);
    }
    // What a kill leaves behind, made certain.
    write_text(out + "/.acdf-aB3xY9.acdf", "half a file");
    const Result last = run_acdf(with_output(out));
    ASSERT_EQ(last.code, 0) << last.err;
    const Files files = files_in(out), expected = files_in(folder / "undisturbed");
    EXPECT_EQ(files.size(), jobs);
    EXPECT_TRUE(files == expected);
}

TEST_F(BatchCommand, TheBuildFileQuotesWhatItMust) {
    const std::string odd = probes + "/it's a $kind: sky";
    write_small_probes(odd, 1);
    const Result result = batch({probes, "--emit", "ninja", "--set", "env.cells=40"});
    ASSERT_EQ(result.code, 0) << result.err;
    const std::string text = read_text(out + "/build.ninja");
    EXPECT_NE(text.find("build it's$ a$ $$kind$:$ sky/probe000.acdf: convert "), std::string::npos) << text;
    EXPECT_NE(text.find("'\\''s a $$kind: sky/probe000.pfm'"), std::string::npos) << text;
    const std::string bar = probes + "/a|b";
    write_small_probes(bar, 1);
    ASSERT_EQ(batch({probes, "--emit", "ninja", "--set", "env.cells=40"}).code, 0);
    if (std::system("command -v ninja >/dev/null") == 0) {
        EXPECT_EQ(std::system(("ninja -C '" + out + "' >'" + (folder / "log") + "'").c_str()), 0)
            << read_text(folder / "log");
        EXPECT_TRUE(fs::exists(out + "/a|b/probe000.acdf"));
        EXPECT_TRUE(fs::exists(out + "/it's a $kind: sky/probe000.acdf"));
    }
    write_text(out + "/build.ninja", "rule mine\n");
    EXPECT_EQ(batch({probes, "--emit", "ninja"}).code, 1);
    EXPECT_EQ(batch({probes, "--emit", "ninja", "--force"}).code, 0);
}

} // namespace
} // namespace acdf::test
