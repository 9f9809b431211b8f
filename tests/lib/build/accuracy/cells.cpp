// for_each_cell: the cells of any tree partition its grid.
#include "tests/lib/build/accuracy/random_cascade.h"
#include "tests/lib/curves/open.h"

#include "build/accuracy/cells.h"
#include "compress/store/store.h"

#include <acdf/curves/curves.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace {

using namespace acdf;

TEST(Cells, PartitionTheGrid) {
    constexpr std::uint32_t kColumns = 17, kRows = 11;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        SCOPED_TRACE(seed);
        const auto bytes =
            compress::store(compress::encode_tree(acdf_test::RandomCascade(seed, 0.0, 4).make(kColumns, kRows)),
                            compress::environment_description(kColumns, kRows));
        File file;
        ASSERT_TRUE(File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves()).ok());
        std::vector<int> covered(kColumns * kRows, 0);
        double sum = 0.0;
        build::for_each_cell(file, file.bin(0).root, [&](const build::Cell& cell) {
            ASSERT_LT(cell.range[0].low, cell.range[0].high);
            ASSERT_LT(cell.range[1].low, cell.range[1].high);
            for (std::uint32_t r = cell.range[1].low; r < cell.range[1].high; ++r)
                for (std::uint32_t c = cell.range[0].low; c < cell.range[0].high; ++c) {
                    ++covered[r * kColumns + c];
                    // The reader finds the same cell there.
                    const std::uint32_t square[2] = {c, r};
                    AcdfTiltedRange found[2] = {acdf_whole_axis(kColumns), acdf_whole_axis(kRows)};
                    EXPECT_EQ(
                        acdf_tree_find(acdf_test::TreeOf(file).data, file.bin(0).root, square, found, nullptr),
                        cell.probability);
                    for (int axis = 0; axis < 2; ++axis) {
                        EXPECT_EQ(found[axis].low, cell.range[axis].low);
                        EXPECT_EQ(found[axis].high, cell.range[axis].high);
                    }
                }
            sum += cell.probability;
        });
        EXPECT_EQ(std::count(covered.begin(), covered.end(), 1), kColumns * kRows);
        EXPECT_NEAR(sum, 1.0, 1e-13);
    }
}

TEST(Cells, ThoseOfProbabilityZeroAreVisitedToo) {
    const compress::Cascade cascade{{{1, {1, 2}, {0.5, 0.0, 0.5}, {}, {}}}, {0}};
    const auto bytes = compress::store(compress::encode_tree(cascade), compress::environment_description(4, 3));
    File file;
    ASSERT_TRUE(File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves()).ok());
    std::vector<double> probability;
    build::for_each_cell(file, file.bin(0).root,
                         [&](const build::Cell& cell) { probability.push_back(cell.probability); });
    ASSERT_EQ(probability.size(), 3u);
    EXPECT_NEAR(probability[0], 0.5, 1e-5);
    EXPECT_EQ(probability[1], 0.0);
}

} // namespace
