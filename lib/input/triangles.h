// The surfaces of a scene as triangles, and what lies on a ray among them.
#pragma once

#include "input/scene_normals.h"

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

/// Reads a mesh (.obj, .ply), polygons as fans of triangles; `up` as for normals. Throws Error.
Triangles read_triangles(const std::string& path, UpAxis up);

/// A hierarchy of boxes over triangles. Results are the same on every machine and for any number of threads.
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
    struct Node {
        float low[3], high[3];
        std::uint32_t begin = 0; ///< of its triangles in order_; or its second child, the first one follows at once
        std::uint32_t count = 0; ///< of triangles; 0: it has children
    };
    /// A corner and the two edges from it.
    struct Edges {
        std::array<double, 3> corner, to_second, to_third;
    };
    struct Work;
    std::uint32_t build(Work& work, std::uint32_t begin, std::uint32_t end);
    template <bool any_hit>
    std::optional<Hit> search(const std::array<double, 3>& origin, const std::array<double, 3>& direction,
                              double least) const;

    double size_ = 1e-30;
    std::vector<std::uint32_t> order_;
    std::vector<Edges> edges_; ///< of the triangles in that order
    std::vector<Node> nodes_;
};

} // namespace acdf::input
