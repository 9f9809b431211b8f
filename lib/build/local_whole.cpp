#include "build/local_whole.h"

#include "build/accuracy/environment.h"
#include "compress/local/whole.h"

#include <acdf/reader.h>
#include <acdf/views.h>

#include <algorithm>
#include <stdexcept>
#include <string>

namespace acdf::build {
namespace {

constexpr std::uint64_t kPart = 4;
/// What environment files have beside their tree, about: the least of it, so that none of as many bytes is better.
constexpr std::uint64_t kBesideTree = 640;

/// What the whole environment counts beside the normals where it would be too noisy else.
constexpr double kSomeWorth = 1.0, kMostWorth = 4.0;

double relative_variance(const compress::Target& target, compress::EncodedTree tree) {
    tree.roots = {0};
    const std::vector<std::uint8_t> bytes = compress::store(
        tree, compress::environment_description(target.columns, target.rows, target.parameterization));
    File file;
    if (const Status status = File::from_memory(bytes.data(), bytes.size(), file); !status.ok())
        throw std::logic_error(std::string("the reader refuses the tree just made: ") + status.message);
    return measure_environment(file, target).relative_variance;
}

} // namespace

std::uint64_t whole_tree_bytes(std::uint64_t file) {
    const std::uint64_t part = file / kPart;
    return std::max(part - std::min(part, kBesideTree), compress::kLeastWholeBytes);
}

std::uint64_t file_of_others(std::uint64_t others) {
    return others * kPart / (kPart - 1) + compress::kLeastWholeBytes;
}

WholeChoice first_choice(const LocalOptions& options) {
    const bool of_tiles = options.shape == compress::LocalShape::small && !options.mis;
    return {of_tiles ? compress::WholeTree::of_tiles : compress::WholeTree::own, 0.0};
}

WholeChoice next_choice(const WholeChoice& choice) {
    if (choice.worth >= kMostWorth) return {compress::WholeTree::own, 0.0};
    return {compress::WholeTree::of_tiles, choice.worth > 0.0 ? kMostWorth : kSomeWorth};
}

bool AloneTree::is_matched(const compress::EncodedTree& tree, std::uint64_t bytes) {
    if (const std::uint64_t alone = whole_tree_bytes(bytes); alone != bytes_) {
        bytes_ = alone;
        relative_variance_ = relative_variance(target_, compress::fit_whole(target_, alone).tree);
    }
    return relative_variance(target_, tree) <= relative_variance_;
}

} // namespace acdf::build
