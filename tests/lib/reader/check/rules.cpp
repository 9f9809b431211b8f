// For every rule of the table a file that breaks it and no other.
#include "rules/rules.h"
#include "reader/check/check.h"
#include "tests/lib/indexed/load.h"
#include "tests/lib/reader/brdf_builder.h"
#include "tests/lib/reader/check/broken.h"
#include "tests/lib/reader/check/cases.h"
#include "tests/lib/reader/normals_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <limits>

using namespace acdf_test;

namespace {

std::vector<Case> cases() {
    std::vector<Case> all = container_cases();
    for (auto make : {plane_cases, partner_cases, description_cases, tree_cases, table_cases, local_cases,
                      brdf_cases, halvings_cases, indexed_cases, normals_cases})
        for (const Case& c : make()) all.push_back(c);
    return all;
}

class BrokenRule : public testing::TestWithParam<Case> {};

TEST_P(BrokenRule, isFoundAndNoOther) {
    const Case& c = GetParam();
    const acdf::Rule* rule = acdf::find_rule(c.rule);
    ASSERT_NE(rule, nullptr);
    const Bytes file = c.make();
    const Findings found = findings_with_maps(file, c.limits);
    EXPECT_EQ(std::set<int>(found.rules.begin(), found.rules.end()), std::set<int>{c.rule}) << found.text;
    EXPECT_LE(found.last_offset, file.size());
    const acdf::Status status = load_with_maps(file, c.limits);
    EXPECT_EQ(status.code, acdf::code_of(c.rule));
    if (rule->severity == acdf::Severity::warning) return;
    EXPECT_EQ(status.rule, c.rule) << status.message;
    EXPECT_NE(std::strstr(status.message, std::to_string(c.rule).c_str()), nullptr) << status.message;
    EXPECT_EQ(std::strchr(status.message, '\n'), nullptr) << status.message;
}

std::string case_name(const testing::TestParamInfo<Case>& info) {
    std::string id = acdf::find_rule(info.param.rule)->id;
    for (char& letter : id)
        if (letter == '-') letter = '_';
    return std::to_string(info.param.rule) + "_" + id + "_" + info.param.name;
}

INSTANTIATE_TEST_SUITE_P(Rules, BrokenRule, testing::ValuesIn(cases()), case_name);

TEST(Rules, theCompleteFilesBreakNone) {
    for (const FileSpec& spec :
         {complete_file(), spare_file(), table_file(), chain(1).file(), chain(64).file(), small_normals().file(),
          separate_local().file(), shared_brdf().file(), separate_brdf().file()}) {
        const Findings found = findings(spec.encode());
        EXPECT_TRUE(found.rules.empty()) << found.text;
    }
    EXPECT_TRUE(load(table_shares(0.5f + 0x1p-21f)()).ok()); // what rounding leaves
    FileSpec spaced = complete_file();
    spaced.chunks.push_back({"X ~!", {1, 2, 3}, 0, false});
    EXPECT_TRUE(load(spaced.encode()).ok());
}

// Unit 0 is not a root of its own.
TEST(Rules, unitZeroIsARootWhereTheSpecificationSaysSo) {
    BrdfSpec spec = separate_brdf();
    spec.tree.curves.insert(spec.tree.curves.begin(), CurveSpec());
    for (CurveSpec& curve : spec.tree.curves)
        for (int& child : curve.children) child += child >= 0;
    for (BinSpec& bin : spec.bins) ++bin.root;
    EXPECT_EQ(findings(spec.encode()).rules, std::multiset<int>{6012}); // a warning
    LocalSpec local = separate_local();                                 // where unit 0 is the whole environment's
    for (BinSpec& bin : local.bins) bin = {no_root, 0.0f};
    EXPECT_TRUE(findings(local.encode()).rules.empty());
}

TEST(Rules, eachHasABrokenFile) {
    std::set<int> tested = {1001, 1002, 1003, 1004}; // reader_load.cpp: Open.rule1001 and so on
    for (const Case& c : cases()) tested.insert(c.rule);
    for (int rule = 7009; rule <= 7019; ++rule) tested.insert(rule); // tests/lib/visibility
    for (std::size_t i = 0; i < acdf::rule_count; ++i)
        EXPECT_TRUE(tested.count(acdf::rules[i].number)) << acdf::rules[i].number << " has no broken file";
}

// For other readers (tests/format/decoder.py): RULE_name.acdf for each broken file, in the folder that a variable
// names.
TEST(Rules, brokenFilesAreWrittenWhereAskedFor) {
    const char* folder = std::getenv("ACDF_BROKEN_FILES");
    if (!folder) GTEST_SKIP() << "ACDF_BROKEN_FILES names no folder";
    for (const Case& c : cases()) {
        if (c.limits.max_inflated_bytes != acdf::Limits().max_inflated_bytes) continue;
        const Bytes file = c.make();
        std::ofstream out(std::string(folder) + "/" + std::to_string(c.rule) + "_" + c.name + ".acdf",
                          std::ios::binary);
        out.write(reinterpret_cast<const char*>(file.data()), static_cast<std::streamsize>(file.size()));
        ASSERT_TRUE(out.flush()) << folder;
    }
}

TEST(Rules, someAxisIsSampled) {
    FileSpec file = spare_file();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        set(file.chunks[0].raw, 64 + 48 * axis + 16, 4, 1); // indexed
        set(file.chunks[0].raw, 64 + 48 * axis + 24, 4, 1); // of one step
    }
    EXPECT_EQ(load(file.encode()).rule, 5012);
    EXPECT_EQ(findings(file.encode()).rules, std::multiset<int>{5012});
}

TEST(Rules, areSortedAndNamedOnce) {
    std::set<std::string> ids;
    for (std::size_t i = 0; i < acdf::rule_count; ++i) {
        const acdf::Rule& rule = acdf::rules[i];
        if (i > 0) {
            EXPECT_LT(acdf::rules[i - 1].number, rule.number);
        }
        const bool same_id_elsewhere = !ids.insert(rule.id).second;
        EXPECT_FALSE(same_id_elsewhere) << rule.number << ' ' << rule.id;
        EXPECT_EQ(rule.severity == acdf::Severity::warning, acdf::code_of(rule.number) == ACDF_OK) << rule.number;
    }
    EXPECT_EQ(acdf::find_rule(2002), &acdf::rules[5]);
    EXPECT_EQ(acdf::find_rule(9999), nullptr);
}

// Faults that do not hide each other are all reported; the sink may stop.
TEST(Validate, reportsAllFindings) {
    Bytes file = complete_file().encode();
    set(file, 28, 4, 5);                                 // two feature bits
    set(file, payload_of(file, "DESC") + 56, 8, 0);      // total 0
    set(file, payload_of(file, "TREE") + 34, 2, 0x8000); // tilt
    set(file, payload_of(file, "TREE") + 11, 1, 7);      // curve padding
    file.back() = 1;                                     // file padding
    seal(file);
    const Findings found = findings(file);
    EXPECT_EQ(found.rules, (std::multiset<int>{2007, 2007, 4002, 5010, 6011, 6013})) << found.text;
    int calls = 0;
    const acdf::Verdict verdict = acdf::validate(
        file.data(), file.size(), [&](const acdf::Finding&) { return ++calls < 3; }, acdf::with_curves());
    EXPECT_EQ(calls, 3);
    EXPECT_EQ(verdict.errors, 3u);
    EXPECT_FALSE(verdict.valid());
}

} // namespace
