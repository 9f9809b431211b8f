// W. A. Horn, Single-machine job sequencing with treelike precedence ordering and linear delay penalties, 1972: the
// best halving of all, or group of them, either comes next, or right behind its parent, with which it becomes a
// group.
#include "compress/tables/order.h"

#include <queue>

namespace acdf::compress {
namespace {

constexpr std::uint32_t kNoHalving = 0xFFFFFFFFu;
constexpr double kBeforeAll = 1e30; // what halving a leaf that is too heavy gains, whatever the costs

class HalvingGroups {
public:
    explicit HalvingGroups(const TableGrowth& grown) : nodes_(grown.nodes()), groups_(nodes_.size()) {
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
            const TableNode& node = nodes_[i];
            groups_[i].of = groups_[i].last = i;
            if (node.lower == 0) continue;
            const double gain = node.cost() - nodes_[node.lower].cost() - nodes_[node.lower + 1].cost();
            groups_[i].gain = node.heavy ? kBeforeAll : gain * grown.cost(node.tree);
            groups_[i].count = 1;
            wait(i);
        }
    }

    /// Calls visit(node) for all that are halved, in their order.
    template <class Visit>
    void run(const Visit& visit) {
        while (!waiting_.empty()) {
            const Waiting next = waiting_.top();
            waiting_.pop();
            Group& group = groups_[next.group];
            if (group.of != next.group || group.count != next.count || group.done) continue; // it has grown since
            const std::uint32_t above = nodes_[next.group].parent, parent = group_of(above);
            if (above == next.group || groups_[parent].done) {
                group.done = true;
                for (std::uint32_t i = next.group; i != kNoHalving; i = groups_[i].next) visit(i);
            } else {
                join(parent, next.group);
            }
        }
    }

private:
    /// What is halved one after the other; by the number of the first node.
    struct Group {
        double gain = 0.0;
        std::uint32_t count = 0;
        std::uint32_t of = 0;                      ///< a group that this has joined; its own number: none
        std::uint32_t last = 0, next = kNoHalving; ///< the last node of the group; the node behind this one
        bool done = false;
    };
    struct Waiting {
        double gain; ///< a halving
        std::uint32_t group, count;
        bool operator<(const Waiting& other) const {
            return gain != other.gain ? gain < other.gain : group > other.group;
        }
    };

    void wait(std::uint32_t group) {
        const Group& of = groups_[group];
        waiting_.push({of.gain / double(of.count), group, of.count});
    }

    std::uint32_t group_of(std::uint32_t node) {
        while (groups_[node].of != node) node = groups_[node].of = groups_[groups_[node].of].of;
        return node;
    }

    void join(std::uint32_t above, std::uint32_t group) {
        Group &to = groups_[above], &from = groups_[group];
        from.of = above;
        to.gain += from.gain;
        to.count += from.count;
        groups_[to.last].next = group;
        to.last = from.last;
        wait(above);
    }

    const std::vector<TableNode>& nodes_;
    std::vector<Group> groups_;
    std::priority_queue<Waiting> waiting_;
};

} // namespace

TableOrder::TableOrder(const TableGrowth& grown, std::size_t trees) : trees_(trees) {
    const std::vector<TableNode>& from = grown.nodes();
    std::vector<std::uint32_t> number(from.size());
    std::vector<double> cost;
    double squares = 0.0;
    nodes_.reserve(from.size());
    const auto add = [&](std::uint32_t node) {
        number[node] = static_cast<std::uint32_t>(nodes_.size());
        nodes_.push_back(from[node]);
        nodes_.back().parent = number[from[node].parent];
        nodes_.back().lower = 0;
    };
    for (std::uint32_t tree = 0; tree < trees; ++tree) {
        add(tree);
        cost.push_back(from[tree].cost());
        squares += cost[tree] * cost[tree];
    }
    variances_.push_back(squares / double(trees) - 1.0);
    HalvingGroups(grown).run([&](std::uint32_t node) {
        const std::uint32_t lower = from[node].lower;
        nodes_[number[node]].lower = static_cast<std::uint32_t>(nodes_.size());
        add(lower);
        add(lower + 1);
        double& sum = cost[from[node].tree];
        squares -= sum * sum;
        sum += from[lower].cost() + from[lower + 1].cost() - from[node].cost();
        squares += sum * sum;
        variances_.push_back(squares / double(trees) - 1.0);
    });
}

} // namespace acdf::compress
