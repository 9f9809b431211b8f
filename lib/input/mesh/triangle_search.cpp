// What lies on a ray: a traversal of a hierarchy of boxes with a stack, four boxes and four triangles at once. What
// compilers make of vectors has the same results on every processor.
#include "input/mesh/triangles.h"

#include <cmath>
#include <cstring>
#include <limits>

namespace acdf::input {
namespace {

using Vec3 = std::array<double, 3>;
typedef float Floats __attribute__((vector_size(16)));
typedef std::int32_t FloatMask __attribute__((vector_size(16)));
typedef double Doubles __attribute__((vector_size(32)));
typedef long long DoubleMask __attribute__((vector_size(32)));

constexpr float kMissed = std::numeric_limits<float>::infinity();

/// Four vectors side by side.
struct FourVectors {
    Doubles x, y, z;
    explicit FourVectors(const double (&numbers)[3][4]) {
        std::memcpy(static_cast<void*>(this), numbers, sizeof numbers);
    }
};

/// A ray as boxes need it: which of their sides it meets first, and where.
struct BoxRay {
    float from[3], inverse[3];
    int near[3]; ///< 0: the low side

    BoxRay(const Vec3& origin, const Vec3& direction) {
        for (std::size_t k = 0; k < 3; ++k) {
            from[k] = static_cast<float>(origin[k]);
            const double d = std::fabs(direction[k]) > 1e-20 ? direction[k] : 1e-20;
            inverse[k] = static_cast<float>(1.0 / d);
            near[k] = d < 0.0;
        }
    }
};

} // namespace

/// Moeller and Trumbore 1997, without a division where a triangle is missed.
void TriangleTree::meet(const Quad& quad, const Vec3& origin, const Vec3& direction, double least,
                        std::optional<Hit>& best) {
    const FourVectors e1(quad.to_second), e2(quad.to_third), corner(quad.corner);
    const double dx = direction[0], dy = direction[1], dz = direction[2];
    const Doubles px = dy * e2.z - dz * e2.y, py = dz * e2.x - dx * e2.z, pz = dx * e2.y - dy * e2.x;
    const Doubles determinant = e1.x * px + e1.y * py + e1.z * pz;
    const Doubles sx = origin[0] - corner.x, sy = origin[1] - corner.y, sz = origin[2] - corner.z;
    const Doubles qx = sy * e1.z - sz * e1.y, qy = sz * e1.x - sx * e1.z, qz = sx * e1.y - sy * e1.x;
    const Doubles u = sx * px + sy * py + sz * pz, v = dx * qx + dy * qy + dz * qz;
    const Doubles zero = {};
    // Both of the sign of the determinant, and together no larger.
    const DoubleMask inside = (u * determinant >= zero) & (v * determinant >= zero) &
                              ((u + v) * determinant <= determinant * determinant) & (determinant != zero);
    if ((inside[0] | inside[1] | inside[2] | inside[3]) == 0) return;
    const Doubles t = e2.x * qx + e2.y * qy + e2.z * qz;
    for (std::size_t k = 0; k < wide; ++k) {
        if (!inside[k]) continue;
        const double distance = t[k] / determinant[k];
        if (distance > least && (!best || distance < best->distance))
            best = Hit{distance, quad.triangle[k], u[k] / determinant[k], v[k] / determinant[k]};
    }
}

template <bool any_hit>
std::optional<TriangleTree::Hit> TriangleTree::search(const Vec3& origin, const Vec3& direction,
                                                      double least) const {
    std::optional<Hit> best;
    if (nodes_.empty()) return best;
    const BoxRay ray(origin, direction);
    struct Waiting {
        std::uint32_t node;
        float distance;
    };
    Waiting stack[(wide - 1) * (deepest + 32)]; // below the deepest parts have half of the triangles each
    std::size_t depth = 0;
    std::uint32_t now = 0;
    for (;;) {
        if (now & leaf) {
            const std::uint32_t first = now & ((1u << quad_bits) - 1), more = (now & ~leaf) >> quad_bits;
            for (std::uint32_t i = first; i <= first + more; ++i) meet(quads_[i], origin, direction, least, best);
            if (any_hit && best) return best;
        } else {
            const Node& node = nodes_[now];
            const float most = best ? static_cast<float>(best->distance) : kMissed;
            Floats low = {}, high = {most, most, most, most};
            for (std::size_t k = 0; k < 3; ++k) {
                Floats a, b;
                std::memcpy(&a, node.side[ray.near[k]][k], sizeof a);
                std::memcpy(&b, node.side[1 - ray.near[k]][k], sizeof b);
                a = (a - ray.from[k]) * ray.inverse[k];
                b = (b - ray.from[k]) * ray.inverse[k];
                low = a > low ? a : low;
                high = b < high ? b : high;
            }
            const FloatMask enters = low <= high * 1.00001f;
            Waiting nearest{0, kMissed};
            for (std::size_t k = 0; k < wide; ++k) {
                if (!enters[k]) continue;
                Waiting next{node.child[k], low[k]};
                if (next.distance < nearest.distance) std::swap(next, nearest);
                if (next.distance < kMissed) stack[depth++] = next;
            }
            if (nearest.distance < kMissed) {
                now = nearest.node;
                continue;
            }
        }
        do {
            if (depth == 0) return best;
            --depth;
        } while (best && static_cast<double>(stack[depth].distance) > best->distance * 1.00001);
        now = stack[depth].node;
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
