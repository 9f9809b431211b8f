// The surfaces of a scene as triangles, and what lies on a ray among them.
#pragma once

#include "input/up_axis.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace acdf::input {

/// Triangles of any size, also none. Positions in the frame of docs/conventions.md: z up.
struct Triangles {
    struct Corner {
        std::array<float, 3> position{}, normal{}; ///< normal: unit, or zero where the file has none
    };
    std::vector<Corner> corners; ///< three a triangle

    std::size_t count() const { return corners.size() / 3; }
    /// The unit normal of a triangle as it is wound; zero where it has no area.
    std::array<double, 3> face_normal(std::size_t triangle) const;
    double area(std::size_t triangle) const;
    /// The normal at barycentric coordinates (of corner 1 and 2): interpolated where there are normals.
    std::array<double, 3> normal(std::size_t triangle, double b1, double b2) const;
    std::array<double, 3> position(std::size_t triangle, double b1, double b2) const;
};

/// Reads a mesh or a list of instances (file.h), polygons as fans of triangles; `up` as for normals. Triangles
/// with a corner that is no number, or farther than 1e30 from the origin on an axis, are left out. Throws Error.
Triangles read_triangles(const std::string& path, UpAxis up);

/// A hierarchy of boxes over triangles, four side by side. Results are the same on every machine and for any number
/// of threads.
class TriangleTree {
public:
    struct Hit {
        double distance = 0.0; ///< in lengths of the direction
        std::size_t triangle = 0;
        double b1 = 0.0, b2 = 0.0;
    };

    explicit TriangleTree(const Triangles& triangles);

    /// The largest extent of all, at least 1e-30.
    double size() const { return size_; }
    /// The first triangle on a ray farther than `least`, none where it is missed.
    std::optional<Hit> first(const std::array<double, 3>& origin, const std::array<double, 3>& direction,
                             double least) const;
    /// Whether any is.
    bool any(const std::array<double, 3>& origin, const std::array<double, 3>& direction, double least) const;

private:
    static constexpr std::size_t wide = 4;
    /// A child: a node, or leaf | number of quads - 1 | first of them.
    static constexpr std::uint32_t leaf = 0x80000000u, quad_bits = 28, deepest = 60;

    /// Boxes of up to four children; that of a child that is not there holds nothing.
    struct alignas(64) Node {
        float side[2][3][wide]; ///< low, high
        std::uint32_t child[wide];
    };
    /// Up to four triangles: a corner of each and the two edges from it; zero where there is none.
    struct alignas(64) Quad {
        double corner[3][wide], to_second[3][wide], to_third[3][wide];
        std::uint32_t triangle[wide];
    };
    struct Work;
    std::uint32_t build(Work& work, std::uint32_t begin, std::uint32_t end) const;
    std::uint32_t join(const Work& work, const Triangles& triangles, std::uint32_t index);
    std::uint32_t gather(const Work& work, const Triangles& triangles, std::uint32_t index);
    template <bool any_hit>
    std::optional<Hit> search(const std::array<double, 3>& origin, const std::array<double, 3>& direction,
                              double least) const;
    static void meet(const Quad& quad, const std::array<double, 3>& origin, const std::array<double, 3>& direction,
                     double least, std::optional<Hit>& best);

    double size_ = 1e-30;
    std::vector<Quad> quads_;
    std::vector<Node> nodes_;
};

} // namespace acdf::input
