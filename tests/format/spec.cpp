// format/SPEC.md and format/examples.md against the program: rules and worked examples.
#include "tests/lib/curves/open.h"
#include "tests/lib/curves/planes.h"
#include "tests/lib/reader/load.h"

#include "rules/rules.h"

#include <acdf/curves/curves.h>
#include <acdf/halvings.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

using namespace acdf_test;

namespace {

std::vector<std::string> lines_of(const std::string& page) {
    std::ifstream in(ACDF_TEST_DIR "/../format/" + page);
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

/// The rows of all tables of rules, by number: "6012, a warning" and the sentence.
std::vector<std::pair<std::string, std::string>> spec_rules() {
    std::vector<std::pair<std::string, std::string>> rules;
    for (const std::string& line : lines_of("SPEC.md")) {
        const auto cells = cells_of(line);
        if (cells.size() == 2 && cells[0].size() >= 4 && cells[0].find_first_not_of("0123456789") >= 4)
            rules.emplace_back(cells[0], cells[1]);
    }
    std::sort(rules.begin(), rules.end());
    return rules;
}

TEST(Spec, hasTheRulesOfTheProgram) {
    const auto rows = spec_rules();
    ASSERT_EQ(rows.size(), acdf::rule_count);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const acdf::Rule& rule = acdf::rules[i];
        const char* severity = rule.severity == acdf::Severity::error ? "" : ", a warning";
        EXPECT_EQ(rows[i].first, std::to_string(rule.number) + severity);
        EXPECT_EQ(rows[i].second, rule.sentence) << rule.number;
    }
}

// The bytes of block `number` of ```hex: each line an offset, two spaces, bytes, two spaces, a remark. Bytes that
// are not listed are 0.
Bytes worked_example(int number) {
    Bytes bytes;
    int blocks = 0;
    bool in_block = false;
    for (const std::string& line : lines_of("examples.md")) {
        if (line.rfind("```", 0) == 0) {
            in_block = line == "```hex" && blocks++ == number;
            continue;
        }
        if (!in_block) continue;
        const std::size_t offset = std::stoul(line.substr(0, 4), nullptr, 16);
        EXPECT_GE(offset, bytes.size()) << line;
        bytes.resize(offset, 0);
        for (std::size_t at = 6; at + 1 < line.size() && line[at] != ' '; at += 3)
            bytes.push_back(static_cast<std::uint8_t>(std::stoul(line.substr(at, 2), nullptr, 16)));
    }
    return bytes;
}

/// examples.md as one line.
std::string worked_text() {
    std::string text;
    for (const std::string& line : lines_of("examples.md")) text += line + ' ';
    return text;
}

void expect_in_text(std::initializer_list<float> values) {
    const std::string text = worked_text();
    for (const float value : values) {
        char digits[32];
        std::snprintf(digits, sizeof digits, "%.6f", std::fabs(static_cast<double>(value)));
        EXPECT_NE(text.find(digits), std::string::npos) << digits;
    }
}

/// The first example.
EnvironmentSpec halved_environment() {
    EnvironmentSpec spec;
    spec.columns = 8;
    spec.rows = 4;
    spec.halvings.nodes = {{1, 255}, {0, 85}, {1, 200}, {}, {}, {}, {}};
    return spec;
}

Bytes first_example() {
    Bytes bytes = worked_example(0);
    pad_to(bytes, 64);
    return bytes;
}

TEST(Spec, firstExampleIsWhatTheTestsBuild) { EXPECT_EQ(first_example(), halved_environment().encode()); }

// The numbers that the text works out for it.
TEST(Spec, firstExampleLoads) {
    const Bytes bytes = first_example();
    EXPECT_TRUE(findings(bytes).rules.empty()) << findings(bytes).text;
    acdf::File file;
    const acdf::Status status = acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves());
    ASSERT_TRUE(status.ok()) << status.message;
    const auto s = file.environment().sample(0.1, 0.25);
    const float right[3] = {0.6f, 0.0f, 0.8f}, low[3] = {0.0f, 0.8f, 0.6f}, below[3] = {0.6f, 0.0f, -0.8f};
    EXPECT_EQ(file.environment().pdf(below), 0.0f);
    expect_in_text({s.direction[0], s.direction[1], s.direction[2], s.pdf, file.environment().pdf(low),
                    file.environment().pdf(right)});
}

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

/// A file with the payload of the text, whose zlib stream is stored, not deflated.
Bytes second_example() {
    FileSpec file = second_environment().file();
    const std::uint64_t raw_length = file.chunks[2].raw.size();
    file.chunks[2].raw = worked_example(1);
    Bytes bytes = file.encode();
    set(bytes, chunk_at(2) + 8, 4, 2);
    set(bytes, chunk_at(2) + 32, 8, raw_length);
    seal(bytes);
    return bytes;
}

TEST(Spec, secondExampleIsWhatTheTestsBuild) {
    const FileSpec written = taken_apart(second_example()), built = as_planes(second_environment());
    ASSERT_EQ(written.chunks.size(), built.chunks.size());
    EXPECT_EQ(written.chunks[2].raw, built.chunks[2].raw);
    EXPECT_EQ(written.chunks[2].planes_of, built.chunks[2].planes_of);
}

TEST(Spec, secondExampleLoads) {
    const Bytes bytes = second_example();
    EXPECT_TRUE(findings(bytes).rules.empty()) << findings(bytes).text;
    acdf::File file;
    const acdf::Status status = acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves());
    ASSERT_TRUE(status.ok()) << status.message;
    const Bytes tree(TreeOf(file).data, TreeOf(file).data + 2 * TreeOf(file).units);
    EXPECT_EQ(tree, second_environment().tree.encode());
    std::string listed;
    for (const std::uint8_t byte : tree) {
        char digits[4];
        std::snprintf(digits, sizeof digits, "%02X ", byte);
        listed += digits;
    }
    EXPECT_NE(worked_text().find("TREE is the 14 bytes " + listed.substr(0, 18) + "and " + listed.substr(18, 23)),
              std::string::npos)
        << listed;
    const auto s = file.environment().sample(0.1, 0.25);
    expect_in_text({s.direction[0], s.direction[1], s.pdf});
    const float right[3] = {0.6f, 0.0f, 0.8f}, below[3] = {0.6f, 0.0f, -0.8f}, edge[3] = {-0.6f, 0.0f, 0.8f};
    EXPECT_NEAR(file.environment().pdf(right), 0.190736277f, 1e-8f);
    EXPECT_NEAR(file.environment().pdf(edge), 0.5f * 0.106519387f, 1e-8f);
    EXPECT_EQ(file.environment().pdf(below), 0.0f);
}

// The table of shares in §6.2.
TEST(Spec, sharesOfCodesAreThoseOfTheProgram) {
    int shares = 0;
    for (const std::string& line : lines_of("SPEC.md")) {
        const auto cells = cells_of(line);
        if (line == "| B | k | share |") shares = 1;
        else if (shares > 0 && cells.size() != 3) break;
        else if (shares > 0 && cells[0].find_first_not_of("0123456789") == std::string::npos) {
            const auto number = [&](std::size_t i) { return static_cast<std::uint32_t>(std::stoul(cells[i])); };
            EXPECT_EQ(acdf_halving_share(number(1), number(0)), number(2)) << line;
            ++shares;
        }
    }
    EXPECT_EQ(shares, 1 + 6);
}

} // namespace
