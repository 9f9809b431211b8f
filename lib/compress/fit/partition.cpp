#include "compress/fit/partition.h"

#include "compress/fit/division.h"
#include "compress/fit/prune.h"
#include "compress/parallel.h"

#include <algorithm>
#include <array>
#include <mutex>

namespace acdf::compress {
namespace {

constexpr std::size_t kParts = 1024;      // parts divided at once
constexpr std::size_t kSubtree = 1 << 16; // steps of a box that one thread divides to the end
constexpr std::size_t kSubtreesAtOnce = 64;

struct PartScratch {
    Projections projections;
    DivisionScratch division;
};

struct Children {
    std::array<Part, Division::most_parts> parts;
    std::size_t count = 0;
};

/// The axis whose division gains most a knot, or `forced` where that one can be divided at all.
std::size_t best_axis(const std::array<Division, ACDF_MAX_AXES>& divisions, std::size_t axes, std::int8_t forced) {
    if (forced != Part::whole && divisions[static_cast<std::size_t>(forced)].knots > 0)
        return static_cast<std::size_t>(forced);
    std::size_t best = 0;
    for (std::size_t axis = 1; axis < axes; ++axis)
        if (divisions[axis].gain_per_knot > divisions[best].gain_per_knot) best = axis;
    return best;
}

/// How far parts are divided, and how.
struct Growth {
    const Grid& grid;
    double total, finest, heaviest;

    bool open(const Part& part) const {
        return part.split == Part::whole && divisible(part) &&
               (part.excess() > finest || part.moments.above(heaviest));
    }

    /// Divides a part; its children get their position later.
    void divide(std::int8_t forced, Part& part, Children& out) const {
        thread_local PartScratch scratch; // arrays as long as an axis
        project(grid, total, part.box, scratch.projections);
        std::array<Division, ACDF_MAX_AXES> divisions;
        const double cost = part.moments.cost();
        for (std::size_t axis = 0; axis < grid.dimensions(); ++axis)
            divisions[axis] = compress::divide(scratch.projections[axis], cost, scratch.division);
        const std::size_t axis = best_axis(divisions, grid.dimensions(), forced);
        const Division& division = divisions[axis];
        part.split = static_cast<std::int8_t>(axis);
        out.count = division.knots + 1;
        for (std::size_t k = 0; k < out.count; ++k) {
            const std::uint32_t begin = k == 0 ? 0 : division.cuts[k - 1];
            const std::uint32_t end = k < division.knots ? division.cuts[k] : part.box.length(axis);
            Part& child = out.parts[k] = Part{};
            child.box = part.box;
            child.box.begin[axis] = part.box.begin[axis] + begin;
            child.box.end[axis] = part.box.begin[axis] + end;
            child.depth = static_cast<std::uint8_t>(part.depth + 1);
            child.moments = scratch.projections[axis].sum(begin, end, total);
        }
    }

private:
    bool divisible(const Part& part) const {
        for (std::size_t axis = 0; axis < grid.dimensions(); ++axis)
            if (part.box.length(axis) > 1) return part.depth <= ACDF_MAX_DEPTH;
        return false;
    }
};

std::size_t steps(const Grid& grid, const Box& box) {
    std::size_t product = 1;
    for (std::size_t axis = 0; axis < grid.dimensions(); ++axis) product *= box.length(axis);
    return product;
}

void adopt(const Children& children, std::size_t parent, std::vector<Part>& parts) {
    parts[parent].first_child = static_cast<std::uint32_t>(parts.size());
    parts[parent].children = static_cast<std::uint32_t>(children.count);
    parts.insert(parts.end(), children.parts.begin(), children.parts.begin() + std::ptrdiff_t(children.count));
}

/// A part and all that is to be divided below it, by one thread.
std::vector<Part> grow_subtree(const Growth& growth, std::int8_t forced, const Part& root) {
    std::vector<Part> parts{root};
    Children children;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (!growth.open(parts[i])) continue;
        growth.divide(i == 0 ? forced : Part::whole, parts[i], children);
        adopt(children, i, parts);
    }
    return parts;
}

/// Copies a part's children, then all that is below each of them, without the divisions that do not pay.
void copy_below(const std::vector<Part>& parts, const std::vector<bool>& pays, std::uint32_t from, std::size_t to,
                std::vector<Part>& out) {
    if (!pays[from]) {
        out[to].split = Part::whole;
        out[to].first_child = out[to].children = 0;
        return;
    }
    const std::uint32_t first = parts[from].first_child, count = parts[from].children;
    const std::size_t placed = out.size();
    out[to].first_child = static_cast<std::uint32_t>(placed);
    out.insert(out.end(), parts.begin() + first, parts.begin() + first + count);
    for (std::uint32_t k = 0; k < count; ++k) copy_below(parts, pays, first + k, placed + k, out);
}

/// The parts without the divisions that pay at no price from `price` on. What belongs together lies together.
std::vector<Part> without_dear(const std::vector<Part>& parts, double price, double heaviest) {
    const std::vector<bool> pays = may_pay(parts, price, heaviest);
    std::size_t kept = 1; // at most
    for (std::size_t i = 0; i < parts.size(); ++i) kept += pays[i] ? parts[i].children : 0;
    std::vector<Part> out;
    out.reserve(kept);
    out.push_back(parts.front());
    copy_below(parts, pays, 0, 0, out);
    return out;
}

/// Puts what was divided below part `root` elsewhere, `subtree` with the part itself in front, below it.
void graft(const std::vector<Part>& subtree, std::size_t root, std::vector<Part>& parts) {
    const std::size_t moved = parts.size() - 1;
    const auto place = [&](Part part) {
        if (part.split != Part::whole) part.first_child += static_cast<std::uint32_t>(moved);
        return part;
    };
    parts[root] = place(subtree.front());
    for (std::size_t i = 1; i < subtree.size(); ++i) parts.push_back(place(subtree[i]));
}

/// Divides parts and what comes of them, level by level. Parts of a level are independent of each other.
class Levels {
public:
    Levels(const Growth& growth, std::int8_t first, const Forgetting& forgetting, std::vector<Part>& parts)
        : growth_(growth), first_(first), forgetting_(forgetting), parts_(parts) {}

    /// `visit` is called for each part that is divided, from one thread at a time.
    template <class Visit>
    void run(const Visit& visit) {
        std::vector<std::uint32_t> level, next;
        for (std::uint32_t i = 0; i < parts_.size(); ++i)
            if (growth_.open(parts_[i])) level.push_back(i);
        for (; !level.empty(); level.swap(next)) {
            next.clear();
            for (std::size_t begin = 0; begin < level.size(); begin += kParts) {
                if (full()) return;
                batch_.assign(level.begin() + std::ptrdiff_t(begin),
                              level.begin() + std::ptrdiff_t(std::min(level.size(), begin + kParts)));
                if (parts_.size() > forgetting_.parts) put_small_ones_aside();
                divide_batch(next, visit);
            }
        }
        for (std::size_t begin = 0; begin < aside_.size() && !full(); begin += kSubtreesAtOnce)
            grow_subtrees(begin, std::min(aside_.size(), begin + kSubtreesAtOnce), visit);
    }

    bool forgot() const { return !aside_.empty(); }
    bool full() const { return parts_.size() > forgetting_.most; }

private:
    std::int8_t forced(std::uint32_t part) const { return part == 0 ? first_ : Part::whole; }

    void put_small_ones_aside() {
        const auto small = std::stable_partition(batch_.begin(), batch_.end(), [&](std::uint32_t i) {
            return steps(growth_.grid, parts_[i].box) > kSubtree;
        });
        aside_.insert(aside_.end(), small, batch_.end());
        batch_.erase(small, batch_.end());
    }

    template <class Visit>
    void divide_batch(std::vector<std::uint32_t>& next, const Visit& visit) {
        if (children_.size() < batch_.size()) children_.resize(batch_.size()); // most partitions are tiles: small
        parallel_for(std::size_t{0}, batch_.size(),
                     [&](std::size_t k) { growth_.divide(forced(batch_[k]), parts_[batch_[k]], children_[k]); });
        for (std::size_t k = 0; k < batch_.size(); ++k) {
            visit(parts_[batch_[k]]);
            adopt(children_[k], batch_[k], parts_);
            for (std::size_t child = parts_.size() - children_[k].count; child < parts_.size(); ++child)
                if (growth_.open(parts_[child])) next.push_back(static_cast<std::uint32_t>(child));
        }
    }

    template <class Visit>
    void grow_subtrees(std::size_t begin, std::size_t end, const Visit& visit) {
        std::vector<std::vector<Part>> kept(end - begin);
        std::mutex visiting;
        parallel_for(begin, end, [&](std::size_t k) {
            const std::vector<Part> all = grow_subtree(growth_, forced(aside_[k]), parts_[aside_[k]]);
            kept[k - begin] = without_dear(all, forgetting_.price, growth_.heaviest);
            const std::lock_guard<std::mutex> lock(visiting);
            for (const Part& part : all)
                if (part.split != Part::whole) visit(part);
        });
        for (std::size_t k = begin; k < end; ++k) graft(kept[k - begin], aside_[k], parts_);
    }

    const Growth& growth_;
    std::int8_t first_;
    const Forgetting& forgetting_;
    std::vector<Part>& parts_;
    std::vector<Children> children_;
    std::vector<std::uint32_t> batch_, aside_;
};

} // namespace

Partition::Partition(Grid grid, double total, std::int8_t first)
    : grid_(std::move(grid)), total_(total), first_(first) {
    Box everything;
    everything.end.fill(1);
    for (std::size_t axis = 0; axis < grid_.dimensions(); ++axis) everything.end[axis] = grid_.shape[axis];
    add_first_part(everything, 1);
}

Partition::Partition(Grid grid, double total, const Box& box, std::uint8_t depth)
    : grid_(std::move(grid)), total_(total), first_(Part::whole) {
    add_first_part(box, depth);
}

void Partition::add_first_part(const Box& box, std::uint8_t depth) {
    Part first;
    first.box = box;
    first.depth = depth;
    Projections projections;
    project(grid_, total_, box, projections);
    first.moments = projections[0].sum(0, projections[0].size(), total_);
    parts_.push_back(first);
}

void Partition::forget(double price, double heaviest) {
    parts_ = without_dear(parts_, price, heaviest);
    forgot_ = true;
}

bool Partition::refine(double finest, double heaviest, const Forgetting& forgetting) {
    if (parts_.size() > forgetting.parts) forget(forgetting.price, heaviest);
    bool any_new = false;
    const Growth growth{grid_, total_, finest, heaviest};
    Levels levels(growth, first_, forgetting, parts_);
    levels.run([&](const Part& part) { any_new = any_new || !forgot_ || !(part.excess() > finest_); });
    full_ = levels.full();
    forgot_ = forgot_ || levels.forgot() || full_;
    if (!full_) finest_ = std::min(finest_, finest);
    return any_new;
}

} // namespace acdf::compress
