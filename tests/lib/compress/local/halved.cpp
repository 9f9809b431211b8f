// What local environment maps on one tree of halvings are fitted by, beside plain sums over texels.
#include "compress/local/halved/rows.h"
#include "tests/inputs/directions.h"
#include "tests/inputs/synthetic.h"

#include "build/accuracy/local.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace acdf::compress {
namespace {

Target noise(std::uint32_t columns, std::uint32_t rows, AcdfParameterization parameterization) {
    Target out = empty_target(columns, rows, parameterization);
    out.values.resize(std::size_t{columns} * rows);
    std::mt19937 random(5);
    std::lognormal_distribution<float> light(0.0f, 1.0f);
    for (float& value : out.values) value = light(random);
    return out;
}

struct Moved {
    Target target;
    Blocks blocks;
    BlockMoments light;

    explicit Moved(Target of) : target(std::move(of)), blocks(target), light(blocks) {
        light.integrate([this](std::uint32_t r, float*) { return target.row(r); });
    }
};

/// The integral of light times the square of its cosine above a horizon, over a range of blocks.
double seen_slowly(const Moved& of, const double low[2], const double high[2], const Direction& n) {
    constexpr int kParts = 256; // of the whole grid, along the longer axis
    double sum = 0.0;
    const std::uint32_t rows = of.target.rows, columns = of.target.columns;
    const auto across = [](std::uint32_t texels) { return std::max(1u, kParts * 2 / texels); };
    for (std::uint32_t r = 0; r < rows; ++r)
        for (std::uint32_t c = 0; c < columns; ++c)
            for (std::uint32_t i = 0; i < across(rows); ++i)
                for (std::uint32_t k = 0; k < across(columns); ++k) {
                    const double y = r + (i + 0.5) / across(rows), x = c + (k + 0.5) / across(columns);
                    if (y < low[0] || y >= high[0] || x < low[1] || x >= high[1]) continue;
                    const Direction d = direction_at(of.target, y, x);
                    const double cosine = std::max(0.0, dot(d, n));
                    double tall = of.target.row_measure[r] / across(rows);
                    if (!is_octahedral(of.target)) // sin theta d theta
                        tall = ACDF_PI / rows / across(rows) * std::sqrt(1.0 - d[2] * d[2]);
                    sum += double{of.target.row(r)[c]} * tall * of.target.column_measure[c] / across(columns) *
                           cosine * cosine;
                }
    return sum;
}

void expect_moments(Target target) {
    const Moved of(std::move(target));
    std::mt19937_64 random(2);
    Normals normals;
    std::vector<Direction> directions;
    for (const build::Normal& n : build::random_normals(12)) {
        directions.push_back({double{n[0]}, double{n[1]}, double{n[2]}});
        normals.add(directions.back());
    }
    const double whole = double{of.light[HalvedBox{}].sum};
    EXPECT_NEAR(whole, integral(of.target), 1e-4 * whole);
    std::vector<float> seen(normals.size());
    for (int i = 0; i < 6; ++i) {
        HalvedBox box;
        for (std::uint64_t levels = random() % 9; levels-- > 0;) {
            const int axis = static_cast<int>(random() % 2);
            if (of.blocks.can_halve(box, axis)) box = half(box, axis, random() % 2);
        }
        double low[2], high[2];
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const std::uint32_t blocks = axis == 0 ? of.blocks.rows() : of.blocks.columns();
            std::uint32_t first = axis == 0 ? box.rows : box.columns, last = first + 1;
            while (first < blocks) first *= 2, last *= 2;
            low[axis] = of.blocks.borders(axis)[first - blocks];
            high[axis] = of.blocks.borders(axis)[last - blocks];
        }
        of.light.seen(box, normals, seen.data());
        for (std::size_t k = 0; k < seen.size(); ++k) {
            const double slowly = seen_slowly(of, low, high, directions[k]);
            EXPECT_NEAR(double{seen[k]}, slowly, 0.02 * slowly + 0.005 * double{of.light[box].sum})
                << of.target.columns << " columns, box " << box.rows << ", " << box.columns;
            EXPECT_TRUE(seen[k] > 0.0f || slowly == 0.0);
        }
    }
}

TEST(HalvedLocals, MomentsAreThoseOfTexels) {
    for (const std::uint32_t columns : {1u, 2u, 7u, 64u, 300u}) {
        expect_moments(noise(columns, (columns + 1) / 2, ACDF_PARAM_LATLONG));
        if (columns > 1) expect_moments(noise(columns, columns, ACDF_PARAM_OCTAHEDRAL));
    }
}

/// No direction of a box is farther from its middle than its cone is wide.
TEST(HalvedLocals, ConesHoldTheirBoxes) {
    for (const AcdfParameterization parameterization : {ACDF_PARAM_LATLONG, ACDF_PARAM_OCTAHEDRAL}) {
        const Target target = noise(64, parameterization == ACDF_PARAM_LATLONG ? 32 : 64, parameterization);
        const Blocks blocks(target);
        std::mt19937_64 random(3);
        for (int i = 0; i < 20000; ++i) {
            const double y = double(random() >> 11) * 0x1p-53, x = double(random() >> 11) * 0x1p-53;
            const Direction d = direction_at(target, y * target.rows, x * target.columns);
            HalvedBox box{blocks.rows() + static_cast<std::uint32_t>(y * blocks.rows()),
                          blocks.columns() + static_cast<std::uint32_t>(x * blocks.columns())};
            for (std::uint64_t levels = random() % 7; levels-- > 0;) (random() % 2 ? box.rows : box.columns) /= 2;
            const BoxCone& cone = blocks.cone(box);
            if (cone.sine > 1.0f) continue;
            const double cosine =
                double{cone.axis[0]} * d[0] + double{cone.axis[1]} * d[1] + double{cone.axis[2]} * d[2];
            EXPECT_GT(cosine, std::sqrt(1.0 - double{cone.sine} * double{cone.sine}) - 1e-6);
        }
    }
}

/// The sum of a mixture's variance, as defined.
double variance_slowly(const Moved& of, const std::vector<HalvedBox>& tiles, const NormalBins& bins,
                       const RowParts& rows) {
    const Mixtures mixtures(bins);
    double sum = 0.0, weight = 0.0;
    for (std::size_t j = 0; j < mixtures.of.size(); ++j) {
        Normals one;
        one.add({double{mixtures.normals.x[j]}, double{mixtures.normals.y[j]}, double{mixtures.normals.z[j]}});
        double moments = 0.0, mixed = 0.0, cost = 0.0;
        for (std::size_t t = 0; t < tiles.size(); ++t) {
            float seen;
            of.light.seen(tiles[t], one, &seen);
            const double c = double{mixtures.of[j].length} * std::sqrt(double{seen});
            double r = 0.0;
            for (std::size_t i = 0; i < 3; ++i)
                r += double{mixtures.of[j].weight[i]} * double{rows[mixtures.of[j].bin[i]][t]};
            if (c > 0.0) moments += c * c / r;
            mixed += r;
            cost += c;
        }
        sum += mixtures.of[j].frequency * (moments * mixed / (cost * cost) - 1.0);
        weight += mixtures.of[j].frequency;
    }
    return sum / weight;
}

TEST(HalvedLocals, RowsAreMadeForMixtures) {
    const Moved of(noise(64, 32, ACDF_PARAM_LATLONG));
    std::vector<HalvedBox> tiles;
    for (std::uint32_t r = 16; r < 32; ++r)
        for (std::uint32_t c = 16; c < 32; ++c) tiles.push_back({r, c});
    const NormalBins bins = octahedral_bins(4);
    const MixedRows rows(of.light, tiles, bins);
    Normals normals;
    for (const Direction& n : bins.normals) normals.add(n);
    RowParts own(bins.normals.size(), std::vector<float>(tiles.size()));
    std::vector<float> seen(normals.size());
    for (std::size_t t = 0; t < tiles.size(); ++t) {
        of.light.seen(tiles[t], normals, seen.data());
        for (std::size_t b = 0; b < own.size(); ++b) own[b][t] = std::sqrt(seen[b]);
    }
    const RowParts made = rows.parts();
    for (std::size_t b = 0; b < own.size(); ++b)
        for (std::size_t t = 0; t < tiles.size(); ++t) EXPECT_EQ(made[b][t] > 0.0f, own[b][t] > 0.0f);
    const double of_own = variance_slowly(of, tiles, bins, own), of_made = variance_slowly(of, tiles, bins, made);
    EXPECT_NEAR(rows.variance(own), of_own, 1e-4);
    EXPECT_NEAR(rows.variance(made), of_made, 1e-4);
    EXPECT_LT(of_made, 0.9 * of_own);
}

} // namespace
} // namespace acdf::compress
