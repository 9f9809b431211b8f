// Files with visibility cells that break one rule each.
#include "tests/lib/reader/normals_builder.h"
#include "tests/lib/visibility/cases.h"
#include "tests/lib/visibility/load.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace acdf_test {

namespace {

using Make = Action<Bytes()>;

constexpr float infinite = std::numeric_limits<float>::infinity();

Make changed(NormalsSpec (*make)(), Action<void(VisibilitySpec&)> change) {
    return [=] {
        NormalsSpec spec = make();
        change(*spec.visibility);
        return spec.encode();
    };
}
Make with_cells(Action<void(VisibilitySpec&)> change) { return changed(visible_normals, std::move(change)); }
Make regional(Action<void(VisibilitySpec&)> change) { return changed(regional_normals, std::move(change)); }

// Changes the payload of PLAC.
Make payload(Action<void(Bytes&)> change) {
    return [=] {
        FileSpec file = visible_normals().file();
        change(file.chunks.back().raw);
        return file.encode();
    };
}
Make field(std::size_t at, std::uint64_t value) {
    return payload([=](Bytes& raw) { set(raw, at, 4, value); });
}

// `count` splits, each in the upper part of the one before.
Make chain_of_cells(std::uint32_t count) {
    return with_cells([=](VisibilitySpec& visibility) {
        visibility.splits.clear();
        for (std::uint32_t i = 0; i < count; ++i)
            visibility.splits.push_back(
                {float(i), 2, {visibility_row, i + 1 < count ? i + 1 : visibility_row | 1}});
    });
}

} // namespace

std::vector<Case> visibility_cases() {
    return {
        {3009, "critical_visibility",
         [] {
             FileSpec file = visible_normals().file();
             file.chunks.back().flags = 1;
             return file.encode();
         }},
        {3013, "visibility_of_an_environment",
         [] {
             FileSpec file = complete_file();
             file.chunks.push_back({"PLAC", visible_normals().visibility->encode(), 0, false});
             return file.encode();
         }},
        {7009, "without_rows",
         [] {
             FileSpec file = separate_local().file();
             file.chunks.push_back({"PLAC", visible_normals().visibility->encode(), 0, false});
             return file.encode();
         }},
        {7009, "empty", payload([](Bytes& raw) { raw.clear(); })},
        {7009, "cut_in_the_header", payload([](Bytes& raw) { raw.resize(87); })},
        {7009, "too_short", payload([](Bytes& raw) { raw.pop_back(); })},
        {7009, "too_long", payload([](Bytes& raw) { raw.push_back(0); })},
        {7009, "no_rows", field(4, 0)},
        {7009, "most_rows", field(4, 0xFFFFFFFF)},
        {7009, "most_splits", field(0, 0xFFFFFFFF)},
        {7009, "most_columns", field(8, 3)},
        {7009, "a_set_too_many", field(12, 1)},
        {7009, "most_sets", field(12, 0xFFFFFFFF)},
        {7010, "low_is_high", with_cells([](VisibilitySpec& p) { p.low[1] = p.high[1]; })},
        {7010, "infinite_high", with_cells([](VisibilitySpec& p) { p.high[2] = infinite; })},
        {7010, "low_is_no_number", with_cells([](VisibilitySpec& p) { p.low[0] = infinite - infinite; })},
        {7010, "infinite_transform", with_cells([](VisibilitySpec& p) { p.transform[11] = -infinite; })},
        {7011, "itself", with_cells([](VisibilitySpec& p) { p.splits[0].part[1] = 0; })},
        {7011, "no_such_split", with_cells([](VisibilitySpec& p) { p.splits[0].part[1] = 3; })},
        {7011, "no_such_row", with_cells([](VisibilitySpec& p) { p.splits[1].part[0] = visibility_row | 4; })},
        {7011, "high_bits",
         with_cells([](VisibilitySpec& p) { p.splits[1].part[1] = 0x80000000 | visibility_row; })},
        {7011, "split_left_over", with_cells([](VisibilitySpec& p) { p.splits[0].part[1] = visibility_row; })},
        {7011, "not_in_preorder", with_cells([](VisibilitySpec& p) {
             p.splits = {{1.0f, 0, {2, 1}},
                         {0.0f, 1, {visibility_row, visibility_row}},
                         {0.0f, 1, {visibility_row, visibility_row}}};
         })},
        {7011, "too_deep", chain_of_cells(65)},
        {7012, "seventh_axis", with_cells([](VisibilitySpec& p) { p.splits[1].axis = 6; })},
        {7012, "infinite_position", with_cells([](VisibilitySpec& p) { p.splits[0].position = infinite; })},
        {7013, "column_at_the_first_tile", with_cells([](VisibilitySpec& p) { p.columns[1].tile = 0; })},
        {7013, "column_behind_the_tiles", with_cells([](VisibilitySpec& p) { p.columns[0].tile = 3; })},
        {7013, "column_twice", with_cells([](VisibilitySpec& p) { p.columns[1].tile = 2; })},
        {7013, "column_left_out", with_cells([](VisibilitySpec& p) { p.columns[0].parts = no_lower_column; })},
        {7013, "no_such_column", with_cells([](VisibilitySpec& p) { p.columns[1].parts = 0; })},
        {7013, "column_that_comes_too_early", with_cells([](VisibilitySpec& p) {
             p.columns = {{1, 1}, {2, no_lower_column}};
         })},
        {7013, "column_of_a_set", regional([](VisibilitySpec& p) { p.columns[1].tile = 4; })},
        {7014, "nothing_below", with_cells([](VisibilitySpec& p) { p.rows[0][1] = 0; })},
        {7014, "nothing_above", with_cells([](VisibilitySpec& p) { p.rows[2][2] = 255; })},
        {7015, "no_such_set", regional([](VisibilitySpec& p) { p.set_of_row[2] = 2; })},
    };
}

namespace {

TEST(VisibilityRules, whatIsAtTheirLimitsIsRight) {
    expect_visible(visible_normals().encode());
    expect_visible(chain_of_cells(64)());
    expect_visible(regional_normals().encode());
    expect_visible(with_cells([](VisibilitySpec& p) { // one cell
        p.splits.clear();
        p.rows.resize(1);
    })());
    expect_visible(with_cells([](VisibilitySpec& p) { // no column
        p.columns.clear();
        for (Bytes& row : p.rows) row.resize(1);
    })());
    NormalsSpec zipped = visible_normals();
    zipped.zlib = true;
    expect_visible(zipped.encode());
}

} // namespace

} // namespace acdf_test
