// A tree of halvings at whose top each of several rows has codes of its own; what is below, all share.
#pragma once

#include "compress/halvings/codes.h"
#include "compress/halvings/growth.h"
#include "compress/halvings/halvings.h"
#include "compress/store/store.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace acdf::compress {

constexpr std::uint32_t kSharedCodeBits = 8; ///< of the codes that rows share

/// Random numbers that a row leads to a node are none where it has excluded it: whether it has a code there.
enum class Unreached { stored, left_out };

/// The codes of a row, in preorder, and the random numbers, out of 2^31, that lead to each tile.
struct CodedRow {
    std::vector<std::uint16_t> codes;
    std::vector<std::uint32_t> steps;
};

/// The tree with the codes that rows share.
class RowTree {
public:
    struct Leaf {
        std::uint32_t node;
        double share; ///< of the random numbers of its tile
    };
    struct Tile {
        std::uint32_t node;
        std::vector<Leaf> leaves;
    };

    /// The first 2 `top` + 1 of `nodes` are the top. `weights`: one a node, that of its leaves together: shares are
    /// in proportion. A node without weight, or with too few random numbers to be divided, becomes a leaf. `axes`:
    /// as TreeCoder has them.
    RowTree(const std::vector<HalvedNode>& nodes, std::size_t top, const std::vector<double>& weights,
            std::array<std::uint32_t, 2> axes);

    const Halvings& halvings() const { return halvings_; }
    /// One a halving: rows have a code of their own.
    const std::vector<bool>& has_codes() const { return has_codes_; }
    const std::vector<Tile>& tiles() const { return tiles_; }

    /// The row that leads random numbers to tiles in proportion to `parts` as nearly as it can, and some to each
    /// that is positive.
    CodedRow row(const HalvingCodes& codes, const std::vector<double>& parts, Unreached unreached) const;

private:
    static constexpr std::uint32_t kTile = 0; ///< no upper half has that number
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;
    struct Part;

    Halvings halvings_;
    std::vector<bool> has_codes_;
    std::vector<Tile> tiles_;
    std::vector<std::uint32_t> upper_; ///< of nodes at the top in preorder, the lower half being the next; kTile
};

/// A tree of halvings, and rows of codes at its top: what chunks HALV and NORM hold.
struct RowHalvings {
    Halvings halvings;           ///< with the codes that all share, and those of none where rows have their own
    std::vector<bool> has_codes; ///< one a halving: rows have a code of their own
    std::uint32_t code_bits = 7; ///< of these
    std::vector<std::vector<std::uint16_t>>
        rows; ///< of each, codes of the halvings that it leads random numbers to
};

/// Chunk NORM.
Chunk rows_chunk(const RowHalvings& rows);

/// Appends them as chunks MAPS and NORM have them: a bit a halving, whether it has codes of rows, then the codes.
void put_rows(const std::vector<bool>& has_codes, const std::vector<std::vector<std::uint16_t>>& rows,
              std::uint32_t code_bits, std::vector<std::uint8_t>& bytes);

} // namespace acdf::compress
