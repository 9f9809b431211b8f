// What a box of a grid holds, seen along each axis.
#pragma once

#include "compress/grid.h"

#include <acdf/layout.h>

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace acdf::compress {

/// Steps [begin, end) on each axis of the grid; axes that the grid lacks hold [0, 1).
struct Box {
    std::array<std::uint32_t, ACDF_MAX_AXES> begin{}, end{};

    std::uint32_t length(std::size_t axis) const { return end[axis] - begin[axis]; }
};

/// Integrals over a part of the grid.
struct Moments {
    double measure = 0.0;
    double energy = 0.0; ///< of f^2
    double flux = 0.0;   ///< of f; beside an MIS partner of what f costs at best
    double left = 0.0;   ///< beside an MIS partner twice what the part costs if it is left to it; 0: without any
    double peak = 0.0;   ///< the largest f

    void add(const Moments& other) {
        measure += other.measure;
        energy += other.energy;
        flux += other.flux;
        left += other.left;
        peak = other.peak > peak ? other.peak : peak;
    }
    /// C: what the part adds to sqrt(E[(f/p)^2]) as one cell of the best constant density. At least `flux`,
    /// which is what it adds however finely it is divided. Beside an MIS partner: docs/method.md.
    double cost() const;
    /// What its probability is proportional to: without an MIS partner, its cost.
    double share(const Filling* filling) const;
    /// The largest f/p of the part as one cell, relative to its best pdf: peak over root mean square.
    double weight() const;
    /// Whether that is above `heaviest`, infinity where it does not matter.
    bool above(double heaviest) const {
        return heaviest < std::numeric_limits<double>::infinity() && weight() > heaviest;
    }
};

/// The moments of the slices of a box across one axis, by what they are.
struct Slices {
    std::vector<double> measure, energy, flux;
    std::vector<double> left; ///< empty without an MIS partner
    std::vector<float> peak;  ///< not normalised

    std::size_t size() const { return measure.size(); }
    void reset(std::size_t count);
    /// The sum over slices [begin, end), in order; peaks are divided by `total`.
    Moments sum(std::size_t begin, std::size_t end, double total) const;
};

/// For each axis of the grid, the slices of a box across it.
using Projections = std::array<Slices, ACDF_MAX_AXES>;

/// Sums f / `total` over the box. Sums are made from the steps of the box, one line of the last axis after the
/// other, never as differences of larger sums: beside a bright spot nothing dim is lost.
void project(const Grid& grid, double total, const Box& box, Projections& out);

} // namespace acdf::compress
