// A partition of a grid into boxes by repeated splits: what the variance fit grows and prunes.
#pragma once

#include "compress/cascade.h"
#include "compress/grid.h"

#include <acdf/layout.h>

#include <array>
#include <cstdint>
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
    double flux = 0.0;   ///< of f
    double peak = 0.0;   ///< the largest f

    void add(const Moments& other) {
        measure += other.measure;
        energy += other.energy;
        flux += other.flux;
        peak = other.peak > peak ? other.peak : peak;
    }
    /// C: what the part adds to sqrt(E[(f/p)^2]) as one cell of the best constant density. At least `flux`,
    /// which is what it adds however finely it is divided.
    double cost() const;
    /// The largest f/p of the part as one cell, relative to its best density: peak over root mean square.
    double weight() const;
};

/// A box, and how it is divided: not at all, or along one axis into two parts or more.
struct Part {
    static constexpr std::int8_t whole = -1;

    Box box;
    Moments moments;
    std::int8_t split = whole;     ///< the axis of the grid along which it is divided
    std::uint8_t depth = 1;        ///< curves on the way to its own, itself included
    std::uint32_t first_child = 0; ///< children lie side by side
    std::uint32_t children = 0;
};

/// Divides a grid, normalised to an integral of 1. parts()[0] is everything; children come after their parents.
/// The same for any number of threads.
class Partition {
public:
    /// `total` is the integral over the grid, > 0. `first` is the axis along which everything is divided first,
    /// Part::whole to choose it as for any other part.
    Partition(Grid grid, double total, std::int8_t first = Part::whole);
    /// Divides `box` of the grid alone, `depth` curves below a root; `total` is that of the whole grid all the
    /// same.
    Partition(Grid grid, double total, const Box& box, std::uint8_t depth);

    /// Divides on until no part is left whose cost could fall by more than `finest` or whose weight() is above
    /// `heaviest`. May be called again with smaller values; a part is divided in the same way whenever that
    /// happens.
    void refine(double finest, double heaviest);
    const std::vector<Part>& parts() const { return parts_; }
    const Grid& grid() const { return grid_; }
    /// The integral over the grid, to which it is normalised.
    double total() const { return total_; }

private:
    void add_first_part(const Box& box, std::uint8_t depth);

    Grid grid_;
    double total_;
    std::int8_t first_;
    std::vector<Part> parts_;
};

} // namespace acdf::compress
