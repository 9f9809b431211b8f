// Trees of halvings: the lookup grid, the share of codes, memory, and files of every shape of tree.
#include "tests/lib/reader/environment_pair.h"
#include "tests/lib/reader/random_halvings.h"

#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace acdf_test;

namespace {

// SPEC.md §6.2, with the numbers of its table of examples.
TEST(HalvingShare, RisesFromZeroToOneAndIsSymmetric) {
    for (std::uint32_t bits = ACDF_LEAST_CODE_BITS; bits <= ACDF_MOST_CODE_BITS; ++bits) {
        const std::uint32_t last = (1u << bits) - 1;
        EXPECT_EQ(acdf_halving_share(0, bits), 0u);
        EXPECT_EQ(acdf_halving_share(last, bits), ACDF_STEPS);
        for (std::uint32_t code = 0; code < last; ++code) {
            ASSERT_LT(acdf_halving_share(code, bits), acdf_halving_share(code + 1, bits));
            const std::uint64_t both =
                std::uint64_t{acdf_halving_share(code, bits)} + acdf_halving_share(last - code, bits);
            ASSERT_NEAR(double(both), double(ACDF_STEPS), 1.0);
            ASSERT_EQ(acdf_halving_share(code, bits), acdf_reference::halving_share(code, bits));
        }
    }
    EXPECT_EQ(acdf_halving_share(1, 8), 67677u);
    EXPECT_EQ(acdf_halving_share(127, 8), 1067124963u);
    EXPECT_EQ(acdf_halving_share(512, 10), 1075391196u);
}

// What rounding to a code costs, (change of p)^2 / (p (1 - p)), differs by less than a third between codes.
TEST(HalvingShare, CostsTheSameEverywhere) {
    constexpr std::uint32_t bits = 10, last = (1u << bits) - 1;
    double least = 1e9, most = 0.0;
    for (std::uint32_t code = 16; code + 17 < last; ++code) {
        const double a = acdf_halving_share(code, bits) / double(ACDF_STEPS),
                     b = acdf_halving_share(code + 1, bits) / double(ACDF_STEPS), p = 0.5 * (a + b);
        const double cost = (b - a) * (b - a) / (p * (1.0 - p));
        least = std::min(least, cost);
        most = std::max(most, cost);
    }
    EXPECT_LT(most, 1.34 * least);
}

TEST(LookupGrid, AgreesWithDescentsFromTheRoot) {
    for (std::uint32_t seed = 0; seed < 120; ++seed) {
        RandomOptions options = varied_options(seed, seed % 4 == 0 ? 65536 : 1024);
        options.octahedral = seed % 2 == 1;
        options.end = seed % 5 == 0 ? 0.02 : 0.25;
        expect_agreement(EnvironmentPair(RandomHalvings(seed, options).make().encode()), 300);
        if (testing::Test::HasFatalFailure()) FAIL() << "seed " << seed;
    }
}

TEST(LookupGrid, IsMadeForTreesOfFiveCellsAndMore) {
    EnvironmentSpec spec;
    spec.columns = spec.rows = 8;
    spec.halvings.nodes = {{}};
    const EnvironmentPair whole(spec.encode());
    EXPECT_EQ(whole.view().data().halved->count, 0u);
    const float up[3] = {0, 0, 1};
    EXPECT_FLOAT_EQ(whole.view().pdf(up), static_cast<float>(0.25 / M_PI));
    spec.halvings.nodes = {{0, 100}, {1, 90}, {}, {}, {1, 120}, {}, {1, 80}, {}, {}};
    EXPECT_GT(EnvironmentPair(spec.encode()).view().data().halved->bits, 0u);
}

// A tree that halves every range as far as it goes: every texel of 256 x 128 has a cell.
EnvironmentSpec full_tree(std::uint32_t columns, std::uint32_t rows) {
    EnvironmentSpec spec;
    spec.columns = columns;
    spec.rows = rows;
    const std::function<void(std::uint32_t, std::uint32_t)> grow = [&](std::uint32_t wide, std::uint32_t high) {
        if (wide == 1 && high == 1) return spec.halvings.nodes.push_back({});
        const bool across = wide >= high;
        spec.halvings.nodes.push_back({across ? 0 : 1, 100 + (wide * 7 + high * 13) % 56});
        for (int half = 0; half < 2; ++half) grow(across ? wide / 2 : wide, across ? high : high / 2);
    };
    grow(columns, rows);
    return spec;
}

TEST(LookupGrid, ServesACellATexel) { expect_agreement(EnvironmentPair(full_tree(256, 128).encode()), 2000); }

// What is made at load stays within twelve times the file and 64 KiB, and is what `table_bytes` reports.
TEST(LookupGrid, KeepsToItsMemory) {
    for (const std::uint32_t columns : {64u, 128u, 256u, 512u, 1024u}) {
        const EnvironmentPair pair(full_tree(columns, columns / 2).encode());
        EXPECT_LE(pair.fast.table_bytes(), 12 * pair.bytes.size() + (64u << 10)) << columns;
        EXPECT_LT(pair.plain.table_bytes(), pair.fast.table_bytes());
    }
}

// A float has 24 bits: with the other number's bits below them, every cell is reached.
TEST(Halvings, CellsOfOneStepAreReachedByFloats) {
    EnvironmentSpec spec;
    spec.columns = 2;
    spec.rows = 1;
    spec.halvings.code_bits = 12;
    spec.halvings.nodes = {{0, 1}, {}, {}};
    const EnvironmentPair pair(spec.encode());
    int lower = 0;
    for (std::uint32_t k = 0; k < 4096; ++k) {
        double u[2];
        acdf_widen(0.0f, static_cast<float>(k) / 4096.0f, u);
        lower += pair.view().sample(u[0], u[1]).direction[1] > 0.0f;
    }
    EXPECT_GT(lower, 0);
}

} // namespace
