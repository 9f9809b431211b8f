#include "compress/tables/growth.h"

#include "compress/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace acdf::compress {
namespace {

/// The same for numbers that are within a factor of about the root of 2.
int magnitude(double value) {
    int exponent = 0;
    const double fraction = std::frexp(value, &exponent);
    return 2 * exponent + (fraction > 0.70710678);
}

} // namespace

TableGrowth::TableGrowth(const TableCosts& costs) : costs_(costs), nodes_(costs.trees()) {
    parallel_for(std::size_t{0}, costs.trees(),
                 [&](std::size_t i) { nodes_[i] = costs.root(static_cast<std::uint32_t>(i)); });
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
        of_tree_.push_back(nodes_[i].cost());
        wait(i);
    }
}

/// What a leaf promises lowers the square of what its tree costs.
void TableGrowth::wait(std::uint32_t node) {
    const TableNode& leaf = nodes_[node];
    if (leaf.axis < 0) return;
    heavy_ += leaf.heavy;
    const int first = std::numeric_limits<int>::max();
    waiting_[leaf.heavy ? first : magnitude(static_cast<double>(leaf.promise) * of_tree_[leaf.tree])].push_back(
        node);
}

double TableGrowth::variance() const {
    double sum = 0.0;
    for (const double cost : of_tree_) sum += cost * cost;
    return sum / double(of_tree_.size()) - 1.0;
}

void TableGrowth::run(std::size_t leaves, double enough, const std::function<void(double)>& progress) {
    while (this->leaves() < leaves && !waiting_.empty() && (heavy_ > 0 || variance() > enough)) {
        halve(next(leaves - this->leaves()));
        if (progress) progress(std::min(1.0, double(this->leaves()) / double(leaves)));
    }
}

/// Takes the leaves that promise most, of those the first.
std::vector<std::uint32_t> TableGrowth::next(std::size_t most) {
    const auto best = waiting_.begin();
    std::vector<std::uint32_t> out = std::move(best->second);
    if (out.size() > most) {
        best->second.assign(out.begin() + static_cast<std::ptrdiff_t>(most), out.end());
        out.resize(most);
    } else {
        waiting_.erase(best);
    }
    return out;
}

void TableGrowth::halve(const std::vector<std::uint32_t>& leaves) {
    const std::size_t before = nodes_.size();
    for (std::size_t i = 0; i < leaves.size(); ++i)
        nodes_[leaves[i]].lower = static_cast<std::uint32_t>(before + 2 * i);
    nodes_.resize(before + 2 * leaves.size());
    parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t i) {
        const auto halves = costs_.halves_of(nodes_, leaves[i]);
        std::copy(halves.begin(), halves.end(), nodes_.begin() + static_cast<std::ptrdiff_t>(before + 2 * i));
    });
    for (const std::uint32_t leaf : leaves) {
        const TableNode& node = nodes_[leaf];
        heavy_ -= node.heavy;
        of_tree_[node.tree] += nodes_[node.lower].cost() + nodes_[node.lower + 1].cost() - node.cost();
        wait(node.lower);
        wait(node.lower + 1);
    }
}

} // namespace acdf::compress
