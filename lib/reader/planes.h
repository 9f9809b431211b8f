// Codec 2 of format/SPEC.md §7.4: a tree taken apart into planes, which deflate better. Not installed.
#pragma once

#include "sources.h"

namespace acdf {

/// Puts the tree of `tree_size` bytes at `tree` (aligned to 4) together from `size` bytes of planes. False where
/// they are not the planes of a tree of that size; `tree` then holds anything. Whether the tree itself keeps the
/// rules is for others to check. Reads and writes nothing else, allocates nothing; linear in both sizes.
bool planes_to_tree(const u8* planes, u64 size, u8* tree, u64 tree_size) noexcept;

/// Inflates planes, and puts the tree together; null, or what is wrong.
const char* inflate_planes(const u8* in, u64 in_size, u8* tree, u64 tree_size) noexcept;
extern const char no_memory_for_planes[];

} // namespace acdf
