#include "compress/fit/outline.h"

#include <algorithm>
#include <utility>

namespace acdf::compress {
namespace {

class Outliner {
public:
    Outliner(const PruneNodes& nodes, const Pruned& pruned, const std::vector<double>& cost, Outline& out)
        : nodes_(nodes), pruned_(pruned), cost_(cost), out_(out) {}

    std::int32_t add_curve(std::uint32_t i) {
        const std::int8_t split = pruned_.divided[i] ? nodes_[i].split : std::int8_t{0};
        const std::size_t index = out_.curves.size(), first = out_.segments.size();
        collect(i, split);
        const std::size_t count = out_.segments.size() - first;
        out_.curves.push_back({i, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count),
                               static_cast<std::size_t>(split)});
        add_children(first, count);
        return static_cast<std::int32_t>(index);
    }

private:
    /// The parts that become the segments of a curve that starts at part i.
    void collect(std::uint32_t i, std::int8_t split) {
        if (!pruned_.divided[i] || nodes_[i].split != split) {
            out_.segments.push_back({i, -1});
            return;
        }
        for (std::uint32_t k = 0; k < nodes_[i].children; ++k) collect(nodes_[i].first_child + k, split);
    }

    /// Small subtrees first: most links are then short enough for one byte.
    void add_children(std::size_t first, std::size_t count) {
        const std::size_t begin = order_.size();
        for (std::size_t s = first; s < first + count; ++s) {
            const std::uint32_t part = out_.segments[s].part;
            if (pruned_.divided[part] && cost_[part] > 0.0) order_.emplace_back(pruned_.cells[part], s);
        }
        std::sort(order_.begin() + std::ptrdiff_t(begin), order_.end());
        const std::size_t end = order_.size();
        for (std::size_t k = begin; k < end; ++k) {
            const std::size_t s = order_[k].second;
            const std::int32_t child = add_curve(out_.segments[s].part);
            out_.segments[s].child = child;
        }
        order_.resize(begin);
    }

    const PruneNodes& nodes_;
    const Pruned& pruned_;
    const std::vector<double>& cost_;
    Outline& out_;
    std::vector<std::pair<std::uint32_t, std::size_t>> order_; ///< cells and segment, of all curves above
};

} // namespace

std::vector<double> shares_below(const PruneNodes& nodes, const Pruned& pruned) {
    const auto sums = [&](double PruneNode::*what) {
        std::vector<double> out(nodes.size(), 0.0);
        for (std::size_t i = nodes.size(); i-- > 0;) {
            if (!pruned.divided[i]) out[i] = nodes[i].*what;
            for (std::uint32_t k = 0; pruned.divided[i] && k < nodes[i].children; ++k)
                out[i] += out[nodes[i].first_child + k];
        }
        return out;
    };
    std::vector<double> shares = sums(&PruneNode::share);
    return shares[0] > 0.0 ? shares : sums(&PruneNode::cost);
}

Outline outline(const PruneNodes& nodes, const Pruned& pruned, const std::vector<double>& cost) {
    Outline out;
    Outliner(nodes, pruned, cost, out).add_curve(0);
    return out;
}

} // namespace acdf::compress
