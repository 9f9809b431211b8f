#include "compress/local/halved/tile_light.h"

namespace acdf::compress {

BlockMoments light_of_tiles(const Blocks& blocks, const SharedLight& shared, const BlockMoments& squares,
                            const RowTree& tree, const std::vector<HalvedNode>& nodes) {
    BlockMoments out(blocks);
    const HalvedAxes& axes = shared.costs().axes();
    const std::uint32_t rows = blocks.rows(), columns = blocks.columns();
    const auto add = [&](HalvedBox box, double share) {
        std::uint32_t r[2] = {box.rows, box.rows + 1}, c[2] = {box.columns, box.columns + 1};
        const bool low = box.rows < 2 * rows, left = box.columns < 2 * columns;
        while (r[0] < rows) r[0] *= 2, r[1] *= 2;
        while (c[0] < columns) c[0] *= 2, c[1] *= 2;
        if (low && left) {
            const double factor = axes.measure(box) / share;
            for (std::uint32_t i = r[0]; i < r[1]; ++i)
                for (std::uint32_t k = c[0]; k < c[1]; ++k) {
                    BlockMoment& to = out[{i, k}];
                    to = squares[{i, k}];
                    for (float& q : to.quad) q = static_cast<float>(double{q} * factor);
                    to.sum = static_cast<float>(double{to.sum} * factor);
                }
            return;
        }
        // It cuts blocks: of the part in each, all light comes from the middle.
        const auto cut = [&](std::uint32_t number, std::uint32_t blocks) {
            while (number >= 2 * blocks) number /= 2;
            return number;
        };
        for (std::uint32_t i = low ? r[0] : box.rows; i < (low ? r[1] : box.rows + 1); ++i)
            for (std::uint32_t k = left ? c[0] : box.columns; k < (left ? c[1] : box.columns + 1); ++k) {
                HalvedBox part{i, k};
                double of = 1.0; // texels may be larger than blocks
                for (; !axes.rows.has(part.rows); part.rows /= 2) of *= 0.5;
                for (; !axes.columns.has(part.columns); part.columns /= 2) of *= 0.5;
                const double alone = shared.alone(part) * of;
                if (!(alone > 0.0)) continue;
                const double light = alone * alone / (axes.measure(part) * of) * axes.measure(box) / share;
                const Direction d =
                    direction_at(blocks.grid(), 0.5 * (axes.rows.low(part.rows) + axes.rows.high(part.rows)),
                                 0.5 * (axes.columns.low(part.columns) + axes.columns.high(part.columns)));
                BlockMoment& to = out[{cut(i, rows), cut(k, columns)}];
                to = to + moment_of(d, light);
            }
    };
    for (const RowTree::Tile& tile : tree.tiles())
        for (const RowTree::Leaf& leaf : tile.leaves)
            if (leaf.share > 0.0) add(nodes[leaf.node].box, leaf.share);
    out.add_up();
    return out;
}

} // namespace acdf::compress
