// A tree taken apart into planes, which deflate better: codec 2 of format/SPEC.md §7.4.
#pragma once

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// The planes of chunk TREE; empty where it has none, since a subtree does not lie right behind what comes before
/// it (curves that several links lead to).
std::vector<std::uint8_t> tree_to_planes(const std::vector<std::uint8_t>& tree);

} // namespace acdf::compress
