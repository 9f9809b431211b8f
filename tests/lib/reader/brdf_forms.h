// BRDF files of every form that runtime tables and batches meet.
#pragma once

#include "tests/lib/reader/brdf_builder.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace acdf_test {

struct SplitBox {
    std::uint32_t low[2], high[2];
};

/// Splits a box `levels` times over, on both axes in turns, nearly each time at a position of its own. Returns what
/// number it has as a child.
inline std::uint16_t halve(BrdfSpec& spec, const SplitBox& box, std::uint32_t levels, std::uint32_t& tiles) {
    if (levels == 0) return static_cast<std::uint16_t>(tile_flag | tiles++);
    const std::size_t number = spec.splits.size();
    const std::uint32_t axis = levels % 2, half = (box.high[axis] - box.low[axis]) / 2;
    const std::uint32_t position = box.low[axis] + half + static_cast<std::uint32_t>(number) % half;
    spec.splits.push_back({axis, position, {0, 0}});
    for (const std::size_t part : {0u, 1u}) {
        SplitBox inside = box;
        (part == 0 ? inside.high : inside.low)[axis] = position;
        const std::uint16_t child = halve(spec, inside, levels - 1, tiles);
        spec.splits[number].child[part] = child;
    }
    return static_cast<std::uint16_t>(number);
}

/// 2048 cells whose borders lie at hundreds of thousands of pairs of positions.
inline BrdfSpec many_borders() {
    BrdfSpec spec = shared_brdf();
    spec.columns = 65536, spec.rows = 1u << 28, spec.splits.clear();
    std::uint32_t tiles = 0;
    halve(spec, {{0, 0}, {spec.columns, spec.rows}}, 11, tiles);
    spec.codes.assign(3, {});
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t i = 0; i < spec.splits.size(); ++i)
            spec.codes[row].push_back(static_cast<std::uint8_t>(2 + (5 * row + i) % 250));
    return spec;
}

/// What the vectors have tables for, at its smallest and with a chain of splits, and what they leave to the loop.
inline std::vector<std::pair<std::string, BrdfSpec>> brdf_forms() {
    std::vector<std::pair<std::string, BrdfSpec>> out;
    const auto add = [&](const char* name, auto change) {
        out.emplace_back(name, shared_brdf());
        change(out.back().second);
    };
    add("mirrored", [](BrdfSpec&) {});
    add("both sides", [](BrdfSpec& s) { s.flags = 0; });
    add("one view", [](BrdfSpec& s) {
        s.nodes = {0.5f}, s.bins = {{1, 0.5f}}, s.codes = {s.codes[0], s.codes[1]};
    });
    add("two views of one row", [](BrdfSpec& s) {
        s.nodes = {0.25f, 0.75f}, s.bins = {{0, 0.5f}, {0, 0.25f}}, s.codes = {s.codes[0]};
    });
    add("views close together", [](BrdfSpec& s) {
        s.nodes.clear(), s.bins.clear();
        for (int i = 0; i < 90; ++i) {
            s.nodes.push_back(i < 45 ? 0.5f + 1e-4f * float(i) : 0.51f + 0.01f * float(i - 45));
            s.bins.push_back({static_cast<std::uint32_t>(i % 3), 0.01f});
        }
        s.rows = s.columns = 8;
    });
    add("a black view", [](BrdfSpec& s) { s.bins[1].share = 0.0f; });
    add("nothing but black views", [](BrdfSpec& s) {
        for (auto& bin : s.bins) bin.share = 0.0f;
    });
    add("a chain", [](BrdfSpec& s) {
        s.columns = 64, s.splits.clear(), s.codes.assign(3, {});
        for (std::uint16_t i = 0; i < 48; ++i) {
            const auto next = static_cast<std::uint16_t>(i < 47 ? i + 1 : tile_flag | 48);
            s.splits.push_back({0, i + 1u, {static_cast<std::uint16_t>(tile_flag | i), next}});
            for (std::size_t row = 0; row < 3; ++row)
                s.codes[row].push_back(static_cast<std::uint8_t>(2 + 5 * row + i % 7));
        }
    });
    add("as many rows as may be", [](BrdfSpec& s) { s.columns = 65536, s.rows = 1u << 28; });
    add("a floor", [](BrdfSpec& s) { s.diffuse_share = 0.25f; });
    out.emplace_back("many borders", many_borders());
    out.emplace_back("trees of their own", separate_brdf());
    return out;
}

} // namespace acdf_test
