// A mesh as a surface that light falls on: points all over it, and what it hides.
#pragma once

#include "input/mesh/triangles.h"

#include <cstdint>
#include <vector>

namespace acdf::input {

/// On which side of a surface point `index` of a sequence lies: on each about as often, and independent of other
/// sequences (Kronecker's, of the root of x^3 = x + 1; Roberts 2018).
bool is_front(std::uint64_t index);

/// Stays where it is.
class MeshSurface {
public:
    struct Point {
        std::array<double, 3> position{}, normal{}; ///< of the side that is asked for
    };

    explicit MeshSurface(Triangles triangles);
    MeshSurface(const MeshSurface&) = delete;
    MeshSurface& operator=(const MeshSurface&) = delete;

    const Triangles& triangles() const { return triangles_; }
    const TriangleTree& tree() const { return tree_; }
    /// The sum over triangles of the root of their area.
    double weight() const { return upto_.empty() ? 0.0 : upto_.back(); }
    /// A point for u, v in [0, 1): a triangle with a probability that grows as the root of its area, as detail is
    /// what small triangles are for; on its front or on its back.
    Point at(double u, double v, bool front) const;

private:
    Triangles triangles_;
    TriangleTree tree_;
    std::vector<double> upto_;
};

} // namespace acdf::input
