// Files of the fast shape that break one rule each.
#include "tests/lib/reader/check/cases.h"
#include "tests/lib/reader/load.h"
#include "tests/lib/reader/local_builder.h"

#include <gtest/gtest.h>

namespace acdf_test {

namespace {

using Make = Action<Bytes()>;

Make fast(Action<void(LocalSpec&)> change) {
    return [=] {
        LocalSpec spec = fast_local();
        change(spec);
        return spec.encode();
    };
}
Make row(Action<void(FastRow&)> change) {
    return fast([=](LocalSpec& spec) { change(spec.fast->rows[1]); });
}
Make grid(std::size_t tile, Action<void(FastGrid&)> change) {
    return fast([=](LocalSpec& spec) { change(spec.fast->grids[tile]); });
}

// Changes the chunks: DESC, BINS, TREE, TILE, SUMS, GRID, LOCL.
constexpr std::size_t tile_at = 3, sums_at = 4, grid_at = 5;
Make chunks(Action<void(std::vector<ChunkSpec>&)> change) {
    return [=] {
        FileSpec file = fast_local().file();
        change(file.chunks);
        return file.encode();
    };
}
Make payload(std::size_t chunk, Action<void(Bytes&)> change) {
    return chunks([=](std::vector<ChunkSpec>& list) { change(list[chunk].raw); });
}
Make without(std::size_t chunk) {
    return chunks([=](std::vector<ChunkSpec>& list) { list.erase(list.begin() + std::ptrdiff_t(chunk)); });
}

} // namespace

std::vector<Case> fast_cases() {
    return {
        {3009, "ancillary_sums", chunks([](std::vector<ChunkSpec>& list) { list[sums_at].flags = 0; })},
        {3009, "ancillary_grid", chunks([](std::vector<ChunkSpec>& list) { list[grid_at].flags = 0; })},
        {3013, "sums_of_an_environment",
         [] {
             FileSpec file = complete_file();
             file.chunks.push_back({"SUMS", fast_local().fast->sum_chunk(), 1, false});
             return file.encode();
         }},
        {3013, "grid_of_a_table",
         [] {
             FileSpec file = table_file();
             file.chunks.push_back({"GRID", fast_local().fast->grid_chunk(), 1, false});
             return file.encode();
         }},
        {6026, "bin_with_a_row_behind_the_last", fast([](LocalSpec& spec) { spec.bins[2].root = 2; })},
        {6027, "without_sums", without(sums_at)},
        {6027, "without_grid", without(grid_at)},
        {6027, "beside_rows", chunks([](std::vector<ChunkSpec>& list) {
             list.push_back({"ROWS", Bytes(4, 100), 1, false});
         })},
        {6027, "beside_visibility", chunks([](std::vector<ChunkSpec>& list) {
             list.push_back({"PLAC", visibility_local().visibility->encode(), 0, false});
         })},
        {6027, "beside_portals", chunks([](std::vector<ChunkSpec>& list) {
             list.push_back({"PORT", windowed_local().portals->encode(), 0, false});
         })},
        {6027, "without_roots",
         payload(tile_at,
                 [](Bytes& raw) {
                     set(raw, 4, 4, 0);
                     raw.resize(raw.size() - 12);
                 })},
        {6028, "sums_cut", payload(sums_at, [](Bytes& raw) { raw.pop_back(); })},
        {6028, "sums_too_long", payload(sums_at, [](Bytes& raw) { raw.push_back(0); })},
        {6028, "no_sums", payload(sums_at, [](Bytes& raw) { raw.clear(); })},
        {6028, "fewer_rows_than_told", payload(tile_at, [](Bytes& raw) { set(raw, 8, 4, 3); })},
        {6028, "group_below_the_whole", row([](FastRow& r) { r.groups = {32766}; })},
        {6028, "group_above_the_whole", row([](FastRow& r) { r.groups = {32768}; })},
        {6028, "padding_of_groups", payload(sums_at, [](Bytes& raw) { set(raw, 2 * 7, 2, 32766); })},
        {6028, "tiles_below_the_whole", row([](FastRow& r) {
             r.tiles = {10, 20, 254};
         })},
        {6028, "tiles_that_decrease", row([](FastRow& r) {
             r.tiles = {21, 20, 255};
         })},
        {6028, "share_behind_the_last_tile", row([](FastRow& r) {
             r.tiles = {21, 30, 100, 255};
         })},
        {6029, "grid_cut", payload(grid_at, [](Bytes& raw) { raw.pop_back(); })},
        {6029, "grid_too_long", payload(grid_at, [](Bytes& raw) { raw.push_back(0); })},
        {6029, "grid_of_nothing", payload(grid_at, [](Bytes& raw) { raw.clear(); })},
        {6029, "grid_ends_in_the_last_tile", payload(grid_at, [](Bytes& raw) { raw.resize(raw.size() - 68); })},
        {6029, "padding_is_not_zero", payload(grid_at, [](Bytes& raw) { raw.back() = 1; })},
        {6029, "root_elsewhere", payload(tile_at, [](Bytes& raw) { set(raw, 528 + 16 + 4, 4, 7); })},
        {6029, "root_that_tells_a_cell",
         payload(tile_at, [](Bytes& raw) { set(raw, 528 + 16 + 4, 4, 0xFFFFFFFF); })},
        {6029, "shift_too_large", grid(1, [](FastGrid& g) { g.shift[1] = 31; })},
        {6029, "largest_shift", grid(1, [](FastGrid& g) { g.shift[0] = 255; })},
        {6029, "too_many_cells", fast([](LocalSpec& spec) {
             spec.columns = 134; // of which tile 2 has 131
             spec.fast->grids[2].cells = {Bytes(66, 255), Bytes(66, 255)};
         })},
        {6029, "lines_below_the_whole",
         grid(0,
              [](FastGrid& g) {
                  g.lines = {90, 90, 200, 254};
              })},
        {6029, "lines_that_decrease",
         grid(0,
              [](FastGrid& g) {
                  g.lines = {90, 89, 200, 255};
              })},
        {6029, "cells_below_the_whole",
         grid(0,
              [](FastGrid& g) {
                  g.cells[1] = {0, 0, 0};
              })},
        {6029, "cells_that_decrease",
         grid(0,
              [](FastGrid& g) {
                  g.cells[3] = {254, 1, 255};
              })},
        {7007, "light_in_a_row",
         [] {
             LocalSpec spec = fast_lit_local();
             spec.fast->rows[1].tiles = {200, 201, 255};
             return spec.encode();
         }},
    };
}

namespace {

TEST(FastRules, whatIsAtTheirLimitsIsRight) {
    expect_valid(fast_local().encode());
    expect_valid(fast_lit_local().encode());
    LocalSpec zipped = fast_lit_local();
    zipped.zlib = true;
    expect_valid(zipped.encode());
    LocalSpec one = fast_local(); // one tile of 64 x 1 cells, and the largest shift
    one.columns = 64;
    one.tiles = 1;
    one.splits.clear();
    one.fast->rows = {{{32767}, {255}}, {{32767}, {255}}};
    one.fast->grids = {{{0, 30}, {255}, {Bytes(64, 255)}}};
    expect_valid(one.encode());
    expect_valid([] { // a light in a row that no bin with light has
        LocalSpec spec = fast_lit_local();
        spec.fast->rows.push_back({{32767}, {1, 2, 255}});
        spec.bins[0] = {2, 0.0f};
        return spec.encode();
    }());
}

// Every truncation, and every byte of the two chunks changed, with CRCs that fit: refused, or sampled from safely.
TEST(FastRules, changedBytesAreRefusedOrSafe) {
    for (const char* type : {"SUMS", "GRID", "TILE"}) {
        const FileSpec good = fast_lit_local().file();
        std::size_t chunk = 0;
        while (good.chunks[chunk].type != type) ++chunk;
        const std::size_t size = good.chunks[chunk].raw.size();
        for (std::size_t i = 0; i < size; i += i < 16 || i >= 528 || std::string(type) != "TILE" ? 1 : 64)
            for (const int value : {0, 1, 128, 255}) {
                FileSpec file = good;
                file.chunks[chunk].raw[i] = static_cast<std::uint8_t>(value);
                const Bytes bytes = file.encode();
                acdf::File opened;
                if (!acdf::File::from_memory(bytes.data(), bytes.size(), opened).ok()) continue;
                const acdf::LocalEnvironmentView view = opened.local();
                for (int k = 0; k < 16; ++k) {
                    const float n[3] = {static_cast<float>(k % 3 - 1), static_cast<float>(k % 5 - 2), 0.5f};
                    const acdf::DirectionSample s = view.sample(n, k / 15.0, 1.0 - k / 15.0);
                    ASSERT_TRUE(s.pdf >= 0.0f);
                    ASSERT_EQ(view.pdf(n, s.direction), s.pdf);
                }
            }
    }
}

} // namespace

} // namespace acdf_test
