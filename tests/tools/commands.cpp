// The acdf program from outside: exit codes, messages, and what each command prints.
#include "tests/tools/run.h"

#include <nlohmann/json.hpp>

#include <cctype>
#include <cmath>
#include <cstdio>
#include <set>
#include <sstream>

using namespace acdf::test;
using nlohmann::json;

namespace {

class Commands : public testing::Test {
protected:
    Folder folder;
    std::string sky = folder / "sky.acdf";
    void SetUp() override { write_bytes(sky, small_environment()); }
};

// What `acdf --help` lists, so that no new command goes untested.
std::vector<std::string> command_names() {
    std::vector<std::string> names;
    std::istringstream lines(run_acdf({"--help"}).out);
    for (std::string line; std::getline(lines, line);)
        if (line.size() > 4 && line.substr(0, 2) == "  " && std::islower(static_cast<unsigned char>(line[2])))
            names.push_back(line.substr(2, line.find(' ', 2) - 2));
    return names;
}

void expect_one_line_error(const Result& result, int code, const std::string& part) {
    EXPECT_EQ(result.code, code) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(lines_in(result.err), 1u) << result.err;
    EXPECT_EQ(result.err.rfind("acdf", 0), 0u) << result.err;
    EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
}

std::vector<std::vector<double>> numbers_in(const std::string& csv, bool header) {
    std::vector<std::vector<double>> rows;
    std::istringstream in(csv);
    std::string line, field;
    if (header) std::getline(in, line);
    while (std::getline(in, line)) {
        rows.emplace_back();
        for (std::istringstream fields(line); std::getline(fields, field, ',');)
            rows.back().push_back(std::stod(field));
    }
    return rows;
}

// ---- the program ---------------------------------------------------------------------------------------

TEST_F(Commands, HelpOfEveryCommandHasExamplesAndExitCodes) {
    for (const std::string& name : command_names()) {
        const Result result = run_acdf({name, "--help"});
        EXPECT_EQ(result.code, 0) << name;
        EXPECT_EQ(result.err, "") << name;
        EXPECT_NE(result.out.find("Usage: acdf " + name), std::string::npos) << result.out;
        EXPECT_NE(result.out.find("Examples:\n  "), std::string::npos) << name;
        EXPECT_NE(result.out.find("acdf " + name + " "), std::string::npos) << name;
        EXPECT_NE(result.out.find("Exit codes: 0 done, 1 "), std::string::npos) << name;
        std::istringstream lines(result.out);
        for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << name << ": " << line;
    }
}

TEST_F(Commands, HelpOfTheProgramListsEveryCommand) {
    const Result result = run_acdf({"--help"});
    EXPECT_EQ(result.code, 0);
    for (const char* name :
         {"env", "local", "brdf", "table", "info", "validate", "measure", "sample", "pdf", "plot", "demo"})
        EXPECT_NE(result.out.find(std::string("\n  ") + name + " "), std::string::npos) << result.out;
}

TEST_F(Commands, VersionNamesProgramFormatAndLibraries) {
    const Result result = run_acdf({"--version"});
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(result.out.rfind("acdf " ACDF_VERSION "\nformat 1.0\n", 0), 0u) << result.out;
    std::istringstream lines(result.out);
    std::set<std::string> names;
    for (std::string name, version; lines >> name >> version; names.insert(name))
        EXPECT_TRUE(std::isdigit(static_cast<unsigned char>(version[0]))) << name << " " << version;
    for (const char* library : {"zlib", "oneTBB", "OpenSSL", "nlohmann-json", "CLI11", "assimp", "OpenImageIO"})
        EXPECT_EQ(names.count(library), 1u) << library;
}

TEST_F(Commands, CompletionsKnowEveryCommandAndOption) {
    const std::string bash = run_acdf({"completion", "bash"}).out, zsh = run_acdf({"completion", "zsh"}).out;
    for (const std::string& name : command_names()) {
        EXPECT_NE(bash.find("\n    " + name + ") options='"), std::string::npos) << name;
        EXPECT_NE(zsh.find("\n            '" + name + ":"), std::string::npos) << name;
        std::istringstream help(run_acdf({name, "--help"}).out);
        const std::size_t begin = bash.find("\n    " + name + ") "), end = bash.find('\n', begin + 1);
        const std::string known = bash.substr(begin, end - begin);
        int options = 0;
        for (std::string line; std::getline(help, line);) { // "  -o,--output FILE ..."
            if (line.rfind("  -", 0) != 0) continue;
            std::istringstream spellings(line.substr(2, line.find(' ', 2) - 2));
            for (std::string option; std::getline(spellings, option, ','); ++options)
                EXPECT_NE((known + " ").find(option), std::string::npos) << name << " " << option;
        }
        EXPECT_GE(options, 2) << name;
    }
    expect_one_line_error(run_acdf({"completion", "fish"}), 2, "fish");
}

TEST_F(Commands, WrongUsageIsExitCode2AndOneLine) {
    expect_one_line_error(run_acdf({"--no-such-option"}), 2, "--no-such-option");
    expect_one_line_error(run_acdf({"no-such-command"}), 2, "no-such-command");
    expect_one_line_error(run_acdf({"Env", sky, "-o", folder / "out"}), 2, "there is no command 'Env'");
    expect_one_line_error(run_acdf({""}), 2, "there is no command ''");
    expect_one_line_error(run_acdf({"sample", sky, "-n", "1", "--sed", "7"}), 2, "not expected: --sed 7");
    expect_one_line_error(run_acdf({"sample", sky, "-n", "many"}), 2, "many");
    expect_one_line_error(run_acdf({"sample", sky, "-n", "0"}), 2, "acdf sample --help");
    expect_one_line_error(run_acdf({"sample", sky, "-n", "-1"}), 2, "acdf sample --help");
    expect_one_line_error(run_acdf({"sample", sky}), 2, "--count");
    expect_one_line_error(run_acdf({"sample", sky, "-n", "1", "--sequence", "halton"}), 2, "halton");
    expect_one_line_error(run_acdf({"sample", sky, "-n"}), 2, "--count: needs a value");
    expect_one_line_error(run_acdf({"sample", sky, "-n", "1", "-n", "2"}), 2, "--count: is given more than once");
    expect_one_line_error(run_acdf({"table", sky, "-o", folder / "out", "--names", ",,"}), 2,
                          "--names: needs a value");
    expect_one_line_error(run_acdf({"table", sky, "-o", folder / "out", "--names", "a,b,,c"}), 2,
                          "--names: needs a value between all commas");
    expect_one_line_error(run_acdf({"sweep", sky, "-o", "-"}), 1, "stdout: is not a folder");
    expect_one_line_error(run_acdf({"table", sky, "-o", folder / "out", "--mis", ""}), 2, "--mis: needs a value");
    for (const char* seed : {"18446744073709551616", "-1", "0x10", "1e3", " 1", "+1"})
        expect_one_line_error(run_acdf({"sample", sky, "-n", "1", "--seed", seed}), 2, seed);
    EXPECT_EQ(run_acdf({"sample", sky, "-n", "010"}).out, run_acdf({"sample", sky, "-n", "10"}).out);
    for (const std::string& name : command_names())
        expect_one_line_error(run_acdf({name, "--no-such-option"}), 2, "acdf " + name + " --help");
    for (const std::string name : {"info", "validate", "sample", "pdf"}) {
        expect_one_line_error(run_acdf({name}), 2, "FILE");
    }
    const Result nothing = run_acdf({});
    EXPECT_EQ(nothing.code, 2);
    EXPECT_NE(nothing.err.find("Usage: acdf"), std::string::npos);
}

// Each option that takes a number with a fraction, before any input is looked at.
TEST_F(Commands, NoNumberMayBeNanOrInfinite) {
    const std::vector<std::pair<std::string, std::string>> options = {
        {"env", "--target-variance"},   {"env", "--max-weight"},   {"env", "--eps"},
        {"local", "--target-variance"}, {"local", "--eps"},        {"local", "--cosine-share"},
        {"brdf", "--target-variance"},  {"brdf", "--eps"},         {"brdf", "--diffuse-floor"},
        {"table", "--target-variance"}, {"table", "--max-weight"}, {"sweep", "--visible"},
        {"render", "--shadow-ray-ns"},  {"local", "--max-weight"}, {"brdf", "--max-weight"}};
    for (const auto& [command, option] : options)
        for (const char* value : {"nan", "1e999"}) {
            SCOPED_TRACE(command + ' ' + option + '=' + value);
            expect_one_line_error(run_acdf({command, "ggx:alpha=0.2", option + '=' + value, "-o", folder / "out"}),
                                  2, option);
        }
}

// JSON has no such numbers; what stands for them is refused where it is read.
TEST_F(Commands, NoNumberOfAJsonFileMayBeNanOrInfinite) {
    const std::string scene = folder / "scene.json", jobs = folder / "jobs.jsonl";
    const std::string before = R"({"source": "ggx:alpha=0.2", "output": "a.acdf", "options": {"eps": )",
                      after = "}}\n";
    for (const std::string value : {"NaN", "Infinity", "-Infinity", "1e999"}) {
        SCOPED_TRACE(value);
        write_text(scene, "{\"camera\": {\"position\": [0, " + value + ", 1]}}");
        expect_one_line_error(run_acdf({"render", "--scene", scene, "-o", folder / "out"}), 1, "not JSON");
        write_text(jobs, before + value + after);
        EXPECT_EQ(run_acdf({"batch", jobs, "-o", folder / "all"}).code, 1);
    }
    write_text(jobs, before + "\"nan\"" + after);
    const Result result = run_acdf({"batch", jobs, "-o", folder / "all"});
    EXPECT_NE(result.code, 0);
    EXPECT_NE(result.err.find("nan"), std::string::npos) << result.err;
}

TEST_F(Commands, UnreadableInputIsExitCode1AndOneLine) {
    const std::string missing = folder / "missing.acdf", text = folder / "text.acdf";
    write_text(text, "no acdf file at all, but long enough to hold a header of sixty-four bytes\n");
    const std::vector<std::vector<std::string>> commands = {
        {"info", missing}, {"validate", missing}, {"sample", missing, "-n", "1"}, {"pdf", missing}};
    for (const auto& command : commands) expect_one_line_error(run_acdf(command), 1, missing + ": ");
    for (auto command : commands) {
        if (command[0] == "validate") continue;
        command[1] = text;
        expect_one_line_error(run_acdf(command), 1, text + ": ");
    }
    for (auto command : commands) {
        command[1] = folder / ".";
        expect_one_line_error(run_acdf(command), 1, "is a folder");
    }
}

TEST_F(Commands, FullDiskIsAnError) {
    if (access("/dev/full", W_OK) != 0) GTEST_SKIP() << "this system has no /dev/full";
    const Result result = run_acdf({"sample", sky, "-n", "10", "-o", "/dev/full"});
    expect_one_line_error(result, 1, "No space left");
    EXPECT_EQ(wait_for(start_acdf({"info", sky}, "/dev/null", "/dev/full", "/dev/null")), 1);
    for (const char* told : {"--help", "--version"})
        EXPECT_EQ(wait_for(start_acdf({told}, "/dev/null", "/dev/full", "/dev/null")), 1) << told;
}

// ---- info ----------------------------------------------------------------------------------------------

TEST_F(Commands, InfoAsJson) {
    const Result result = run_acdf({"info", "--json", sky});
    ASSERT_EQ(result.code, 0) << result.err;
    const json report = json::parse(result.out);
    EXPECT_EQ(report["kind"], "environment");
    EXPECT_EQ(report["version"], "1.0");
    EXPECT_EQ(report["bytes"], small_environment().size());
    EXPECT_EQ(report["bins"], 1);
    EXPECT_EQ(report["cells"], 3);
    EXPECT_EQ(report["curves"], 2);
    EXPECT_EQ(report["fit"], "variance");
    EXPECT_EQ(report["filter"], "nearest");
    EXPECT_EQ(report["parameterization"], "latlong");
    EXPECT_EQ(report["total"], 2.5);
    EXPECT_EQ(report["channel_weights"], (json{0.2126, 0.7152, 0.0722}));
    ASSERT_EQ(report["axes"].size(), 2u);
    EXPECT_EQ(report["axes"][0]["resolution"], 8);
    EXPECT_EQ(report["axes"][0]["role"], "sampled");
    EXPECT_EQ(report["axes"][1]["resolution"], 4);
    EXPECT_EQ(report["axes"][1]["measure"], "cosine");
    EXPECT_EQ(report["source"]["name"], "sky.exr");
    EXPECT_EQ(report["tool"], "acdf test");
    EXPECT_EQ(report["options"], "--cells 3");
    EXPECT_EQ(report["accuracy"]["relative_variance"], 0.125);
    std::set<std::string> types;
    for (const json& chunk : report["chunks"]) {
        types.insert(chunk["type"]);
        EXPECT_EQ(chunk["offset"].get<int>() % 64, 0);
        EXPECT_EQ(chunk["stored"], chunk["raw"]);
    }
    EXPECT_EQ(types, (std::set<std::string>{"DESC", "BINS", "TREE", "META"}));
}

TEST_F(Commands, InfoOfHalvings) {
    write_bytes(sky, small_halvings());
    const Result result = run_acdf({"info", "--json", sky});
    ASSERT_EQ(result.code, 0) << result.err;
    const json report = json::parse(result.out);
    EXPECT_EQ(report["bytes"], small_halvings().size());
    EXPECT_GT(report["table_bytes"], 0);
    EXPECT_EQ(report["memory_bytes"], report["bytes"].get<int>() + report["table_bytes"].get<int>());
    EXPECT_EQ(report["bins"], 1);
    EXPECT_EQ(report["cells"], 3);
    EXPECT_EQ(report["curves"], 0);
    std::set<std::string> types;
    for (const json& chunk : report["chunks"]) types.insert(chunk["type"]);
    EXPECT_EQ(types, (std::set<std::string>{"DESC", "HALV", "META"}));
    const Result people = run_acdf({"info", sky});
    ASSERT_EQ(people.code, 0) << people.err;
    EXPECT_NE(people.out.find("3 cells"), std::string::npos) << people.out;
    EXPECT_NE(people.out.find("are tables made when it is opened"), std::string::npos) << people.out;
}

TEST_F(Commands, InfoOfSeveralFilesIsAnArrayAndABadOneIsReported) {
    const Result good = run_acdf({"info", sky, sky, "--json"});
    EXPECT_EQ(good.code, 0);
    EXPECT_EQ(json::parse(good.out).size(), 2u);
    const Result mixed = run_acdf({"info", sky, folder / "missing", "--json"});
    EXPECT_EQ(mixed.code, 1);
    EXPECT_EQ(lines_in(mixed.err), 1u);
    EXPECT_EQ(json::parse(mixed.out).size(), 1u);
}

TEST_F(Commands, InfoForPeopleAndFromStdin) {
    const std::string bytes = read_text(sky);
    const Result result = run_acdf({"info", "-"}, bytes);
    ASSERT_EQ(result.code, 0) << result.err;
    for (const char* part :
         {"environment", "format 1.0", "3 cells in 2 curves", "sky.exr", "relative_variance", "0.125"})
        EXPECT_NE(result.out.find(part), std::string::npos) << part << " in:\n" << result.out;
}

// ---- validate ------------------------------------------------------------------------------------------

TEST_F(Commands, ValidateAcceptsAndRefuses) {
    const Result good = run_acdf({"validate", sky});
    EXPECT_EQ(good.code, 0) << good.out << good.err;
    EXPECT_EQ(good.out, sky + ": valid\n");
    EXPECT_EQ(run_acdf({"validate", "--quiet", sky}).out, "");

    std::string bytes = read_text(sky);
    bytes[44] = static_cast<char>(bytes[44] ^ 1); // header.reserved: breaks the checksum and the reserved rule
    bytes.back() = 1;                             // padding
    write_text(folder / "bad.acdf", bytes);
    const Result bad = run_acdf({"validate", folder / "bad.acdf"});
    EXPECT_EQ(bad.code, 3);
    EXPECT_NE(bad.out.find("error 2004"), std::string::npos) << bad.out;
    EXPECT_NE(bad.out.find("error 2008"), std::string::npos) << bad.out;

    const Result report = run_acdf({"validate", "--json", folder / "bad.acdf"});
    EXPECT_EQ(report.code, 3);
    const json parsed = json::parse(report.out);
    EXPECT_EQ(parsed["valid"], false);
    EXPECT_EQ(parsed["errors"], parsed["findings"].size());
    std::set<int> rules;
    for (const json& finding : parsed["findings"]) {
        rules.insert(finding["rule"].get<int>());
        EXPECT_EQ(finding["severity"], "error");
        EXPECT_LT(finding["offset"].get<std::size_t>(), bytes.size());
        EXPECT_FALSE(finding["detail"].get<std::string>().empty());
    }
    EXPECT_TRUE(rules.count(2004) && rules.count(2008)) << report.out;
}

TEST_F(Commands, ValidateDistinguishesFaultsFromUnreadableFiles) {
    write_text(folder / "empty", "");
    EXPECT_EQ(run_acdf({"validate", sky, folder / "empty"}).code, 3);
    EXPECT_EQ(run_acdf({"validate", folder / "empty", folder / "missing"}).code, 1);
}

// ---- sample --------------------------------------------------------------------------------------------

TEST_F(Commands, SampleWritesUnitDirectionsInEverySequence) {
    for (const std::string sequence : {"random", "stratified", "sobol"}) {
        const Result result = run_acdf({"sample", sky, "-n", "100", "--sequence", sequence});
        ASSERT_EQ(result.code, 0) << result.err;
        EXPECT_EQ(result.out.rfind("u0,u1,x,y,z,pdf\n", 0), 0u);
        const auto rows = numbers_in(result.out, true);
        ASSERT_EQ(rows.size(), 100u);
        int upper = 0;
        for (const auto& row : rows) {
            ASSERT_EQ(row.size(), 6u);
            EXPECT_TRUE(row[0] >= 0 && row[0] < 1 && row[1] >= 0 && row[1] < 1);
            EXPECT_NEAR(std::hypot(row[2], row[3], row[4]), 1.0, 1e-6);
            EXPECT_GT(row[5], 0.0);
            upper += row[4] > 0;
        }
        // 75 expected: stratified and sobol points cannot stray, random ones by 4 standard deviations.
        EXPECT_NEAR(upper, 75, sequence == "random" ? 18 : 2) << sequence;
    }
}

TEST_F(Commands, SampleIsTheSameOnEveryMachine) {
    const auto head = [this](std::vector<std::string> more) {
        std::vector<std::string> arguments = {"sample", sky, "-n", "2"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return numbers_in(run_acdf(arguments).out, true);
    };
    // The first outputs of std::mt19937_64(1), as the standard fixes them, times 2^-64 to 53 bits.
    const auto random = head({"--seed", "1"});
    ASSERT_EQ(random.size(), 2u);
    EXPECT_EQ(random[0][0], static_cast<double>(2469588189546311528u >> 11) * 0x1p-53);
    EXPECT_EQ(random[0][1], static_cast<double>(2516265689700432462u >> 11) * 0x1p-53);
    EXPECT_NE(head({"--seed", "2"}), random);
    const auto sobol = head({"--sequence", "sobol"});
    EXPECT_EQ(sobol[0][0], 0.0);
    EXPECT_EQ(sobol[1][0], 0.5);
    EXPECT_EQ(sobol[1][1], 0.5);
    EXPECT_NE(head({"--sequence", "sobol", "--seed", "1"}), sobol);
}

// ---- pdf -----------------------------------------------------------------------------------------------

TEST_F(Commands, PdfOfSamplesIsTheirPdf) {
    const Result samples = run_acdf({"sample", sky, "-n", "200", "--seed", "7"});
    const Result evaluated = run_acdf({"pdf", sky}, samples.out);
    ASSERT_EQ(evaluated.code, 0) << evaluated.err;
    const auto rows = numbers_in(samples.out, true), pdfs = numbers_in(evaluated.out, false);
    ASSERT_EQ(pdfs.size(), rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_NEAR(pdfs[i][0], rows[i][5], 1e-6 * rows[i][5]) << i;

    write_text(folder / "samples.csv", samples.out);
    EXPECT_EQ(run_acdf({"pdf", sky, folder / "samples.csv"}).out, evaluated.out);
}

TEST_F(Commands, PdfOfHalvings) {
    write_bytes(sky, small_halvings());
    const Result samples = run_acdf({"sample", sky, "-n", "200", "--seed", "7"});
    const Result evaluated = run_acdf({"pdf", sky}, samples.out);
    ASSERT_EQ(evaluated.code, 0) << evaluated.err;
    const auto rows = numbers_in(samples.out, true), pdfs = numbers_in(evaluated.out, false);
    ASSERT_EQ(pdfs.size(), 200u);
    for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(pdfs[i][0], rows[i][5]) << i;
    // Codes 170 and 100 of 8 bits stand for 0.75153 and 0.33329.
    const auto by_hand =
        numbers_in(run_acdf({"pdf", sky}, "0.6 -0.64 0.48\n0.6 0.64 0.48\n0.6 0 -0.8\n").out, false);
    const double pi = 3.14159265358979323846, upper = 0.751526538, low_phi = 0.333292101;
    EXPECT_NEAR(by_hand[0][0], upper * (1.0 - low_phi) / pi, 1e-6);
    EXPECT_NEAR(by_hand[1][0], upper * low_phi / pi, 1e-6);
    EXPECT_NEAR(by_hand[2][0], (1.0 - upper) / (2 * pi), 1e-6);
}

TEST_F(Commands, PdfReadsWhatPeopleWrite) {
    // By hand: 2/3 of 3/4 over the quarter sphere of phi < 0, 1/3 of it over phi > 0, 1/4 over the lower half.
    const std::string text = "# directions\n 0.6 -0.8 0 # trailing\n\n0.6,0.8,0\r\n+0\t0.6 -8e-1\n2 0 1\nnan 0 1\n";
    const Result result = run_acdf({"pdf", sky}, text);
    ASSERT_EQ(result.code, 0) << result.err;
    const auto pdfs = numbers_in(result.out, false);
    ASSERT_EQ(pdfs.size(), 5u);
    const double pi = 3.14159265358979323846;
    EXPECT_NEAR(pdfs[2][0], 0.25 / (2 * pi), 1e-4);
    EXPECT_EQ(pdfs[3][0], 0.0);
    EXPECT_EQ(pdfs[4][0], 0.0);
    const auto upper = numbers_in(run_acdf({"pdf", sky, "--normalize"}, "6 -8 1\n6 8 1\n0 0 0\n").out, false);
    EXPECT_NEAR(upper[0][0], 0.5 / pi, 1e-4);
    EXPECT_NEAR(upper[1][0], 0.25 / pi, 1e-4);
    EXPECT_EQ(upper[2][0], 0.0);
    EXPECT_EQ(run_acdf({"pdf", sky, "--normalize", "--csv"}, "0 0 0\n").out, "x,y,z,pdf\n0,0,0,0\n");
}

TEST_F(Commands, PdfFindsColumnsByName) {
    const Result plain = run_acdf({"pdf", sky}, "0.6 -0.8 0\n");
    const Result named = run_acdf({"pdf", sky}, "z,weight,x,y\n0,9,0.6,-0.8\n");
    EXPECT_EQ(named.code, 0) << named.err;
    EXPECT_EQ(named.out, plain.out);
    const Result csv = run_acdf({"pdf", sky, "--csv"}, "0.6 -0.8 0\n");
    EXPECT_EQ(csv.out.rfind("x,y,z,pdf\n0.600000024,-0.800000012,0,", 0), 0u) << csv.out;
    const std::string mark = "\xEF\xBB\xBF"; // before numbers, and before a header
    EXPECT_EQ(run_acdf({"pdf", sky, "--csv"}, mark + "0.6 -0.8 0\n").out, csv.out);
    EXPECT_EQ(run_acdf({"pdf", sky, "--csv"}, mark + "x,y,z\r\n0.6,-0.8,0\r\n").out, csv.out);
}

TEST_F(Commands, PdfRefusesMalformedLinesByNumber) {
    for (const std::string line : {"1 2", "1 2 three", "1,2,", "1 2 3 4", "1;2;3", "1 2 +-3"}) {
        const Result result = run_acdf({"pdf", sky, "-o", folder / "out.txt"}, "0 0 1\n# note\n" + line + "\n");
        expect_one_line_error(result, 1, "stdin: line 3: ");
        EXPECT_FALSE(std::filesystem::exists(folder / "out.txt"));
    }
    expect_one_line_error(run_acdf({"pdf", "-"}), 2, "stdin");
    expect_one_line_error(run_acdf({"pdf", sky, folder / "missing.csv"}), 1, "missing.csv: cannot open");
}

} // namespace
