#include "compress/fit/shared.h"
#include "compress/parallel.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>

namespace acdf::compress {
namespace {

constexpr std::size_t kBoxes = 32;        // boxes divided at once: the same for any number of threads
constexpr double kLeastSharedGain = 1e-9; // of the sum of costs, which is about 1: less is rounding
// A share of all cells that may be needed together. The known part of a cell at the border of what a row sees may
// be less than what is there: a floor bounds the weights, at the price of this share of the samples at most.
constexpr double kLeastShares = 2e-4;
constexpr std::uint32_t kBisections = 60;

/// For each line across a box, and each target, the integral of its square: lines x targets.
struct Projection {
    std::vector<double> energy, measure;
};

double cost_of(double measure, const double* energy, const std::vector<SharedTarget>& targets) {
    double cost = 0.0;
    for (std::size_t b = 0; b < targets.size(); ++b) cost += targets[b].weight * std::sqrt(measure * energy[b]);
    return cost;
}

void project(const SharedGrid& grid, const std::vector<SharedTarget>& targets, const Box& box, Projection out[2]) {
    const std::size_t rows = box.length(0), columns = box.length(1), bins = targets.size();
    double height = 0.0, width = 0.0;
    for (std::size_t r = 0; r < rows; ++r) height += grid.row_measure[box.begin[0] + r];
    for (std::size_t c = 0; c < columns; ++c) width += grid.column_measure[box.begin[1] + c];
    out[0].measure.resize(rows);
    out[1].measure.resize(columns);
    for (std::size_t r = 0; r < rows; ++r) out[0].measure[r] = grid.row_measure[box.begin[0] + r] * width;
    for (std::size_t c = 0; c < columns; ++c) out[1].measure[c] = grid.column_measure[box.begin[1] + c] * height;
    out[0].energy.assign(rows * bins, 0.0);
    out[1].energy.assign(columns * bins, 0.0);
    std::vector<double> across(columns);
    for (std::size_t b = 0; b < bins; ++b) {
        std::fill(across.begin(), across.end(), 0.0);
        for (std::size_t r = 0; r < rows; ++r) {
            const double row = grid.row_measure[box.begin[0] + r];
            const float* square = targets[b].square.data() + (box.begin[0] + r) * grid.columns() + box.begin[1];
            double sum = 0.0;
            for (std::size_t c = 0; c < columns; ++c) {
                const double energy = square[c] * row * grid.column_measure[box.begin[1] + c];
                sum += energy;
                across[c] += energy;
            }
            out[0].energy[r * bins + b] = sum;
        }
        for (std::size_t c = 0; c < columns; ++c) out[1].energy[c * bins + b] = across[c];
    }
}

/// Cost of the first lines, for each number of them; backwards: of the last ones. Sums of what is added, so that
/// nothing cancels.
std::vector<double> running_cost(const Projection& lines, const std::vector<SharedTarget>& targets,
                                 bool backwards) {
    const std::size_t count = lines.measure.size(), bins = targets.size();
    std::vector<double> out(count + 1, 0.0), energy(bins, 0.0);
    double measure = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t line = backwards ? count - 1 - i : i;
        measure += lines.measure[line];
        for (std::size_t b = 0; b < bins; ++b) energy[b] += lines.energy[line * bins + b];
        out[i + 1] = cost_of(measure, energy.data(), targets);
    }
    return out;
}

double part_sum(std::uint32_t child, const std::vector<double>& cells, const std::vector<double>& splits) {
    return child & TileTree::tile ? cells[child & ~TileTree::tile] : splits[child];
}

} // namespace

void SharedPartition::consider(const SharedGrid& grid, const std::vector<SharedTarget>& targets, Node& node) const {
    Projection lines[2];
    project(grid, targets, node.box, lines);
    node.gain = 0.0;
    for (std::uint32_t axis = 0; axis < 2; ++axis) {
        const std::vector<double> lower = running_cost(lines[axis], targets, false),
                                  upper = running_cost(lines[axis], targets, true);
        const std::size_t count = lower.size() - 1;
        if (axis == 0) node.cost = lower[count];
        for (std::size_t i = 1; i < count; ++i) {
            const double gain = node.cost - lower[i] - upper[count - i];
            if (gain <= node.gain) continue;
            node.gain = gain;
            node.axis = axis;
            node.position = node.box.begin[axis] + static_cast<std::uint32_t>(i);
        }
    }
    if (node.depth > TileTree::most_depth) node.gain = 0.0;
}

SharedPartition::SharedPartition(const SharedGrid& grid, const std::vector<SharedTarget>& targets,
                                 std::uint32_t cells) {
    Node root;
    root.box.end.fill(1);
    root.box.end[0] = grid.rows();
    root.box.end[1] = grid.columns();
    consider(grid, targets, root);
    nodes_.push_back(root);
    using Entry = std::pair<double, std::uint32_t>; // gain, and number from the back: for equal gains the older one
    std::priority_queue<Entry> queue;
    const auto push = [&](std::uint32_t index) {
        if (nodes_[index].gain > kLeastSharedGain) queue.push({nodes_[index].gain, ~index});
    };
    push(0);
    for (std::uint32_t leaves = 1; leaves < cells && !queue.empty();) {
        std::vector<std::uint32_t> children;
        while (!queue.empty() && leaves < cells && children.size() < 2 * kBoxes) {
            const std::uint32_t index = ~queue.top().second;
            queue.pop();
            Node lower = nodes_[index], upper = lower;
            lower.box.end[lower.axis] = upper.box.begin[lower.axis] = lower.position;
            lower.depth = ++upper.depth;
            nodes_[index].first_child = static_cast<std::uint32_t>(nodes_.size());
            for (const Node& child : {lower, upper}) {
                children.push_back(static_cast<std::uint32_t>(nodes_.size()));
                nodes_.push_back(child);
            }
            ++leaves;
            // Early on the order matters: the best box is among few.
            if (children.size() >= std::max<std::size_t>(2, leaves / 8)) break;
        }
        parallel_for(std::size_t{0}, children.size(),
                     [&](std::size_t i) { consider(grid, targets, nodes_[children[i]]); });
        for (const std::uint32_t child : children) push(child);
    }
}

/// Marks the divisions that lower the cost by more than `price` a cell; returns the number of cells.
std::uint32_t SharedPartition::keep(double price, std::vector<bool>& divided) const {
    std::vector<double> cost(nodes_.size());
    std::vector<std::uint32_t> cells(nodes_.size(), 1);
    divided.assign(nodes_.size(), false);
    for (std::size_t i = nodes_.size(); i-- > 0;) {
        const Node& node = nodes_[i];
        cost[i] = node.cost;
        if (node.first_child == 0) continue;
        const std::size_t lower = node.first_child, upper = lower + 1;
        const std::uint32_t count = cells[lower] + cells[upper];
        if (cost[lower] + cost[upper] + price * (count - 1) >= node.cost) continue;
        cost[i] = cost[lower] + cost[upper];
        cells[i] = count;
        divided[i] = true;
    }
    return cells[0];
}

std::uint32_t SharedPartition::emit(const std::vector<bool>& divided, std::uint32_t node, TileTree& tree) const {
    const Node& n = nodes_[node];
    if (!divided[node]) {
        tree.tiles.push_back(n.box);
        return TileTree::tile | static_cast<std::uint32_t>(tree.tiles.size() - 1);
    }
    const std::size_t index = tree.splits.size();
    tree.splits.push_back({n.axis, n.position, {}});
    for (std::uint32_t k = 0; k < 2; ++k) {
        const std::uint32_t child = emit(divided, n.first_child + k, tree);
        tree.splits[index].child[k] = child;
    }
    return static_cast<std::uint32_t>(index);
}

TileTree SharedPartition::pruned(std::uint32_t cells) const {
    std::vector<bool> divided;
    double low = 0.0, high = nodes_[0].cost + 1.0;
    if (keep(low, divided) > cells) {
        for (std::uint32_t i = 0; i < kBisections; ++i) {
            const double middle = low > 0.0 ? std::sqrt(low * high) : high * 1e-12;
            (keep(middle, divided) > cells ? low : high) = middle;
        }
        keep(high, divided);
    }
    TileTree tree;
    emit(divided, 0, tree);
    return tree;
}

std::vector<std::uint32_t> cell_of_squares(const SharedGrid& grid, const TileTree& tree) {
    std::vector<std::uint32_t> out(grid.size());
    for (std::uint32_t i = 0; i < tree.tiles.size(); ++i) {
        const Box& box = tree.tiles[i];
        for (std::uint32_t r = box.begin[0]; r < box.end[0]; ++r)
            std::fill_n(out.begin() + std::ptrdiff_t(std::size_t{r} * grid.columns() + box.begin[1]), box.length(1),
                        i);
    }
    return out;
}

double second_moment(const RowProbabilities& rows, const std::vector<SharedMixture>& mixtures) {
    std::vector<double> moment(mixtures.size(), 0.0);
    parallel_for(std::size_t{0}, mixtures.size(), [&](std::size_t m) {
        const SharedMixture& mix = mixtures[m];
        for (std::size_t c = 0; c < mix.moment.size(); ++c) {
            double q = 0.0;
            for (int i = 0; i < mix.count; ++i) q += mix.share[i] * rows[mix.bin[i]][c];
            if (mix.moment[c] > 0.0) moment[m] += mix.moment[c] / q;
        }
    });
    double sum = 0.0, weight = 0.0;
    for (std::size_t m = 0; m < mixtures.size(); ++m) {
        sum += mixtures[m].weight * moment[m];
        weight += mixtures[m].weight;
    }
    return sum / weight;
}

void optimise_rows(RowProbabilities& rows, const std::vector<SharedMixture>& mixtures, int steps) {
    const std::size_t cells = rows.front().size();
    constexpr std::size_t block = 64; // cells a task
    const double least = kLeastShares / double(cells);
    for (int step = 0; step < steps; ++step) {
        // At the minimum the derivatives by the probabilities of a row are equal wherever these are positive.
        parallel_for(std::size_t{0}, (cells + block - 1) / block, [&](std::size_t task) {
            std::vector<double> slope(rows.size());
            for (std::size_t c = task * block; c < std::min(cells, (task + 1) * block); ++c) {
                std::fill(slope.begin(), slope.end(), 0.0);
                for (const SharedMixture& mix : mixtures) {
                    double q = 0.0;
                    for (int i = 0; i < mix.count; ++i) q += mix.share[i] * rows[mix.bin[i]][c];
                    if (!(q > 0.0)) continue;
                    const double g = mix.weight * mix.moment[c] / (q * q);
                    for (int i = 0; i < mix.count; ++i) slope[mix.bin[i]] += mix.share[i] * g;
                }
                for (std::size_t b = 0; b < rows.size(); ++b)
                    if (rows[b][c] > 0.0) rows[b][c] = std::max(rows[b][c] * std::sqrt(slope[b]), least * 1e-9);
            }
        });
        parallel_for(std::size_t{0}, rows.size(), [&](std::size_t b) {
            double sum = 0.0;
            for (const double p : rows[b]) sum += p;
            for (double& p : rows[b])
                if (p > 0.0) p = std::max(p / sum, least);
        });
    }
}

std::vector<std::uint16_t> row_codebook() {
    std::vector<std::uint16_t> out;
    for (int code = 0; code < 256; ++code) {
        const double x = code / 255.0, y = 1.0 - x;
        out.push_back(static_cast<std::uint16_t>(std::lround(65535.0 * x * x / (x * x + y * y))));
    }
    for (std::size_t code = 1; code < out.size(); ++code) // strictly increasing, from both ends
        out[code] = std::max(out[code], static_cast<std::uint16_t>(out[code - 1] + 1));
    for (std::size_t code = out.size() - 1; code-- > 0;)
        out[code] = std::min(out[code], static_cast<std::uint16_t>(out[code + 1] - 1));
    return out;
}

std::uint8_t row_code(double lower, double upper) {
    if (!(lower > 0.0)) return 0;
    if (!(upper > 0.0)) return 255;
    const double odds = std::sqrt(lower / upper);
    return static_cast<std::uint8_t>(std::clamp(std::lround(255.0 * odds / (1.0 + odds)), 1l, 254l));
}

std::vector<std::uint8_t> encode_row(const TileTree& tree, const std::vector<double>& probability) {
    std::vector<double> below(tree.splits.size());
    std::vector<std::uint8_t> out(tree.splits.size());
    for (std::size_t s = tree.splits.size(); s-- > 0;) {
        const double lower = part_sum(tree.splits[s].child[0], probability, below),
                     upper = part_sum(tree.splits[s].child[1], probability, below);
        below[s] = lower + upper;
        out[s] = row_code(lower, upper);
    }
    return out;
}

std::vector<double> decode_row(const TileTree& tree, const std::vector<std::uint16_t>& codebook,
                               const std::uint8_t* row) {
    std::vector<double> cells(tree.tiles.size(), 1.0), splits(tree.splits.size(), 1.0);
    for (std::size_t s = 0; s < tree.splits.size(); ++s)
        for (std::size_t k = 0; k < 2; ++k) {
            const std::uint32_t child = tree.splits[s].child[k];
            const double p = k == 0 ? codebook[row[s]] / 65535.0 : (65535 - codebook[row[s]]) / 65535.0;
            (child & TileTree::tile ? cells[child & ~TileTree::tile] : splits[child]) = splits[s] * p;
        }
    return cells;
}

} // namespace acdf::compress
