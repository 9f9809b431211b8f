// Builds a hierarchy of boxes: two children each, top-down by the surface area heuristic in bins (Wald 2007), then
// four by leaving out nodes between (Ernst and Greiner 2008).
#include "input/mesh/triangles.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace acdf::input {
namespace {

using Vec3 = std::array<double, 3>;

constexpr std::uint32_t kLeaf = 4, kBins = 16;
constexpr float kInfinite = std::numeric_limits<float>::infinity();

Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3 difference(const std::array<float, 3>& a, const std::array<float, 3>& b) {
    return {double{a[0]} - double{b[0]}, double{a[1]} - double{b[1]}, double{a[2]} - double{b[2]}};
}
/// Twice the area along the normal.
Vec3 twice_area(const Triangles& triangles, std::size_t triangle) {
    const Triangles::Corner* c = &triangles.corners[3 * triangle];
    return cross(difference(c[1].position, c[0].position), difference(c[2].position, c[0].position));
}

struct Bounds {
    std::array<float, 3> low{kInfinite, kInfinite, kInfinite}, high{-kInfinite, -kInfinite, -kInfinite};

    void add(const std::array<float, 3>& point) {
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], point[k]);
            high[k] = std::max(high[k], point[k]);
        }
    }
    void add(const Bounds& other) {
        if (other.low[0] > other.high[0]) return;
        add(other.low);
        add(other.high);
    }
    double surface() const {
        if (low[0] > high[0]) return 0.0;
        const double x = double{high[0]} - double{low[0]}, y = double{high[1]} - double{low[1]},
                     z = double{high[2]} - double{low[2]};
        return x * y + y * z + z * x;
    }
};

} // namespace

double Triangles::area(std::size_t triangle) const {
    const Vec3 twice = twice_area(*this, triangle);
    return 0.5 * std::sqrt(dot(twice, twice));
}

Vec3 Triangles::face_normal(std::size_t triangle) const {
    const Vec3 n = twice_area(*this, triangle);
    const double length = std::sqrt(dot(n, n));
    if (!(length > 0.0)) return {};
    return {n[0] / length, n[1] / length, n[2] / length};
}

Vec3 Triangles::normal(std::size_t triangle, double b1, double b2) const {
    const Corner* c = &corners[3 * triangle];
    Vec3 n{};
    for (std::size_t k = 0; k < 3; ++k)
        n[k] = (1.0 - b1 - b2) * double{c[0].normal[k]} + b1 * double{c[1].normal[k]} + b2 * double{c[2].normal[k]};
    const double length = std::sqrt(dot(n, n));
    if (!(length > 1e-6)) return face_normal(triangle);
    return {n[0] / length, n[1] / length, n[2] / length};
}

Vec3 Triangles::position(std::size_t triangle, double b1, double b2) const {
    const Corner* c = &corners[3 * triangle];
    Vec3 out{};
    for (std::size_t k = 0; k < 3; ++k)
        out[k] = (1.0 - b1 - b2) * double{c[0].position[k]} + b1 * double{c[1].position[k]} +
                 b2 * double{c[2].position[k]};
    return out;
}

struct TriangleTree::Work {
    /// Of a tree with two children each; its triangles, and where it has children also the second one, which the
    /// first comes before.
    struct Node {
        Bounds box;
        std::uint32_t begin = 0, end = 0, second = 0, first = 0; ///< no children: both 0
    };
    std::vector<Bounds> box;                  ///< one a triangle
    std::vector<std::array<float, 3>> middle; ///< of it
    std::vector<std::uint32_t> order;         ///< triangles, those of a node together
    std::vector<Node> nodes;
    std::uint32_t depth = 0;
};

TriangleTree::TriangleTree(const Triangles& triangles) {
    Work work;
    Bounds all;
    for (std::size_t t = 0; t < triangles.count(); ++t) {
        Bounds box;
        for (std::size_t k = 0; k < 3; ++k) box.add(triangles.corners[3 * t + k].position);
        all.add(box);
        work.middle.push_back({0.5f * (box.low[0] + box.high[0]), 0.5f * (box.low[1] + box.high[1]),
                               0.5f * (box.low[2] + box.high[2])});
        work.box.push_back(box);
        work.order.push_back(static_cast<std::uint32_t>(t));
    }
    if (work.order.empty()) return;
    for (std::size_t k = 0; k < 3; ++k) size_ = std::max(size_, double{all.high[k]} - double{all.low[k]});
    build(work, 0, static_cast<std::uint32_t>(work.order.size()));
    join(work, triangles, 0);
}

/// The node of four children, or fewer, that stands for one of two.
std::uint32_t TriangleTree::join(const Work& work, const Triangles& triangles, std::uint32_t index) {
    std::vector<std::uint32_t> children{index};
    while (children.size() < wide) { // the largest is replaced by its own two
        std::size_t largest = children.size();
        double most = -1.0;
        for (std::size_t k = 0; k < children.size(); ++k)
            if (const Work::Node& node = work.nodes[children[k]]; node.second > 0 && node.box.surface() > most) {
                largest = k;
                most = node.box.surface();
            }
        if (largest == children.size()) break;
        const Work::Node& node = work.nodes[children[largest]];
        children[largest] = node.first;
        children.insert(children.begin() + std::ptrdiff_t(largest) + 1, node.second);
    }
    const auto out = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    for (std::size_t k = 0; k < wide; ++k) {
        const bool there = k < children.size();
        const Bounds box = there ? work.nodes[children[k]].box : Bounds();
        for (std::size_t a = 0; a < 3; ++a) { // a little larger: rounding misses nothing
            const auto margin = static_cast<float>(1e-6 * size_);
            nodes_[out].side[0][a][k] = box.low[a] - (there ? 1e-6f * std::fabs(box.low[a]) + margin : 0.0f);
            nodes_[out].side[1][a][k] = box.high[a] + (there ? 1e-6f * std::fabs(box.high[a]) + margin : 0.0f);
        }
        std::uint32_t child = 0;
        if (there)
            child = work.nodes[children[k]].second > 0 ? join(work, triangles, children[k])
                                                       : gather(work, triangles, children[k]);
        nodes_[out].child[k] = child;
    }
    return out;
}

/// The leaf of a node without children.
std::uint32_t TriangleTree::gather(const Work& work, const Triangles& triangles, std::uint32_t index) {
    const Work::Node& node = work.nodes[index];
    const auto first = static_cast<std::uint32_t>(quads_.size()), count = node.end - node.begin;
    for (std::uint32_t i = 0; i < count; ++i) {
        if (i % wide == 0) quads_.push_back({});
        Quad& quad = quads_.back();
        const std::uint32_t triangle = work.order[node.begin + i];
        const Triangles::Corner* c = &triangles.corners[3 * std::size_t{triangle}];
        const Vec3 e1 = difference(c[1].position, c[0].position), e2 = difference(c[2].position, c[0].position);
        for (std::size_t a = 0; a < 3; ++a) {
            quad.corner[a][i % wide] = double{c[0].position[a]};
            quad.to_second[a][i % wide] = e1[a];
            quad.to_third[a][i % wide] = e2[a];
        }
        quad.triangle[i % wide] = triangle;
    }
    return leaf | (count - 1) / std::uint32_t{wide} << quad_bits | first;
}

std::uint32_t TriangleTree::build(Work& work, std::uint32_t begin, std::uint32_t end) const {
    Bounds box, middles;
    for (std::uint32_t i = begin; i < end; ++i) {
        box.add(work.box[work.order[i]]);
        middles.add(work.middle[work.order[i]]);
    }
    const auto index = static_cast<std::uint32_t>(work.nodes.size());
    work.nodes.push_back({box, begin, end});
    if (end - begin <= kLeaf) return index;
    double best = double(end - begin) * box.surface();
    std::size_t best_axis = 3;
    std::uint32_t best_bin = 0;
    const auto bin_of = [&](std::uint32_t triangle, std::size_t axis) {
        const float at =
            (work.middle[triangle][axis] - middles.low[axis]) / (middles.high[axis] - middles.low[axis]);
        return std::min(static_cast<std::uint32_t>(at * float(kBins)), kBins - 1);
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!(middles.high[axis] > middles.low[axis])) continue;
        Bounds of_bin[kBins];
        std::uint32_t count[kBins] = {};
        for (std::uint32_t i = begin; i < end; ++i) {
            const std::uint32_t b = bin_of(work.order[i], axis);
            of_bin[b].add(work.box[work.order[i]]);
            ++count[b];
        }
        double upper[kBins] = {}; // cost of bin b and all above
        Bounds sum;
        std::uint32_t n = 0;
        for (std::uint32_t b = kBins; b-- > 1;) {
            sum.add(of_bin[b]);
            upper[b] = double(n += count[b]) * sum.surface();
        }
        sum = Bounds();
        n = 0;
        for (std::uint32_t b = 1; b < kBins; ++b) {
            sum.add(of_bin[b - 1]);
            n += count[b - 1];
            const double cost = double(n) * sum.surface() + upper[b];
            if (n == 0 || n == end - begin || !(cost < best)) continue;
            best = cost;
            best_axis = axis;
            best_bin = b;
        }
    }
    std::uint32_t middle = begin + (end - begin) / 2;
    if (best_axis < 3 && work.depth < deepest)
        middle = static_cast<std::uint32_t>(
            std::stable_partition(work.order.begin() + begin, work.order.begin() + end,
                                  [&](std::uint32_t t) { return bin_of(t, best_axis) < best_bin; }) -
            work.order.begin());
    else if (end - begin <= 4 * kLeaf) return index;
    ++work.depth;
    const std::uint32_t first = build(work, begin, middle), second = build(work, middle, end);
    --work.depth;
    work.nodes[index].first = first;
    work.nodes[index].second = second;
    return index;
}

} // namespace acdf::input
