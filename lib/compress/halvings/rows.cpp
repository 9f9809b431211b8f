#include "compress/halvings/rows.h"

#include "compress/halvings/bit_writer.h"

#include <acdf/halvings.h>
#include <acdf/layout.h>

#include <algorithm>
#include <cstring>

namespace acdf::compress {

struct RowTree::Part {
    std::uint32_t node, tile; ///< tile: its number, kNone above
    std::uint32_t below;      ///< of an upper half at the top, the number of the node that was halved; else kNone
    AcdfSpan steps[2];
    double share; ///< of the steps of its tile
};

RowTree::RowTree(const std::vector<HalvedNode>& nodes, std::size_t top, const std::vector<double>& weights,
                 std::array<std::uint32_t, 2> axes) {
    const HalvingCodes codes(kSharedCodeBits);
    halvings_.code_bits = kSharedCodeBits;
    std::vector<Part> open{{0, kNone, kNone, {{{0, ACDF_STEPS}}, {{0, ACDF_STEPS}}}, 1.0}};
    while (!open.empty()) {
        Part part = open.back();
        open.pop_back();
        const HalvedNode& node = nodes[part.node];
        const std::size_t axis = node.axis == 1 ? 1 : 0;
        const std::uint32_t wide = part.steps[axis].end[1] - part.steps[axis].end[0];
        const bool halved = node.lower != 0 && weights[part.node] > 0.0 && wide >= 2 * kStepsOfFloats;
        const bool own = halved && node.lower < 2 * top + 1;
        const auto number = static_cast<std::uint32_t>(upper_.size()); // if it is at the top
        if (part.tile == kNone) {
            if (part.below != kNone) upper_[part.below] = number;
            upper_.push_back(kTile);
            if (!own) {
                part.tile = static_cast<std::uint32_t>(tiles_.size());
                part.share = 1.0;
                tiles_.push_back({part.node, {}});
            }
        }
        if (!halved) {
            halvings_.axes.push_back(-1);
            tiles_[part.tile].leaves.push_back({part.node, part.share});
            continue;
        }
        const std::uint32_t code =
            codes.best(wide, weights[node.lower], weights[node.lower + 1], kStepsOfFloats, kStepsOfFloats);
        const std::uint32_t lower = codes.lower(wide, code);
        halvings_.axes.push_back(static_cast<std::int8_t>(axes[axis]));
        halvings_.codes.push_back(static_cast<std::uint16_t>(code));
        has_codes_.push_back(own);
        Part half[2] = {part, part};
        for (std::uint32_t upper = 0; upper < 2; ++upper) {
            half[upper].node = node.lower + upper;
            half[upper].below = own && upper ? number : kNone;
            half[upper].steps[axis].end[1 - upper] = part.steps[axis].end[0] + lower;
            half[upper].share *= double(upper ? wide - lower : lower) / double(wide);
        }
        open.push_back(half[1]);
        open.push_back(half[0]);
    }
}

CodedRow RowTree::row(const HalvingCodes& codes, const std::vector<double>& parts, Unreached unreached) const {
    std::vector<double> weights(upper_.size()), least(upper_.size());
    std::size_t tile = tiles_.size();
    for (std::size_t i = upper_.size(); i-- > 0;) {
        if (upper_[i] == kTile) {
            weights[i] = parts[--tile];
            least[i] = weights[i] > 0.0 ? kStepsOfFloats : 0.0;
        } else {
            weights[i] = weights[i + 1] + weights[upper_[i]];
            least[i] = codes.least(least[i + 1], least[upper_[i]]);
        }
    }
    CodedRow out;
    out.steps.reserve(tiles_.size());
    std::vector<std::uint32_t> steps(upper_.size());
    steps[0] = ACDF_STEPS;
    for (std::size_t i = 0; i < upper_.size(); ++i) {
        if (upper_[i] == kTile) {
            out.steps.push_back(steps[i]);
            continue;
        }
        const std::size_t lower = i + 1, upper = upper_[i];
        const std::uint32_t code = codes.best(steps[i], weights[lower], weights[upper], least[lower], least[upper]);
        if (steps[i] > 0 || unreached == Unreached::stored) out.codes.push_back(static_cast<std::uint16_t>(code));
        steps[lower] = codes.lower(steps[i], code);
        steps[upper] = steps[i] - steps[lower];
    }
    return out;
}

void put_rows(const std::vector<bool>& has_codes, const std::vector<std::vector<std::uint16_t>>& rows,
              std::uint32_t code_bits, std::vector<std::uint8_t>& bytes) {
    BitWriter bits(bytes);
    for (const bool own : has_codes) bits.put(own, 1);
    bits.pad();
    for (const std::vector<std::uint16_t>& row : rows)
        for (const std::uint16_t code : row) bits.put(code, code_bits);
    bits.pad();
}

Chunk rows_chunk(const RowHalvings& rows) {
    const auto splits = static_cast<std::uint32_t>(std::count(rows.has_codes.begin(), rows.has_codes.end(), true));
    const AcdfNormalsHeader header = {static_cast<std::uint32_t>(rows.rows.size()), splits, rows.code_bits, 0};
    Chunk chunk{ACDF_CHUNK_NORMALS, {}};
    chunk.bytes.resize(sizeof header);
    std::memcpy(chunk.bytes.data(), &header, sizeof header);
    put_rows(rows.has_codes, rows.rows, rows.code_bits, chunk.bytes);
    return chunk;
}

} // namespace acdf::compress
