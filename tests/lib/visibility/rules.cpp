// For every rule of visibility cells and portals a file that breaks it and no other.
#include "reader/check/check.h"
#include "tests/lib/reader/normals_builder.h"
#include "tests/lib/visibility/cases.h"
#include "tests/lib/visibility/load.h"

#include <acdf/visibility/visibility_c.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <set>
#include <string>
#include <vector>

using namespace acdf_test;

namespace {

std::vector<Case> cases() {
    std::vector<Case> all = visibility_cases();
    for (const Case& c : portal_cases()) all.push_back(c);
    return all;
}

class BrokenVisibility : public testing::TestWithParam<Case> {};

TEST_P(BrokenVisibility, isFoundAndNoOther) {
    const Case& c = GetParam();
    const Bytes file = c.make();
    const Findings found = visible_findings(file);
    EXPECT_EQ(std::set<int>(found.rules.begin(), found.rules.end()), std::set<int>{c.rule}) << found.text;
    EXPECT_LE(found.last_offset, file.size());
    const acdf::Status status = load_visible(file);
    EXPECT_EQ(status.code, acdf::code_of(c.rule));
    EXPECT_EQ(status.rule, c.rule) << status.message;
    EXPECT_LE(status.offset, file.size());
    EXPECT_NE(std::strstr(status.message, std::to_string(c.rule).c_str()), nullptr) << status.message;
    EXPECT_EQ(std::strchr(status.message, '\n'), nullptr) << status.message;
}

/// Without cells and portals, a file that breaks their rules serves normals.
TEST_P(BrokenVisibility, isNoMatterForTheReader) {
    const Case& c = GetParam();
    if (c.rule >= 7009) {
        EXPECT_TRUE(load(c.make()).ok());
    }
}

INSTANTIATE_TEST_SUITE_P(Rules, BrokenVisibility, testing::ValuesIn(cases()),
                         [](const auto& info) { return std::to_string(info.param.rule) + "_" + info.param.name; });

TEST(VisibilityRules, eachHasABrokenFile) {
    std::set<int> tested;
    for (const Case& c : cases()) tested.insert(c.rule);
    for (int rule = 7009; rule <= 7019; ++rule) EXPECT_TRUE(tested.count(rule)) << rule;
}

/// For other readers (tests/format/decoder.py): as of those of the reader.
TEST(VisibilityRules, brokenFilesAreWrittenWhereAskedFor) {
    const char* folder = std::getenv("ACDF_BROKEN_FILES");
    if (!folder) GTEST_SKIP() << "ACDF_BROKEN_FILES names no folder";
    for (const Case& c : cases()) {
        const Bytes file = c.make();
        std::ofstream out(std::string(folder) + "/" + std::to_string(c.rule) + "_" + c.name + ".acdf",
                          std::ios::binary);
        out.write(reinterpret_cast<const char*>(file.data()), static_cast<std::streamsize>(file.size()));
        ASSERT_TRUE(out.flush()) << folder;
    }
}

TEST(VisibilityRules, viewsInCSayWhatIsWrong) {
    NormalsSpec spec = visible_normals();
    const Bytes good = spec.encode();
    spec.visibility->rows[0][1] = 0;
    const Bytes bad = spec.encode(), table = table_file().encode();
    AcdfVisibleLocal view;
    AcdfError error;
    AcdfFile* file = acdf_from_memory(good.data(), good.size(), nullptr);
    EXPECT_EQ(acdf_visible_local(file, &view, &error), 1);
    EXPECT_EQ(error.code, ACDF_OK);
    EXPECT_EQ(acdf_visible_local(file, &view, nullptr), 1);
    acdf_close(file);
    file = acdf_from_memory(bad.data(), bad.size(), nullptr);
    EXPECT_EQ(acdf_visible_local(file, &view, &error), 0);
    EXPECT_EQ(error.code, ACDF_MALFORMED);
    EXPECT_EQ(error.rule, 7014);
    acdf_close(file);
    file = acdf_from_memory(table.data(), table.size(), nullptr);
    EXPECT_EQ(acdf_visible_local(file, &view, &error), 0);
    EXPECT_EQ(error.code, ACDF_UNSUPPORTED);
    EXPECT_NE(error.message[0], 0);
    acdf_close(file);
    EXPECT_EQ(acdf_visible_local(nullptr, &view, &error), 0);
}

} // namespace
