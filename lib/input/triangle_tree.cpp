// A hierarchy of boxes, built top-down by the surface area heuristic in bins (Wald 2007), walked with a stack.
#include "input/triangles.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace acdf::input {
namespace {

using Vec3 = std::array<double, 3>;

constexpr std::uint32_t kLeaf = 4, kBins = 16, kDeepest = 60;
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
    std::vector<Bounds> box;                  ///< one a triangle
    std::vector<std::array<float, 3>> middle; ///< of it
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
        order_.push_back(static_cast<std::uint32_t>(t));
    }
    if (order_.empty()) return;
    for (std::size_t k = 0; k < 3; ++k) size_ = std::max(size_, double{all.high[k]} - double{all.low[k]});
    build(work, 0, static_cast<std::uint32_t>(order_.size()));
    for (const std::uint32_t triangle : order_) {
        const Triangles::Corner* c = &triangles.corners[3 * std::size_t{triangle}];
        const std::array<float, 3>& p = c[0].position;
        edges_.push_back({{double{p[0]}, double{p[1]}, double{p[2]}},
                          difference(c[1].position, p),
                          difference(c[2].position, p)});
    }
}

std::uint32_t TriangleTree::build(Work& work, std::uint32_t begin, std::uint32_t end) {
    Bounds box, middles;
    for (std::uint32_t i = begin; i < end; ++i) {
        box.add(work.box[order_[i]]);
        middles.add(work.middle[order_[i]]);
    }
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    Node node;
    for (std::size_t k = 0; k < 3; ++k) { // a little larger: rounding misses nothing
        node.low[k] = box.low[k] - 1e-6f * std::fabs(box.low[k]) - static_cast<float>(1e-6 * size_);
        node.high[k] = box.high[k] + 1e-6f * std::fabs(box.high[k]) + static_cast<float>(1e-6 * size_);
    }
    node.begin = begin;
    node.count = end - begin;
    nodes_.push_back(node);
    if (end - begin <= kLeaf || work.depth >= kDeepest) return index;
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
            const std::uint32_t b = bin_of(order_[i], axis);
            of_bin[b].add(work.box[order_[i]]);
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
    if (best_axis < 3)
        middle = static_cast<std::uint32_t>(
            std::stable_partition(order_.begin() + begin, order_.begin() + end,
                                  [&](std::uint32_t t) { return bin_of(t, best_axis) < best_bin; }) -
            order_.begin());
    else if (end - begin <= 4 * kLeaf) return index;
    ++work.depth;
    build(work, begin, middle);
    const std::uint32_t second = build(work, middle, end);
    --work.depth;
    nodes_[index].begin = second;
    nodes_[index].count = 0;
    return index;
}

template <bool any_hit>
std::optional<TriangleTree::Hit> TriangleTree::search(const Vec3& origin, const Vec3& direction,
                                                      double least) const {
    if (nodes_.empty()) return std::nullopt;
    std::optional<Hit> best;
    double most = std::numeric_limits<double>::infinity();
    float from[3], inverse[3];
    for (std::size_t k = 0; k < 3; ++k) {
        from[k] = static_cast<float>(origin[k]);
        const double d = std::fabs(direction[k]) > 1e-20 ? direction[k] : 1e-20;
        inverse[k] = static_cast<float>(1.0 / d);
    }
    const auto enters = [&](const Node& node) { // at what distance, infinite where the box is missed
        float low = 0.0f, high = static_cast<float>(most);
        for (std::size_t k = 0; k < 3; ++k) {
            const float a = (node.low[k] - from[k]) * inverse[k], b = (node.high[k] - from[k]) * inverse[k];
            low = std::max(low, std::min(a, b));
            high = std::min(high, std::max(a, b));
        }
        return low <= high * 1.00001f ? low : kInfinite;
    };
    std::uint32_t stack[kDeepest + 4], depth = 0, now = 0;
    if (!(enters(nodes_[0]) < kInfinite)) return std::nullopt;
    for (;;) {
        const Node& node = nodes_[now];
        if (node.count == 0) {
            std::uint32_t near = now + 1, far = node.begin;
            float at_near = enters(nodes_[near]), at_far = enters(nodes_[far]);
            if (at_far < at_near) {
                std::swap(near, far);
                std::swap(at_near, at_far);
            }
            if (at_near < kInfinite) {
                if (at_far < kInfinite) stack[depth++] = far;
                now = near;
                continue;
            }
        } else {
            for (std::uint32_t i = node.begin; i < node.begin + node.count; ++i) { // Moeller and Trumbore 1997
                const Vec3 &corner = edges_[i].corner, &e1 = edges_[i].to_second, &e2 = edges_[i].to_third;
                const Vec3 p = cross(direction, e2);
                const double determinant = dot(e1, p);
                if (determinant == 0.0) continue;
                const Vec3 s{origin[0] - corner[0], origin[1] - corner[1], origin[2] - corner[2]};
                const double b1 = dot(s, p) / determinant;
                if (!(b1 >= 0.0 && b1 <= 1.0)) continue;
                const Vec3 q = cross(s, e1);
                const double b2 = dot(direction, q) / determinant;
                if (!(b2 >= 0.0 && b1 + b2 <= 1.0)) continue;
                const double distance = dot(e2, q) / determinant;
                if (!(distance > least && distance < most)) continue;
                best = Hit{distance, order_[i], b1, b2};
                if (any_hit) return best;
                most = distance;
            }
        }
        if (depth == 0) return best;
        now = stack[--depth];
    }
}

std::optional<TriangleTree::Hit> TriangleTree::first(const Vec3& origin, const Vec3& direction,
                                                     double least) const {
    return search<false>(origin, direction, least);
}

bool TriangleTree::any(const Vec3& origin, const Vec3& direction, double least) const {
    return search<true>(origin, direction, least).has_value();
}

} // namespace acdf::input
