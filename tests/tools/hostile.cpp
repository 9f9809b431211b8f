// Names, texts and inputs that are made to hurt: each gets one line, an exit code, and no time.
#include "tests/tools/run.h"

#include "tools/cli/messages.h"
#include "tools/cli/progress.h"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <fstream>

#include <sys/stat.h>

using namespace acdf::test;
using nlohmann::json;

namespace {

/// 8 x 4 texels, of which one is bright, as a portable float map.
void write_probe(const std::string& path, int columns = 8, int rows = 4) {
    std::ofstream file(path, std::ios::binary);
    file << "PF\n" << columns << ' ' << rows << "\n-1.0\n";
    for (int i = 0; i < columns * rows * 3; ++i) {
        const float value = i < 3 ? 9.0f : 1.0f;
        file.write(reinterpret_cast<const char*>(&value), sizeof value);
    }
}

class Hostile : public testing::Test {
protected:
    Folder folder;
    const std::string probe = folder / "probe.pfm", file = folder / "probe.acdf";
    void SetUp() override { write_probe(probe); }

    void expect_failure(const std::vector<std::string>& command, int code, const std::string& part,
                        const std::string& input = "") {
        const Result result = run_acdf(command, input);
        EXPECT_EQ(result.code, code) << command[0] << ": " << result.err;
        EXPECT_EQ(lines_in(result.err), 1u) << result.err;
        EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
    }
};

TEST(Printable, LeavesTextAndEscapesTheRest) {
    using acdf::tools::printable;
    EXPECT_EQ(printable("a b\tc\n"), "a b\tc\n");
    EXPECT_EQ(printable("na\xc3\xafve \xe2\x82\xac \xf0\x9f\x98\x80"),
              "na\xc3\xafve \xe2\x82\xac \xf0\x9f\x98\x80");
    EXPECT_EQ(printable("\x1b[31m\x07\x7f\r"), "\\x1b[31m\\x07\\x7f\\x0d");
    EXPECT_EQ(printable("\xc2\x9b"
                        "2J"),
              "\\xc2\\x9b2J")
        << "the one-byte form of ESC [";
    EXPECT_EQ(printable("\xff\xc3"), "\\xff\\xc3");
    EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "a surrogate";
    EXPECT_EQ(acdf::tools::on_one_line("a\nb\n\n"), "a b");
}

TEST(Printable, EscapesWhatTurnsTextOrEndsLines) {
    using acdf::tools::printable;
    EXPECT_EQ(printable("a\u202Efdca.exe"), "a\\xe2\\x80\\xaefdca.exe");
    for (const char* one : {"\u0085", "\u061C", "\u200E", "\u200F", "\u2028", "\u2029", "\u202A", "\u202B",
                            "\u202C", "\u202D", "\u202E", "\u2066", "\u2067", "\u2068", "\u2069"}) {
        EXPECT_EQ(printable(one).find(one), std::string::npos) << printable(one);
        const std::string escaped = acdf::tools::printable_json("[\"" + std::string(one) + "\"]");
        EXPECT_EQ(escaped.find(one), std::string::npos) << escaped;
        EXPECT_EQ(json::parse(escaped)[0], one);
    }
    const std::string hebrew = "\u05E9\u05DE\u05E9 \u200B\u2027\u202F\u2065\u206A \U0001F31E.exr";
    EXPECT_EQ(printable(hebrew), hebrew) << "letters of any script";
    EXPECT_EQ(acdf::tools::printable_json(hebrew), hebrew);
}

TEST(TimeLeft, IsShownOnceItIsKnown) {
    using acdf::tools::time_left;
    EXPECT_EQ(time_left(0.0, 3.0), "");
    EXPECT_EQ(time_left(0.01, 3.0), "");
    EXPECT_EQ(time_left(0.5, 3.0), ", 3 s left");
    EXPECT_EQ(time_left(0.1, 10.0), ", 1:30 min left");
    EXPECT_EQ(time_left(0.1, 1000.0), ", 2:30 h left");
}

TEST_F(Hostile, NamesThatAreNotUtf8) {
    const std::string odd = folder / "odd\xff\x1b[31m.pfm";
    write_probe(odd);
    const Result made = run_acdf({"env", odd, "-o", file, "--json"});
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_EQ(json::parse(made.out)["source"], folder / "odd\xef\xbf\xbd\x1b[31m.pfm");
    EXPECT_EQ(made.err.find('\x1b'), std::string::npos) << made.err;
    EXPECT_NE(made.err.find("odd\\xff\\x1b[31m.pfm"), std::string::npos) << made.err;
    const Result info = run_acdf({"info", file});
    EXPECT_EQ(info.code, 0);
    EXPECT_EQ(info.out.find('\x1b'), std::string::npos) << info.out;
    EXPECT_EQ(run_acdf({"validate", file}).code, 0);
    const Result odd_output = run_acdf({"env", probe, "-o", folder / "o\xff.acdf", "--json"});
    EXPECT_EQ(odd_output.code, 0) << odd_output.err;
    EXPECT_FALSE(json::parse(odd_output.out, nullptr, false).is_discarded());
}

TEST_F(Hostile, NamesThatTurnTheLine) {
    const std::string turn = "\u202E", separator = "\u2028", odd = folder / ("a" + turn + "b" + separator + ".pfm");
    write_probe(odd);
    const auto expect_plain = [&](const std::vector<std::string>& command) {
        const Result result = run_acdf(command);
        EXPECT_EQ(result.code, 0) << command[0] << ": " << result.err;
        for (const std::string& text : {result.out, result.err})
            for (const std::string& mark : {turn, separator})
                EXPECT_EQ(text.find(mark), std::string::npos) << command[0] << ": " << text;
        return result.out;
    };
    const std::string out = folder / ("made" + turn + separator + ".acdf"),
                      name = "a" + turn + "b" + separator + ".pfm";
    EXPECT_EQ(json::parse(expect_plain({"env", odd, "-o", out, "--json"}))["source"], odd);
    expect_plain({"env", odd, "-o", out, "-f"});
    EXPECT_EQ(json::parse(expect_plain({"info", out, "--json"}))["source"]["name"], name);
    expect_plain({"info", out});
    expect_plain({"validate", out});
    expect_plain({"measure", out, "--against", odd});
    expect_plain({"local", odd, "-o", folder / "local.acdf"});
    expect_plain({"batch", odd, "-o", folder / ("batch" + turn)});
    expect_plain({"batch", odd, "-o", folder / ("batch" + turn), "--dry-run"});
    expect_plain({"batch", odd, "-o", folder / ("ninja" + turn), "--emit", "ninja"});
    expect_plain({"sweep", odd, "-o", folder / ("sweep" + turn), "--files", "env", "--budgets", "1KiB"});
    expect_plain({"demo", odd, "-o", folder / ("demo" + turn)});
}

TEST_F(Hostile, InputsWithoutAnEnd) {
    const std::string pipe = folder / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    ASSERT_EQ(run_acdf({"env", probe, "-o", file, "-q"}).code, 0);
    for (const std::string& input : {pipe, std::string("/dev/zero")}) {
        const std::string out = folder / "out.acdf";
        for (const std::vector<std::string>& command :
             std::vector<std::vector<std::string>>{{"info", input},
                                                   {"validate", input},
                                                   {"env", input, "-o", out},
                                                   {"local", input, "-o", out},
                                                   {"local", probe, "-q", "--scene", input, "-o", out},
                                                   {"table", input, "-o", out},
                                                   {"brdf", input, "-o", out},
                                                   {"measure", file, "--against", input},
                                                   {"plot", input, "-o", folder / "out.png"},
                                                   {"render", "--scene", input, "-o", folder / "rendered"},
                                                   {"pdf", file, input}})
            expect_failure(command, 1, "is a pipe or a device");
    }
    expect_failure({"pdf", file}, 1, "longer than 65536 characters", std::string(70000, '1'));
    expect_failure({"info", "-"}, 1, "not an .acdf file", std::string(1 << 20, '\0'));
}

TEST_F(Hostile, RadianceBeyondFloatsIsReportedWithItsFile) {
    const std::string bright = folder / "bright.pfm";
    std::ofstream(bright, std::ios::binary) << "PF\n2 1\n-1.0\n" << std::string(24, '\x7F'); // 3.4e38 each
    expect_failure({"env", bright, "--channel", "rgb", "-o", file}, 1, "bright.pfm: the channels of the radiance");
    std::ofstream(bright, std::ios::binary) << "PF\n1 1\n-1.0\n" << std::string(12, '\x7F');
    for (const char* projection : {"angular", "octahedral"})
        expect_failure(
            {"env", bright, "--channel", "rgb", "--domain", "octahedral", "--projection", projection, "-o", file},
            1, "bright.pfm: the channels of the radiance");
}

TEST_F(Hostile, ReportsOfFilesWithoutVarianceHaveNumbersAlone) {
    const std::string even = folder / "even.pfm";
    write_probe(even, 1, 1);
    ASSERT_EQ(run_acdf({"local", even, "--projection", "latlong", "--budget", "8KiB", "-o", file, "-q"}).code, 0);
    for (const std::vector<std::string>& form : std::vector<std::vector<std::string>>{{}, {"--json"}}) {
        std::vector<std::string> words{"measure", file, "--against", even, "--projection", "latlong", "-q"};
        words.insert(words.end(), form.begin(), form.end());
        const Result result = run_acdf(words);
        EXPECT_EQ(result.code, 0) << result.err;
        for (const char* none : {"-nan", " nan", "null"})
            EXPECT_EQ(result.out.find(none), std::string::npos) << result.out;
    }
}

TEST_F(Hostile, CommandsThatFailLeaveNoFolder) {
    const std::string scene = folder / "scene.json", out = folder / "a/b";
    std::ofstream(scene) << R"({"camera": {"from": [3, 0, 1], "to": [0, 0, 0], "fov": 40},
        "image": {"width": 2, "height": 2}, "light": {"built_in": "sky"},
        "objects": [{"sphere": {"centre": [0, 0, 0], "radius": 1}, "brdf": "lambert"}],
        "samples": 1, "samplers": ["portals"]})";
    expect_failure({"render", "--scene", scene, "-o", out, "-q"}, 1, "the scene has no portals");
    const std::vector<std::string> words{"sweep", probe, "--files", "env", "--budgets", "1", "-q", "-o"};
    const auto fails = [&](const std::string& to) {
        std::vector<std::string> all = words;
        all.push_back(to);
        expect_failure(all, 1, "none of the sizes can be made");
    };
    fails(out);
    EXPECT_EQ(folder.entries(), 2u); // the probe and the scene
    ASSERT_EQ(mkdir((folder / "a").c_str(), 0700), 0);
    fails(folder / "a");
    EXPECT_EQ(folder.entries(), 3u); // the folder was there before
}

TEST_F(Hostile, DamagedPicturesAreReportedInOneLine) { // and not by libpng, too
    ASSERT_EQ(run_acdf({"env", probe, "-o", file, "-q"}).code, 0);
    const std::string picture = folder / "probe.png", damaged = folder / "damaged.png", out = folder / "out.acdf";
    ASSERT_EQ(run_acdf({"plot", file, "-o", picture, "-q", "--no-legend", "--width", "64"}).code, 0);
    const std::string bytes = read_text(picture);
    const auto write = [&](const std::string& text) { std::ofstream(damaged, std::ios::binary) << text; };
    // libpng leaves functions of OpenImageIO behind by longjmp, and what they have allocated.
    const char* const options = std::getenv("ASAN_OPTIONS");
    const std::string before = options ? options : "";
    setenv("ASAN_OPTIONS", (before + ":detect_leaks=0").c_str(), 1);
    write(bytes.substr(0, bytes.size() - 100)); // of the pixels, which are last
    expect_failure({"env", damaged, "-q", "-o", out}, 1, "damaged.png: its pixels cannot be read");
    setenv("ASAN_OPTIONS", before.c_str(), 1);
    // Between IHDR and the rest a text with a wrong checksum, of which libpng warns.
    write(bytes.substr(0, 33) + std::string("\0\0\0\3tEXta\0b1234", 15) + bytes.substr(33));
    const Result made = run_acdf({"env", damaged, "-q", "-o", out});
    EXPECT_EQ(made.code, 0);
    EXPECT_EQ(made.err, "");
}

TEST_F(Hostile, NamesOfChoicesAreListed) {
    expect_failure({"env", probe, "--fit", "spline", "-o", file}, 2,
                   "'spline' is none of cdf, pdf, uniform, variance");
    expect_failure({"env", probe, "--fit", "2", "-o", file}, 2, "'2' is none of");
    expect_failure({"env", probe, "--compress", "1", "-o", file}, 2, "'1' is none of");
    expect_failure({"env", probe, "--on-black", "true", "-o", file}, 2, "'true' is none of error, uniform");
}

TEST_F(Hostile, OptionsOfOtherFitsAreRefused) {
    for (const char* order : {"phi", "z"})
        expect_failure({"env", probe, "--order", order, "-o", file}, 2,
                       "--order: is for --fit uniform, cdf and pdf");
    expect_failure({"env", probe, "--shape", "cascade", "-o", file}, 2, "--shape");
    expect_failure({"env", probe, "--fit", "cdf", "--cells", "9", "-o", file}, 2, "--cells: is for --fit variance");
    EXPECT_EQ(run_acdf({"env", probe, "--fit", "cdf", "--order", "z", "-o", file, "-q"}).code, 0);
}

TEST_F(Hostile, RefusedListsSayHowTheyAreWritten) {
    for (const char* normal : {"0 0 1", "0,1", "1"})
        expect_failure({"plot", file, "-o", folder / "n.png", "--normal", normal}, 2,
                       "--normal: needs 3 numbers with commas between them; see");
    expect_failure({"plot", file, "-o", folder / "n.png", "--position", "1,2"}, 2, "--position: needs 3 numbers");
}

TEST_F(Hostile, OptionsWithoutAnEffectAreRefused) {
    ASSERT_EQ(run_acdf({"env", probe, "-o", file, "-q"}).code, 0);
    expect_failure({"measure", file, "--against", probe, "--baselines"}, 2, "--baselines");
    expect_failure({"measure", file, "--against", probe, "--normals", "7"}, 2, "--normals");
    expect_failure({"measure", file, "--against", probe, "--views", "7"}, 2, "--views");
    const std::string brdf = folder / "b.acdf";
    ASSERT_EQ(run_acdf({"brdf", "ggx:alpha=0.5", "--budget", "4KiB", "--views", "4", "-o", brdf, "-q"}).code, 0);
    for (const std::string option : {"--projection=latlong", "--bad-pixels=clamp", "--on-black=uniform"})
        expect_failure({"measure", brdf, "--against", "ggx:alpha=0.5", option}, 2, option.substr(0, 5));
    const std::string png = folder / "p.png";
    expect_failure({"plot", brdf, "-o", png, "--position", "0,0,0"}, 2, "--position");
    expect_failure({"plot", brdf, "-o", png, "--normal", "0,0,1"}, 1, "--normal");
    expect_failure({"plot", probe, "-o", png, "--normal", "0,0,1"}, 1, "--normal");
    expect_failure({"plot", probe, "-o", png, "--view", "30"}, 2, "--view");
    expect_failure({"plot", file, "-o", png, "--probe-projection", "latlong"}, 2, "--probe-projection");
    for (const char* kind : {"env", "local"}) {
        const std::string out = folder / "l.acdf";
        expect_failure({kind, probe, "--scene-up", "y", "-o", out}, 2, "--scene-up");
        expect_failure({kind, probe, "--scene-axes", "(y,z,x)", "-o", out}, 2, "--scene-axes");
        for (const char* axes : {"", "(x,y)", "(x,y,y)", "(x,y,z,x)", "(x,y,-)", "x y z", "(--x,y,z)", "(x,y,w)"})
            expect_failure({kind, probe, "--scene", folder / "none.obj", "--scene-axes", axes, "-o", out}, 2,
                           "--scene-axes");
        expect_failure(
            {kind, probe, "--scene", folder / "none.obj", "--scene-axes", "(y,z,x)", "--scene-up", "y", "-o", out},
            2, "--scene-");
    }
}

// An MIS partner of all normals is seldom that of a picture.
TEST_F(Hostile, FilesForAllNormalsAdviseASceneOrTheMean) {
    const std::string normals = folder / "normals.txt";
    write_text(normals, "0 0 1\n0 0 -1\n0 1 0\n0 -1 0\n1 0 0\n-1 0 0\n");
    const auto advised = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments{"env", probe, "-o", file, "--force", "--cells", "64"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Result result = run_acdf(arguments);
        EXPECT_EQ(result.code, 0) << result.err;
        return result.err.find("--mis mean") != std::string::npos;
    };
    EXPECT_TRUE(advised({"--mis", "cosine"}));
    EXPECT_FALSE(advised({"--mis", "mean"}));
    EXPECT_FALSE(advised({"--mis", "cosine", "--scene", normals}));
    EXPECT_FALSE(advised({}));
}

// A file is measured against any source, and another one is reported; where it has no pdf for the light, that is an
// error.
TEST_F(Hostile, ASourceThatAFileDoesNotStandForIsRefused) {
    const auto write = [&](const std::string& path, int bright, int height = 8) { // the only one
        std::ofstream out(path, std::ios::binary);
        out << "PF\n16 " << height << "\n-1.0\n";
        for (int i = 0; i < 16 * height * 3; ++i) {
            const float value = i / 3 == bright ? 9.0f : 0.0f;
            out.write(reinterpret_cast<const char*>(&value), sizeof value);
        }
    };
    const std::string here = folder / "here.pfm", there = folder / "there.pfm", even = folder / "even.pfm";
    write(here, 40);
    write(there, 90);
    write_probe(even, 16, 8);
    for (const char* kind : {"env", "local"}) {
        std::vector<std::string> command = {kind, here, "-o", file, "-q", "-f"};
        if (std::string(kind) == "local") command.insert(command.end(), {"--budget", "16KiB"});
        ASSERT_EQ(run_acdf(command).code, 0) << kind;
        EXPECT_EQ(run_acdf({"measure", file, "--against", here}).code, 0) << kind;
        const Result result = run_acdf({"measure", file, "--against", there, "-q", "--json"});
        EXPECT_EQ(result.code, 1) << kind;
        EXPECT_GT(json::parse(result.out).at("support_violations").get<int>(),
                  0); // figures are printed all the same
        EXPECT_EQ(lines_in(result.err), 1u) << result.err;
        EXPECT_NE(result.err.find("is not a file of " + there), std::string::npos) << result.err;
    }
    const std::string square = folder / "square.pfm";
    write(square, 70, 16);
    ASSERT_EQ(run_acdf({"env", square, "--projection", "octahedral", "-o", file, "-q", "-f"}).code, 0);
    EXPECT_EQ(run_acdf({"measure", file, "--against", square, "--projection", "octahedral"}).code, 0);
    EXPECT_EQ(run_acdf({"measure", file, "--against", square}).code, 0); // the file says so
    EXPECT_NE(run_acdf({"measure", file, "--against", here}).err.find("latlong (2:1 shape)"), std::string::npos);
    const Result otherwise = run_acdf({"measure", file, "--against", square, "--projection", "angular", "-q"});
    EXPECT_EQ(otherwise.code, 1); // the same file, but read as another one
    EXPECT_NE(otherwise.err.find("as it is read here"), std::string::npos) << otherwise.err;
    ASSERT_EQ(run_acdf({"env", even, "-o", file, "-q", "-f"}).code, 0);
    const Result covered = run_acdf({"measure", file, "--against", there});
    EXPECT_EQ(covered.code, 0); // it has a pdf there: noise, no bias
    EXPECT_NE(covered.err.find("made from another file"), std::string::npos) << covered.err;
}

TEST_F(Hostile, ABoundOnWeightsThatIsOutOfReachNamesWhatItTakes) {
    const auto bounded = [this](const std::string& weight) {
        return run_acdf(
            {"env", probe, "-q", "-f", "--filter", "bilinear", "--cells", "2", "--max-weight", weight, "-o", file});
    };
    const Result result = bounded("1.5");
    EXPECT_EQ(result.code, 1);
    const std::string before = "a largest weight of 1.5 is out of reach; the smallest possible is ";
    const std::size_t at = result.err.find(before);
    ASSERT_NE(at, std::string::npos) << result.err;
    const double least = std::stod(result.err.substr(at + before.size()));
    EXPECT_GT(least, 1.5);
    EXPECT_EQ(bounded(std::to_string(1.001 * least)).code, 0);
}

TEST_F(Hostile, MapsBeyondTheFormatAreRefusedBeforeTheyAreRead) {
    const std::string wide = folder / "wide.pfm";
    write_probe(wide, 70000, 2);
    expect_failure({"env", wide, "--projection", "latlong", "-o", file}, 1, "more than 65536 on a side");
}

TEST_F(Hostile, OtherJsonThanReportsIsRefusedWithoutExceptions) {
    const std::string report = folder / "report.json";
    for (const auto& [text, what] :
         std::vector<std::pair<std::string, std::string>>{{"{\"batch\"", "not JSON from byte"},
                                                          {"{\"batch\": 3}", "a key is missing"},
                                                          {"[]", "a key is missing"}}) {
        write_text(report, text);
        expect_failure({"batch", "--merge-reports", report}, 1, what);
        EXPECT_EQ(run_acdf({"batch", "--merge-reports", report}).err.find("json.exception"), std::string::npos);
    }
}

} // namespace
