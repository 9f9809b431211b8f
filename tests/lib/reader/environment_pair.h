// The lookup grid of an environment beside a descent from the root: the same sample for all numbers, the same pdf
// for every direction.
#pragma once

#include "tests/inputs/directions.h"
#include "tests/lib/reader/random.h"

#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <utility>
#include <vector>

namespace acdf_test {

/// A file of halvings with a lookup grid and without.
struct EnvironmentPair {
    std::vector<std::uint8_t> bytes;
    acdf::File fast, plain;

    explicit EnvironmentPair(std::vector<std::uint8_t> given) : bytes(std::move(given)) {
        acdf::LoadOptions options;
        options.tables = false;
        EXPECT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), plain, options).ok());
        const acdf::Status status = acdf::File::from_memory(bytes.data(), bytes.size(), fast);
        EXPECT_TRUE(status.ok()) << status.message;
        EXPECT_EQ(plain.environment().data().halved->bits, 0u);
    }
    acdf::EnvironmentView view() const { return fast.environment(); }
};

inline std::uint32_t bits_of(float x) {
    std::uint32_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    return bits;
}

inline void expect_same_pdf(const EnvironmentPair& pair, const float direction[3]) {
    const float fast = pair.view().pdf(direction), plain = pair.plain.environment().pdf(direction);
    ASSERT_EQ(bits_of(fast), bits_of(plain)) << direction[0] << ' ' << direction[1] << ' ' << direction[2];
}

/// A sample, its pdf, and the pdfs of directions that rounding could make of it.
inline void expect_same_sample(const EnvironmentPair& pair, double u0, double u1) {
    const acdf::DirectionSample fast = pair.view().sample(u0, u1);
    const acdf::DirectionSample plain = pair.plain.environment().sample(u0, u1);
    ASSERT_EQ(bits_of(fast.pdf), bits_of(plain.pdf)) << u0 << ' ' << u1; // of another cell it is another one
    for (int i = 0; i < 3; ++i)
        ASSERT_EQ(bits_of(fast.direction[i]), bits_of(plain.direction[i])) << u0 << ' ' << u1;
    ASSERT_EQ(bits_of(pair.view().pdf(fast.direction)), bits_of(fast.pdf)) << u0 << ' ' << u1;
    ASSERT_EQ(bits_of(pair.plain.environment().pdf(fast.direction)), bits_of(fast.pdf)) << u0 << ' ' << u1;
    const double length =
        std::sqrt(double{fast.direction[0]} * fast.direction[0] + double{fast.direction[1]} * fast.direction[1] +
                  double{fast.direction[2]} * fast.direction[2]);
    float again[3];
    for (int i = 0; i < 3; ++i) again[i] = static_cast<float>(fast.direction[i] / length);
    ASSERT_EQ(bits_of(pair.view().pdf(again)), bits_of(fast.pdf)) << u0 << ' ' << u1;
}

/// A direction on a border between columns or rows, or `off` (radians) beside it; `free` says where along it.
inline void direction_at_border(const AcdfGrid& grid, int axis, std::uint32_t step, double off, double free,
                                float out[3]) {
    const double part = static_cast<double>(step) / (axis == 0 ? grid.columns : grid.rows);
    if (acdf_grid_is_octahedral(&grid)) {
        const double at = part + off / ACDF_OCTAHEDRAL_LEAST_SPEED;
        double d[3];
        acdf_octahedral_direction(axis == 0 ? at : free, axis == 0 ? free : at, d);
        for (int i = 0; i < 3; ++i) out[i] = static_cast<float>(d[i]);
    } else if (axis == 0) {
        direction_of(M_PI * (1.0 - 2.0 * part) + off, 1.0 - 2.0 * free, out);
    } else {
        direction_of(2.0 * M_PI * free, std::cos(M_PI * part + off), out);
    }
}

inline void expect_agreement(const EnvironmentPair& pair, int count) {
    std::mt19937_64 random(5);
    for (int i = 0; i < count && !testing::Test::HasFatalFailure(); ++i) {
        const auto step0 = static_cast<float>(random() >> 40) * 0x1p-24f;
        const auto step1 = static_cast<float>(random() >> 40) * 0x1p-24f;
        double wide[2];
        acdf_widen(step0, step1, wide);
        expect_same_sample(pair, uniform(random), uniform(random));
        expect_same_sample(pair, double{step0}, double{step1});
        expect_same_sample(pair, wide[0], wide[1]);
        float direction[3];
        direction_of(2.0 * M_PI * uniform(random), 2.0 * uniform(random) - 1.0, direction);
        expect_same_pdf(pair, direction);
        for (float& d : direction) d *= 1.0003f; // not quite of unit length: it counts all the same
        expect_same_pdf(pair, direction);
        direction_of(M_PI_4 * static_cast<double>(random() % 8), 1.0 - std::exp(-30.0 * uniform(random)),
                     direction);
        expect_same_pdf(pair, direction); // at the seams of pieces, close to the poles
    }
    // Exactly on the borders of cells, of the grids, and beside them.
    const AcdfEnvironment data = pair.plain.environment().data();
    const AcdfGrid grid = acdf_environment_grid(&data);
    for (int i = 0; i < count && !testing::Test::HasFatalFailure(); ++i) {
        float direction[3];
        const auto column = static_cast<std::uint32_t>(random() % data.columns),
                   row = static_cast<std::uint32_t>(random() % data.rows);
        const double off = (uniform(random) - 0.5) * std::exp2(-20.0 - 10.0 * uniform(random));
        direction_at_border(grid, 0, column, off, uniform(random), direction);
        expect_same_pdf(pair, direction);
        direction_at_border(grid, 1, row, off, uniform(random), direction);
        expect_same_pdf(pair, direction);
        const double u[2] = {static_cast<double>(random() % 256) / 256.0,
                             static_cast<double>(random() % 65536) / 65535.0};
        expect_same_sample(pair, u[0], u[1]);
        expect_same_sample(pair, u[1], uniform(random));
        expect_same_sample(pair, std::nextafter(u[1], 0.0), std::nextafter(u[0], 1.0));
    }
}

} // namespace acdf_test
