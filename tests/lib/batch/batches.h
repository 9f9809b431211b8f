// What tests of batches share: each set of instructions that the processor has, and what batches are asked for.
#pragma once

#include "tests/inputs/directions.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

namespace batch_test {

/// Calls test() with each set of instructions, until one fails; the last of them are no vectors at all.
template <class Test>
void with_each_target(Test&& test) {
    const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
    EXPECT_GT(targets.size(), 1u);
    for (const std::int64_t target : targets) {
        SCOPED_TRACE(hwy::TargetName(target));
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        test();
        if (testing::Test::HasFailure()) break;
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

using Pair = std::array<double, 2>;
using Vector = std::array<float, 3>;

/// Pairs of random numbers, among them 0, 1, NaN, infinite and other numbers outside of [0, 1].
inline std::vector<Pair> numbers(std::size_t count, unsigned seed) {
    constexpr double inf = std::numeric_limits<double>::infinity();
    static const double odd[] = {0.0,          1.0,  -0.0, 1.0 - 0x1p-53, 0x1p-31, 1.0 - 0x1p-31, 0.5, 0x1p-1060,
                                 std::nan(""), -inf, inf,  -0.25,         1.25,    0x1.8p-31,     0.25};
    std::mt19937_64 random(seed);
    std::vector<Pair> out(count);
    for (Pair& u : out)
        for (double& x : u) x = random() % 16 == 0 ? odd[random() % std::size(odd)] : acdf_test::uniform(random);
    return out;
}

/// Directions anywhere, at the poles and on axes, of other lengths than 1, and what is none.
inline std::vector<Vector> directions(std::size_t count, unsigned seed) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    static const Vector odd[] = {{0.0f, 0.0f, 1.0f},    {0.0f, 0.0f, -1.0f},  {-1.0f, 0.0f, 0.0f},
                                 {-1.0f, -0.0f, 0.0f},  {0.0f, 1.0f, 0.0f},   {1e-7f, -1e-7f, 1.0f},
                                 {1e-20f, 0.0f, -1.0f}, {0.0f, 0.0f, 0.0f},   {nan, 0.0f, 1.0f},
                                 {0.6f, nan, 0.8f},     {inf, 0.0f, 0.0f},    {0.6f, 0.0f, 0.9f},
                                 {0.6f, 0.8f, 0.0f},    {-0.6f, 0.0f, -0.8f}, {3e38f, 3e38f, 3e38f}};
    std::mt19937_64 random(seed);
    std::vector<Vector> out(count);
    for (Vector& w : out) {
        w = acdf_test::random_direction(random);
        if (random() % 8 == 0)
            for (float& x : w) x *= 1.0004f; // not quite of unit length: it counts all the same
        if (random() % 16 == 0) w = odd[random() % std::size(odd)];
    }
    return out;
}

/// What a batch writes: `count` items, from one on that is not aligned, between others that it must leave alone.
struct Results {
    explicit Results(std::size_t count) : directions_(3 * count + 2, -7.0f), pdfs_(count + 2, -7.0f) {}

    float (*directions())[3] { return reinterpret_cast<float(*)[3]>(directions_.data() + 1); }
    float* pdfs() { return pdfs_.data() + 1; }
    Vector direction(std::size_t i) const {
        return {directions_[3 * i + 1], directions_[3 * i + 2], directions_[3 * i + 3]};
    }
    /// Bit for bit.
    bool operator==(const Results& other) const {
        return same(directions_, other.directions_) && same(pdfs_, other.pdfs_);
    }
    void set(std::size_t i, const float direction[3], float pdf) {
        std::memcpy(directions()[i], direction, sizeof(Vector));
        pdfs()[i] = pdf;
    }

private:
    static bool same(const std::vector<float>& a, const std::vector<float>& b) {
        return std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
    }
    std::vector<float> directions_, pdfs_;
};

template <class Item>
auto array_of(const std::vector<Item>& items, std::size_t first = 0) {
    using Number = typename Item::value_type;
    return reinterpret_cast<const Number(*)[std::tuple_size<Item>::value]>(items.data() + first);
}

/// Lengths around those of vectors and blocks.
inline const std::vector<std::size_t>& lengths() {
    static const std::vector<std::size_t> some = {0, 1, 2, 3, 7, 8, 15, 16, 17, 31, 33, 127, 128, 129, 143, 400};
    return some;
}

} // namespace batch_test
