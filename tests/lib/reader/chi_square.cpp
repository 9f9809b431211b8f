// Samples follow the pdf that goes with them.
#include "tests/inputs/sanitized.h"
#include "tests/lib/reader/reference.h"
#include "tests/lib/reader/sampling.h"

#include <cmath>

using namespace acdf_test;
using acdf_reference::Cell;
using acdf_reference::Environment;

namespace {

// Upper quantile of the normal distribution, by bisection.
double normal_quantile(double tail) {
    double low = 0.0, high = 20.0;
    while (high - low > 1e-9) {
        const double mid = (low + high) / 2;
        (0.5 * std::erfc(mid / std::sqrt(2.0)) > tail ? low : high) = mid;
    }
    return low;
}

// The value chi-square exceeds with probability `tail` (Wilson and Hilferty 1931).
double chi_square_quantile(double degrees, double tail) {
    const double k = 2.0 / (9.0 * degrees);
    return degrees * std::pow(1.0 - k + normal_quantile(tail) * std::sqrt(k), 3);
}

// Counts over the quarters of all cells (halved at t = 1/2 on both axes), located by the slow decoder.
TEST(EnvironmentView, samplesFollowThePdf) {
    const int samples = repeated(40000);
    // Šidák: all trees together fail by chance once in a hundred times; the seeds are fixed.
    const double tail = 1.0 - std::pow(1.0 - 0.01, 1.0 / tree_count);
    for (std::uint32_t seed = 0; seed < tree_count; ++seed) {
        const auto env = loaded(random_environment(seed, options_of(seed)));
        const Environment reference(env->bytes);
        const auto columns = static_cast<std::size_t>(reference.columns);
        std::vector<Cell> cells;
        std::vector<std::uint32_t> owner(columns * static_cast<std::size_t>(reference.rows));
        reference.each_cell([&](const Cell& cell) {
            for (double y = cell.low[1]; y < cell.high[1]; ++y)
                for (double x = cell.low[0]; x < cell.high[0]; ++x)
                    owner[static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(x)] =
                        static_cast<std::uint32_t>(cells.size());
            cells.push_back(cell);
        });
        std::vector<double> count(4 * cells.size(), 0.0);
        std::mt19937_64 rng(seed);
        for (int n = 0; n < samples; ++n) {
            const auto s = env->view.sample(uniform(rng), uniform(rng));
            const double d[3] = {s.direction[0], s.direction[1], s.direction[2]};
            double square[2], t[2];
            ASSERT_TRUE(reference.square_of(d, square));
            const std::size_t index =
                owner[static_cast<std::size_t>(square[1]) * columns + static_cast<std::size_t>(square[0])];
            reference.fractions(cells[index], d, t);
            const bool right = t[0] >= 0.5, low = t[1] >= 0.5;
            count[4 * index + 2 * right + low] += 1;
        }
        double chi_square = 0.0, pooled_count = 0.0, pooled_expected = 0.0;
        int degrees = -1;
        for (std::size_t i = 0; i < count.size(); ++i) {
            const Cell& cell = cells[i / 4];
            const double half0 = i & 2 ? 0.5 + cell.tilt[0] / 4 : 0.5 - cell.tilt[0] / 4;
            const double half1 = i & 1 ? 0.5 + cell.tilt[1] / 4 : 0.5 - cell.tilt[1] / 4;
            const double expected = samples * cell.p * half0 * half1;
            if (expected == 0.0) {
                EXPECT_EQ(count[i], 0.0) << seed;
            } // no sample where the pdf is 0
            pooled_count += count[i];
            pooled_expected += expected;
            if (pooled_expected < 5.0) continue;
            chi_square += (pooled_count - pooled_expected) * (pooled_count - pooled_expected) / pooled_expected;
            pooled_count = pooled_expected = 0.0;
            ++degrees;
        }
        if (degrees > 0) {
            EXPECT_LT(chi_square, chi_square_quantile(degrees, tail))
                << "seed " << seed << ", " << degrees << " degrees";
        }
    }
}

} // namespace
