#include "compress/brdf/halved.h"

#include "compress/halvings/row_size.h"
#include "compress/parallel.h"

#include <acdf/layout.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace acdf::compress {
namespace {

constexpr float kAlike = 0.9f;                // of a round of growth
constexpr std::uint32_t kCodeBits = 8;        // of rows
constexpr double kLeastPart = 1e-9;           // of a row, of tiles that are seen
constexpr int kRowSteps = 24;                 // of optimise_rows
constexpr int kRaises = 12;                   // of rows whose codes do not keep a bound on weights
constexpr std::uint32_t kFileAxes[] = {1, 0}; // of rows and columns: cos_theta_h, phi_h

/// The top of the tree, and codes of rows there, one for each target that has light in a node that is halved.
class GrownTop {
public:
    GrownTop(const ViewCosts& costs, std::size_t halvings)
        : growth_({{0, std::min<std::size_t>(halvings, ACDF_MOST_HALVINGS) + 1}}, {kAlike}) {
        growth_.run(costs, Loop(false), {});
        codes_.assign(growth_.leaves(), 0);
        for (const HalvedNode& node : growth_.nodes()) {
            if (node.lower == 0) continue;
            const float* squares = costs.squares(node.box);
            codes_[(node.lower + 1) / 2] = static_cast<std::size_t>(
                std::count_if(squares, squares + costs.targets(), [](float square) { return square > 0.0f; }));
        }
        std::partial_sum(codes_.begin(), codes_.end(), codes_.begin());
    }

    const HalvedGrowth& growth() const { return growth_; }
    std::size_t halvings() const { return growth_.leaves() - 1; }
    /// Of the first so many halvings.
    std::size_t codes(std::size_t halvings) const { return codes_[halvings]; }

private:
    HalvedGrowth growth_;
    std::vector<std::size_t> codes_;
};

/// Where cells of a tree lie on the grid of views.
struct Cells {
    std::vector<TileCell> of;          ///< each
    std::vector<HalvedBox> box;        ///< of each
    std::vector<std::uint32_t> square; ///< of each square, its cell
    std::size_t tiles = 0;
};

Cells cells_of(const RowTree& tree, const std::vector<HalvedNode>& nodes, const HalvedAxes& axes) {
    Cells out;
    out.tiles = tree.tiles().size();
    out.square.resize(std::size_t{axes.rows.steps()} * axes.columns.steps());
    for (std::uint32_t t = 0; t < out.tiles; ++t)
        for (const RowTree::Leaf& leaf : tree.tiles()[t].leaves) {
            const HalvedBox box = nodes[leaf.node].box;
            for (std::uint32_t r = axes.rows.low(box.rows); r < axes.rows.high(box.rows); ++r)
                std::fill_n(out.square.begin() + std::ptrdiff_t(std::size_t{r} * axes.columns.steps() +
                                                                axes.columns.low(box.columns)),
                            axes.columns.high(box.columns) - axes.columns.low(box.columns),
                            static_cast<std::uint32_t>(out.of.size()));
            out.of.push_back({t, leaf.share});
            out.box.push_back(box);
        }
    return out;
}

class HalvedFit {
public:
    HalvedFit(const BrdfViews& views, const ViewMixtures& mixtures)
        : views_(views), mixtures_(mixtures.mixtures()),
          targets_(mixtures.targets()), axes_{HalvedAxis(views.grid.row_measure),
                                              HalvedAxis(views.grid.column_measure)},
          costs_(axes_, views.measures, targets_),
          below_(axes_, views.measures, {shared_target(views.measures, targets_, costs_)}) {}

    HalvedBrdf run(const HalvedBrdfSize& size, const HorizonSquares& horizon, double max_weight) const {
        std::size_t top = 0, all = 0;
        const GrownTop grown = size.bytes ? top_within(size.bytes, top, all) : GrownTop(costs_, size.cells - 1);
        if (!size.bytes) top = all = grown.halvings();
        HalvedGrowth growth({{0, all + 1}}, {kAlike});
        growth.run_below(first_halvings(grown.growth().nodes(), top), below_, Loop(false), {});
        const std::vector<HalvedNode>& nodes = growth.nodes();
        const RowTree tree(nodes, top, weights_of(nodes), {kFileAxes[0], kFileAxes[1]});
        return coded(tree, cells_of(tree, nodes, axes_), horizon, max_weight);
    }

private:
    GrownTop top_within(std::uint64_t bytes, std::size_t& top, std::size_t& all) const {
        const double rows = double(targets_.size()), space = double(bytes);
        const GrownTop grown(costs_, static_cast<std::size_t>(halvings_for(space, rows)) + 1);
        const std::size_t about =
            std::min(grown.halvings(), static_cast<std::size_t>(halvings_for(space, rows * kCodeBits)));
        const double row_bits =
            about > 0 ? kCodeBits * double(grown.codes(about)) / double(about) : rows * kCodeBits;
        top = std::min(choose_top(grown.growth(), below_, 1.0, row_bits, space), grown.halvings());
        while (top > 0 && (row_bytes(top, grown.codes(top), kCodeBits) > bytes ||
                           !are_dense(targets_.size(), top, grown.codes(top), kCodeBits)))
            --top;
        if (row_bytes(top, grown.codes(top), kCodeBits) > bytes)
            throw std::runtime_error("no tree fits into the budget");
        all = halvings_within(bytes, grown.codes(top), kCodeBits);
        return grown;
    }

    /// Of nodes, in which a sum below a tile is what its light costs together.
    std::vector<double> weights_of(const std::vector<HalvedNode>& nodes) const {
        std::vector<double> out(nodes.size());
        for (std::size_t i = nodes.size(); i-- > 0;) {
            const std::uint32_t lower = nodes[i].lower;
            out[i] = lower ? out[lower] + out[lower + 1] : double{below_.cost(nodes[i].box)};
        }
        return out;
    }

    /// What each view costs where a tile has all samples.
    std::vector<SharedMixture> moments(const Cells& cells) const {
        std::vector<SharedMixture> out = mixtures_;
        const SharedGrid& m = views_.measures;
        parallel_for(std::size_t{0}, out.size(), [&](std::size_t v) {
            std::vector<double> energy(cells.of.size(), 0.0);
            const std::vector<float>& square = views_.targets[v].square;
            for (std::uint32_t r = 0, i = 0; r < m.rows(); ++r)
                for (std::uint32_t c = 0; c < m.columns(); ++c, ++i)
                    energy[cells.square[i]] += double{square[i]} * m.row_measure[r] * m.column_measure[c];
            out[v].moment.assign(cells.tiles, 0.0);
            for (std::size_t k = 0; k < energy.size(); ++k) // dark cells have no share
                if (energy[k] > 0.0)
                    out[v].moment[cells.of[k].tile] += energy[k] * axes_.measure(cells.box[k]) / cells.of[k].share;
        });
        return out;
    }

    /// The best row for a bin by itself; every tile of which some half-vector is seen keeps something.
    std::vector<double> first_row(std::size_t bin, const Cells& cells) const {
        std::vector<double> row(cells.tiles, 0.0);
        for (std::size_t k = 0; k < cells.of.size(); ++k)
            if (const double square{costs_.squares(cells.box[k])[bin]}; square > 0.0)
                row[cells.of[k].tile] += square * axes_.measure(cells.box[k]) / cells.of[k].share;
        for (double& part : row)
            if (part > 0.0) part = std::max(std::sqrt(part), kLeastPart);
        const double sum = std::accumulate(row.begin(), row.end(), 0.0);
        for (double& part : row) part /= sum;
        return row;
    }

    /// The codes of all rows, which become what the codes stand for.
    static void code(const RowTree& tree, RowProbabilities& rows, RowHalvings& out) {
        const HalvingCodes codes(out.code_bits);
        parallel_for(std::size_t{0}, rows.size(), [&](std::size_t b) {
            CodedRow row = tree.row(codes, rows[b], Unreached::left_out);
            for (std::size_t t = 0; t < rows[b].size(); ++t) rows[b][t] = row.steps[t] * 0x1p-31;
            out.rows[b] = std::move(row.codes);
        });
    }

    HalvedBrdf coded(const RowTree& tree, const Cells& cells, const HorizonSquares& horizon,
                     double max_weight) const {
        const std::vector<SharedMixture> mixtures = moments(cells);
        RowProbabilities rows(targets_.size());
        parallel_for(std::size_t{0}, rows.size(), [&](std::size_t b) { rows[b] = first_row(b, cells); });
        optimise_rows(rows, mixtures, kRowSteps);
        HalvedBrdf out;
        out.rows = {tree.halvings(), tree.has_codes(), kCodeBits, {}};
        out.rows.rows.resize(rows.size());
        const WeightBound bound(views_, horizon, cells.square, cells.of, cells.tiles, max_weight);
        bound.raise(rows, mixtures, rows);
        RowProbabilities wanted = rows; // a code may stand for less than half of what is wanted
        code(tree, rows, out.rows);
        for (int step = 0; step < kRaises && bound.raise(rows, mixtures, wanted); ++step) {
            rows = wanted;
            code(tree, rows, out.rows);
        }
        out.relative_variance = second_moment(rows, mixtures) - 1.0;
        return out;
    }

    const BrdfViews& views_;
    const std::vector<SharedMixture>& mixtures_; ///< one a view, without moments
    const std::vector<SharedTarget> targets_;    ///< one a bin
    const HalvedAxes axes_;
    const ViewCosts costs_;
    const ViewCosts below_; ///< of what all share
};

} // namespace

HalvedBrdf fit_halved_brdf(const BrdfViews& views, const HorizonSquares& horizon, const ViewMixtures& mixtures,
                           const HalvedBrdfSize& size, double max_weight) {
    return HalvedFit(views, mixtures).run(size, horizon, max_weight);
}

} // namespace acdf::compress
