// Lines where cells end, and nowhere else.
#include "tools/plot/knots.h"

#include "tests/tools/plot/files.h"
#include "tools/plot/pdf_image.h"

#include "build/accuracy/cells.h"

#include <algorithm>
#include <set>

namespace acdf::test {
namespace {

std::vector<build::Cell> cells_of(const File& file) {
    std::vector<build::Cell> cells;
    build::for_each_cell(file.environment(), [&](const build::Cell& cell) { cells.push_back(cell); });
    return cells;
}

class EachFitKnots : public testing::TestWithParam<AcdfFit> {};

// Eight pixels a grid step: each cell's first column and row of pixels, but for the edges of the picture.
TEST_P(EachFitKnots, LatlongLinesAreExactlyTheFirstPixelsOfCells) {
    const StoredEnvironment stored(dark_noise(), fit_options(GetParam(), 8, 6));
    const int scale = 8, width = 64 * scale, height = 32 * scale;
    const std::vector<float> opacity = tools::knot_opacity(stored.view(), {build::Layout::latlong, width, height});
    std::vector<char> expected(opacity.size(), 0);
    for (const build::Cell& cell : cells_of(stored.file)) {
        const int x0 = static_cast<int>(cell.range[0].low) * scale,
                  x1 = static_cast<int>(cell.range[0].high) * scale;
        const int y0 = static_cast<int>(cell.range[1].low) * scale,
                  y1 = static_cast<int>(cell.range[1].high) * scale;
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x)
                if ((x == x0 && x > 0) || (y == y0 && y > 0)) expected[static_cast<std::size_t>(y * width + x)] = 1;
    }
    EXPECT_GT(std::count(expected.begin(), expected.end(), 1), 1000);
    for (std::size_t i = 0; i < opacity.size(); ++i)
        ASSERT_EQ(opacity[i] > 1e-3f, expected[i] == 1)
            << i % static_cast<std::size_t>(width) << "," << i / static_cast<std::size_t>(width);
}

INSTANTIATE_TEST_SUITE_P(Fits, EachFitKnots,
                         testing::Values(ACDF_FIT_UNIFORM, ACDF_FIT_CDF, ACDF_FIT_PDF, ACDF_FIT_VARIANCE));

using CellKey = std::array<std::uint32_t, 4>;

CellKey cell_at(const EnvironmentView& view, const float direction[3]) {
    AcdfRange range[2];
    double t[2];
    AcdfStratum strata[2];
    acdf_environment_find(&view.data(), direction, range, t, strata);
    return {range[0].low, range[0].high, range[1].low, range[1].high};
}

TEST(PlotKnots, AngularLinesRunBetweenNeighboursOfDifferentCells) {
    const StoredEnvironment stored(dark_noise(), fit_options(ACDF_FIT_UNIFORM, 8, 6));
    const int width = 300;
    const std::vector<float> opacity = tools::knot_opacity(stored.view(), {build::Layout::angular, width, width});
    const auto opaque = [&](int x, int y) { return opacity[static_cast<std::size_t>(y * width + x)]; };
    int borders = 0, interior = 0;
    for (int y = 2; y < width - 2; ++y)
        for (int x = 2; x < width - 2; ++x) {
            float d[3], right[3], around[3];
            if (!angular_direction(width, x, y, d) || !angular_direction(width, x + 1, y, right)) continue;
            if (std::abs(d[2]) > 0.95f || d[0] < -0.95f) continue; // cells meet at the poles and the rim
            const CellKey cell = cell_at(stored.view(), d);
            if (cell != cell_at(stored.view(), right)) {
                ++borders;
                ASSERT_GT(opaque(x, y) + opaque(x + 1, y), 0.3f) << x << "," << y;
            }
            bool alone = true;
            for (int j = -2; j <= 2; ++j)
                for (int i = -2; i <= 2; ++i)
                    alone = alone && angular_direction(width, x + i, y + j, around) &&
                            cell_at(stored.view(), around) == cell;
            if (!alone) continue;
            ++interior;
            ASSERT_EQ(opaque(x, y), 0.0f) << x << "," << y;
        }
    EXPECT_GT(borders, 500);
    EXPECT_GT(interior, 20000);
}

TEST(PlotKnots, OfCellsTooSmallToSeeVanish) {
    const StoredEnvironment stored(dark_noise(), fit_options(ACDF_FIT_UNIFORM, 64, 32));
    for (const float opacity : tools::knot_opacity(stored.view(), {build::Layout::latlong, 128, 64}))
        ASSERT_EQ(opacity, 0.0f);
}

TEST(PlotKnots, OfASingleCellAreNone) {
    const compress::Target target = acdf_test::sphere_target(64, 32, [](double, double) { return 1.0; });
    const StoredEnvironment stored(target, fit_options(ACDF_FIT_UNIFORM, 1, 1));
    ASSERT_EQ(cells_of(stored.file).size(), 1u);
    for (const build::Map map :
         {build::Map{build::Layout::latlong, 128, 64}, build::Map{build::Layout::angular, 99, 99}})
        for (const float opacity : tools::knot_opacity(stored.view(), map)) ASSERT_EQ(opacity, 0.0f);
}

TEST(PlotKnots, ContrastWithWhatTheyCross) {
    images::Picture picture(3, 1);
    float* rgb = picture.values.data();
    const float before[9] = {0.1f, 0.1f, 0.3f, 0.9f, 0.9f, 0.2f, 0.5f, 0.6f, 0.7f};
    std::copy(before, before + 9, rgb);
    tools::draw_knots(picture, {1.0f, 1.0f, 0.0f});
    EXPECT_GT(rgb[0], 0.5f); // white on dark
    EXPECT_LT(rgb[3], 0.5f); // black on light
    for (int i = 6; i < 9; ++i) EXPECT_EQ(rgb[i], before[i]);
}

} // namespace
} // namespace acdf::test
