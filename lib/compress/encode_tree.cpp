#include "compress/quantize.h"
#include "compress/store.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace acdf::compress {
namespace {

/// How often sampling reaches each curve, summed over the bins (which are as likely as each other).
std::vector<double> reach(const Cascade& cascade) {
    std::vector<double> reach(cascade.curves.size(), 0.0);
    for (std::uint32_t root : cascade.roots) reach[root] += 1.0 / static_cast<double>(cascade.roots.size());
    for (std::size_t i = 0; i < cascade.curves.size(); ++i) {
        const Curve& curve = cascade.curves[i];
        for (std::size_t s = 0; s < curve.children.size(); ++s)
            if (curve.children[s] >= 0)
                reach[static_cast<std::size_t>(curve.children[s])] += reach[i] * curve.probability[s];
    }
    return reach;
}

/// A curve ready to be laid out.
struct Packed {
    const Curve* curve = nullptr;
    QuantizedCurve probability;
    bool wide_positions = false;
    AcdfLinks links = ACDF_LINKS_NONE;
};

Packed pack(const Curve& curve, double tolerance) {
    if (curve.segments() > ACDF_MAX_SEGMENTS) throw std::invalid_argument("a curve of more than 1048575 segments");
    Packed packed{&curve, quantize(curve.probability, tolerance), false, ACDF_LINKS_NONE};
    packed.wide_positions = !curve.knots.empty() && curve.knots.back() > 0xFFFF;
    const bool refined =
        std::any_of(curve.children.begin(), curve.children.end(), [](std::int32_t c) { return c >= 0; });
    if (refined) packed.links = ACDF_LINKS_16;
    return packed;
}

class Block {
public:
    explicit Block(std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}
    void put(std::uint32_t value, std::size_t size) {
        for (std::size_t i = 0; i < size; ++i) bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    }
    void align(std::size_t size) { bytes_.resize((bytes_.size() + size - 1) / size * size, 0); }

private:
    std::vector<std::uint8_t>& bytes_;
};

std::size_t rounded(std::size_t size, std::size_t alignment) {
    return (size + alignment - 1) / alignment * alignment;
}

std::uint32_t words(const Packed& packed) {
    const std::size_t n = packed.curve->segments();
    std::size_t size = 4 + (n - 1) * (packed.probability.wide ? 4 : 2);
    if (packed.wide_positions) size = rounded(size, 4);
    size += (n - 1) * (packed.wide_positions ? 4 : 2);
    if (packed.links == ACDF_LINKS_32) size = rounded(size, 4) + n * 4;
    if (packed.links == ACDF_LINKS_16) size += n * 2;
    if (!packed.curve->tilts.empty()) size += n * 2;
    return static_cast<std::uint32_t>(rounded(size, 4) / 4);
}

/// Word offsets of all curves; links that do not fit 16 bits become 32 bits wide, which moves what follows.
std::vector<std::uint64_t> place(std::vector<Packed>& packed) {
    std::vector<std::uint64_t> offset(packed.size() + 1, 0);
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t i = 0; i < packed.size(); ++i) offset[i + 1] = offset[i] + words(packed[i]);
        for (std::size_t i = 0; i < packed.size(); ++i) {
            if (packed[i].links != ACDF_LINKS_16) continue;
            for (std::int32_t child : packed[i].curve->children)
                if (child >= 0 && offset[static_cast<std::size_t>(child)] - offset[i] > 0xFFFF)
                    packed[i].links = ACDF_LINKS_32;
            changed |= packed[i].links == ACDF_LINKS_32;
        }
    }
    return offset;
}

std::uint32_t header_word(const Packed& packed) {
    std::uint32_t header = packed.curve->axis | static_cast<std::uint32_t>(packed.curve->segments())
                                                    << ACDF_CURVE_SEGMENTS_SHIFT;
    if (packed.probability.wide) header |= ACDF_CURVE_WIDE_CUMULATIVE;
    if (packed.wide_positions) header |= ACDF_CURVE_WIDE_POSITIONS;
    if (!packed.curve->tilts.empty()) header |= ACDF_CURVE_TILTED;
    return header | static_cast<std::uint32_t>(packed.links) << ACDF_CURVE_LINKS_SHIFT;
}

std::uint32_t stored_tilt(double tilt) {
    const double scaled = std::nearbyint(std::clamp(tilt * 32768.0, -32767.0, 32767.0));
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(scaled)) & 0xFFFFu;
}

void write_curve(const Packed& packed, std::uint64_t at, const std::vector<std::uint64_t>& offset, Block block) {
    block.put(header_word(packed), 4);
    for (std::uint32_t value : packed.probability.cumulative) block.put(value, packed.probability.wide ? 4 : 2);
    if (packed.wide_positions) block.align(4);
    for (std::uint32_t knot : packed.curve->knots) block.put(knot, packed.wide_positions ? 4 : 2);
    if (packed.links != ACDF_LINKS_NONE) {
        const std::size_t size = packed.links == ACDF_LINKS_32 ? 4 : 2;
        block.align(size);
        for (std::int32_t child : packed.curve->children)
            block.put(child < 0 ? 0 : static_cast<std::uint32_t>(offset[static_cast<std::size_t>(child)] - at),
                      size);
    }
    for (double tilt : packed.curve->tilts) block.put(stored_tilt(tilt), 2);
    block.align(4);
}

} // namespace

EncodedTree encode_tree(const Cascade& cascade, double tolerance) {
    const std::vector<double> weight = reach(cascade);
    std::vector<Packed> packed;
    packed.reserve(cascade.curves.size());
    for (std::size_t i = 0; i < cascade.curves.size(); ++i)
        packed.push_back(pack(cascade.curves[i], weight[i] > 0.0 ? tolerance / weight[i] : 1.0));
    const std::vector<std::uint64_t> offset = place(packed);
    if (offset.back() > 0xFFFFFFFFu) throw std::invalid_argument("a tree of more than 16 GiB");

    EncodedTree tree;
    tree.bytes.reserve(offset.back() * 4);
    for (std::size_t i = 0; i < packed.size(); ++i) write_curve(packed[i], offset[i], offset, Block(tree.bytes));
    for (std::uint32_t root : cascade.roots) tree.roots.push_back(static_cast<std::uint32_t>(offset[root]));
    return tree;
}

} // namespace acdf::compress
