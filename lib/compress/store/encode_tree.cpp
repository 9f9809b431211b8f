#include "compress/store/curve_layout.h"
#include "compress/store/quantize.h"
#include "compress/store/store.h"

#include <acdf/curves/tree.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace acdf::compress {
namespace {

/// How often sampling reaches each curve, summed over the bins (which are as
/// likely as each other).
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

/// Where each curve's range begins on each axis; kMany where that depends on
/// the way that leads to it.
using Lows = std::array<std::uint32_t, ACDF_MAX_AXES>;
constexpr std::uint32_t kUnset = 0xFFFFFFFFu, kMany = 0xFFFFFFFEu;

void meet(Lows& known, const Lows& low) {
    for (std::size_t axis = 0; axis < known.size(); ++axis)
        if (known[axis] == kUnset) known[axis] = low[axis];
        else if (known[axis] != low[axis]) known[axis] = kMany;
}

std::vector<Lows> range_lows(const Cascade& cascade) {
    Lows unset, zero;
    unset.fill(kUnset);
    zero.fill(0);
    std::vector<Lows> lows(cascade.curves.size(), unset);
    for (std::uint32_t root : cascade.roots) meet(lows[root], zero);
    for (std::size_t i = 0; i < cascade.curves.size(); ++i) {
        const Curve& curve = cascade.curves[i];
        for (std::size_t s = 0; s < curve.children.size(); ++s) {
            if (curve.children[s] < 0) continue;
            Lows low = lows[i];
            if (s > 0) low[curve.axis] = curve.knots[s - 1];
            meet(lows[static_cast<std::size_t>(curve.children[s])], low);
        }
    }
    return lows;
}

/// A curve ready to be laid out.
struct Packed {
    const Curve* curve = nullptr;
    QuantizedCurve probability;
    std::uint32_t origin = 0; ///< what positions are counted from
};

Packed pack(const Curve& curve, const Lows& lows, double reach, double price, CurveShape& shape) {
    if (curve.segments() > ACDF_MAX_SEGMENTS) throw std::invalid_argument("a curve of more than 1048575 segments");
    Packed packed{&curve, quantize(curve.probability, reach, price), 0};
    shape.segments = static_cast<std::uint32_t>(curve.segments());
    shape.probability_code = packed.probability.code;
    const std::uint32_t low = lows[curve.axis];
    if (!curve.knots.empty()) shape.position_code = position_code(curve.knots.back(), low, low != kMany);
    if (shape.position_code == 0) packed.origin = low;
    const bool refined =
        std::any_of(curve.children.begin(), curve.children.end(), [](std::int32_t c) { return c >= 0; });
    if (refined) shape.link_code = 1;
    shape.tilted = !curve.tilts.empty();
    return packed;
}

/// Little-endian integers at the end of a growing array.
class Block {
public:
    explicit Block(std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}
    void put(std::uint32_t value, std::size_t size) {
        for (std::size_t i = 0; i < size; ++i) bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    }
    void align(std::size_t size) { bytes_.resize(rounded(bytes_.size(), size), 0); }

private:
    std::vector<std::uint8_t>& bytes_;
};

void write_header(std::uint32_t axis, const CurveShape& shape, Block block) {
    const bool many = shape.segments > ACDF_CURVE_SHORT_SEGMENTS;
    std::uint32_t header = axis | shape.probability_code << 3 | shape.position_code << 5 | shape.link_code << 7 |
                           (many ? 0 : shape.segments << ACDF_CURVE_SEGMENTS_SHIFT);
    if (shape.tilted) header |= ACDF_CURVE_TILTED;
    block.put(header, 2);
    if (many) block.put(shape.segments, 4);
}

std::uint32_t stored_tilt(double tilt) {
    const double scaled = std::nearbyint(std::clamp(tilt * 32768.0, -32767.0, 32767.0));
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(scaled)) & 0xFFFFu;
}

void write_curve(const Packed& packed, const CurveShape& shape, std::size_t at,
                 const std::vector<std::size_t>& offset, Block block) {
    const auto array = [&](const auto& values, std::uint32_t code, auto stored) {
        const std::size_t size = acdf_element_size(code);
        block.align(size);
        for (const auto& value : values) block.put(stored(value), size);
    };
    write_header(packed.curve->axis, shape, block);
    array(packed.probability.cumulative, shape.probability_code, [](std::uint32_t value) { return value; });
    array(packed.curve->knots, shape.position_code, [&](std::uint32_t knot) { return knot - packed.origin; });
    if (shape.link_code > 0)
        array(packed.curve->children, shape.link_code - 1, [&](std::int32_t child) {
            return child < 0 ? 0u : static_cast<std::uint32_t>((offset[static_cast<std::size_t>(child)] - at) / 2);
        });
    if (!packed.curve->tilts.empty()) array(packed.curve->tilts, 1, stored_tilt);
    block.align(2);
}

EncodedTree encode(const Cascade& cascade, double price) {
    const std::vector<double> weight = reach(cascade);
    const std::vector<Lows> lows = range_lows(cascade);
    std::vector<Packed> packed;
    packed.reserve(cascade.curves.size());
    std::vector<CurveShape> shapes(cascade.curves.size());
    for (std::size_t i = 0; i < cascade.curves.size(); ++i)
        packed.push_back(pack(cascade.curves[i], lows[i], weight[i], price, shapes[i]));
    const auto any_child = [&](std::size_t i, const auto& test) {
        const std::vector<std::int32_t>& children = cascade.curves[i].children;
        return std::any_of(children.begin(), children.end(),
                           [&](std::int32_t child) { return child >= 0 && test(std::size_t(child)); });
    };
    const std::vector<std::size_t> offset = place(shapes, any_child);
    if (offset.back() / 2 > 0xFFFFFFFFu) throw std::invalid_argument("a tree of more than 8 GiB");

    EncodedTree tree;
    tree.bytes.reserve(offset.back());
    for (std::size_t i = 0; i < packed.size(); ++i)
        write_curve(packed[i], shapes[i], offset[i], offset, Block(tree.bytes));
    for (std::uint32_t root : cascade.roots) tree.roots.push_back(static_cast<std::uint32_t>(offset[root] / 2));
    return tree;
}

/// A bin of one cell.
bool is_bare(const Curve& curve) {
    const auto refined = [](std::int32_t child) { return child >= 0; };
    return curve.segments() == 1 && curve.tilts.empty() &&
           std::none_of(curve.children.begin(), curve.children.end(), refined);
}

/// The same with one bare curve for all roots that are one.
Cascade sharing_bare_roots(const Cascade& cascade) {
    Cascade out;
    std::vector<std::uint32_t> now; // where each curve is
    std::vector<char> root(cascade.curves.size(), 0);
    for (const std::uint32_t r : cascade.roots) root[r] = 1;
    for (const Curve& curve : cascade.curves) // a child stays behind its parents
        for (const std::int32_t child : curve.children)
            if (child >= 0) root[static_cast<std::size_t>(child)] = 0;
    std::int64_t bare = -1;
    for (std::size_t i = 0; i < cascade.curves.size(); ++i) {
        const bool shared = root[i] && is_bare(cascade.curves[i]);
        if (shared && bare >= 0) {
            now.push_back(static_cast<std::uint32_t>(bare));
            continue;
        }
        if (shared) bare = static_cast<std::int64_t>(out.curves.size());
        now.push_back(static_cast<std::uint32_t>(out.curves.size()));
        out.curves.push_back(cascade.curves[i]);
    }
    for (Curve& curve : out.curves)
        for (std::int32_t& child : curve.children)
            if (child >= 0) child = static_cast<std::int32_t>(now[static_cast<std::size_t>(child)]);
    for (const std::uint32_t r : cascade.roots) out.roots.push_back(now[r]);
    return out;
}

} // namespace

EncodedTree encode_tree(const Cascade& cascade, double price) {
    EncodedTree tree = encode(cascade, price);
    if (cascade.curves.size() <= tree.bytes.size() / 4 + 1) return tree;
    // Many bins of one cell, whose curves have two bytes: readers take no more curves than a quarter of the bytes.
    return encode(sharing_bare_roots(cascade), price);
}

} // namespace acdf::compress
