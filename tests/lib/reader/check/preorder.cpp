// Trees that lie in preorder are checked in one pass (lib/reader/check/preorder.cpp), all others in several: both
// find the same of the same curves.
#include "tests/lib/reader/golden_files.h"
#include "tests/lib/reader/load.h"
#include "tests/lib/reader/planes.h"

#include <gtest/gtest.h>

using namespace acdf_test;

namespace {

ChunkSpec* tree_of(FileSpec& file) {
    for (ChunkSpec& chunk : file.chunks)
        if (chunk.type == "TREE" && !chunk.zlib) return &chunk;
    return nullptr;
}

// A curve that nothing leads to, behind all others: the tree is in preorder no more, and rule 6012 warns of it.
Bytes with_spare_curve(FileSpec file) {
    Bytes& tree = tree_of(file)->raw;
    const Bytes curve = {static_cast<std::uint8_t>(tree[0] & 7), 2 << 2, 128, 1}; // two segments on the same axis
    tree.insert(tree.end(), curve.begin(), curve.end());
    return file.encode();
}

// Returns how many of the changed trees were right.
int compare(const Bytes& bytes) {
    FileSpec file = taken_apart(bytes);
    if (!tree_of(file)) return 0;
    int right = 0;
    Bytes& tree = tree_of(file)->raw;
    const Bytes whole = tree;
    for (std::size_t at = 0; at < whole.size(); at += 1 + whole.size() / 2000)
        for (const unsigned value : {0x00u, 0xFFu, whole[at] + 1u, whole[at] - 1u, whole[at] ^ 0x01u,
                                     whole[at] ^ 0x08u, whole[at] ^ 0x40u}) {
            tree[at] = static_cast<std::uint8_t>(value);
            const bool one = findings(file.encode()).rules.empty();
            const bool several = findings(with_spare_curve(file)).rules == std::multiset<int>{6012};
            EXPECT_EQ(one, several) << "byte " << at << " is " << value % 256 << ": "
                                    << findings(with_spare_curve(file)).text;
            right += one;
            tree = whole;
        }
    return right;
}

// Seven short curves below tilted segments of the first axis, which must be on the second one.
EnvironmentSpec below_tilts() {
    EnvironmentSpec spec;
    spec.columns = 64;
    spec.rows = 8;
    CurveSpec root = even_curve(0, {8, 16, 24, 32, 40, 48});
    root.link_bytes = 1;
    spec.tree.curves = {root};
    for (int i = 1; i <= 7; ++i) {
        spec.tree.curves[0].children.push_back(i);
        spec.tree.curves[0].tilts.push_back(100 * i);
        CurveSpec end = even_curve(1, {2, 3, 5, 7});
        end.cumulative_bytes = end.position_bytes = 1;
        end.cumulative = {50, 100, 100, 200};
        spec.tree.curves.push_back(end);
    }
    return spec;
}

TEST(Preorder, isJudgedAsAnyOtherOrder) {
    EXPECT_GT(compare(below_tilts().encode()), 20);
    EXPECT_GT(compare(preorder_environment().encode()), 20);
    int right = 0;
    each_golden_file([&](const Bytes& bytes) { right += compare(bytes); });
    EXPECT_GT(right, 500);
}

} // namespace
