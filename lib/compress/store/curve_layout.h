// Where curves lie in chunk TREE (format/SPEC.md, section 7.2).
#pragma once

#include <acdf/curves/tree.h>
#include <acdf/layout.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// What the bytes of a curve depend on. Codes are those of its header.
struct CurveShape {
    std::uint32_t segments = 1;
    std::uint32_t probability_code = 0, position_code = 0, link_code = 0;
    bool tilted = false;
};

inline std::size_t rounded(std::size_t size, std::size_t alignment) {
    return (size + alignment - 1) / alignment * alignment;
}

/// The code of positions up to `last`, counted from `low` where that fits one byte and is known.
inline std::uint32_t position_code(std::uint32_t last, std::uint32_t low, bool low_known) {
    if (low_known && last - low <= 0xFF) return 0;
    return last > 0xFFFF ? 2 : 1;
}

/// Offset behind a curve that begins at `offset`, both in bytes.
inline std::size_t end_of(const CurveShape& curve, std::size_t offset) {
    const std::size_t n = curve.segments;
    const auto array = [&](std::size_t count, std::uint32_t code) {
        const std::size_t size = acdf_element_size(code);
        offset = rounded(offset, size) + count * size;
    };
    offset += n > ACDF_CURVE_SHORT_SEGMENTS ? 6 : 2;
    array(n - 1, curve.probability_code);
    array(n - 1, curve.position_code);
    if (curve.link_code > 0) array(n, curve.link_code - 1);
    if (curve.tilted) array(n, 1);
    return rounded(offset, 2);
}

/// Byte offsets of all curves, and of the end. Links start at one byte (code 1; 0 where there are none); those that
/// do not fit become wider, which moves what follows. `any_child(i, test)` returns whether a child of curve i
/// passes.
template <class AnyChild>
std::vector<std::size_t> place(std::vector<CurveShape>& curves, const AnyChild& any_child) {
    std::vector<std::size_t> offset(curves.size() + 1, 0);
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t i = 0; i < curves.size(); ++i) offset[i + 1] = end_of(curves[i], offset[i]);
        for (std::size_t i = 0; i < curves.size(); ++i) {
            if (curves[i].link_code == 0 || curves[i].link_code == 3) continue;
            const std::size_t most = curves[i].link_code == 1 ? 0xFF : 0xFFFF;
            if (!any_child(i, [&](std::size_t child) { return (offset[child] - offset[i]) / 2 > most; })) continue;
            ++curves[i].link_code;
            changed = true;
        }
    }
    return offset;
}

} // namespace acdf::compress
