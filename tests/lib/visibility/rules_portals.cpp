// Files with portals that break one rule each.
#include "tests/lib/reader/normals_builder.h"
#include "tests/lib/visibility/cases.h"
#include "tests/lib/visibility/load.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace acdf_test {

namespace {

using MakePortals = Action<Bytes()>;

constexpr float no_bound = std::numeric_limits<float>::infinity();

MakePortals windowed(Action<void(PortalsSpec&)> change) {
    return [=] {
        NormalsSpec spec = windowed_normals();
        change(*spec.portals);
        return spec.encode();
    };
}

// Changes the payload of PORT.
MakePortals portal_payload(Action<void(Bytes&)> change) {
    return [=] {
        FileSpec file = windowed_normals().file();
        change(file.chunks.back().raw);
        return file.encode();
    };
}
MakePortals portal_word(std::size_t at, std::uint64_t value) {
    return portal_payload([=](Bytes& raw) { set(raw, at, 4, value); });
}

constexpr std::size_t sums_begin = 16 + 3 * 24 + 2 * 40; // of windowed_normals

} // namespace

std::vector<Case> portal_cases() {
    return {
        {3009, "critical_portals",
         [] {
             FileSpec file = windowed_normals().file();
             file.chunks.back().flags = 1;
             return file.encode();
         }},
        {3013, "portals_of_an_environment",
         [] {
             FileSpec file = complete_file();
             file.chunks.push_back({"PORT", windowed_normals().portals->encode(), 0, false});
             return file.encode();
         }},
        {7016, "without_visibility",
         [] {
             NormalsSpec spec = windowed_normals();
             spec.visibility.reset();
             return spec.encode();
         }},
        {7016, "empty", portal_payload([](Bytes& raw) { raw.clear(); })},
        {7016, "cut_in_the_header", portal_payload([](Bytes& raw) { raw.resize(15); })},
        {7016, "too_short", portal_payload([](Bytes& raw) { raw.pop_back(); })},
        {7016, "too_long", portal_payload([](Bytes& raw) { raw.push_back(0); })},
        {7016, "no_portals", portal_word(0, 0)},
        {7016, "nine_portals", portal_word(0, 9)},
        {7016, "no_maps", portal_word(4, 0)},
        {7016, "more_maps_than_portals", portal_word(4, 4)},
        {7016, "no_cells", portal_word(8, 0)},
        {7016, "too_many_cells", portal_word(8, 4097)},
        {7016, "most_cells", portal_word(8, 0xFFFFFFFF)},
        {7016, "no_pieces", portal_word(12, 0)},
        {7016, "five_pieces", portal_word(12, 5)},
        {7017, "corner_is_no_number",
         windowed([](PortalsSpec& p) { p.portals[0].corner[1] = no_bound - no_bound; })},
        {7017, "infinite_side", windowed([](PortalsSpec& p) { p.portals[1].sides[1] = no_bound; })},
        {7017, "no_side", windowed([](PortalsSpec& p) { p.portals[2].sides[0] = 0.0f; })},
        {7017, "no_such_map", windowed([](PortalsSpec& p) { p.portals[2].map = 2; })},
        {7018, "axis_of_another_length", windowed([](PortalsSpec& p) { p.maps[0].axis[1] = 1.001f; })},
        {7018, "axes_askew", windowed([](PortalsSpec& p) { p.maps[1].axis[5] = 0.01f; })},
        {7018, "axis_is_no_number", windowed([](PortalsSpec& p) { p.maps[1].axis[8] = no_bound - no_bound; })},
        {7018, "no_unit", windowed([](PortalsSpec& p) { p.maps[0].unit = 0.0f; })},
        {7018, "infinite_unit", windowed([](PortalsSpec& p) { p.maps[1].unit = no_bound; })},
        {7019, "a_row_that_does_not_begin_at_0", portal_word(sums_begin, 1)},
        {7019, "a_column_that_does_not_begin_at_0", portal_word(sums_begin + 4 * 5, 1)},
        {7019, "less_than_nothing_in_a_cell", portal_word(sums_begin + 4 * 12, 3)},
        {7019, "the_second_map", portal_word(sums_begin + 4 * 25 + 4 * 6, 0xFFFFFFFF)},
    };
}

namespace {

TEST(PortalRules, whatIsAtTheirLimitsIsRight) {
    expect_visible(windowed_normals().encode());
    expect_visible(windowed([](PortalsSpec& p) { // one portal, of one piece, and a map of one cell without light
        p.portals.resize(1);
        p.maps.resize(1);
        p.size = p.pieces = 1;
        p.maps[0].light = {0};
        for (Bytes& row : p.rows) row.resize(2);
    })());
    expect_visible(windowed([](PortalsSpec& p) { // eight portals of sixteen pieces
        p.portals.resize(8, p.portals[2]);
        p.pieces = 4;
        for (Bytes& row : p.rows) row.resize(1 + 8 * 16);
    })());
    NormalsSpec zipped = windowed_normals();
    zipped.zlib = true;
    expect_visible(zipped.encode());
}

} // namespace

} // namespace acdf_test
