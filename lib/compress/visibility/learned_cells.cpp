#include "compress/visibility/learned_cells.h"

#include "compress/parallel.h"
#include "compress/visibility/chunk.h"
#include "compress/visibility/ray_sites.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <queue>

namespace acdf::compress {
namespace {

constexpr std::uint32_t kBordersOfAxis = 16;             ///< positions on an axis where a cell may be divided
constexpr float kLeastRays = 24.0f;                      ///< of a cell
constexpr float kGuess = 0.5f;                           ///< what is seen where nothing is known
constexpr float kGuessRays = 3.0f;                       ///< rays that a guess counts as, for each part
constexpr float kFewestPrior = 1.0f, kMostPrior = 32.0f; ///< the same of what a cell knows for those in it
constexpr float kDarkestCell = 0.1f;                     ///< of the mean: what is added to the light of each cell
constexpr std::uint32_t kManySites = 1024;               ///< of a cell whose halves are worth threads of their own

/// A cell, or what is divided into two.
struct LearnedCell {
    std::array<float, RaySites::axes> low{}, high{};
    std::uint32_t begin = 0, end = 0; ///< its sites
    std::uint32_t axis = 0, depth = 0, number = 0;
    float position = 0.0f;
    double gain = 0.0;    ///< of dividing it
    bool divided = false; ///< it is
    std::unique_ptr<LearnedCell> child[2];
};

/// What is seen of each part, by a cell's own rays and, as `rays` of them, by what is seen around it.
void learn_shares(const RaySums& sums, float rays, std::vector<float>& shares) {
    for (std::size_t p = 0; p < shares.size(); ++p)
        shares[p] = (sums.seen[p] + rays * shares[p]) / (sums.all[p] + rays);
}

/// How many rays what is known of a cell counts as for its two parts: the more the less these differ, beside what
/// they would by chance. By the method of moments for beta-binomial counts, of all parts of the sphere together.
float prior_rays(const RaySums& a, const RaySums& b) {
    double spread = 0.0, chance = 0.0;
    for (std::size_t p = 0; p < a.all.size(); ++p) {
        const float all = a.all[p] + b.all[p], seen = a.seen[p] + b.seen[p];
        if (!(a.all[p] > 0.0f && b.all[p] > 0.0f && seen > 0.0f && seen < all)) continue;
        const float share = seen / all, own = share * (1.0f - share) * all / (all - 1.0f);
        const float difference = a.seen[p] / a.all[p] - b.seen[p] / b.all[p];
        const float both = a.all[p] * b.all[p] / all, weight = (a.light[p] + b.light[p]) * both;
        chance += double{weight * own};
        spread += 0.5 * double{weight * (difference * difference - own / both)};
    }
    if (!(chance > 0.0 && spread > 0.0)) return kMostPrior;
    return std::clamp(static_cast<float>(chance / spread) - 1.0f, kFewestPrior, kMostPrior);
}

class LearnedTree {
public:
    LearnedTree(const RaySites& sites, const BesideCosine* beside) : sites_(sites), beside_(beside) {
        order_.resize(sites.count());
        for (std::uint32_t i = 0; i < order_.size(); ++i) order_[i] = i;
    }

    /// Divides as long as that gains anything.
    void grow(LearnedCell& root) {
        root.begin = 0;
        root.end = static_cast<std::uint32_t>(order_.size());
        const RaySums sums = sums_of(root);
        const std::vector<float> shares = guess(sums);
        float light = 0.0f;
        for (std::size_t p = 0; p < shares.size(); ++p) light += sums.light[p] * shares[p];
        dark_ = sums.rays > 0.0f ? kDarkestCell * light / sums.rays : 1.0f;
        grow(root, sums, shares);
    }
    /// visit(cell, sums, factors) of all cells, by several threads.
    template <class Visit>
    void for_each_cell(const LearnedCell& root, const Visit& visit) const {
        const RaySums sums = sums_of(root);
        for_each_cell(root, sums, guess(sums), visit);
    }

private:
    RaySums sums_of(const LearnedCell& cell) const {
        RaySums out(sites_.parts());
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) sites_.add(order_[i], out);
        return out;
    }
    std::vector<float> guess(const RaySums& sums) const {
        std::vector<float> out(sites_.parts(), kGuess);
        learn_shares(sums, kGuessRays, out);
        return out;
    }
    /// below(k) of both halves of a cell.
    template <class Below>
    static void both(const LearnedCell& cell, const Below& below) {
        if (cell.end - cell.begin > kManySites) parallel_for(0u, 2u, below);
        else below(0u), below(1u);
    }
    template <class Visit>
    void for_each_cell(const LearnedCell& cell, const RaySums& sums, const std::vector<float>& shares,
                       const Visit& visit) const {
        if (!cell.divided) return visit(cell, sums, factors(cell, sums, shares));
        const RaySums side[2] = {sums_of(*cell.child[0]), sums_of(*cell.child[1])};
        const float rays = prior_rays(side[0], side[1]);
        both(cell, [&](std::uint32_t k) {
            std::vector<float> own = shares;
            learn_shares(side[k], rays, own);
            for_each_cell(*cell.child[k], side[k], own, visit);
        });
    }

    /// What rows multiply light with.
    std::vector<float> factors(const LearnedCell& cell, const RaySums& sums,
                               const std::vector<float>& shares) const {
        std::vector<float> out(shares.size(), 1.0f);
        if (!(sums.rays > 0.0f)) return out;
        if (beside_) {
            std::vector<float> masses(shares.size() * BesideCosine::groups, 0.0f);
            for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
                const std::vector<float>& own = sites_.masses(order_[i]);
                const float part = sites_.rays(order_[i]) / sums.rays;
                for (std::size_t g = 0; g < masses.size(); ++g) masses[g] += part * own[g];
            }
            beside_->factors(sums.light.data(), shares.data(), masses.data(), out.data());
            return out;
        }
        const float more = unoccluded(sums, shares, out);
        for (float& factor : out) factor += more;
        return out;
    }
    /// Roots of shares, and what is added to them so that kUnoccluded of the samples go where light comes from.
    static float unoccluded(const RaySums& sums, const std::vector<float>& shares, std::vector<float>& roots) {
        float all = 1e-30f, sampled = 1e-30f; // where nothing is known
        for (std::size_t p = 0; p < roots.size(); ++p) roots[p] = std::sqrt(shares[p]);
        for (std::size_t p = 0; p < roots.size(); ++p) {
            all += sums.light[p];
            sampled += sums.light[p] * roots[p];
        }
        return kUnoccluded / (1.0f - kUnoccluded) * sampled / all;
    }

    /// The noise of samples by rows of its own, times how many rays were asked for there.
    double cost(const RaySums& sums, const std::vector<float>& around, std::vector<float> work[2]) const {
        if (!(sums.rays > 0.0f)) return 0.0;
        std::vector<float>&shares = work[0], &roots = work[1];
        shares = around;
        roots.resize(shares.size());
        learn_shares(sums, kGuessRays, shares);
        const float more = unoccluded(sums, shares, roots);
        float arrives = 0.0f, moment = 0.0f, weight = 1e-30f;
        for (std::size_t p = 0; p < roots.size(); ++p) {
            arrives += sums.light[p] * shares[p];
            weight += sums.light[p] * (roots[p] + more);
        }
        if (beside_) { // the balance heuristic divides by both pdfs
            const float unit = sums.rays / weight;
            for (std::size_t p = 0; p < roots.size(); ++p) {
                const float pdf = unit * sums.light[p] * (roots[p] + more) + sums.cosine[p] + 1e-30f;
                moment += shares[p] * sums.light[p] * sums.light[p] / pdf;
            }
            weight = sums.rays;
        } else {
            for (std::size_t p = 0; p < roots.size(); ++p) moment += shares[p] * sums.light[p] / (roots[p] + more);
        }
        return double{sums.rays} * std::sqrt(double{moment} * double{weight}) /
               (double{arrives} + double{dark_} * double{sums.rays});
    }

    void grow(LearnedCell& cell, const RaySums& sums, const std::vector<float>& shares) {
        if (cell.depth + 1 >= ACDF_MAX_VISIBILITY_DEPTH || sums.rays < 2.0f * kLeastRays) return;
        RaySums side[2] = {RaySums(sites_.parts()), RaySums(sites_.parts())};
        for (std::size_t axis = 0; axis < RaySites::axes; ++axis) consider(cell, axis, sums, shares, side);
        if (!(cell.gain > 0.0)) return;
        const auto middle =
            std::stable_partition(order_.begin() + cell.begin, order_.begin() + cell.end, [&](std::uint32_t site) {
                return sites_.coordinate(site, cell.axis) < cell.position;
            });
        const auto border = static_cast<std::uint32_t>(middle - order_.begin());
        for (std::size_t k = 0; k < 2; ++k) {
            cell.child[k] = std::make_unique<LearnedCell>();
            LearnedCell& child = *cell.child[k];
            child.low = cell.low;
            child.high = cell.high;
            (k == 0 ? child.high : child.low)[cell.axis] = cell.position;
            child.begin = k == 0 ? cell.begin : border;
            child.end = k == 0 ? border : cell.end;
            child.depth = cell.depth + 1;
        }
        const float rays = prior_rays(side[0], side[1]);
        both(cell, [&](std::uint32_t k) {
            std::vector<float> own = shares;
            learn_shares(side[k], rays, own);
            grow(*cell.child[k], side[k], own);
        });
    }

    /// Where it is best divided on an axis, if that is better than what was found before; `side`: of both parts.
    void consider(LearnedCell& cell, std::size_t axis, const RaySums& sums, const std::vector<float>& shares,
                  RaySums side[2]) const {
        float low = sites_.coordinate(order_[cell.begin], axis), high = low;
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            low = std::min(low, sites_.coordinate(order_[i], axis));
            high = std::max(high, sites_.coordinate(order_[i], axis));
        }
        if (!(high > low)) return;
        float width = (high - low) / float(kBordersOfAxis);
        if (const float grid = sites_.width(axis); grid > 0.0f) { // borders are those of the grid
            width = std::max(std::round((high - low + grid) / float(kBordersOfAxis) / grid), 1.0f) * grid;
            low -= 0.5f * grid;
        }
        std::vector<RaySums> steps(kBordersOfAxis, RaySums(sites_.parts()));
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            const float at = (sites_.coordinate(order_[i], axis) - low) / width;
            sites_.add(order_[i], steps[static_cast<std::size_t>(std::clamp(at, 0.0f, float(kBordersOfAxis - 1)))]);
        }
        std::vector<float> work[2];
        const double whole = cost(sums, shares, work);
        RaySums lower(sites_.parts()), upper(sites_.parts());
        for (std::uint32_t k = 0; k + 1 < kBordersOfAxis; ++k) {
            if (!(steps[k].rays > 0.0f)) continue;
            lower.add(steps[k]);
            if (lower.rays < kLeastRays || sums.rays - lower.rays < kLeastRays) continue;
            upper.become_rest(sums, lower);
            const double gain = whole - cost(lower, shares, work) - cost(upper, shares, work);
            if (gain <= cell.gain) continue;
            cell.gain = gain;
            cell.axis = static_cast<std::uint32_t>(axis);
            cell.position = low + width * float(k + 1);
            side[0] = lower;
            side[1] = upper;
        }
    }

    const RaySites& sites_;
    const BesideCosine* beside_;
    std::vector<std::uint32_t> order_; ///< sites, those of a cell together
    float dark_ = 0.0f;
};

/// Divides those cells first of which it gains most; returns how many there are, at most `most`.
std::uint32_t divide_best(LearnedCell& root, std::uint32_t most) {
    using Entry = std::pair<double, std::uint32_t>; // gain, and number from the back: for equal gains the older one
    std::priority_queue<Entry> queue;
    std::vector<LearnedCell*> cells;
    const auto push = [&](LearnedCell* cell) {
        if (!cell->child[0]) return;
        queue.push({cell->gain, ~static_cast<std::uint32_t>(cells.size())});
        cells.push_back(cell);
    };
    push(&root);
    std::uint32_t count = 1;
    for (; count < most && !queue.empty(); ++count) {
        LearnedCell* cell = cells[~queue.top().second];
        queue.pop();
        cell->divided = true;
        for (const auto& child : cell->child) push(child.get());
    }
    return count;
}

/// Splits in preorder, and the numbers of cells. Returns what the cell is as a child.
std::uint32_t list_splits(LearnedCell& cell, std::uint32_t& cells, std::vector<AcdfVisibilitySplit>& out) {
    if (!cell.divided) return ACDF_VISIBILITY_ROW | (cell.number = cells++);
    const auto own = static_cast<std::uint32_t>(out.size());
    out.push_back({cell.position, 0, 0});
    const std::uint32_t lower = list_splits(*cell.child[0], cells, out);
    const std::uint32_t upper = list_splits(*cell.child[1], cells, out);
    out[own].lower = cell.axis | lower << 3;
    out[own].upper = upper;
    return own;
}

/// Cells that fill a chunk.
std::uint32_t cells_for(std::uint64_t bytes, std::size_t width, const VisibilityParts& parts) {
    const std::uint64_t beside = sizeof(AcdfVisibility) + parts.column_count() * sizeof(AcdfColumn);
    const std::uint64_t cells = bytes > beside ? (bytes - beside) / (width + sizeof(AcdfVisibilitySplit)) : 0;
    return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(cells, 1, ACDF_VISIBILITY_ROW - 1));
}

} // namespace

Chunk learned_visibility(const VisibilityParts& parts, const VisibilityCounts::Sorted& counts,
                         const LearnedSize& size) {
    std::optional<BesideCosine> cosine;
    if (size.beside_cosine) cosine.emplace(parts);
    const BesideCosine* beside = cosine ? &*cosine : nullptr;
    const RaySites sites(parts, counts, beside);
    LearnedTree tree(sites, beside);
    LearnedCell root;
    for (std::size_t k = 0; k < 3; ++k) {
        root.low[k] = counts.low(k);
        root.high[k] = counts.high(k);
        root.low[3 + k] = -1.0f;
        root.high[3 + k] = 1.0f;
    }
    tree.grow(root);

    const std::size_t width = 1 + parts.column_count();
    VisibilityChunk out;
    out.header.row_count = divide_best(root, cells_for(size.bytes, width, parts));
    out.header.column_count = parts.column_count();
    for (std::size_t k = 0; k < 3; ++k) {
        out.header.low[k] = counts.low(k);
        out.header.high[k] = counts.high(k);
        out.header.transform[k][k] = 1.0f;
    }
    std::uint32_t cells = 0;
    list_splits(root, cells, out.splits);
    out.header.split_count = static_cast<std::uint32_t>(out.splits.size());
    out.columns = parts.columns();
    out.rows.resize(out.header.row_count * width);
    tree.for_each_cell(root, [&](const LearnedCell& cell, const RaySums& sums, const std::vector<float>& factors) {
        encode_visibility(parts, sums.light.data(), factors.data(), &out.rows[cell.number * width]);
    });
    return out.stored();
}

} // namespace acdf::compress
