// `acdf sweep` as a user runs it.
#include "tests/inputs/sanitized.h"
#include "tests/tools/plot/files.h"
#include "tests/tools/run.h"
#include "tests/tools/sweep/advised.h"
#include "tools/cli/sizes.h"

#include <nlohmann/json.hpp>

#include <map>
#include <set>
#include <sstream>
#include <tuple>

namespace acdf::test {
namespace {

/// 32 x 16 texels, no two alike.
std::string tiny_probe(const Folder& folder) {
    std::vector<float> rgb(32 * 16 * 3);
    for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<float>(1 + (i / 3 * 37) % 523);
    const std::string path = folder / "tiny.pfm";
    write_rgb(path, 32, 16, rgb);
    return path;
}

const std::vector<std::string> quick = {"--budgets", "1500", "--files", "env", "--no-timing", "--quiet"};

Result sweep(const std::string& source, const std::string& folder, std::vector<std::string> more = {}) {
    std::vector<std::string> words = {"sweep", source, "-o", folder};
    words.insert(words.end(), quick.begin(), quick.end());
    words.insert(words.end(), more.begin(), more.end());
    return run_acdf(words);
}

/// That a row has the size of a file, and of what it takes in memory with the tables that are made when it is
/// opened.
void expect_sizes_of(const nlohmann::json& row, const std::string& file) {
    const Result told = run_acdf({"info", "--json", file});
    ASSERT_EQ(told.code, 0) << told.err;
    const auto info = nlohmann::json::parse(told.out);
    const std::uint64_t bytes = info["bytes"], tables = info["table_bytes"];
    EXPECT_EQ(row["file_bytes"], std::filesystem::file_size(file));
    EXPECT_EQ(row["file_bytes"], bytes);
    const std::string kind = row["file"];
    if (kind.find("cdf") == std::string::npos && kind.find("uniform") == std::string::npos) {
        EXPECT_GT(tables, 0u) << kind;
    }
    EXPECT_EQ(row["bytes"], bytes + tables);
    EXPECT_EQ(info["memory_bytes"], bytes + tables);
}

TEST(SweepCommand, WritesTheSameBytesEveryTime) {
    ACDF_NOT_SANITIZED();
    const Folder folder;
    const std::string probe = tiny_probe(folder);
    const Result first_run = sweep(probe, folder / "new/a"); // folders are made
    ASSERT_EQ(first_run.code, 0) << first_run.err;
    ASSERT_EQ(sweep(probe, folder / "b", {"--threads", "1"}).code, 0);
    for (const char* name : {"sweep.csv", "sweep.json", "report.html"}) {
        const std::string first = read_text(folder / (std::string("new/a/") + name));
        EXPECT_FALSE(first.empty()) << name;
        EXPECT_EQ(first, read_text(folder / (std::string("b/") + name))) << name;
    }
}

TEST(SweepCommand, TheCommandMakesTheRecommendedFile) {
    const Folder folder;
    const std::string probe = tiny_probe(folder);
    ASSERT_EQ(sweep(probe, folder / "out", {"--channel", "red"}).code, 0);
    const auto json = nlohmann::json::parse(read_text(folder / "out/sweep.json"));
    ASSERT_EQ(json["renderers"].size(), 4u);
    const std::string command = json["renderers"][0]["command"];
    EXPECT_EQ(command, "acdf env " + probe + " --channel red --budget 1500 -o tiny.acdf");
    const std::string file = folder / "tiny.acdf";
    const Result made =
        run_acdf({"env", probe, "--channel", "red", "--budget", "1500", "-o", file, "--json", "--quiet"});
    ASSERT_EQ(made.code, 0) << made.err;
    const auto& row = json["rows"][json["renderers"][0]["row"].get<std::size_t>()];
    expect_sizes_of(row, file);
    const std::string page = read_text(folder / "out/report.html");
    EXPECT_NE(page.find("(" + tools::to_readable_size(row["bytes"]) + " in memory)"), std::string::npos);
    const double variance = nlohmann::json::parse(made.out)["relative_variance"];
    EXPECT_NEAR(variance, row["relative_variance"], 1e-8 * variance);
}

// Of probes that lie on no grid, or on another one than their own: the file is the one that is made, and so is its
// noise.
TEST(SweepCommand, ResampledProbesAreMeasuredAsFilesOfThemAre) {
    const Folder folder;
    std::vector<float> rgb(24 * 24 * 3);
    for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<float>(1 + (i / 3 * 37) % 523);
    const std::string disc = folder / "disc.pfm", grid = tiny_probe(folder), file = folder / "made.acdf";
    write_rgb(disc, 24, 24, rgb);
    for (const auto& [source, option, value] :
         {std::tuple{disc, "--projection", "angular"}, std::tuple{grid, "--domain", "octahedral"}}) {
        if (acdf_test::kSanitized && source == grid) break; // the same code, on another grid
        ASSERT_EQ(sweep(source, folder / "out", {option, value, "--force"}).code, 0) << value;
        const auto json = nlohmann::json::parse(read_text(folder / "out/sweep.json"));
        const std::string words = source + " " + option + " " + value + " --budget 1500 -o ";
        EXPECT_EQ(json["renderers"][0]["command"],
                  "acdf env " + words + (source == disc ? "disc" : "tiny") + ".acdf");
        const Result made = run_acdf(
            {"env", source, option, value, "--budget", "1500", "-o", file, "--json", "--quiet", "--force"});
        ASSERT_EQ(made.code, 0) << made.err;
        const auto report = nlohmann::json::parse(made.out);
        const double variance = report["relative_variance"], least = report["least_variance"];
        const auto& row = json["rows"][json["renderers"][0]["row"].get<std::size_t>()];
        expect_sizes_of(row, file);
        EXPECT_NEAR(row["relative_variance"], variance, 1e-8 * variance);
        EXPECT_GT(least, 1e-3);
        for (const auto& other : json["rows"]) {
            if (other["system"] != "full_cdf") continue;
            EXPECT_NEAR(other["relative_variance"], least, 1e-5);
        }
    }
}

/// A roof over one half of a floor: files that know what it hides win for who hands the position over.
TEST(SweepCommand, AMeshIsWhereFilesAreCompared) {
    const Folder folder;
    const std::string probe = tiny_probe(folder), mesh = folder / "roof.obj";
    write_text(mesh, "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv -1 -1 1\nv 1 -1 1\nv 1 0 1\nv -1 0 1\n"
                     "f 1 2 3 4\nf 5 6 7 8\nf 1 2 6 5\n");
    const Result made = run_acdf({"sweep", probe, "-o", folder / "out", "--scene", mesh, "--no-timing", "--files",
                                  "local,visibility", "--budgets", "128KiB", "--quiet"});
    ASSERT_EQ(made.code, 0) << made.err;
    const auto json = nlohmann::json::parse(read_text(folder / "out/sweep.json"));
    EXPECT_TRUE(json["on_mesh"]);
    EXPECT_GT(json["conditions"], 20);
    std::map<std::string, double> mis;
    for (const auto& row : json["rows"])
        mis[row["system"] == "acdf" ? row["file"] : row["system"]] = row["mis_diffuse_hidden"];
    EXPECT_GT(mis["visibility"], 0.0);
    EXPECT_GT(mis["local"], 1.15 * mis["visibility"]);
    EXPECT_GT(mis["full_cdf"], 3.0 * mis["visibility"]);
    std::map<std::string, std::string> commands;
    for (const auto& one : json["renderers"]) commands[one["renderer"]] = one["command"];
    EXPECT_EQ(commands["mis_normal"], "acdf local " + probe + " --budget 128KiB -o tiny.local.acdf");
    EXPECT_EQ(commands["mis_position"],
              "acdf local " + probe + " --scene " + mesh + " --visibility --budget 128KiB -o tiny.visibility.acdf");
    EXPECT_EQ(commands.count("alone"), 0u); // no such file was tried
    const std::string page = read_text(folder / "out/report.html");
    EXPECT_NE(page.find("--scene " + mesh + " --visibility"), std::string::npos);
    EXPECT_EQ(run_acdf({"sweep", probe, "-o", folder / "x", "--files", "visibility"}).code, 2);
    EXPECT_EQ(run_acdf({"sweep", probe, "-o", folder / "x", "--scene", probe}).code, 1);
    EXPECT_EQ(run_acdf({"sweep", "ggx:alpha=0.3", "-o", folder / "x", "--scene", mesh}).code, 2);
}

// Files of every kind, each made again by its options.
TEST(SweepCommand, OptionsMakeTheFilesAgain) {
    ACDF_NOT_SANITIZED();
    const Folder folder;
    const std::string probe = tiny_probe(folder);
    const Result made =
        run_acdf({"sweep", probe, "-o", folder / "out", "--budgets", "32KiB", "--no-timing", "--files",
                  "env,env-mis,local,local-mis,local-cdf,env-uniform", "--heuristic", "power", "--quiet"});
    ASSERT_EQ(made.code, 0) << made.err;
    const auto json = nlohmann::json::parse(read_text(folder / "out/sweep.json"));
    std::set<std::string> files;
    for (const auto& row : json["rows"]) {
        if (row["system"] != "acdf") continue;
        const std::string file = row["file"], options = row["options"];
        files.insert(file);
        EXPECT_EQ(options.find("--heuristic power") != std::string::npos, row["needs_mis"].get<bool>()) << options;
        const Folder again;
        std::vector<std::string> words{file.substr(0, file.find('-')), probe, "-q", "-o", again / "x.acdf"};
        std::istringstream each(options);
        for (std::string word; each >> word;) words.push_back(word);
        const Result result = run_acdf(words);
        EXPECT_EQ(result.code, 0) << result.err;
        expect_sizes_of(row, again / "x.acdf");
    }
    EXPECT_EQ(files.size(), 6u);
}

TEST(SweepCommand, RefusesWhatIsThereAndWrongOptions) {
    const Folder folder;
    const std::string probe = tiny_probe(folder);
    std::filesystem::create_directory(folder / "out");
    write_text(folder / "out/report.html", "mine");
    Result result = sweep(probe, folder / "out");
    EXPECT_EQ(result.code, 1);
    EXPECT_NE(result.err.find("report.html"), std::string::npos) << result.err;
    EXPECT_EQ(read_text(folder / "out/report.html"), "mine");
    EXPECT_FALSE(std::filesystem::exists(folder / "out/sweep.csv"));
    EXPECT_EQ(sweep(probe, folder / "x", {"--heuristic", "nonsense"}).code, 2);
    result = run_acdf({"sweep", "ggx:alpha=0.3", "-o", folder / "x", "--files", "env"});
    EXPECT_EQ(result.code, 2);
    EXPECT_NE(result.err.find("uniform"), std::string::npos) << result.err; // what there is
    EXPECT_EQ(run_acdf({"sweep", "ggx:alpha=0.3", "-o", folder / "x", "--budgets", "12 parsecs"}).code, 2);
    EXPECT_EQ(run_acdf({"sweep", folder / "absent.exr", "-o", folder / "x"}).code, 1);
    result = run_acdf({"sweep", probe, "-o", folder / "x", "--files", "env", "--budgets", "100", "--quiet"});
    EXPECT_EQ(result.code, 1);
    EXPECT_NE(result.err.find(probe + ": none of the sizes can be made"), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "x"));
}

/// What of JSON schema docs/sweep.schema.json uses: type, properties, required, items, enum.
void expect_valid(const nlohmann::json& schema, const nlohmann::json& value, const std::string& at) {
    if (schema.contains("type")) {
        const auto is = [&](const std::string& type) {
            return type == "object"    ? value.is_object()
                   : type == "array"   ? value.is_array()
                   : type == "string"  ? value.is_string()
                   : type == "integer" ? value.is_number_integer()
                   : type == "number"  ? value.is_number()
                   : type == "boolean" ? value.is_boolean()
                                       : type == "null" && value.is_null();
        };
        bool any = false;
        if (schema["type"].is_array())
            for (const auto& type : schema["type"]) any |= is(type);
        else any = is(schema["type"]);
        EXPECT_TRUE(any) << at << ": " << value.dump() << " is not " << schema["type"].dump();
    }
    if (schema.contains("enum")) {
        EXPECT_NE(std::find(schema["enum"].begin(), schema["enum"].end(), value), schema["enum"].end()) << at;
    }
    if (value.is_object() && schema.contains("properties")) {
        for (const auto& [key, each] : value.items()) {
            ASSERT_TRUE(schema["properties"].contains(key)) << at << "." << key << " is not in the schema";
            expect_valid(schema["properties"][key], each, at + "." + key);
        }
        for (const auto& key : schema.value("required", nlohmann::json::array()))
            EXPECT_TRUE(value.contains(key)) << at << " lacks " << key;
    }
    if (value.is_array() && schema.contains("items"))
        for (const auto& each : value) expect_valid(schema["items"], each, at + "[]");
}

TEST(SweepCommand, JsonFollowsItsSchema) {
    const Folder folder;
    const std::string probe = tiny_probe(folder);
    const auto schema = nlohmann::json::parse(read_text(std::string(ACDF_TEST_DIR) + "/../docs/sweep.schema.json"));
    for (const std::vector<std::string>& more :
         std::vector<std::vector<std::string>>{{probe, "--budgets", "1500", "--files", "env,env-mis"},
                                               {"ggx:alpha=0.3", "--budgets", "8KiB", "--files", "variance"}}) {
        std::vector<std::string> words{"sweep", "-o", folder / "out", "--json", "--quiet", "--force"};
        words.insert(words.end(), more.begin(), more.end());
        const Result result = run_acdf(words);
        ASSERT_EQ(result.code, 0) << result.err;
        const auto json = nlohmann::json::parse(result.out);
        EXPECT_TRUE(json["timed"]);
        expect_valid(schema, json, "sweep");
        EXPECT_EQ(result.out, read_text(folder / "out/sweep.json"));
        EXPECT_EQ(json["recommendation"].is_null(), json["kind"] == "probe");
    }
}

// The probes of docs/integrate.md's pictures: what wins there in pbrt-v4 is what is advised.
TEST(SweepCommand, AdvisesWhatWinsInPbrt) {
    ACDF_NOT_SANITIZED();
    if (!probes_are_there()) GTEST_SKIP() << "probes are absent; set ACDF_TEST_DATA";
    const auto table = table_of("docs/integrate.md", "integrator | `env`");
    ASSERT_EQ(table.size(), 3u);
    /// The column with the largest gain among those that are wanted.
    const auto winner = [&](const std::vector<std::string>& gains, const char* begins) {
        std::string best;
        double most = 0.0;
        for (std::size_t i = 1; i < gains.size(); ++i) {
            const std::string file = code_in(table[0][i]);
            const double gain = std::strtod(gains[i].c_str(), nullptr);
            if (file.rfind(begins, 0) != 0 || file == "local --visibility" || gain <= most) continue;
            most = gain;
            best = "acdf " + file;
        }
        return best;
    };
    for (const char* name : {"city.exr", "noon_grass_1k.hdr", "studio.exr"}) {
        const Folder folder;
        const input::Probe small = reduced_probe(name, 128);
        write_rgb(folder / "probe.pfm", small.width, small.height, small.rgb);
        const Result made = run_acdf({"sweep", folder / "probe.pfm", "-o", folder / "out", "--budgets", "64KiB",
                                      "--heuristic", "power", "--no-timing", "--quiet"});
        ASSERT_EQ(made.code, 0) << made.err;
        const auto json = nlohmann::json::parse(read_text(folder / "out/sweep.json"));
        std::map<std::string, std::string> advised;
        for (const auto& one : json["renderers"])
            advised[one["renderer"]] = json["rows"][one["row"].get<std::size_t>()]["label"];
        EXPECT_EQ(advised["mis_normal"], winner(table[1], "")) << name;
        EXPECT_EQ(advised["mis"], winner(table[1], "env")) << name;
        EXPECT_EQ(advised["alone_normal"], winner(table[2], "")) << name;
        EXPECT_EQ(advised["alone"], winner(table[2], "env")) << name;
    }
}

} // namespace
} // namespace acdf::test
