#include "compress/fit/tiles.h"

#include "compress/fit/octahedral_boxes.h"

#include <acdf/sample.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>

namespace acdf::compress {
namespace {

/// Light, and the sum of its directions.
struct Light {
    double flux = 0.0;
    std::array<double, 3> sum{};

    void add(const Light& other) {
        flux += other.flux;
        for (std::size_t k = 0; k < 3; ++k) sum[k] += other.sum[k];
    }
    /// ∫ L |omega - mean|^2.
    double spread() const {
        const double square = sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2];
        return flux > 0.0 ? std::max(0.0, flux - square / flux) : 0.0;
    }
};

/// Directions of the texels of a lat-long target.
struct Sphere {
    std::vector<double> cosine, sine;  ///< of phi, one a column
    std::vector<double> z, sine_theta; ///< one a row
};

Sphere sphere_of(const Target& target) {
    Sphere out;
    for (std::uint32_t c = 0; c < target.columns; ++c) {
        double s, k;
        acdf_sincospi(1.0 - (2.0 * c + 1.0) / target.columns, &s, &k);
        out.cosine.push_back(k);
        out.sine.push_back(s);
    }
    for (std::uint32_t r = 0; r < target.rows; ++r) {
        double s, k;
        acdf_sincospi((r + 0.5) / target.rows, &s, &k);
        out.z.push_back(k);
        out.sine_theta.push_back(s);
    }
    return out;
}

/// The best division of a box, found or not.
struct TileSplit {
    double gain = 0.0;
    std::uint32_t axis = 0, position = 0;
    std::size_t node = 0;

    bool operator<(const TileSplit& other) const { // for equal gains the older node first
        return gain != other.gain ? gain < other.gain : node > other.node;
    }
};

class Divider {
public:
    Divider(const Target& target, const Worth& worth, const BrightTileRule& rule)
        : target_(target), worth_(worth), rule_(rule), sphere_(sphere_of(target)) {}

    TileTree run(std::uint32_t count) {
        Box all;
        all.end.fill(1);
        all.end[0] = target_.rows;
        all.end[1] = target_.columns;
        push(all, 1);
        for (std::uint32_t tiles = 1; tiles < count && !queue_.empty(); ++tiles) {
            const TileSplit best = queue_.top();
            queue_.pop();
            Box lower = nodes_[best.node].box, upper = lower;
            const std::uint32_t depth = nodes_[best.node].depth + 1;
            lower.end[best.axis] = upper.begin[best.axis] = best.position;
            nodes_[best.node].split = best;
            nodes_[best.node].first_child = nodes_.size();
            push(lower, depth);
            push(upper, depth);
        }
        TileTree tree;
        emit(0, tree);
        return tree;
    }

private:
    struct Node {
        Box box;
        TileSplit split;
        std::size_t first_child = 0; ///< 0: a tile
        std::uint32_t depth = 1;     ///< splits on the way to its own, itself included
        bool light = false;          ///< if it stays a tile
    };

    double at(const CoarseMap& map, std::uint32_t row, std::uint32_t column) const {
        return map.at(double(column) / target_.columns, double(row) / target_.rows);
    }

    /// Sums over the lines of a box across each axis.
    void project(const Box& box) {
        lines_[0].assign(box.length(0), Light{});
        lines_[1].assign(box.length(1), Light{});
        for (std::uint32_t r = box.begin[0]; r < box.end[0]; ++r) {
            const float* values = target_.row(r);
            Light& row = lines_[0][r - box.begin[0]];
            const double sine = sphere_.sine_theta[r], z = sphere_.z[r];
            for (std::uint32_t c = box.begin[1]; c < box.end[1]; ++c) {
                if (values[c] == 0.0f) continue;
                const double flux =
                    values[c] * at(worth_.spread, r, c) * target_.row_measure[r] * target_.column_measure[c];
                Light light{flux, {flux * sine * sphere_.cosine[c], flux * sine * sphere_.sine[c], flux * z}};
                if (is_octahedral(target_)) {
                    light.sum = octahedral_direction(target_, c + 0.5, r + 0.5);
                    for (double& x : light.sum) x *= flux;
                }
                row.add(light);
                lines_[1][c - box.begin[1]].add(light);
            }
        }
    }

    /// The best split of the lines projected last.
    void consider(std::uint32_t axis, const Box& box, double whole, TileSplit& best) {
        const std::vector<Light>& lines = lines_[axis];
        after_.assign(lines.size() + 1, Light{});
        for (std::size_t i = lines.size(); i-- > 0;) {
            after_[i] = after_[i + 1];
            after_[i].add(lines[i]);
        }
        Light before;
        for (std::size_t i = 1; i < lines.size(); ++i) {
            before.add(lines[i - 1]);
            const double gain = whole - before.spread() - after_[i].spread();
            if (gain <= best.gain) continue;
            best.gain = gain;
            best.axis = axis;
            best.position = box.begin[axis] + static_cast<std::uint32_t>(i);
        }
    }

    void push(const Box& box, std::uint32_t depth) {
        const std::size_t index = nodes_.size();
        nodes_.push_back({box, {}, 0, depth, false});
        if (depth > TileTree::most_depth) return;
        project(box);
        Light all;
        for (const Light& line : lines_[0]) all.add(line);
        TileSplit best;
        best.node = index;
        for (std::uint32_t axis = 0; axis < 2; ++axis) consider(axis, box, all.spread(), best);
        if (best.position == 0) return;
        const double worth = at(worth_.spread, box.begin[0], box.begin[1]);
        const double alarm = worth > 0.0 ? all.flux / worth * at(worth_.alarm, box.begin[0], box.begin[1]) : 0.0;
        // A bright tile that crosses the horizon may sample in vain as it does between bins, over its radius
        // instead.
        const double reach = radius(target_, box);
        if (alarm > rule_.alarm) {
            nodes_[index].light = reach <= rule_.radius;
            if (nodes_[index].light && rule_.few) return;
            if (!nodes_[index].light || alarm * reach > rule_.alarm * worth_.band)
                best.gain += 1e6 * alarm; // first of all
        }
        queue_.push(best);
    }

    std::uint32_t emit(std::size_t node, TileTree& tree) const {
        const Node& n = nodes_[node];
        if (n.first_child == 0) {
            tree.tiles.push_back(n.box);
            tree.bright_tiles += n.light;
            return TileTree::tile | static_cast<std::uint32_t>(tree.tiles.size() - 1);
        }
        const std::size_t index = tree.splits.size();
        tree.splits.push_back({n.split.axis, n.split.position, {}});
        for (std::size_t k = 0; k < 2; ++k) {
            const std::uint32_t child = emit(n.first_child + k, tree);
            tree.splits[index].child[k] = child;
        }
        return static_cast<std::uint32_t>(index);
    }

    const Target& target_;
    const Worth& worth_;
    const BrightTileRule rule_;
    Sphere sphere_;
    std::array<std::vector<Light>, 2> lines_;
    std::vector<Light> after_;
    std::vector<Node> nodes_;
    std::priority_queue<TileSplit> queue_;
};

} // namespace

TileTree divide_tiles(const Target& target, const Worth& worth, std::uint32_t count, const BrightTileRule& rule) {
    return Divider(target, worth, rule).run(count);
}

std::array<double, 3> centre(const Target& target, const Box& box) {
    if (is_octahedral(target))
        return octahedral_direction(target, 0.5 * (double(box.begin[1]) + box.end[1]),
                                    0.5 * (double(box.begin[0]) + box.end[0]));
    const double z = 0.5 * (acdf_row_z(box.begin[0], target.rows) + acdf_row_z(box.end[0], target.rows));
    const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
    double s, c;
    acdf_sincospi(1.0 - (double(box.begin[1]) + double(box.end[1])) / target.columns, &s, &c);
    return {r * c, r * s, z};
}

double largest_cosine(const Target& target, const Box& box, const std::array<double, 3>& n) {
    if (is_octahedral(target)) return largest_octahedral_cosine(target, box, n);
    const double sine = std::hypot(n[0], n[1]);
    double column = target.columns * (0.5 - 0.5 * acdf_atan2pi(n[1], n[0]));
    double best = 1.0; // cosine of the difference in azimuth
    if (column < box.begin[1] || column > box.end[1]) {
        best = -1.0;
        for (double end : {double(box.begin[1]), double(box.end[1])}) {
            double s, c;
            acdf_sincospi(2.0 * std::remainder(end - column, target.columns) / target.columns, &s, &c);
            best = std::max(best, c);
        }
    }
    const double a = sine * best; // cosine = a sin(theta) + n.z cos(theta), largest at atan2(a, n.z)
    const double row = target.rows * acdf_atan2pi(a, n[2]);
    if (row >= box.begin[0] && row <= box.end[0]) return std::hypot(a, n[2]);
    double largest = -1.0;
    for (std::uint32_t end : {box.begin[0], box.end[0]}) {
        double s, c;
        acdf_sincospi(double(end) / target.rows, &s, &c);
        largest = std::max(largest, a * s + n[2] * c);
    }
    return largest;
}

double radius(const Target& target, const Box& box) {
    std::array<double, 3> opposite = centre(target, box);
    for (double& x : opposite) x = -x;
    return std::sqrt(std::max(0.0, 2.0 + 2.0 * largest_cosine(target, box, opposite)));
}

} // namespace acdf::compress
