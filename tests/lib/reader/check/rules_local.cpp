// Files of kind 2 that break one rule each, and what they must not hide.
#include "tests/lib/reader/check/cases.h"
#include "tests/lib/reader/load.h"
#include "tests/lib/reader/local_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace acdf_test {

namespace {

using Make = Action<Bytes()>;
using Change = Action<void(LocalSpec&)>;

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

// Changes the parts before they become a file.
Make with(LocalSpec (*make)(), Change change) {
    return [=] {
        LocalSpec spec = make();
        change(spec);
        return spec.encode();
    };
}
Make shared(Change change) { return with(shared_local, std::move(change)); }
Make lit(Change change) { return with(lit_local, std::move(change)); }
Make light(Action<void(BrightTileSpec&)> change) {
    return lit([=](LocalSpec& spec) { change(spec.bright_tiles[0]); });
}

// Changes the payload of a chunk.
Make payload(LocalSpec (*make)(), const char* type, Action<void(Bytes&)> change) {
    return [=] {
        FileSpec file = make().file();
        for (ChunkSpec& chunk : file.chunks)
            if (chunk.type == type) change(chunk.raw);
        return file.encode();
    };
}
Make field(LocalSpec (*make)(), const char* type, std::size_t at, int size, std::uint64_t value) {
    return payload(make, type, [=](Bytes& raw) { set(raw, at, size, value); });
}
Make without(LocalSpec (*make)(), const char* type) {
    return [=] {
        FileSpec file = make().file();
        for (std::size_t i = file.chunks.size(); i-- > 0;)
            if (file.chunks[i].type == type) file.chunks.erase(file.chunks.begin() + std::ptrdiff_t(i));
        return file.encode();
    };
}
Make beside(FileSpec (*make)(), const char* type, const Bytes& raw) {
    return [=] {
        FileSpec file = make();
        file.chunks.push_back({type, raw, 1, false});
        return file.encode();
    };
}

// Axes anew; `bins` of them.
Make axes(LocalSpec (*make)(), std::uint32_t bins, Action<void(std::vector<AxisSpec>&)> change) {
    return [=] {
        LocalSpec spec = make();
        spec.bins.resize(bins, {no_root, 0.0f});
        FileSpec file = spec.file();
        DescriptionSpec description = spec.description();
        change(description.axes);
        file.chunks[0].raw = description.encode();
        return file.encode();
    };
}

// `count` splits, each in the upper part of the one before.
Make chain_of_splits(std::uint32_t count) {
    return shared([count](LocalSpec& spec) {
        spec.columns = 200;
        spec.tree = {{CurveSpec{}}, {}};
        spec.tiles = count + 1;
        spec.tile_curves.clear();
        spec.splits.clear();
        for (std::uint32_t i = 0; i < count; ++i)
            spec.splits.push_back({0, i + 1, {tile_flag | i, i + 1 < count ? i + 1 : tile_flag | count}});
        spec.codes.assign(2, Bytes(count, 254));
    });
}

// A curve that only a tile leads to.
Make curve_of_tile(int tile, const CurveSpec& curve) {
    return shared([=](LocalSpec& spec) {
        spec.tile_curves[std::size_t(tile)] = static_cast<int>(spec.tree.curves.size());
        spec.tree.curves.push_back(curve);
    });
}

CurveSpec one_byte_split(std::uint32_t axis, std::uint32_t position, std::uint32_t origin) {
    CurveSpec curve = even_curve(axis, {position});
    curve.position_bytes = 1;
    curve.origin = origin;
    return curve;
}

std::vector<Case> chunk_cases() {
    const Bytes no_lights(8, 0), one_tile = [] {
        LocalSpec spec;
        spec.tiles = 1;
        spec.codebook = even_codebook();
        return spec.tile_chunk();
    }();
    return {
        {3009, "ancillary_tiles",
         [] {
             FileSpec file = shared_local().file();
             file.chunks[3].flags = 0;
             return file.encode();
         }},
        {3013, "lights_of_an_environment", beside(complete_file, "LOCL", no_lights)},
        {3013, "lights_of_a_table", beside(table_file, "LOCL", no_lights)},
        {3013, "tiles_of_an_environment", beside(complete_file, "TILE", one_tile)},
        {3013, "tiles_of_a_table", beside(table_file, "TILE", one_tile)},
        {3013, "rows_of_a_table", beside(table_file, "ROWS", {1, 2, 3})},
        {6020, "empty", payload(shared_local, "TILE", [](Bytes& raw) { raw.clear(); })},
        {6020, "cut_in_the_codebook", payload(shared_local, "TILE", [](Bytes& raw) { raw.resize(527); })},
        {6020, "cut_in_the_splits", payload(lit_local, "TILE", [](Bytes& raw) { raw.resize(528 + 8); })},
        {6020, "too_long", payload(shared_local, "TILE", [](Bytes& raw) { raw.resize(raw.size() + 4); })},
        {6020, "no_tiles", field(shared_local, "TILE", 0, 4, 0)},
        {6020, "too_many_tiles", field(shared_local, "TILE", 0, 4, 32769)},
        {6020, "most_tiles", field(shared_local, "TILE", 0, 4, 0xFFFFFFFF)},
        {6020, "two_roots", field(shared_local, "TILE", 4, 4, 2)},
        {6020, "no_roots", field(shared_local, "TILE", 4, 4, 0)},
        {6020, "reserved", field(shared_local, "TILE", 12, 4, 1)},
        {6021, "begins_late", shared([](LocalSpec& spec) { spec.codebook[0] = 1; })},
        {6021, "ends_early", shared([](LocalSpec& spec) { spec.codebook[255] = 65534; })},
        {6021, "equal", shared([](LocalSpec& spec) { spec.codebook[7] = spec.codebook[8]; })},
        {6022, "tiles_swapped",
         lit([](LocalSpec& spec) { std::swap(spec.splits[1].child[0], spec.splits[1].child[1]); })},
        {6022, "tile_twice", shared([](LocalSpec& spec) { spec.splits[1].child[1] = tile_flag | 1; })},
        {6022, "no_such_tile", shared([](LocalSpec& spec) { spec.splits[1].child[1] = tile_flag | 3; })},
        {6022, "itself", shared([](LocalSpec& spec) { spec.splits[0].child[1] = 0; })},
        {6022, "no_such_split", shared([](LocalSpec& spec) { spec.splits[0].child[1] = 2; })},
        {6022, "too_few_tiles", shared([](LocalSpec& spec) { spec.splits[1].child[1] = 2; })},
        {6022, "split_left_over", shared([](LocalSpec& spec) {
             spec.tiles = 4;
             spec.splits.push_back({1, 5, {tile_flag | 2, tile_flag | 3}});
             spec.tile_curves.push_back(-1);
             for (Bytes& row : spec.codes) row.push_back(9);
         })},
        {6022, "too_deep", chain_of_splits(49)},
        {6023, "third_axis", shared([](LocalSpec& spec) { spec.splits[1].axis = 2; })},
        {6023, "at_the_low_end", shared([](LocalSpec& spec) {
             spec.splits[1] = {0, 3, {tile_flag | 1, tile_flag | 2}};
         })},
        {6023, "at_the_high_end", shared([](LocalSpec& spec) { spec.splits[1].position = 8; })},
        {6023, "beyond", lit([](LocalSpec& spec) { spec.splits[0].position = 0x1FFFFFFF; })},
        {6024, "inside_a_curve", field(shared_local, "TILE", 528 + 16, 4, 1)},
        {6024, "beyond_the_tree", field(shared_local, "TILE", 528 + 16 + 8, 4, 18)},
        {6025, "no_rows", without(shared_local, "ROWS")},
        {6025, "no_tiles", beside([] { return separate_local().file(); }, "ROWS", {1, 2, 3})},
        {6025, "too_long", payload(lit_local, "ROWS", [](Bytes& raw) { raw.push_back(0); })},
        {6025, "far_too_short", payload(lit_local, "ROWS", [](Bytes& raw) { raw.clear(); })},
        {6025, "too_short", payload(shared_local, "ROWS", [](Bytes& raw) { raw.pop_back(); })},
        {6025, "more_rows", field(shared_local, "TILE", 8, 4, 3)},
        {6025, "most_rows", field(shared_local, "TILE", 8, 4, 0xFFFFFFFF)},
        {6026, "one_too_many", shared([](LocalSpec& spec) { spec.bins[5].root = 2; })},
        {6026, "enormous", lit([](LocalSpec& spec) { spec.bins[0].root = no_root - 1; })},
    };
}

// Rules of the tree, where tiles lead to it.
std::vector<Case> split_cases() {
    return {
        {6003, "axis_of_normals", field(separate_local, "TREE", 32, 2, 1 << 10 | 0x202)},
        {6007, "beyond_its_tile", curve_of_tile(0, even_curve(0, {3}))},
        {6007, "before_its_tile", curve_of_tile(2, even_curve(0, {3}))},
        {6007, "on_the_other_axis", curve_of_tile(1, even_curve(1, {2}))},
        {6007, "one_byte", curve_of_tile(1, one_byte_split(0, 8, 3))},
        {6010, "of_a_bin",
         [] {
             FileSpec file = separate_local().file();
             set(file.chunks[1].raw, 8, 4, 1);
             return file.encode();
         }},
        {6012, "of_no_tile", shared([](LocalSpec& spec) { spec.tree.curves.push_back(even_curve(1, {4})); })},
        {6012, "of_no_bin",
         with(separate_local, [](LocalSpec& spec) { spec.tree.curves.push_back(even_curve(1, {4})); })},
        {6016, "behind_the_environment",
         with(separate_local,
              [](LocalSpec& spec) {
                  spec.tree = chain(65).tree;
                  for (BinSpec& bin : spec.bins) bin.root = no_root;
              })},
        {6017, "infinite", shared([](LocalSpec& spec) { spec.bins[2].share = HUGE_VALF; })},
        {6019, "two_tiles", // whose columns begin at 0 and 3
         shared([](LocalSpec& spec) {
             spec.tree.curves.push_back(one_byte_split(0, 1, 0));
             spec.tile_curves = {3, 3, 2};
         })},
    };
}

std::vector<Case> kind_cases() {
    return {
        {5016, "table", field(shared_local, "DESC", 0, 4, 3)},
        {7001, "of_a_local", field(shared_local, "DESC", 64 + 48 + 20, 4, 0)},
        {7003, "two_axes", axes(separate_local, 1, [](auto& all) { all.resize(2); })},
        {7003, "five_axes",
         axes(separate_local, 6,
              [](auto& all) {
                  all.push_back({"more", 1, 0, 1, 0.0, 1.0});
              })},
        {7003, "name", axes(shared_local, 6, [](auto& all) { all[2].name = "normals"; })},
        {7003, "role", axes(shared_local, 6, [](auto& all) { all[2].role = 0; })},
        {7003, "measure", axes(shared_local, 6, [](auto& all) { all[2].measure = 1; })},
        {7003, "low", axes(shared_local, 6, [](auto& all) { all[2].low = 1.0; })},
        {7003, "high", axes(shared_local, 6, [](auto& all) { all[2].high = 1.0; })},
        {7003, "no_octahedron",
         axes(shared_local, 7,
              [](auto& all) {
                  all[2].resolution = 7;
                  all[2].high = 7.0;
              })},
        {7003, "exchanged", axes(separate_local, 6, [](auto& all) { std::swap(all[2], all[3]); })},
        {7003, "theta_from_below", axes(separate_local, 6, [](auto& all) { std::swap(all[2].low, all[2].high); })},
        {7003, "phi_the_other_way", axes(separate_local, 6, [](auto& all) { std::swap(all[3].low, all[3].high); })},
        {7003, "wide_grid",
         axes(separate_local, 65537,
              [](auto& all) {
                  all[2].resolution = 1;
                  all[3].resolution = 65537;
              })},
        {7004, "one_less", axes(shared_local, 5, [](auto&) {})},
        {7004, "wrapped",
         axes(separate_local, 0x10000,
              [](auto& all) { // 2^32 + 2^16 bins
                  all[2].resolution = 65536;
                  all[3].resolution = 65536;
              })},
        {7005, "none", without(shared_local, "LOCL")},
        {7005, "empty", payload(shared_local, "LOCL", [](Bytes& raw) { raw.clear(); })},
        {7005, "cut", payload(lit_local, "LOCL", [](Bytes& raw) { raw.pop_back(); })},
        {7005, "too_long", payload(lit_local, "LOCL", [](Bytes& raw) { raw.push_back(0); })},
        {7005, "too_many",
         payload(lit_local, "LOCL",
                 [](Bytes& raw) {
                     raw.resize(8 + 65 * 40);
                     set(raw, 4, 4, 65);
                 })},
        {7005, "enormous", field(lit_local, "LOCL", 4, 4, 0xFFFFFFFF)},
        {7005, "all_cosine", shared([](LocalSpec& spec) { spec.cosine_share = 1.0f; })},
        {7005, "negative_cosine", with(separate_local, [](LocalSpec& spec) { spec.cosine_share = -0.25f; })},
        {7005, "nan_cosine", shared([](LocalSpec& spec) { spec.cosine_share = not_a_number; })},
        {7006, "no_such_tile", light([](BrightTileSpec& l) { l.tile = 3; })},
        {7006, "without_tiles", with(separate_local, [](LocalSpec& spec) { spec.bright_tiles.resize(1); })},
        {7006, "twice", lit([](LocalSpec& spec) { spec.bright_tiles.push_back(spec.bright_tiles[0]); })},
        {7006, "falling", lit([](LocalSpec& spec) {
             spec.bright_tiles.push_back(spec.bright_tiles[0]);
             spec.bright_tiles[1].tile = 0;
             spec.bright_tiles[1].low = {0, 0};
             spec.bright_tiles[1].high = {3, 8};
         })},
        {7006, "other_box", light([](BrightTileSpec& l) {
             l.high = {8, 3};
         })},
        {7006, "other_corner", light([](BrightTileSpec& l) {
             l.low = {4, 0};
         })},
        {7006, "long", light([](BrightTileSpec& l) { l.direction[0] = 0.7f; })},
        {7006, "nowhere", light([](BrightTileSpec& l) { l.direction[1] = not_a_number; })},
        {7006, "no_radius", light([](BrightTileSpec& l) { l.radius = 0.0f; })},
        {7006, "wide", light([](BrightTileSpec& l) { l.radius = 2.5f; })},
        {7006, "nan_radius", light([](BrightTileSpec& l) { l.radius = not_a_number; })},
        {7006, "dark", light([](BrightTileSpec& l) { l.share = 0.0f; })},
        {7006, "infinite", light([](BrightTileSpec& l) { l.share = HUGE_VALF; })},
        {7007, "last_split", lit([](LocalSpec& spec) {
             spec.codes[0] = {100, 1};
         })},
        {7007, "first_split", lit([](LocalSpec& spec) {
             spec.codes[1] = {254, 77};
         })},
        {7007, "other_side", lit([](LocalSpec& spec) {
             spec.codes[0] = {0, 255};
         })},
    };
}

} // namespace

std::vector<Case> local_cases() {
    std::vector<Case> all;
    for (auto make : {chunk_cases, split_cases, kind_cases})
        for (const Case& c : make()) all.push_back(c);
    return all;
}

namespace {

TEST(LocalRules, whatIsAtTheirLimitsIsRight) {
    expect_valid(chain_of_splits(48)());
    expect_valid(curve_of_tile(0, even_curve(0, {1, 2}))());
    expect_valid(curve_of_tile(1, one_byte_split(0, 7, 3))());
    expect_valid(lit([](LocalSpec& spec) { spec.zlib = true; })());
    expect_valid(lit([](LocalSpec& spec) { // a row that no bin with light has
        spec.codes.push_back({1, 1});
        spec.bins[0] = {2, 0.0f};
    })());
    expect_valid(light([](BrightTileSpec& l) { l.radius = 2.0f; })());
    LocalSpec one = separate_local();
    one.tiles = 1;
    one.codebook = even_codebook();
    one.codes.resize(1);
    one.bins.assign(6, {0, 1.0f});
    expect_valid(one.encode());
    one.bright_tiles.resize(1); // the only tile: nothing is left for the mixture
    one.bright_tiles[0].high = {8, 8};
    for (BinSpec& bin : one.bins) bin.share = 0.0f;
    expect_valid(one.encode());
}

// A tile is as wrong as its root: the fault is reported at that position.
TEST(LocalRules, findingsStandWhereTheFaultIs) {
    const Bytes root = field(shared_local, "TILE", 528 + 16 + 8, 4, 18)();
    EXPECT_EQ(findings(root).last_offset, payload_of(root, "TILE") + 528 + 16 + 8);
    const Bytes row = shared([](LocalSpec& spec) { spec.bins[5].root = 2; })();
    EXPECT_EQ(findings(row).last_offset, payload_of(row, "BINS") + 5 * 8);
    const Bytes book = shared([](LocalSpec& spec) { spec.codebook[7] = spec.codebook[8]; })();
    EXPECT_EQ(findings(book).last_offset, payload_of(book, "TILE") + 16 + 2 * 8);
    const Bytes source = lit([](LocalSpec& spec) { spec.codes[0] = {100, 1}; })();
    EXPECT_EQ(findings(source).last_offset, payload_of(source, "LOCL") + 8);
}

TEST(LocalRules, faultsDoNotHideEachOther) {
    LocalSpec spec = lit_local();
    spec.codebook[0] = 1;
    spec.bins[1].share = -1.0f;
    spec.bins[5].root = 7;
    spec.cosine_share = 2.0f;
    spec.bright_tiles[0].radius = 0.0f;
    const Findings found = findings(spec.encode());
    EXPECT_EQ(found.rules, (std::multiset<int>{6017, 6021, 6026, 7005, 7006})) << found.text;
}

} // namespace

} // namespace acdf_test
