// A probe in blocks of about a degree: how the boxes that halving makes of them lie to horizons.
#pragma once

#include "compress/halvings/axis.h"
#include "compress/local/light.h"
#include "compress/target.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Light times `unit`, one over the mean. What is lit stays so in squares, and times small areas and cosines.
inline float relative_light(float light, double unit) {
    constexpr float least = 1e-15f;
    return light > 0.0f ? std::max(static_cast<float>(double{light} * unit), least) : 0.0f;
}

/// All directions of a box. They lie above the horizon of a normal whose cosine to the axis is at least `sine`, and
/// below it where that is at most -sine.
struct BoxCone {
    float axis[3];
    float sine; ///< of the angle from the axis to the farthest of them; above 1 where that is above 90 degrees
    std::int8_t longer = 0; ///< side of the box: 0: along rows' axis, 1: along columns'
};

/// The blocks: halvings of an axis down to one depth. Numbers of boxes are those of HalvedBox, so that boxes of the
/// grid that are no smaller than blocks are boxes of blocks. Texels that are larger than blocks are halved in the
/// middle.
class Blocks {
public:
    /// `grid` must outlive it.
    explicit Blocks(const Target& grid);

    const Target& grid() const { return grid_; }
    std::uint32_t rows() const { return static_cast<std::uint32_t>(borders_[0].size() - 1); }
    std::uint32_t columns() const { return static_cast<std::uint32_t>(borders_[1].size() - 1); }
    /// Borders of blocks of an axis, in texels.
    const std::vector<double>& borders(std::size_t axis) const { return borders_[axis]; }

    bool has(HalvedBox box) const { return box.rows < 2 * rows() && box.columns < 2 * columns(); }
    bool is_block(HalvedBox box) const { return box.rows >= rows() && box.columns >= columns(); }
    bool can_halve(HalvedBox box, int axis) const {
        return axis == 0 ? box.rows < rows() : box.columns < columns();
    }
    /// Where a box of blocks stands in an array of size().
    std::size_t index(HalvedBox box) const { return std::size_t{box.rows} * 2 * columns() + box.columns; }
    std::size_t size() const { return std::size_t{4} * rows() * columns(); }
    /// The smallest box of blocks that holds a box of the grid.
    HalvedBox around(HalvedBox box) const;
    /// The block in the middle of a box of the grid, or that holds it.
    HalvedBox block_of(HalvedBox box) const;
    const BoxCone& cone(HalvedBox box) const { return cones_[index(box)]; }
    Direction middle(HalvedBox block) const;

    /// What can be halved of the grid down to blocks and texels.
    const HalvedAxes& axes() const { return axes_; }

private:
    BoxCone cone_of(HalvedBox box, const Direction& sum) const;

    const Target& grid_;
    std::vector<double> borders_[2];
    HalvedAxes axes_;
    std::vector<BoxCone> cones_;
};

} // namespace acdf::compress
