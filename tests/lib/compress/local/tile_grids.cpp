// Grids in tiles: no light is lost, whatever the contrast, and bytes go where they gain.
#include "compress/local/tile_grids.h"
#include "tests/extremes/targets.h"
#include "tests/inputs/synthetic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

using namespace acdf_test;

namespace {

using namespace acdf::compress;

/// Light of very different brightness, with darkness in between.
Target spiky_target(std::uint32_t columns, std::uint32_t rows, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    return texel_target(columns, rows, [&](std::uint32_t, std::uint32_t) {
        const double u = double(random() >> 11) * 0x1p-53;
        return random() % 3 == 0 ? 0.0 : std::pow(10.0, 24.0 * u * u * u - 12.0);
    });
}

Box box(std::uint32_t row, std::uint32_t column, std::uint32_t rows, std::uint32_t columns) {
    Box out;
    out.end.fill(1);
    out.begin[0] = row, out.begin[1] = column;
    out.end[0] = row + rows, out.end[1] = column + columns;
    return out;
}

std::uint64_t sum_of(const std::vector<std::uint64_t>& steps, std::size_t begin, std::size_t count) {
    const auto from = steps.begin() + std::ptrdiff_t(begin);
    return std::accumulate(from, from + std::ptrdiff_t(count), std::uint64_t{0});
}

void expect_whole(const TileGrid& grid) {
    ASSERT_LE(grid.count[0], kMostGridCells);
    ASSERT_LE(grid.count[1], kMostGridCells);
    ASSERT_LE(std::max(grid.shift[0], grid.shift[1]), ACDF_FAST_MOST_SHIFT);
    EXPECT_EQ(sum_of(grid.lines, 0, grid.count[1]), kGridSteps);
    for (std::size_t y = 0; y < grid.count[1]; ++y)
        EXPECT_EQ(sum_of(grid.cells, y * grid.count[0], grid.count[0]), kGridSteps);
}

void expect_covers(const Target& target, const Box& tile, const TileGrid& grid) {
    for (std::uint32_t r = 0; r < tile.length(0); ++r)
        for (std::uint32_t c = 0; c < tile.length(1); ++c)
            if (target.row(tile.begin[0] + r)[tile.begin[1] + c] > 0.0f) {
                ASSERT_GT(grid.probability(r >> grid.shift[1], c >> grid.shift[0]), 0.0) << r << ' ' << c;
            }
}

TEST(TileGrids, NoLightIsLost) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const Target target = spiky_target(150, 70, seed);
        const std::vector<Box> tiles = {box(0, 0, 70, 100), box(0, 100, 1, 50), box(1, 100, 69, 1),
                                        box(1, 101, 69, 49)};
        for (const std::uint64_t bytes : {0u, 100u, 1000u, 1000000u}) {
            TileGrids grids(target, tiles, {1.0, 0.0, 2.0, 3.0});
            grids.choose(bytes);
            for (std::size_t t = 0; t < tiles.size(); ++t) {
                expect_whole(grids.grid(t));
                expect_covers(target, tiles[t], grids.grid(t));
            }
        }
    }
}

TEST(TileGrids, OfAnyTarget) {
    std::vector<NamedTarget> all = synthetic_targets();
    for (NamedTarget& t : extreme_targets()) all.push_back(std::move(t));
    for (const NamedTarget& t : all) {
        const std::vector<Box> tiles = {box(0, 0, t.target.rows, t.target.columns)};
        TileGrids grids(t.target, tiles, {1.0});
        grids.choose(1 << 20);
        expect_whole(grids.grid(0));
        expect_covers(t.target, tiles[0], grids.grid(0));
        EXPECT_GE(grids.tile_cost(0), 1.0 - 1e-9) << t.name; // no cells cost less than the light itself
        double amounts = 0.0;
        for (const LitCell& cell : grids.lit_cells(0)) amounts += cell.amount;
        EXPECT_NEAR(std::sqrt(amounts) / grids.tile_cost(0), 1.0, 1e-9) << t.name;
    }
}

TEST(TileGrids, MoreBytesCostNoMore) {
    const Target target = texel_target(256, 128, [](std::uint32_t c, std::uint32_t r) {
        return c == 70 && r == 40 ? 1000.0 : 1.0 + std::sin(0.2 * c) * std::cos(0.1 * r);
    });
    std::vector<Box> tiles;
    for (std::uint32_t i = 0; i < 8; ++i)
        for (std::uint32_t k = 0; k < 8; ++k) tiles.push_back(box(16 * i, 32 * k, 16, 32));
    TileGrids grids(target, tiles, std::vector<double>(tiles.size(), 1.0));
    double before = INFINITY;
    for (const std::uint64_t bytes : {300u, 1000u, 3000u, 10000u, 40000u}) {
        grids.choose(bytes);
        std::vector<std::uint32_t> offsets;
        EXPECT_LE(grids.stored(offsets).size(), bytes + ACDF_FAST_CELLS);
        double cost = 0.0;
        for (std::size_t t = 0; t < tiles.size(); ++t) cost += grids.tile_cost(t);
        EXPECT_LE(cost, before);
        before = cost;
    }
    EXPECT_LT(before, 1.02);
}

TEST(TileGrids, LieOneBehindTheOther) {
    const Target target = spiky_target(64, 32, 7);
    const std::vector<Box> tiles = {box(0, 0, 32, 20), box(0, 20, 10, 44), box(10, 20, 22, 44)};
    TileGrids grids(target, tiles, {1.0, 1.0, 1.0});
    grids.choose(600);
    std::vector<std::uint32_t> offsets;
    const std::vector<std::uint8_t> bytes = grids.stored(offsets);
    std::size_t at = 0;
    for (std::size_t t = 0; t < tiles.size(); ++t) {
        EXPECT_EQ(offsets[t], at);
        EXPECT_EQ(bytes[at], grids.grid(t).shift[0]);
        EXPECT_EQ(bytes[at + 1], grids.grid(t).shift[1]);
        EXPECT_EQ(bytes[at + 1 + grids.grid(t).count[1]], 255);
        at += grids.grid(t).bytes();
        EXPECT_EQ(bytes[at - 1], 255);
    }
    EXPECT_EQ(bytes.size(), at + ACDF_FAST_CELLS);
}

} // namespace
