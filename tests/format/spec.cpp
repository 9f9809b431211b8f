// format/SPEC.md against the program: the table of rules and the worked examples.
#include "tests/lib/reader/load.h"
#include "tests/lib/reader/planes.h"

#include <acdf/halvings.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>

using namespace acdf_test;

namespace {

std::vector<std::string> spec_lines() {
    std::ifstream in(ACDF_TEST_DIR "/../format/SPEC.md");
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

// "| a | b |" to its cells.
std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells;
    std::size_t at = line.find('|');
    for (std::size_t end; at != std::string::npos && (end = line.find('|', at + 1)) != std::string::npos;
         at = end) {
        std::string cell = line.substr(at + 1, end - at - 1);
        cell.erase(0, cell.find_first_not_of(' '));
        cell.erase(cell.find_last_not_of(' ') + 1);
        cells.push_back(cell);
    }
    return cells;
}

TEST(Spec, tellsTheRulesOfTheProgram) {
    std::vector<std::vector<std::string>> rows;
    for (const std::string& line : spec_lines()) {
        const auto cells = cells_of(line);
        if (cells.size() == 4 && cells[0].size() == 4 &&
            cells[0].find_first_not_of("0123456789") == std::string::npos)
            rows.push_back(cells);
    }
    ASSERT_EQ(rows.size(), acdf::rule_count);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const acdf::Rule& rule = acdf::rules[i];
        EXPECT_EQ(rows[i][0], std::to_string(rule.number));
        EXPECT_EQ(rows[i][1], rule.severity == acdf::Severity::error ? "error" : "warning") << rule.number;
        EXPECT_EQ(rows[i][2], "`" + std::string(rule.id) + "`") << rule.number;
        EXPECT_EQ(rows[i][3], rule.sentence) << rule.number;
    }
}

// The bytes of block `number` of ```hex: each line an offset, two spaces, bytes, two spaces, a remark.
Bytes worked_example(int number = 0) {
    Bytes bytes;
    int blocks = 0;
    bool in_block = false;
    for (const std::string& line : spec_lines()) {
        if (line.rfind("```", 0) == 0) {
            in_block = line == "```hex" && blocks++ == number;
            continue;
        }
        if (!in_block) continue;
        EXPECT_EQ(std::stoul(line.substr(0, 4), nullptr, 16), bytes.size()) << line;
        for (std::size_t at = 6; at + 1 < line.size() && line[at] != ' '; at += 3)
            bytes.push_back(static_cast<std::uint8_t>(std::stoul(line.substr(at, 2), nullptr, 16)));
    }
    return bytes;
}

/// SPEC.md as one line.
std::string worked_text() {
    std::string text;
    for (const std::string& line : spec_lines()) text += line + ' ';
    return text;
}

TEST(Spec, workedExampleLoads) {
    const Bytes bytes = worked_example();
    const Findings found = findings(bytes);
    EXPECT_TRUE(found.rules.empty()) << found.text;
    acdf::File file;
    const acdf::Status status = acdf::File::from_memory(bytes.data(), bytes.size(), file);
    ASSERT_TRUE(status.ok()) << status.message;
    const auto s = file.environment().sample(0.25, 0.5);
    EXPECT_FLOAT_EQ(s.pdf, 0.0795774715f); // 1 / (4 pi)
    EXPECT_NEAR(s.direction[1], 1.0f, 1e-6f);
}

TEST(Spec, workedExampleIsWhatTheTestsBuild) { EXPECT_EQ(worked_example(), EnvironmentSpec().encode()); }

/// The second example: links, a probability of 1, a tilt.
EnvironmentSpec second_environment() {
    EnvironmentSpec spec;
    spec.columns = 8;
    spec.rows = 4;
    CurveSpec root, child;
    root.axis = 1;
    root.cumulative = {255};
    root.positions = {2};
    root.link_bytes = 1;
    root.children = {1, -1};
    child.cumulative = {64};
    child.positions = {3};
    child.tilts = {0x4000, 0};
    spec.tree = {{root, child}, {}};
    return spec;
}

// Its zlib stream is stored, not deflated, so that chunks are compared as they inflate.
TEST(Spec, secondExampleIsWhatTheTestsBuild) {
    const FileSpec written = taken_apart(worked_example(1)), built = as_planes(second_environment());
    ASSERT_EQ(written.chunks.size(), built.chunks.size());
    for (std::size_t i = 0; i < built.chunks.size(); ++i) {
        EXPECT_EQ(written.chunks[i].type, built.chunks[i].type);
        EXPECT_EQ(written.chunks[i].raw, built.chunks[i].raw) << built.chunks[i].type;
        EXPECT_EQ(written.chunks[i].planes_of, built.chunks[i].planes_of);
        EXPECT_EQ(written.chunks[i].flags, built.chunks[i].flags);
    }
}

// The numbers that the text works out for it.
TEST(Spec, secondExampleLoads) {
    const Bytes bytes = worked_example(1);
    EXPECT_TRUE(findings(bytes).rules.empty()) << findings(bytes).text;
    acdf::File file;
    const acdf::Status status = acdf::File::from_memory(bytes.data(), bytes.size(), file);
    ASSERT_TRUE(status.ok()) << status.message;
    EXPECT_EQ(Bytes(file.tree(), file.tree() + 2 * file.tree_units()), second_environment().tree.encode());
    const auto s = file.environment().sample(0.1, 0.25);
    const std::string text = worked_text();
    for (const float value : {s.direction[0], s.direction[1], s.pdf}) {
        char digits[32];
        std::snprintf(digits, sizeof digits, "%.6f", std::fabs(static_cast<double>(value)));
        EXPECT_NE(text.find(digits), std::string::npos) << digits;
    }
    const float right[3] = {0.6f, 0.0f, 0.8f}, below[3] = {0.6f, 0.0f, -0.8f}, edge[3] = {-0.6f, 0.0f, 0.8f};
    EXPECT_NEAR(file.environment().pdf(right), 0.190736277f, 1e-8f);
    EXPECT_NEAR(file.environment().pdf(edge), 0.5f * 0.106519387f, 1e-8f);
    EXPECT_EQ(file.environment().pdf(below), 0.0f);
}

/// The third example.
EnvironmentSpec halved_environment() {
    EnvironmentSpec spec;
    spec.columns = 8;
    spec.rows = 4;
    spec.halvings.nodes = {{1, 255}, {0, 85}, {1, 200}, {}, {}, {}, {}};
    return spec;
}

TEST(Spec, thirdExampleIsWhatTheTestsBuild) { EXPECT_EQ(worked_example(2), halved_environment().encode()); }

TEST(Spec, thirdExampleLoads) {
    const Bytes bytes = worked_example(2);
    EXPECT_TRUE(findings(bytes).rules.empty()) << findings(bytes).text;
    acdf::File file;
    const acdf::Status status = acdf::File::from_memory(bytes.data(), bytes.size(), file);
    ASSERT_TRUE(status.ok()) << status.message;
    const auto s = file.environment().sample(0.1, 0.25);
    const float right[3] = {0.6f, 0.0f, 0.8f}, low[3] = {0.0f, 0.8f, 0.6f}, below[3] = {0.6f, 0.0f, -0.8f};
    EXPECT_EQ(file.environment().pdf(below), 0.0f);
    const std::string text = worked_text();
    for (const float value : {s.direction[0], s.direction[1], s.direction[2], s.pdf, file.environment().pdf(low),
                              file.environment().pdf(right)}) {
        char digits[32];
        std::snprintf(digits, sizeof digits, "%.6f", std::fabs(static_cast<double>(value)));
        EXPECT_NE(text.find(digits), std::string::npos) << digits;
    }
}

// The table of shares in §5.12.
TEST(Spec, sharesOfCodesAreThoseOfTheProgram) {
    int shares = 0;
    for (const std::string& line : spec_lines()) {
        const auto cells = cells_of(line);
        if (line == "| B | k | share |") shares = 1;
        else if (shares > 0 && cells.size() != 3) break;
        else if (shares > 0 && cells[0].find_first_not_of("0123456789") == std::string::npos) {
            const auto number = [&](std::size_t i) { return static_cast<std::uint32_t>(std::stoul(cells[i])); };
            EXPECT_EQ(acdf_halving_share(number(1), number(0)), number(2)) << line;
            ++shares;
        }
    }
    EXPECT_EQ(shares, 1 + 9);
}

} // namespace
