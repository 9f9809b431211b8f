// BRDF files of every form that calls meet.
#pragma once

#include "tests/lib/reader/brdf_builder.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace acdf_test {

/// Halvings of the lower half of the rows again and again, then of the columns: cells of one step.
inline void halve_in_a_chain(BrdfSpec& spec) {
    auto& nodes = spec.halved.tree.halvings.nodes;
    nodes.clear();
    spec.halved.own.clear();
    for (std::uint32_t i = 0; i < 9 + 16; ++i) {
        nodes.push_back({i < 9 ? 1 : 0, 140 + i});
        spec.halved.own.push_back(i < 12);
    }
    nodes.insert(nodes.end(), spec.halved.own.size() + 1, HalvingSpec{});
    for (std::size_t row = 0; row < spec.halved.rows.size(); ++row) {
        spec.halved.rows[row].clear();
        for (std::uint32_t i = 0; i < 12; ++i)
            spec.halved.rows[row].push_back(40 + 5 * static_cast<std::uint32_t>(row) + i % 7);
    }
}

inline std::vector<std::pair<std::string, BrdfSpec>> brdf_forms() {
    std::vector<std::pair<std::string, BrdfSpec>> out;
    const auto add = [&](const char* name, auto change) {
        out.emplace_back(name, shared_brdf());
        change(out.back().second);
    };
    add("mirrored", [](BrdfSpec&) {});
    add("both sides", [](BrdfSpec& s) { s.flags = 0; });
    add("azimuths", [](BrdfSpec& s) {
        s.flags = 0, s.azimuths = 4, s.bins.clear();
        for (std::uint32_t b = 0; b < 12; ++b) s.bins.push_back({b % 3, 0.05f + 0.01f * float(b)});
    });
    add("one view", [](BrdfSpec& s) { s.nodes = {0.5f}, s.bins = {{0, 0.5f}}, s.halved.rows.resize(1); });
    add("two views of one row", [](BrdfSpec& s) {
        s.nodes = {0.25f, 0.75f}, s.bins = {{0, 0.5f}, {0, 0.25f}}, s.halved.rows.resize(1);
    });
    add("views close together", [](BrdfSpec& s) {
        s.nodes.clear(), s.bins.clear();
        for (int i = 0; i < 90; ++i) {
            s.nodes.push_back(i < 45 ? 0.5f + 1e-4f * float(i) : 0.51f + 0.01f * float(i - 45));
            s.bins.push_back({static_cast<std::uint32_t>(i % 3), 0.01f});
        }
    });
    add("a black view", [](BrdfSpec& s) { s.bins[1].share = 0.0f; });
    add("nothing but black views", [](BrdfSpec& s) {
        for (auto& bin : s.bins) bin.share = 0.0f;
    });
    add("a chain", [](BrdfSpec& s) { s.columns = 65536, halve_in_a_chain(s); });
    add("as many columns as may be", [](BrdfSpec& s) { s.columns = 65536; });
    add("one cell", [](BrdfSpec& s) {
        s.halved.tree.halvings.nodes = {{}};
        s.halved.own.clear();
        s.halved.rows.assign(3, {});
    });
    add("a floor", [](BrdfSpec& s) { s.diffuse_share = 0.25f; });
    out.emplace_back("any tree", random_brdf(7));
    out.emplace_back("trees of their own", separate_brdf());
    return out;
}

} // namespace acdf_test
