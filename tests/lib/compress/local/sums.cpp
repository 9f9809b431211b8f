// Rows as sums: what is positive stays so, and what is 0 stays that.
#include "compress/local/sums.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using namespace acdf::compress;

std::vector<std::uint8_t> one_row(const std::vector<double>& parts) {
    const Sums sums{1, parts.size()};
    std::vector<std::uint8_t> out(sums.bytes());
    encode_sums(sums, 0, parts, out.data());
    return out;
}

std::vector<double> stored_as(const std::vector<double>& parts) {
    return decode_sums({1, parts.size()}, 0, one_row(parts).data());
}

std::vector<double> spiky_parts(std::size_t tiles, std::mt19937_64& random) {
    std::vector<double> out(tiles);
    for (double& part : out)
        if (random() % 4 != 0) part = std::pow(10.0, -38.0 + 45.0 * (double(random() >> 11) * 0x1p-53));
    return out;
}

TEST(Sums, NothingIsLostOrAdded) {
    std::mt19937_64 random(3);
    for (const std::size_t tiles : {1u, 2u, 31u, 32u, 33u, 512u, 513u, 1000u, 32768u})
        for (int i = 0; i < 10; ++i) {
            std::vector<double> parts = spiky_parts(tiles, random);
            parts[random() % tiles] = 1.0;
            const std::vector<double> stored = stored_as(parts);
            double sum = 0.0;
            for (std::size_t t = 0; t < tiles; ++t) {
                ASSERT_EQ(stored[t] > 0.0, parts[t] > 0.0) << t << " of " << tiles;
                sum += stored[t];
            }
            EXPECT_NEAR(sum, 1.0, 1e-12);
        }
}

TEST(Sums, EndsNeverDecrease) {
    std::mt19937_64 random(4);
    for (const std::size_t tiles : {1u, 40u, 600u}) {
        const std::vector<std::uint8_t> row = one_row(spiky_parts(tiles, random));
        const std::size_t groups = (tiles + 15) / 16, ends = (groups + 15) / 16 * 16;
        unsigned before = 0;
        for (std::size_t g = 0; g < ends; ++g) {
            const unsigned end = row[2 * g] + 256u * row[2 * g + 1];
            EXPECT_GE(end, before);
            before = end;
            EXPECT_TRUE(g + 1 < groups || end == ACDF_FAST_WHOLE) << end;
        }
        for (std::size_t t = 0; t < 16 * groups; ++t) {
            const std::uint8_t end = row[2 * ends + t], last = t % 16 > 0 ? row[2 * ends + t - 1] : std::uint8_t{0};
            EXPECT_GE(end, last);
            EXPECT_TRUE((t % 16 < 15 && t + 1 < tiles) || end == 255) << int{end};
        }
    }
}

TEST(Sums, RowsStandSideBySide) {
    std::mt19937_64 random(6);
    const Sums sums{3, 50};
    std::vector<std::uint8_t> chunk(sums.bytes());
    std::vector<std::vector<double>> parts;
    for (std::size_t r = 0; r < 3; ++r) {
        parts.push_back(spiky_parts(50, random));
        encode_sums(sums, r, parts[r], chunk.data());
    }
    for (std::size_t r = 0; r < 3; ++r) EXPECT_EQ(decode_sums(sums, r, chunk.data()), stored_as(parts[r]));
}

TEST(Sums, OfABinThatSeesNothing) {
    const std::vector<std::uint8_t> row = one_row(std::vector<double>(70, 0.0));
    EXPECT_EQ(row[0] + 256u * row[1], ACDF_FAST_WHOLE);
    EXPECT_EQ(row.back(), 255);
}

/// Even parts are even to a step; those that fit steps are exact.
TEST(Sums, AreNearWhatTheyStandFor) {
    std::vector<double> parts(64, 1.0);
    const std::vector<double> even = stored_as(parts);
    for (const double p : even) EXPECT_NEAR(p, 1.0 / 64.0, 0.5 / 255.0);
    std::mt19937_64 random(5);
    double moment = 0.0, sum = 0.0;
    for (double& part : parts) sum += part = 1.0 + double(random() % 1000) / 500.0;
    const std::vector<double> stored = stored_as(parts);
    for (std::size_t t = 0; t < parts.size(); ++t) moment += parts[t] / sum * (parts[t] / sum) / stored[t];
    EXPECT_LT(moment, 1.002);
}

} // namespace
