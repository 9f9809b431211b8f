#include "compress/store/planes.h"

#include <acdf/curves/tree.h>

#include <algorithm>
#include <array>
#include <utility>

namespace acdf::compress {
namespace {

constexpr std::uint32_t kValueSizes[] = ACDF_PLANE_VALUE_SIZES;

using Streams = std::array<std::vector<std::uint32_t>, ACDF_PLANE_STREAMS>;

void put_differences(const std::uint8_t* array, std::uint32_t count, std::uint32_t code,
                     std::vector<std::uint32_t>& out) {
    for (std::uint32_t i = 0, before = 0; i < count; ++i) {
        const std::uint32_t value = acdf_load(array, i, code);
        out.push_back(value - before);
        before = value;
    }
}

/// How many segments of the curve are refined, and which, in the order of their subtrees; their offsets, the last
/// one first, go on top of `expected`.
void put_children(const AcdfCurve& curve, std::uint32_t at, std::vector<std::uint32_t>& out,
                  std::vector<std::uint32_t>& expected) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> children; // link, segment
    for (std::uint32_t s = 0; s < curve.segments; ++s)
        if (const std::uint32_t link = acdf_curve_link(&curve, s); link != 0) children.emplace_back(link, s);
    std::sort(children.begin(), children.end());
    out.push_back(static_cast<std::uint32_t>(children.size()));
    for (const auto& child : children) out.push_back(child.second);
    for (std::size_t k = children.size(); k-- > 0;) expected.push_back(at + children[k].first);
}

/// Empty headers where the curves are in an order that planes cannot store.
Streams streams_of(const std::vector<std::uint8_t>& tree) {
    Streams streams;
    std::vector<std::uint32_t> expected; // where the subtrees that are still to come begin; the next one last
    for (std::uint32_t at = 0; 2 * std::size_t{at} < tree.size();) {
        AcdfCurve curve;
        const auto end = static_cast<std::uint32_t>(acdf_curve_decode(tree.data(), at, &curve));
        if (!expected.empty()) {
            if (expected.back() != at) return {};
            expected.pop_back();
        }
        streams[ACDF_PLANE_HEADERS].push_back(curve.header);
        if (curve.header >> ACDF_CURVE_SEGMENTS_SHIFT == 0) streams[ACDF_PLANE_SEGMENTS].push_back(curve.segments);
        const std::uint32_t cumulative = ACDF_CURVE_CUMULATIVE_CODE(curve.header),
                            position = ACDF_CURVE_POSITION_CODE(curve.header);
        put_differences(curve.cumulative, curve.segments - 1, cumulative,
                        streams[ACDF_PLANE_CUMULATIVE + cumulative]);
        put_differences(curve.positions, curve.segments - 1, position, streams[ACDF_PLANE_POSITIONS + position]);
        if (curve.links)
            put_children(curve, at, streams[ACDF_PLANE_CHILDREN + (curve.segments <= 0xFF ? 0 : 1)], expected);
        for (std::uint32_t s = 0; curve.tilts && s < curve.segments; ++s)
            streams[ACDF_PLANE_TILTS].push_back(acdf_load(curve.tilts, s, 1));
        at = end;
    }
    return expected.empty() ? streams : Streams{};
}

} // namespace

std::vector<std::uint8_t> tree_to_planes(const std::vector<std::uint8_t>& tree) {
    const Streams streams = streams_of(tree);
    std::vector<std::uint8_t> out;
    if (streams[ACDF_PLANE_HEADERS].empty()) return out;
    for (const auto& stream : streams)
        for (std::uint32_t byte = 0; byte < 4; ++byte)
            out.push_back(static_cast<std::uint8_t>(stream.size() >> 8 * byte));
    for (std::size_t i = 0; i < streams.size(); ++i)
        for (std::uint32_t byte = 0; byte < kValueSizes[i]; ++byte)
            for (const std::uint32_t value : streams[i])
                out.push_back(static_cast<std::uint8_t>(value >> 8 * byte));
    return out;
}

} // namespace acdf::compress
