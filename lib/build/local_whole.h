// What points without a normal sample from: the tree of a local file that is the environment as a whole. It is as
// accurate as an environment file of a quarter of the bytes.
#pragma once

#include "build/local.h"
#include "compress/local/tile_curves.h"
#include "compress/store/store.h"
#include "compress/target.h"

#include <cstdint>

namespace acdf::build {

/// The bytes of the tree of an environment file that has a quarter of those of a file.
std::uint64_t whole_tree_bytes(std::uint64_t file);
/// The file in which all but such a tree takes `others` bytes.
std::uint64_t file_of_others(std::uint64_t others);

/// Which tree, and of that of the tiles what it counts beside the normals (compress::LocalSize).
struct WholeChoice {
    compress::WholeTree tree;
    double worth;
};
/// The first to try: the tree of the tiles, where their curves are fitted to all light, and are much of the file.
WholeChoice first_choice(const LocalOptions& options);
/// Where that is not accurate enough: it counts more or, at last, has curves of its own.
WholeChoice next_choice(const WholeChoice& choice);

/// What trees are to be as accurate as.
class AloneTree {
public:
    /// `target` must outlive it.
    explicit AloneTree(const compress::Target& target) : target_(target) {}

    /// Whether a tree at unit 0 of TREE, of WholeTree::of_tiles, is accurate enough for a file of `bytes`. The tree
    /// that it is compared with is fitted again only for another number of bytes.
    bool is_matched(const compress::EncodedTree& tree, std::uint64_t bytes);

private:
    const compress::Target& target_;
    std::uint64_t bytes_ = 0; ///< of the tree that was fitted last; 0: none
    double relative_variance_ = 0.0;
};

} // namespace acdf::build
