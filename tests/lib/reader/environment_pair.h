// Runtime tables of an environment beside the walk of its tree: the same cell for every draw, the same density for
// every direction.
#pragma once

#include "tests/inputs/synthetic.h"
#include "tests/lib/reader/random.h"
#include "tests/lib/reader/tables/grouped.h"
#include "tests/lib/reader/tables/tables_pair.h"

#include <acdf/reader.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <optional>
#include <random>

namespace acdf_test {

/// An environment file with the tables that it has (cells or groups), or with groups, and without.
class EnvironmentPair : public TablesPair {
public:
    enum class Tables { own, groups };

    explicit EnvironmentPair(std::vector<std::uint8_t> given, Tables tables = Tables::own)
        : TablesPair(std::move(given)) {
        if (fast.kind() != ACDF_KIND_ENVIRONMENT) return;
        data_ = fast.environment().data();
        grid_ = acdf_environment_grid(&data_);
        if (tables == Tables::own) return;
        grouped_.emplace(data_, fast.tree_units(), 8 * bytes.size() + (1u << 20), false);
        data_ = grouped_->data;
    }

    acdf::EnvironmentView view() const { return acdf::EnvironmentView(data_); }
    bool has_tables() const { return data_.cells || data_.groups; }
    bool tells(double u0, double u1) const {
        AcdfDirectionSample told;
        return data_.cells    ? acdf_cells_sample(data_.cells, u0, u1, &told)
               : data_.groups ? acdf_groups_sample(data_.groups, &grid_, u0, u1, &told)
                              : 0;
    }
    bool tells(const float direction[3]) const {
        float told;
        return data_.cells    ? acdf_cells_pdf(data_.cells, direction, &told)
               : data_.groups ? acdf_groups_pdf(data_.groups, &grid_, direction, &told)
                              : 0;
    }

private:
    AcdfEnvironment data_ = {};
    AcdfGrid grid_ = {};
    std::optional<Grouped> grouped_;
};

/// Numbers and directions that were asked, and for how many the tables told the answer.
struct Served {
    std::size_t draws = 0, directions = 0, of_draws = 0, of_directions = 0;
};

inline std::uint32_t bits_of(float x) {
    std::uint32_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    return bits;
}

inline void expect_same_density(const EnvironmentPair& pair, const float direction[3], Served& served) {
    const float fast = pair.view().pdf(direction), plain = pair.plain.environment().pdf(direction);
    ASSERT_EQ(bits_of(fast), bits_of(plain)) << direction[0] << ' ' << direction[1] << ' ' << direction[2];
    ++served.directions;
    served.of_directions += pair.tells(direction);
}

/// A draw, its density, and the densities of directions that rounding could make of it.
inline void expect_same_draw(const EnvironmentPair& pair, double u0, double u1, Served& served) {
    const acdf::DirectionSample fast = pair.view().sample(u0, u1);
    const acdf::DirectionSample plain = pair.plain.environment().sample(u0, u1);
    ASSERT_EQ(bits_of(fast.pdf), bits_of(plain.pdf)) << u0 << ' ' << u1; // of another cell it is another one
    for (int i = 0; i < 3; ++i) ASSERT_NEAR(fast.direction[i], plain.direction[i], 4e-7) << u0 << ' ' << u1;
    ++served.draws;
    if (!pair.has_tables()) return; // tilts magnify the rounding of directions
    served.of_draws += pair.tells(u0, u1);
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

inline Served expect_agreement(const EnvironmentPair& pair, int count) {
    Served served, edges;
    std::mt19937_64 random(5);
    for (int i = 0; i < count && !testing::Test::HasFatalFailure(); ++i) {
        const auto step0 = static_cast<float>(random() >> 40) * 0x1p-24f;
        const auto step1 = static_cast<float>(random() >> 40) * 0x1p-24f;
        double wide[2];
        acdf_widen(step0, step1, wide);
        expect_same_draw(pair, uniform(random), uniform(random), served);
        expect_same_draw(pair, double{step0}, double{step1}, served);
        expect_same_draw(pair, wide[0], wide[1], served);
        float direction[3];
        direction_of(2.0 * M_PI * uniform(random), 2.0 * uniform(random) - 1.0, direction);
        expect_same_density(pair, direction, served);
        for (float& d : direction) d *= 1.0003f; // not quite of unit length: it counts all the same
        expect_same_density(pair, direction, edges);
        direction_of(M_PI_4 * static_cast<double>(random() % 8), 1.0 - std::exp(-30.0 * uniform(random)),
                     direction);
        expect_same_density(pair, direction, edges); // at the seams of pieces, close to the poles
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
        expect_same_density(pair, direction, edges);
        direction_at_border(grid, 1, row, off, uniform(random), direction);
        expect_same_density(pair, direction, edges);
        const double u[2] = {static_cast<double>(random() % 256) / 256.0,
                             static_cast<double>(random() % 65536) / 65535.0};
        expect_same_draw(pair, u[0], u[1], edges);
        expect_same_draw(pair, u[1], uniform(random), edges);
        expect_same_draw(pair, std::nextafter(u[1], 0.0), std::nextafter(u[0], 1.0), edges);
    }
    return served;
}

inline void expect_nearly_all(const Served& served) {
    EXPECT_GT(double(served.of_draws), 0.99 * double(served.draws));
    EXPECT_GT(double(served.of_directions), 0.99 * double(served.directions));
}

} // namespace acdf_test
