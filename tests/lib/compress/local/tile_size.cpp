// Sizes of trees over tiles, known before they are made.
#include "compress/local/tile_size.h"
#include "compress/local/light.h"
#include "compress/local/normals.h"
#include "compress/store/store.h"
#include "tests/extremes/targets.h"
#include "tests/inputs/sanitized.h"
#include "tests/inputs/synthetic.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

using namespace acdf_test;

namespace {

using namespace acdf::compress;

/// Prices upwards and downwards, as a search has them, before and after the partitions have grown.
void expect_sizes(const Target& target, std::uint32_t count, double most_ratio, WholeTree whole) {
    const NormalBins bins = octahedral_bins(3);
    const TileTree tiles = divide_tiles(target, worth(target, bins, irradiance(light_points(target), bins)), count);
    std::vector<double> worth_of_tiles(tiles.tiles.size(), 1.0 / integral(target));
    worth_of_tiles[0] = 0.0; // stays whole
    TileCurves curves(target, tiles.tiles, worth_of_tiles);
    // Behind a tree of the whole environment that ends between two offsets for integers of four bytes, too.
    const std::vector<std::uint8_t> before =
        whole == WholeTree::own ? std::vector<std::uint8_t>(66) : std::vector<std::uint8_t>();
    TileSizer sizer(tiles, curves, most_ratio, whole, before.size());
    for (const double refined : {1e-5, 1e-9}) {
        curves.refine(refined);
        sizer.forget();
        for (const double price : {1.0, 1e-4, 3e-4, 1e-6, 1.1e-6, 1e-9, 1e-7}) {
            const TileCascade made(tiles, curves, price, whole);
            for (const double byte_price : {2.0 * price, 0.1 * price})
                EXPECT_EQ(sizer.bytes(price, byte_price),
                          encode_tree(made.cascade, byte_price, most_ratio, before).bytes.size())
                    << price << ", " << byte_price;
        }
    }
}

TEST(TileSizer, PredictsTheBytesThatEncodingMakes) {
    ACDF_NOT_SANITIZED();
    const double any = std::numeric_limits<double>::infinity();
    for (const WholeTree whole : {WholeTree::of_tiles, WholeTree::own}) {
        for (const NamedTarget& t : extreme_targets()) {
            if (t.target.rows < 8) continue; // too few for tiles
            SCOPED_TRACE(t.name);
            expect_sizes(t.target, 12, any, whole);
            expect_sizes(t.target, 1, any, whole);
        }
        expect_sizes(noise_target(256, 128, 5), 150, any, whole);
        expect_sizes(noise_target(128, 64, 6), 40, 1.01, whole);
    }
}

} // namespace
