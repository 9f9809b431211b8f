#include "compress/brdf/fit.h"

#include "compress/brdf/fit_separate.h"
#include "compress/brdf/views.h"
#include "compress/brdf/weights.h"
#include "compress/no_energy.h"
#include "compress/parallel.h"

#include <acdf/sample.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <stdexcept>

namespace acdf::compress {
namespace {

constexpr int kRowSteps = 24;            // of optimise_rows
constexpr int kRaises = 12;              // of rows whose bytes do not keep a bound on weights
constexpr std::uint32_t kFileRow = 1;    // axis of the file: cos_theta_h
constexpr std::uint32_t kFileColumn = 0; // phi_h
constexpr std::uint32_t kLeastCells = 16;
constexpr std::size_t kMostNodes = 64, kViews = 150;
constexpr double kCellsPerView = 70.0, kCellsPerTurnedView = 16.0; // isotropic, anisotropic

/// The stored views of one candidate: indices in BrdfViews.
struct Nodes {
    std::vector<std::size_t> x;   ///< increasing
    std::vector<std::size_t> phi; ///< equally spaced, the first is phi = -pi

    std::uint32_t bins() const { return static_cast<std::uint32_t>(x.size() * phi.size()); }
};

/// How much of a view comes from the node at its lower side, on one axis: nodes a and a + 1.
struct Between {
    std::size_t lower = 0, upper = 0;
    double t = 0.0; ///< of the upper one
};

Between between(const std::vector<std::size_t>& nodes, const std::vector<double>& positions, std::size_t i) {
    const auto above = std::upper_bound(nodes.begin(), nodes.end(), i);
    Between out;
    out.lower = static_cast<std::size_t>(above - nodes.begin()) - 1;
    out.upper = std::min(out.lower + 1, nodes.size() - 1);
    if (out.upper > out.lower)
        out.t = (positions[i] - positions[nodes[out.lower]]) /
                (positions[nodes[out.upper]] - positions[nodes[out.lower]]);
    return out;
}

/// The same on the circle, whose nodes divide the views evenly.
Between around(const std::vector<std::size_t>& nodes, std::size_t views, std::size_t k) {
    const std::size_t step = views / nodes.size();
    return {k / step, (k / step + 1) % nodes.size(), double(k % step) / double(step)};
}

/// Fits all that bins share, for one set of nodes.
class SharedFit {
public:
    SharedFit(const BrdfViews& views, const HorizonSquares& horizon, Nodes nodes, std::uint32_t most_cells)
        : views_(views), horizon_(horizon), nodes_(std::move(nodes)), albedos_(stored_albedos()),
          total_(std::accumulate(albedos_.begin(), albedos_.end(), 0.0)), mixtures_(mix()), targets_(serve()),
          partition_(views.measures, targets_, most_cells) {}

    BrdfFit fit(std::uint32_t cells, bool mirrored, double max_weight) const {
        const TileTree tree = partition_.pruned(cells);
        const std::vector<std::uint32_t> cell = cell_of_squares(views_.measures, tree);
        std::vector<SharedMixture> mixtures = mixtures_;
        parallel_for(std::size_t{0}, mixtures.size(),
                     [&](std::size_t m) { mixtures[m].moment = moments(views_.targets[m].square, tree, cell); });
        RowProbabilities rows(nodes_.bins());
        parallel_for(std::size_t{0}, rows.size(), [&](std::size_t b) { rows[b] = first_row(b, tree, cell); });
        optimise_rows(rows, mixtures, kRowSteps);

        BrdfFit out = empty(mirrored);
        out.rows.codebook = row_codebook();
        out.rows.row_count = nodes_.bins();
        const WeightBound bound(views_, horizon_, cell, tree.tiles.size(), max_weight);
        bound.raise(rows, mixtures, rows);
        RowProbabilities wanted = rows; // a byte may stand for less than half of what is wanted
        store_rows(tree, rows, out.rows);
        for (int step = 0; step < kRaises && bound.raise(rows, mixtures, wanted); ++step) {
            rows = wanted;
            store_rows(tree, rows, out.rows);
        }
        out.relative_variance = second_moment(rows, mixtures) - 1.0;
        out.rows.splits = in_file(tree);
        return out;
    }

private:
    std::size_t view_of(std::size_t bin) const {
        return nodes_.x[bin / nodes_.phi.size()] * views_.phi.size() + nodes_.phi[bin % nodes_.phi.size()];
    }

    /// Of the stored views. Where all of these are black they count alike, for the views between them.
    std::vector<double> stored_albedos() const {
        std::vector<double> out;
        for (std::size_t b = 0; b < nodes_.bins(); ++b) out.push_back(views_.targets[view_of(b)].albedo);
        if (std::any_of(out.begin(), out.end(), [](double a) { return a > 0.0; })) return out;
        double sum = 0.0;
        for (const ViewTarget& target : views_.targets) sum += target.albedo;
        std::fill(out.begin(), out.end(), sum / double(views_.targets.size()));
        return out;
    }

    /// The bytes of all rows, which become what the bytes stand for.
    static void store_rows(const TileTree& tree, RowProbabilities& rows, StoredRows& out) {
        out.codes.clear();
        for (std::vector<double>& row : rows) {
            const std::vector<std::uint8_t> codes = encode_row(tree, row);
            out.codes.insert(out.codes.end(), codes.begin(), codes.end());
            row = decode_row(tree, out.codebook, codes.data());
        }
    }

    std::vector<SharedMixture> mix() const {
        std::vector<SharedMixture> out(views_.targets.size());
        for (std::size_t v = 0; v < out.size(); ++v) {
            const std::size_t ix = v / views_.phi.size(), k = v % views_.phi.size();
            const Between x = between(nodes_.x, views_.x, ix), phi = around(nodes_.phi, views_.phi.size(), k);
            out[v].weight = views_.targets[v].albedo > 0.0 ? views_.weight(ix) : 0.0;
            const auto add = [&](std::size_t i, std::size_t j, double share) {
                const std::size_t bin = i * nodes_.phi.size() + j;
                if (!(share > 0.0)) return;
                out[v].bin[out[v].count] = static_cast<std::uint32_t>(bin);
                out[v].share[out[v].count++] = share * std::max(albedos_[bin], kLeastShare * total_);
            };
            add(x.lower, phi.lower, (1.0 - x.t) * (1.0 - phi.t));
            add(x.lower, phi.upper, (1.0 - x.t) * phi.t);
            add(x.upper, phi.lower, x.t * (1.0 - phi.t));
            add(x.upper, phi.upper, x.t * phi.t);
            const double sum = std::accumulate(out[v].share, out[v].share + out[v].count, 0.0);
            for (int i = 0; i < out[v].count; ++i) out[v].share[i] /= sum;
        }
        return out;
    }

    /// What a node is to serve: the mean over the views that it is mixed into.
    std::vector<SharedTarget> serve() const {
        std::vector<SharedTarget> out(nodes_.bins());
        std::vector<std::vector<std::pair<std::size_t, double>>> served(out.size());
        double all = 0.0;
        for (std::size_t v = 0; v < mixtures_.size(); ++v)
            for (int i = 0; i < mixtures_[v].count; ++i)
                if (const double share = mixtures_[v].share[i]; mixtures_[v].weight > 0.0 && share > 0.0) {
                    served[mixtures_[v].bin[i]].push_back({v, share * share});
                    all += mixtures_[v].weight * share;
                }
        parallel_for(std::size_t{0}, out.size(), [&](std::size_t b) {
            std::vector<float>& square = out[b].square;
            square.assign(views_.grid.size(), 0.0f);
            double sum = 0.0, weight = 0.0;
            for (const auto& [v, w] : served[b]) sum += w, weight += mixtures_[v].weight * std::sqrt(w);
            for (const auto& [v, w] : served[b]) {
                const float factor = static_cast<float>(w / sum);
                const float* from = views_.targets[v].square.data();
                for (std::size_t i = 0; i < square.size(); ++i) square[i] += factor * from[i];
            }
            out[b].weight = weight / all;
        });
        return out;
    }

    std::vector<double> moments(const std::vector<float>& square, const TileTree& tree,
                                const std::vector<std::uint32_t>& cell) const {
        const SharedGrid& m = views_.measures;
        std::vector<double> energy(tree.tiles.size(), 0.0), measure(tree.tiles.size(), 0.0);
        for (std::uint32_t r = 0, i = 0; r < m.rows(); ++r)
            for (std::uint32_t c = 0; c < m.columns(); ++c, ++i) {
                const double area = m.row_measure[r] * m.column_measure[c];
                measure[cell[i]] += area;
                energy[cell[i]] += square[i] * area;
            }
        for (std::size_t c = 0; c < energy.size(); ++c) energy[c] *= measure[c];
        return energy;
    }

    /// The best row for a node by itself; every cell of which some half-vector is seen keeps something.
    std::vector<double> first_row(std::size_t bin, const TileTree& tree,
                                  const std::vector<std::uint32_t>& cell) const {
        std::vector<double> row = moments(targets_[bin].square, tree, cell);
        for (double& p : row) p = std::sqrt(p);
        const auto [low, high] = views_around(bin);
        const std::vector<std::uint8_t> visible = visible_squares(views_.grid, low, high);
        std::vector<bool> seen(row.size(), false);
        for (std::size_t i = 0; i < visible.size(); ++i)
            if (visible[i]) seen[cell[i]] = true;
        for (std::size_t c = 0; c < row.size(); ++c) row[c] = seen[c] ? std::max(row[c], 1e-9) : 0.0;
        const double sum = std::accumulate(row.begin(), row.end(), 0.0);
        for (double& p : row) p /= sum;
        return row;
    }

    /// Bounds of all views that a node is mixed into.
    std::pair<View, View> views_around(std::size_t bin) const {
        const std::size_t i = bin / nodes_.phi.size(), k = bin % nodes_.phi.size();
        View low, high;
        low.x = i > 0 ? views_.x[nodes_.x[i - 1]] : 0.0;
        high.x = i + 1 < nodes_.x.size() ? views_.x[nodes_.x[i + 1]] : 1.0;
        if (nodes_.phi.size() > 1) {
            const double step = 2.0 * ACDF_PI / double(nodes_.phi.size()), phi = views_.phi[nodes_.phi[k]];
            low.phi = phi - step;
            high.phi = phi + step;
        }
        return {low, high};
    }

    BrdfFit empty(bool mirrored) const {
        BrdfFit out;
        out.mirrored = mirrored;
        out.phi_views = static_cast<std::uint32_t>(nodes_.phi.size());
        for (const std::size_t i : nodes_.x) out.nodes.push_back(static_cast<float>(views_.x[i]));
        out.total = total_;
        for (const double a : albedos_) out.shares.push_back(static_cast<float>(std::max(a / total_, kLeastShare)));
        Cascade nothing;
        nothing.curves.resize(1);
        nothing.curves[0].probability = {1.0};
        nothing.roots = {0};
        out.tree = encode_tree(nothing);
        out.tree.roots.resize(nodes_.bins());
        std::iota(out.tree.roots.begin(), out.tree.roots.end(), 0u); // each bin its own row
        return out;
    }

    /// From steps and axes of the grid to those of the file.
    std::vector<AcdfSplit> in_file(const TileTree& tree) const {
        return stored_splits(tree, [&](const TileTree::Split& split) {
            const bool row = split.axis == 0;
            const std::uint32_t position = (row ? views_.grid.row_knots : views_.grid.column_knots)[split.position];
            return (row ? kFileRow : kFileColumn) | position << 3;
        });
    }

    const BrdfViews& views_;
    const HorizonSquares& horizon_;
    Nodes nodes_;
    std::vector<double> albedos_;         ///< one a bin
    double total_;                        ///< of those
    std::vector<SharedMixture> mixtures_; ///< one a view, without moments
    std::vector<SharedTarget> targets_;   ///< one a bin
    SharedPartition partition_;
};

/// A file without rows, to ask for its size.
BrdfFit hollow(std::uint32_t thetas, std::uint32_t azimuths, std::uint32_t cells) {
    BrdfFit out;
    out.nodes.assign(thetas, 0.0f);
    out.phi_views = azimuths;
    out.rows.splits.resize(cells - 1);
    out.rows.codebook.resize(256);
    out.rows.codes.resize(std::size_t{out.bins()} * (cells - 1));
    out.shares.resize(out.bins());
    out.tree.bytes = {0, 1 << (ACDF_CURVE_SEGMENTS_SHIFT - 8)}; // a curve of one segment, which `store` may decode
    out.tree.roots.resize(out.bins());
    return out;
}

/// The most cells with which a file of so many views fits the budget; 0: none.
std::uint32_t cells_within(std::uint64_t budget, std::uint32_t thetas, std::uint32_t azimuths,
                           const BrdfOptions& options) {
    const auto size = [&](std::uint32_t cells) { return options.file_size(hollow(thetas, azimuths, cells)); };
    std::uint32_t low = 1, high = ACDF_MAX_TILES;
    if (size(low) > budget) return 0;
    if (size(high) <= budget) return high;
    while (high - low > 1) {
        const std::uint32_t middle = low + (high - low) / 2;
        (size(middle) <= budget ? low : high) = middle;
    }
    return low;
}

/// Stored views, and cells that they share.
struct Plan {
    std::uint32_t thetas = 0, azimuths = 1, cells = 0;
};

/// Another view is worth about as much as cells for its bytes where there are so many cells for each view.
Plan plan(const BrdfOptions& options, std::uint64_t budget) {
    const bool isotropic = options.symmetry.isotropic;
    const double bins = std::sqrt(double(budget) / (isotropic ? kCellsPerView : kCellsPerTurnedView));
    Plan out;
    out.azimuths = options.phi_views ? options.phi_views : isotropic ? 1 : bins < 90.0 ? 8 : 16;
    out.thetas = options.theta_views;
    if (out.thetas == 0)
        out.thetas =
            std::clamp(static_cast<std::uint32_t>(std::lround(bins / out.azimuths)), isotropic ? 6u : 4u, 64u);
    out.cells = cells_within(budget, out.thetas, out.azimuths, options);
    return out;
}

class BrdfSearch {
public:
    BrdfSearch(const Reflected& reflected, const BrdfOptions& options)
        : reflected_(reflected), options_(options),
          grid_(options.symmetry.mirrored    ? 256
                : options.symmetry.isotropic ? 384
                                             : 256,
                options.symmetry.isotropic ? 540 : 270, options.symmetry.mirrored),
          order_(choose_nodes(reflected, options.symmetry, kMostNodes)) {}

    BrdfFit within(std::uint64_t budget) const {
        const Plan p = plan(options_, budget);
        if (p.cells >= kLeastCells) return one(p);
        const std::uint64_t least = options_.file_size(hollow(p.thetas, p.azimuths, kLeastCells));
        throw std::runtime_error("no file of " + std::to_string(budget) + " bytes can hold it; the smallest has " +
                                 std::to_string(least) + " bytes");
    }

    /// Looks at the stored views and some between them, and fits.
    BrdfFit one(const Plan& p) const {
        std::vector<double> x(order_.begin(),
                              order_.begin() + std::min<std::ptrdiff_t>(p.thetas, std::ptrdiff_t(order_.size())));
        std::sort(x.begin(), x.end());
        const bool isotropic = options_.symmetry.isotropic;
        const std::size_t parts = isotropic ? std::clamp<std::size_t>(kViews / x.size(), 3, 8) : 2,
                          turns = isotropic ? 1 : p.azimuths * std::max(2u, 24 / p.azimuths);
        BrdfViews views = look_at(reflected_, grid_, subdivided(x, parts), azimuths(turns));
        const HorizonSquares horizon = look_at_horizon(reflected_, views);
        if (std::none_of(views.targets.begin(), views.targets.end(),
                         [](const ViewTarget& t) { return t.albedo > 0.0; }))
            throw NoEnergy("it reflects nothing to any view looked at, so there is nothing to sample");
        if (options_.progress) options_.progress(0.6);
        Nodes nodes;
        for (std::size_t i = 0; i < x.size(); ++i) nodes.x.push_back(i * parts);
        for (std::size_t k = 0; k < p.azimuths; ++k) nodes.phi.push_back(k * turns / p.azimuths);
        const SharedFit shared(views, horizon, nodes, p.cells + p.cells / 2);
        return shared.fit(p.cells, options_.symmetry.mirrored, options_.max_weight);
    }

    /// The smallest file for a variance, to about a tenth.
    BrdfFit reaching(double variance) const {
        std::uint64_t high = 8192, low = 0;
        BrdfFit fit = within(high);
        for (; fit.relative_variance > variance; fit = within(high)) {
            if (high >= (std::uint64_t{4} << 20)) {
                char text[96];
                std::snprintf(text, sizeof text, "a relative variance of %.3g is out of reach; 4 MiB have %.3g",
                              variance, fit.relative_variance);
                throw std::runtime_error(text);
            }
            low = high;
            high *= 2;
        }
        for (int step = 0; step < 3 && low > 0; ++step) {
            const std::uint64_t middle = (low + high) / 2;
            BrdfFit tried = within(middle);
            if (tried.relative_variance > variance) low = middle;
            else high = middle, fit = std::move(tried);
        }
        return fit;
    }

private:
    const Reflected& reflected_;
    const BrdfOptions& options_;
    HalfGrid grid_;
    std::vector<double> order_; ///< of x: see choose_nodes
};

} // namespace

BrdfFit fit_brdf(const Reflected& reflected, const BrdfOptions& given) {
    BrdfOptions options = given;
    if (options.phi_views > 1) options.symmetry = {false, false};
    if (options.symmetry.isotropic) options.phi_views = 1;
    else options.symmetry.mirrored = false;
    if (options.fit != ACDF_FIT_VARIANCE || !options.sharing) return fit_separate(reflected, options);
    const BrdfSearch search(reflected, options);
    switch (options.goal.kind) {
    case Goal::Kind::variance:
        return search.reaching(options.goal.variance);
    case Goal::Kind::budget:
        return search.within(options.goal.budget);
    default: {
        const bool isotropic = options.symmetry.isotropic;
        return search.one({options.theta_views ? options.theta_views
                           : isotropic         ? 32u
                                               : 12u,
                           options.phi_views ? options.phi_views
                           : isotropic       ? 1u
                                             : 16u,
                           std::min(options.goal.cells, ACDF_MAX_TILES)});
    }
    }
}

} // namespace acdf::compress
