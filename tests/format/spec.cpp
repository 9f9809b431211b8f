// format/SPEC.md against the program: the table of rules and the worked example.
#include "tests/lib/reader/load.h"

#include <gtest/gtest.h>

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

// The bytes of the block ```hex: each line an offset, two spaces, bytes, two spaces, a remark.
Bytes worked_example() {
    Bytes bytes;
    bool in_block = false;
    for (const std::string& line : spec_lines()) {
        if (line.rfind("```", 0) == 0) {
            in_block = line == "```hex";
            continue;
        }
        if (!in_block) continue;
        EXPECT_EQ(std::stoul(line.substr(0, 4), nullptr, 16), bytes.size()) << line;
        for (std::size_t at = 6; at + 1 < line.size() && line[at] != ' '; at += 3)
            bytes.push_back(static_cast<std::uint8_t>(std::stoul(line.substr(at, 2), nullptr, 16)));
    }
    return bytes;
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

} // namespace
