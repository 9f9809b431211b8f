// Codec 2 from SPEC.md §7.4 alone: the planes of a tree in preorder, and files that hold them.
#pragma once

#include "tests/lib/reader/action.h"
#include "tests/lib/reader/files.h"

#include <algorithm>
#include <array>

namespace acdf_test {

struct PlaneStreams {
    static constexpr std::array<int, 11> bytes = {2, 4, 1, 2, 4, 1, 2, 4, 1, 4, 2};
    std::array<std::vector<std::uint32_t>, 11> values;

    void differences(std::size_t stream, const std::vector<std::uint32_t>& array, std::uint32_t origin) {
        for (std::size_t i = 0; i < array.size(); ++i)
            values[stream].push_back(i == 0 ? array[i] - origin : array[i] - array[i - 1]);
    }

    Bytes encode() const {
        Bytes out;
        for (const auto& stream : values) put32(out, static_cast<std::uint32_t>(stream.size()));
        for (std::size_t s = 0; s < values.size(); ++s)
            for (int byte = 0; byte < bytes[s]; ++byte)
                for (std::uint32_t value : values[s]) out.push_back(static_cast<std::uint8_t>(value >> 8 * byte));
        return out;
    }
};

/// Of curves in preorder.
inline PlaneStreams planes_of(const std::vector<CurveSpec>& curves) {
    PlaneStreams out;
    for (const CurveSpec& curve : curves) {
        out.values[0].push_back(curve.header());
        if (curve.many()) out.values[1].push_back(static_cast<std::uint32_t>(curve.segments()));
        out.differences(2 + CurveSpec::code(curve.cumulative_bytes), curve.cumulative, 0);
        out.differences(5 + CurveSpec::code(curve.position_bytes), curve.positions,
                        curve.position_bytes == 1 ? curve.origin : 0);
        if (curve.link_bytes > 0) {
            std::vector<std::pair<int, std::uint32_t>> children; // curve, segment
            for (std::size_t s = 0; s < curve.segments(); ++s)
                if (curve.children[s] >= 0) children.emplace_back(curve.children[s], s);
            std::sort(children.begin(), children.end());
            auto& stream = out.values[curve.segments() <= 255 ? 8 : 9];
            stream.push_back(static_cast<std::uint32_t>(children.size()));
            for (const auto& child : children) stream.push_back(child.second);
        }
        for (int tilt : curve.tilts) out.values[10].push_back(static_cast<std::uint32_t>(tilt) & 0xFFFF);
    }
    return out;
}

/// Four curves in preorder; the subtrees of curve 0 lie in another order than its segments.
inline EnvironmentSpec preorder_environment() {
    EnvironmentSpec spec = complete_environment();
    std::vector<CurveSpec>& curves = spec.tree.curves;
    curves[0].children = {3, 1, -1};
    CurveSpec last = even_curve(1, {5});
    last.position_bytes = 2;
    curves.push_back(last);
    return spec;
}

/// `spec` with TREE as planes; `change(streams, raw_length)` before they are written.
using PlaneChange = Action<void(PlaneStreams&, std::uint64_t&)>;
inline FileSpec as_planes(EnvironmentSpec spec, const PlaneChange& change = {}) {
    FileSpec file = spec.file();
    PlaneStreams streams = planes_of(spec.tree.curves);
    std::uint64_t raw_length = file.chunks[2].raw.size();
    if (change) change(streams, raw_length);
    file.chunks[2].raw = streams.encode();
    file.chunks[2].planes_of = raw_length;
    return file;
}

} // namespace acdf_test
