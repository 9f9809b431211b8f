// Which part of a cut random numbers sample (acdf/product/cut_sample.h): the parts share the square of all numbers
// as their splits say and by their probabilities, and the one whose share holds two numbers is sampled by them.
#include <acdf/product/cut_sample.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace {

double number(std::mt19937_64& rng) { return static_cast<double>(rng() >> 11) * 0x1p-53; }

/// Divides a part that is chosen at random, along either axis.
void divide(AcdfCut& cut, std::mt19937_64& rng, bool deep) {
    const int part = deep ? cut.count - 1 : static_cast<int>(rng() % static_cast<unsigned>(cut.count));
    const int split = cut.count - 1;
    AcdfCutPart &lower = cut.part[part], &upper = cut.part[cut.count];
    cut.split[split].place = static_cast<std::uint32_t>(rng() % 2);
    cut.split[split].child[0] = static_cast<std::int16_t>(~part);
    cut.split[split].child[1] = static_cast<std::int16_t>(~cut.count);
    if (split > 0) cut.split[lower.owner >> 1].child[lower.owner & 1] = static_cast<std::int16_t>(split);
    lower.owner = static_cast<std::uint32_t>(2 * split);
    upper.owner = static_cast<std::uint32_t>(2 * split + 1);
    ++cut.count;
}

/// Of the same size, of many sizes, mostly none, all but nothing of most, or far below 1 together.
double probability(std::mt19937_64& rng, std::uint32_t kind) {
    switch (kind % 5) {
    case 0:
        return 1.0;
    case 1:
        return std::ldexp(number(rng), -static_cast<int>(rng() % 60));
    case 2:
        return rng() % 4 == 0 ? number(rng) : 0.0;
    case 3:
        return rng() % 8 == 0 ? 1.0 : 0x1p-60;
    default:
        return 1e-290 * number(rng);
    }
}

AcdfCut random_cut(int parts, std::uint32_t seed) {
    std::mt19937_64 rng(seed);
    AcdfCut cut = {};
    cut.count = 1;
    while (cut.count < parts) divide(cut, rng, seed % 3 == 0);
    for (int i = 0; i < cut.count; ++i) {
        cut.part[i].sum = 1.0;
        cut.part[i].probability = probability(rng, seed);
    }
    cut.part[rng() % static_cast<unsigned>(parts)].probability = 1e-290;
    acdf_cut_finish(&cut);
    return cut;
}

/// Of one axis: anywhere in [0, 1), and at the borders of parts and beside them.
std::vector<double> numbers_of(const AcdfCut& cut, int axis, std::mt19937_64& rng) {
    std::vector<double> numbers = {0.0, 0x1p-1074, 0.5, 1.0 - 0x1p-53};
    for (int i = 0; i < 60; ++i) numbers.push_back(number(rng));
    for (int i = 0; i < cut.count; ++i)
        for (const double border : cut.part[i].numbers[axis])
            for (const double x : {std::nextafter(border, 0.0), border, std::nextafter(border, 1.0)})
                if (x < 1.0) numbers.push_back(x);
    return numbers;
}

void expect_sampled(const AcdfCut& cut, const double (&u)[2]) {
    int holding = -1, count = 0;
    for (int i = 0; i < cut.count; ++i) {
        const auto& box = cut.part[i].numbers;
        if (u[0] < box[0][0] || u[0] >= box[0][1] || u[1] < box[1][0] || u[1] >= box[1][1]) continue;
        holding = i;
        ++count;
    }
    ASSERT_EQ(count, 1) << u[0] << ' ' << u[1];
    double left[2] = {u[0], u[1]};
    ASSERT_EQ(acdf_cut_choose_part(&cut, left) - cut.part, holding) << u[0] << ' ' << u[1];
    for (int axis = 0; axis < 2; ++axis) {
        const double low = cut.part[holding].numbers[axis][0], high = cut.part[holding].numbers[axis][1];
        ASSERT_EQ(left[axis], u[axis] - low < high - low ? (u[axis] - low) / (high - low) : 1.0);
    }
}

TEST(ProductCut, NumbersSampleThePartThatHoldsThem) {
    for (std::uint32_t seed = 0; seed < 300; ++seed) {
        const int parts = 1 + static_cast<int>(seed * 37 % ACDF_CUT_MAX_PARTS);
        SCOPED_TRACE(testing::Message() << "seed " << seed << ", parts " << parts);
        const AcdfCut cut = random_cut(parts, seed);
        ASSERT_EQ(cut.count, parts);
        for (int i = 0; i < parts; ++i) {
            const auto& box = cut.part[i].numbers;
            EXPECT_NEAR((box[0][1] - box[0][0]) * (box[1][1] - box[1][0]), cut.part[i].probability, 1e-13) << i;
        }
        std::mt19937_64 rng(seed);
        const std::vector<double> numbers[2] = {numbers_of(cut, 0, rng), numbers_of(cut, 1, rng)};
        for (int i = 0; i < 400; ++i)
            expect_sampled(cut, {numbers[0][rng() % numbers[0].size()], numbers[1][rng() % numbers[1].size()]});
    }
}

// Shares as a traversal of the splits gives them, from the whole to a part.
TEST(ProductCut, SplitsShareNumbers) {
    for (std::uint32_t seed = 0; seed < 100; ++seed) {
        SCOPED_TRACE(seed);
        const AcdfCut cut = random_cut(2 + static_cast<int>(seed % (ACDF_CUT_MAX_PARTS - 1)), seed);
        for (int i = 0; i + 1 < cut.count; ++i) {
            const AcdfCutSplit& split = cut.split[i];
            if (split.child[0] >= 0 || split.child[1] >= 0) continue;
            const AcdfCutPart &lower = cut.part[~split.child[0]], &upper = cut.part[~split.child[1]];
            const int axis = static_cast<int>(split.place & 1), other = 1 - axis;
            EXPECT_EQ(lower.numbers[axis][1], upper.numbers[axis][0]) << "one border";
            for (const int side : {0, 1}) EXPECT_EQ(lower.numbers[other][side], upper.numbers[other][side]);
        }
    }
}

} // namespace
