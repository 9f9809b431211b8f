#include "shader/tables/walk_cells.h"

#include <algorithm>
#include <cmath>

namespace acdf {

namespace {

using u32 = std::uint32_t;

constexpr double kSquareMargin = 0x1p-20; // of the side of the square
const u32 equator_key = acdf_float_bits(1.0f);

// low, width, least and greatest of a leaf's axis: `margin` inside, or in its middle.
void set_axis(double low, double high, const double margin[2], float out[4]) {
    const double least = std::min(low, high) + margin[low > high], most = std::max(low, high) - margin[low < high];
    const double middle = 0.5 * (low + high);
    out[0] = static_cast<float>(low);
    out[1] = static_cast<float>(high - low);
    out[2] = static_cast<float>(least < most ? least : middle);
    out[3] = static_cast<float>(least < most ? most : middle);
}

// What keys of directions are at or above from the beginning of a side on.
u32 azimuth_key(const Side& side) {
    const double from_seam = double{ACDF_WALK_SEAM} - side.key;
    return static_cast<u32>(std::ceil(from_seam > 0.0 ? from_seam : from_seam + 0x1p25));
}

} // namespace

u32 chance_of(double lower, double upper) noexcept {
    const double sum = lower + upper;
    return lower <= upper ? float_bits(lower / sum) : float_bits(upper / sum) | 0x80000000u;
}

u32 WalkParts::add(const WalkNode& node) noexcept {
    nodes.add(node);
    return static_cast<u32>(nodes.size() - 1);
}

u32 WalkParts::add(const WalkLeaf& leaf) noexcept {
    leaves.add(leaf);
    return ACDF_WALK_LEAF | static_cast<u32>(leaves.size() - 1);
}

WalkCells::WalkCells(u32 parameterization, u32 columns, u32 rows) noexcept : sides_(columns, rows) {
    grid_.parameterization = parameterization;
    grid_.columns = columns;
    grid_.rows = rows;
}

bool WalkCells::remember(std::size_t most) noexcept {
    return grid_.parameterization != ACDF_PARAM_LATLONG || sides_.remember(most);
}

Cell WalkCells::whole() const noexcept { return {1.0, {0, 0}, {grid_.columns, grid_.rows}, false}; }

u32 WalkCells::key(u32 axis, u32 position) const noexcept {
    const double part = static_cast<double>(position) / steps(axis);
    const bool half = grid_.parameterization == ACDF_PARAM_HALF_ANGLE;
    if (half && axis == 1) return float_bits(part);
    if (half || octahedral()) return static_cast<u32>(std::ceil(part * double{ACDF_SQUARE_STEPS}));
    Cell beyond = whole();
    beyond.first[axis] = position;
    Side sides[5];
    if (axis == 0) {
        sides_.azimuths(beyond, sides);
        return azimuth_key(sides[0]);
    }
    sides_.heights(beyond, sides);
    const u32 cap = float_bits(sides[0].local[0]);
    return sides[0].piece == 1 ? ACDF_WALK_SOUTH - cap : cap;
}

u32 WalkCells::add(const Cell& cell, WalkParts& out) const noexcept {
    if (octahedral()) return square(cell, out);
    return grid_.parameterization == ACDF_PARAM_HALF_ANGLE ? half_vectors(cell, out) : pieces(cell, out);
}

u32 WalkCells::square(const Cell& cell, WalkParts& out) const noexcept {
    WalkLeaf leaf = {0, 0.0f, {}};
    const AcdfGrid grid = acdf_environment_grid(&grid_);
    const AcdfRange range[2] = {{cell.first[0], cell.last[0]}, {cell.first[1], cell.last[1]}};
    const double margin[2] = {kSquareMargin, kSquareMargin};
    leaf.density = acdf_grid_pdf(&grid, range, acdf_positive(cell.probability));
    for (u32 axis = 0; axis < 2; ++axis) {
        const double count = steps(axis);
        set_axis(cell.first[axis] / count, cell.last[axis] / count, margin, leaf.axes[axis]);
    }
    return out.add(leaf);
}

u32 WalkCells::half_vectors(const Cell& cell, WalkParts& out) const noexcept {
    WalkLeaf leaf = {0, 0.0f, {}};
    double area = 1.0;
    for (u32 axis = 0; axis < 2; ++axis) {
        const double width = static_cast<double>(cell.last[axis] - cell.first[axis]) / steps(axis);
        const u32 first = key(axis, cell.first[axis]);
        area *= width;
        leaf.axes[axis][0] = static_cast<float>(static_cast<double>(cell.first[axis]) / steps(axis));
        leaf.axes[axis][1] = static_cast<float>(width);
        leaf.axes[axis][2] = acdf_bits_float(first);
        leaf.axes[axis][3] = acdf_bits_float(key(axis, cell.last[axis]) - first);
    }
    leaf.density = static_cast<float>(std::min(acdf_positive(cell.probability) / (8.0 * ACDF_PI * area), 3e38));
    return out.add(leaf);
}

// Divides a cell along the borders of the pieces of the sphere: first heights, then azimuths.
u32 WalkCells::pieces(const Cell& cell, WalkParts& out) const noexcept {
    const float density = sides_.density(cell);
    Side columns[5], rows[2]; // set as far as they are counted
    const int column_count = sides_.azimuths(cell, columns), row_count = sides_.heights(cell, rows);
    u32 link = ACDF_WALK_LEAF;
    for (int r = row_count - 1; r >= 0; --r) {
        const Side& height = rows[r];
        const bool south = height.piece == 1;
        const double margins[2] = {height.margin[south], height.margin[!south]};
        u32 row = ACDF_WALK_LEAF;
        for (int c = column_count - 1; c >= 0; --c) {
            const Side& azimuth = columns[c];
            WalkLeaf leaf = {azimuth.piece | height.piece << 2, density, {}};
            set_axis(azimuth.local[0], azimuth.local[1], azimuth.margin, leaf.axes[0]);
            set_axis(height.local[south], height.local[!south], margins, leaf.axes[1]);
            const u32 part = out.add(leaf);
            row = c + 1 == column_count
                      ? part
                      : out.add(WalkNode{azimuth_key(columns[c + 1]), part, row,
                                         chance_of(azimuth.high - azimuth.low, 1.0 - azimuth.high)});
        }
        link = r + 1 == row_count ? row
                                  : out.add(WalkNode{0x80000000u | equator_key, row, link,
                                                     chance_of(height.high - height.low, 1.0 - height.high)});
    }
    return link;
}

} // namespace acdf
