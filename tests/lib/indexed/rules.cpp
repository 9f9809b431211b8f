// Environments of several maps that break one rule each.
#include "tests/lib/indexed/indexed_builder.h"
#include "tests/lib/indexed/load.h"
#include "tests/lib/reader/check/broken.h"
#include "tests/lib/reader/check/cases.h"

#include <gtest/gtest.h>

#include <cmath>

namespace acdf_test {

namespace {

using Make = Action<Bytes()>;

Make indexed(Action<void(IndexedSpec&)> change) {
    return [=] {
        IndexedSpec spec;
        change(spec);
        return spec.encode();
    };
}
Make indexed_file(Action<void(FileSpec&)> change) {
    return [=] {
        FileSpec file = IndexedSpec().file();
        change(file);
        return file.encode();
    };
}
// MAPS: 16 bytes of header, 16 of coordinates, 48 of maps, 4 of splits, 4 of codes.
Make maps_field(std::size_t at, int size, std::uint64_t value) {
    return indexed_file([=](FileSpec& f) { set(f.chunks[2].raw, at, size, value); });
}
Make axis_field(std::size_t at, int size, std::uint64_t value) {
    return indexed_file([=](FileSpec& f) { set(f.chunks[0].raw, 64 + 2 * 48 + at, size, value); });
}
Make map_changed(Action<void(MapSpec&)> change) {
    return indexed([=](IndexedSpec& spec) { change(spec.maps[1]); });
}

} // namespace

std::vector<Case> indexed_cases() {
    return {
        {3004, "no_maps", indexed_file([](FileSpec& f) { f.chunks.pop_back(); })},
        {3004, "no_halvings_of_maps", indexed_file([](FileSpec& f) { f.chunks.erase(f.chunks.begin() + 1); })},
        {3013, "maps_of_an_environment",
         [] {
             FileSpec file = complete_file();
             file.chunks.push_back(IndexedSpec().file().chunks[2]);
             return file.encode();
         }},
        {6035, "curves_of_maps", indexed_file([](FileSpec& f) { f.chunks.push_back(complete_file().chunks[2]); })},
        {6036, "cut_in_the_header", indexed_file([](FileSpec& f) { f.chunks[2].raw.resize(12); })},
        {6036, "too_short", indexed_file([](FileSpec& f) { f.chunks[2].raw.pop_back(); })},
        {6036, "too_long", indexed_file([](FileSpec& f) { f.chunks[2].raw.push_back(0); })},
        {6036, "more_maps", maps_field(0, 4, 3)},
        {6036, "more_splits_than_halvings", maps_field(4, 4, 4)},
        {6036, "enormous_splits", maps_field(4, 4, 0xFFFFFFFF)},
        {6036, "3_code_bits", maps_field(8, 4, 3)},
        {6036, "13_code_bits", maps_field(8, 4, 13)},
        {6036, "sun_5", maps_field(12, 4, 5)},
        {6037, "below_a_shared_one", indexed([](IndexedSpec& s) {
             s.own = {false, true, true};
         })},
        {6037, "one_fewer", maps_field(80, 4, 1)},
        {6037, "one_more", maps_field(80, 4, 7)},
        {6038, "behind_the_splits", maps_field(80, 4, 0x0B)},
        {6038, "at_the_end_of_the_splits", maps_field(83, 1, 0x80)},
        {6038, "behind_the_codes",
         [] {
             IndexedSpec spec;
             spec.code_bits = 7; // 28 bits of 32
             for (MapSpec& map : spec.maps) map.codes = {100, 20};
             FileSpec file = spec.file();
             file.chunks[2].raw.back() |= 0x80;
             return file.encode();
         }},
        {7020, "no_axis_of_maps", indexed_file([](FileSpec& f) {
             f.chunks[0].raw.resize(64 + 2 * 48);
             set(f.chunks[0].raw, 20, 4, 2);
         })},
        {7020, "four_axes_of_maps", indexed([](IndexedSpec& s) {
             for (const char* name : {"a", "b", "c"}) s.axes.push_back({name, 1, 0, 1, 0.0, 1.0});
         })},
        {7020, "another_count_of_bins", indexed_file([](FileSpec& f) { set(f.chunks[0].raw, 24, 4, 3); })},
        {7020, "cosine", axis_field(20, 4, 1)},
        {7020, "one_step", axis_field(24, 4, 1)},
        {7020, "65537_steps", axis_field(24, 4, 65537)},
        {7021, "falling", indexed([](IndexedSpec& s) {
             s.coordinates = {{18.0, 6.0}};
         })},
        {7021, "another_low", indexed([](IndexedSpec& s) {
             s.coordinates = {{7.0, 18.0}};
         })},
        {7021, "another_high", indexed([](IndexedSpec& s) {
             s.coordinates = {{6.0, 19.0}};
         })},
        {7021, "not_a_number", indexed([](IndexedSpec& s) {
             s.coordinates = {{6.0, NAN}};
         })},
        {7022, "no_share", map_changed([](MapSpec& m) { m.share = 0.0f; })},
        {7022, "shares_of_more_than_1", map_changed([](MapSpec& m) { m.share = 0.76f; })},
        {7022, "all_light_in_the_sun", map_changed([](MapSpec& m) { m.sun_share = 1.0f; })},
        {7022, "less_than_none_in_the_sun", map_changed([](MapSpec& m) { m.sun_share = -0.1f; })},
        {7022, "not_a_number_in_the_sun", map_changed([](MapSpec& m) { m.sun_share = NAN; })},
        {7022, "a_radius_of_2", map_changed([](MapSpec& m) { m.radius = 2.0f; })},
        {7022, "a_tiny_radius", map_changed([](MapSpec& m) { m.radius = 0x1p-11f; })},
        {7022, "a_radius_below_0", map_changed([](MapSpec& m) { m.radius = -0.25f; })},
        {7022, "no_direction", map_changed([](MapSpec& m) { m.sun[2] = 0.0f; })},
        {7022, "a_direction_without_a_radius", map_changed([](MapSpec& m) { m.radius = m.sun_share = 0.0f; })},
        {7022, "a_sun_without_a_profile", indexed([](IndexedSpec& s) { s.sun = 0; })},
    };
}

namespace {

TEST(IndexedRules, whatIsAtTheirLimitsIsRight) {
    const auto valid = [](Action<void(IndexedSpec&)> change) {
        IndexedSpec spec;
        change(spec);
        const Findings found = findings_with_maps(spec.encode());
        EXPECT_TRUE(found.rules.empty()) << found.text;
    };
    valid([](IndexedSpec&) {});
    valid([](IndexedSpec& s) { s.octahedral = true; });
    valid([](IndexedSpec& s) { s.zlib = true; });
    valid([](IndexedSpec& s) {
        s.own = {true, true, true};
        for (MapSpec& map : s.maps) map.codes = {0, 255, 128};
    });
    valid([](IndexedSpec& s) {
        s.own = {false, false, false};
        for (MapSpec& map : s.maps) map.codes.clear();
    });
    valid([](IndexedSpec& s) { // a leaf
        s.halvings.nodes = {{}};
        s.own.clear();
        for (MapSpec& map : s.maps) map.codes.clear();
    });
    valid([](IndexedSpec& s) {
        s.sun = 0;
        for (MapSpec& map : s.maps) map = {map.share, 0.0f, 0.0f, {0.0f, 0.0f, 0.0f}, map.codes};
    });
    valid([](IndexedSpec& s) { s.code_bits = 12; });
}

} // namespace

} // namespace acdf_test
