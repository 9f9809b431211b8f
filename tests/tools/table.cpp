// acdf table, and the other subcommands on what it makes.
#include "tests/inputs/paths.h"
#include "tests/inputs/sanitized.h"
#include "tests/inputs/table_files.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <sstream>

namespace {

using namespace acdf::test;
using nlohmann::json;

std::string quoted(const std::string& path) { return "'" + path + "'"; }

/// A 3 x 6 x 5 table in a folder.
std::string write_table(const Folder& folder) {
    write_text(folder / "a.npy", npy_file(noisy_array({3, 6, 5}, 2, 0.1).values, {3, 6, 5}));
    return folder / "a.npy";
}

std::vector<std::vector<double>> csv(const std::string& text) {
    std::vector<std::vector<double>> rows;
    std::istringstream in(text);
    std::string line, field;
    std::getline(in, line); // header
    while (std::getline(in, line)) {
        rows.emplace_back();
        std::istringstream fields(line);
        while (std::getline(fields, field, ',')) rows.back().push_back(std::strtod(field.c_str(), nullptr));
    }
    return rows;
}

TEST(TableCommand, MakesAFileThatInfoValidateAndMeasureRead) {
    const Folder folder;
    const std::string source = write_table(folder), file = folder / "a.acdf";
    Result made = run_acdf({"table", source, "-o", file, "--indexed", "1", "--names", "t,x,y", "--range", "x=-1:1",
                            "--range", "2=10:5", "--cells", "12", "--json"});
    ASSERT_EQ(made.code, 0) << made.err;
    const json report = json::parse(made.out);
    EXPECT_EQ(report["bins"], 3);
    EXPECT_EQ(report["support_violations"], 0);

    const json info = json::parse(run_acdf({"info", "--json", file}).out);
    EXPECT_EQ(info["kind"], "table");
    EXPECT_EQ(info["bins"], 3);
    EXPECT_EQ(info["axes"][0]["name"], "t");
    EXPECT_EQ(info["axes"][0]["role"], "indexed");
    EXPECT_EQ(info["axes"][1]["low"], -1.0);
    EXPECT_EQ(info["axes"][2]["high"], 5.0);
    EXPECT_EQ(info["source"]["name"], "a.npy");
    EXPECT_EQ(info["options"], "--indexed 1 --cells 12");
    EXPECT_EQ(info["accuracy"]["relative_variance"],
              std::strtod(info["accuracy"]["relative_variance"].dump().c_str(), nullptr));
    EXPECT_EQ(run_acdf({"info", file}).code, 0);
    EXPECT_EQ(run_acdf({"validate", "--strict", file}).code, 0);

    const json measured = json::parse(run_acdf({"measure", file, "--against", source, "--json"}).out);
    for (const char* key :
         {"relative_variance", "relative_variance_median", "relative_variance_worst", "max_weight", "cells"})
        EXPECT_EQ(measured[key], report[key]) << key;
    const Result text = run_acdf({"measure", file, "--against", source});
    EXPECT_EQ(text.code, 0);
    EXPECT_NE(text.out.find("worst bin"), std::string::npos);
    EXPECT_EQ(text.err, "");
}

TEST(TableCommand, NamesOfAxesAddNoLinesToInfo) {
    const Folder folder;
    const std::string source = write_table(folder), file = folder / "a.acdf";
    ASSERT_EQ(run_acdf({"table", source, "-o", file, "--names", "t,x,y"}).code, 0);
    const std::size_t lines = lines_in(run_acdf({"info", file}).out);
    ASSERT_EQ(run_acdf({"table", source, "-f", "-o", file, "--names", "t\n  x\x1b[1m,x,y"}).code, 0);
    const std::string told = run_acdf({"info", file}).out;
    EXPECT_EQ(lines_in(told), lines) << told;
    EXPECT_NE(told.find("axes         t   x\\x1b[1m (sampled"), std::string::npos) << told;
}

TEST(TableCommand, SampleAndPdfAgree) {
    const Folder folder;
    const std::string source = write_table(folder), file = folder / "a.acdf";
    ASSERT_EQ(run_acdf({"table", source, "-o", file, "--indexed", "1", "--range", "x1=-1:1"}).code, 0);
    const Result samples = run_acdf({"sample", file, "-n", "200", "--at", "2"});
    ASSERT_EQ(samples.code, 0) << samples.err;
    EXPECT_EQ(samples.out.substr(0, samples.out.find('\n')), "u0,u1,x0,x1,pdf");
    const Result evaluated = run_acdf({"pdf", file, "--at", "2"}, samples.out);
    ASSERT_EQ(evaluated.code, 0) << evaluated.err;
    const auto rows = csv(samples.out);
    ASSERT_EQ(rows.size(), 200u);
    std::istringstream in(evaluated.out);
    for (const auto& row : rows) {
        double pdf = 0.0;
        in >> pdf;
        EXPECT_EQ(pdf, row[4]);
        EXPECT_TRUE(row[2] >= -1.0 && row[2] <= 1.0 && row[3] >= 0.0 && row[3] <= 5.0);
    }
    EXPECT_EQ(run_acdf({"sample", file, "-n", "9", "--at", "0", "--sequence", "sobol"}).code, 0);
    EXPECT_EQ(run_acdf({"pdf", file, "--at", "0"}, "0.5 1\n9 9\nnan 1\n").code, 0);
    EXPECT_EQ(run_acdf({"pdf", file, "--at", "0", "--csv"}, "9 9\n").out, "x0,x1,pdf\n9,9,0\n");
}

TEST(TableCommand, OneAxisAndFive) {
    const Folder folder;
    for (const ShapeVector& shape : {ShapeVector{40}, ShapeVector{3, 4, 5, 4, 3}}) {
        write_text(folder / "a.npy", npy_file(noisy_array(shape, 3).values, shape));
        ASSERT_EQ(run_acdf({"table", folder / "a.npy", "-o", folder / "a.acdf", "-f", "--cells", "20"}).code, 0);
        const Result samples = run_acdf({"sample", folder / "a.acdf", "-n", "50"});
        const auto rows = csv(samples.out);
        ASSERT_EQ(rows.size(), 50u);
        EXPECT_EQ(rows[0].size(), 2 * shape.size() + 1);
        EXPECT_EQ(lines_in(run_acdf({"pdf", folder / "a.acdf"}, samples.out).out), 50u);
    }
    EXPECT_EQ(run_acdf({"sample", folder / "a.acdf", "-n", "5", "--sequence", "sobol"}).code, 1);
}

TEST(TableCommand, TheSameBytesForAnyNumberOfThreads) {
    const Folder folder;
    const ShapeVector shape{4, 40, 30};
    write_text(folder / "a.npy", npy_file(noisy_array(shape, 3).values, shape));
    std::string first;
    for (const char* threads : {"1", "2", "7"}) {
        ASSERT_EQ(run_acdf({"table", folder / "a.npy", "-o", folder / "a.acdf", "-f", "--indexed", "1", "--budget",
                            "4KiB", "--threads", threads})
                      .code,
                  0);
        const std::string bytes = read_text(folder / "a.acdf");
        EXPECT_LE(bytes.size(), 4096u);
        if (first.empty()) first = bytes;
        EXPECT_EQ(bytes, first);
    }
}

TEST(TableCommand, FortranOrderAndDoublesMakeTheSameTree) {
    const Folder folder;
    const std::vector<float> values = noisy_array({6, 5}, 2).values;
    std::vector<double> columns;
    for (std::size_t j = 0; j < 5; ++j)
        for (std::size_t i = 0; i < 6; ++i) columns.push_back(double{values[i * 5 + j]});
    write_text(folder / "c.npy", npy_file(values, {6, 5}));
    write_text(folder / "f.npy", npy_file(columns, {6, 5}, true));
    for (const char* name : {"c", "f"})
        ASSERT_EQ(
            run_acdf({"table", folder / (std::string(name) + ".npy"), "-o", folder / (std::string(name) + ".acdf")})
                .code,
            0);
    EXPECT_EQ(run_acdf({"sample", folder / "c.acdf", "-n", "20"}).out,
              run_acdf({"sample", folder / "f.acdf", "-n", "20"}).out);
}

TEST(TableCommand, MistakesAreOneLineWithTheRightCode) {
    const Folder folder;
    const std::string source = write_table(folder), file = folder / "a.acdf";
    ASSERT_EQ(run_acdf({"table", source, "-o", file, "--indexed", "1"}).code, 0);
    struct Mistake {
        int code;
        std::vector<std::string> arguments;
        const char* says;
    };
    const std::string out = folder / "b.acdf";
    write_text(folder / "bad.npy", npy_file(std::vector<float>{1, -1}, {2}));
    write_text(folder / "black.npy", npy_file(std::vector<float>{0, 0}, {2}));
    write_text(folder / "other.npy", npy_file(std::vector<float>{1, 1}, {2}));
    const std::vector<Mistake> mistakes = {
        {1, {"table", source, "-o", file}, "--force"},
        {1, {"table", source, "-o", out, "--indexed", "3"}, "one at least is sampled"},
        {2, {"table", source, "-o", out, "--indexed", "6"}, "--indexed"},
        {2, {"table", source, "-o", out, "--cells", "5", "--budget", "1MB"}, "enough"},
        {2, {"table", source, "-o", out, "--budget", "lots"}, "needs a size"},
        {2, {"table", source, "-o", out, "--range", "x9=0:1"}, "none of the 3 axes"},
        {2, {"table", source, "-o", out, "--range", "3=0:1"}, "none of the 3 axes"},
        {2, {"table", source, "-o", out, "--range", "0=zero:1"}, "AXIS=LOW:HIGH"},
        {1, {"table", source, "-o", out, "--range", "0=1:1"}, "empty"},
        {2, {"table", source, "-o", out, "--range", "x1=0:1", "--range", "1=0:2"}, "the second one for axis 1"},
        {1, {"table", source, "-o", out, "--names", "abcdefghijklmnop,b,c"}, "more than 15 bytes"},
        {1, {"table", source, "-o", out, "--budget", "100"}, "out of reach"},
        {1, {"table", source, "-o", out, "--names", "a,b"}, "2 names"},
        {1, {"table", folder / "bad.npy", "-o", out}, "--bad-values zero"},
        {1, {"table", folder / "black.npy", "-o", out}, "nothing to sample"},
        {1, {"table", folder / "none.npy", "-o", out}, "No such file"},
        {1, {"sample", file, "-n", "5"}, "--at I,J"},
        {1, {"sample", file, "-n", "5", "--at", "3"}, "beyond its axis"},
        {1, {"sample", file, "-n", "5", "--at", "0,0"}, "1 indexed axis"},
        {1, {"pdf", file, source, "--at", "0", "--normalize"}, "no directions"},
        {1, {"measure", file, "--against", folder / "other.npy"}, "its shape is 2, but"},
        {1, {"plot", file, "-o", folder / "b.png"}, "kind 'table'"},
    };
    for (const Mistake& mistake : mistakes) {
        const Result result = run_acdf(mistake.arguments);
        EXPECT_EQ(result.code, mistake.code) << mistake.says << ": " << result.err;
        EXPECT_NE(result.err.find(mistake.says), std::string::npos) << result.err;
        EXPECT_EQ(lines_in(result.err), 1u) << result.err;
        EXPECT_EQ(result.out, "");
    }
    EXPECT_FALSE(std::filesystem::exists(out));
    const Result zeroed = run_acdf({"table", folder / "bad.npy", "-o", out, "--bad-values", "zero"});
    EXPECT_EQ(zeroed.code, 0);
    EXPECT_NE(zeroed.err.find("1 negative numbers set to 0, the first at [1]"), std::string::npos) << zeroed.err;
}

TEST(TableCommand, CompressedFilesSampleTheSame) {
    const Folder folder;
    const std::string source = write_table(folder);
    ASSERT_EQ(run_acdf({"table", source, "-o", folder / "n.acdf", "--cells", "80"}).code, 0);
    ASSERT_EQ(run_acdf({"table", source, "-o", folder / "z.acdf", "--cells", "80", "--compress", "zlib"}).code, 0);
    EXPECT_LT(read_text(folder / "z.acdf").size(), read_text(folder / "n.acdf").size());
    EXPECT_EQ(run_acdf({"sample", folder / "z.acdf", "-n", "9"}).out,
              run_acdf({"sample", folder / "n.acdf", "-n", "9"}).out);
}

/// Runs one command line of the guide in `folder`, with the programs that it calls by their names.
std::string guide_output(const Folder& folder, const std::string& command) {
    const std::string program = quoted(acdf_test::kProgram), examples = acdf_test::kExamples;
    const std::string script =
        "cd " + quoted(folder / "") + " && acdf() { " + program + " \"$@\"; }; " + "light_field() { " +
        quoted(examples + "/light_field") + " \"$@\"; }; " + "read_table() { " + quoted(examples + "/read_table") +
        " \"$@\"; }; " + "light_at_point() { " + quoted(examples + "/light_at_point") + " \"$@\"; }; " + command;
    EXPECT_EQ(std::system(("{ " + script + "; } > " + quoted(folder / "output") + " 2>&1").c_str()), 0) << command;
    return read_text(folder / "output");
}

// Every command of docs/table.md, in order, prints what the page says. With ACDF_RENEW set in the environment the
// page is rewritten instead.
TEST(TableCommand, TheGuideShowsRealOutput) {
    ACDF_NOT_SANITIZED();
    const std::string path = std::string(ACDF_TEST_DIR) + "/../docs/table.md", page = read_text(path);
    const Folder folder;
    std::istringstream in(page);
    std::string line, real;
    int commands = 0;
    for (bool console = false; std::getline(in, line);) {
        if (line.rfind("```", 0) == 0) console = line == "```console";
        const bool command = console && line.rfind("$ ", 0) == 0;
        if (!console || command || line == "```console") real += line + "\n"; // the rest is output
        if (!command) continue;
        real += guide_output(folder, line.substr(2));
        ++commands;
    }
    EXPECT_GE(commands, 6);
    if (std::getenv("ACDF_RENEW")) write_text(path, real);
    else EXPECT_EQ(page, real);
}

// The lines of C++ on the page are those of the program that was compiled.
TEST(TableCommand, TheGuideShowsCompiledCode) {
    const std::string docs = std::string(ACDF_TEST_DIR) + "/../docs/";
    const std::string program = read_text(docs + "examples/read_table.cpp");
    std::istringstream in(read_text(docs + "table.md"));
    std::string line;
    int lines = 0;
    for (bool code = false; std::getline(in, line);) {
        if (line.rfind("```", 0) == 0) {
            code = line == "```cpp";
        } else if (code) {
            EXPECT_NE(program.find(line + "\n"), std::string::npos) << line;
            ++lines;
        }
    }
    EXPECT_GE(lines, 4);
}

} // namespace
