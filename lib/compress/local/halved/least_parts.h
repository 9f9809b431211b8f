// What a bound on weights asks of the rows of bins.
#pragma once

#include "compress/halvings/rows.h"
#include "compress/local/halved/blocks.h"
#include "compress/local/halved/rows.h"

#include <cstddef>
#include <vector>

namespace acdf::compress {

/// A sample of light L and cosine c weighs L c / p, which in a cell that has the share s of a tile's samples, and
/// the measure m, is L c m / s over the probability of the tile. For a mixture of rows the largest c of a cell is
/// no more than the same mixture of those for its bins: where each row gives a tile enough for its own normal, so
/// do mixtures.
class LeastParts {
public:
    /// `blocks` must outlive it. `unit`: what light is multiplied with.
    LeastParts(const Blocks& blocks, const HalvedAxes& axes, double unit, double max_weight, const RowTree& tree,
               const std::vector<HalvedNode>& nodes);

    /// Raises rows in `wanted` by as much as `rows` lack, of which bins sample so many times what their light costs
    /// (MixedRows::surplus). Returns whether any lacks more than a hundredth.
    bool raise(const NormalBins& bins, const RowParts& rows, const std::vector<float>& surplus,
               RowParts& wanted) const;

private:
    struct Cell {
        HalvedBox place; ///< a box of blocks that it lies in
        float part;      ///< L m / s over the bound, L being the largest
    };

    float least(std::size_t tile, const float normal[3]) const;

    const Blocks& blocks_;
    std::vector<std::size_t> begin_; ///< of each tile its cells
    std::vector<Cell> cells_;
    std::vector<float> largest_; ///< of each tile, of the parts of its cells
};

} // namespace acdf::compress
