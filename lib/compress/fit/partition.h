// A partition of a grid into boxes by repeated splits: what the variance fit grows and prunes.
#pragma once

#include "compress/fit/projection.h"
#include "compress/grid.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace acdf::compress {

/// A box, and how it is divided: not at all, or along one axis into two parts or more.
struct Part {
    static constexpr std::int8_t whole = -1;

    Box box;
    Moments moments;
    std::int8_t split = whole;     ///< the axis of the grid along which it is divided
    std::uint8_t depth = 1;        ///< curves on the way to its own, itself included
    std::uint32_t first_child = 0; ///< children lie side by side
    std::uint32_t children = 0;

    /// What dividing it can lower the cost by, however finely.
    double excess() const { return moments.cost() - moments.flux; }
};

/// What a partition may forget.
struct Forgetting {
    double price = 0.0; ///< a byte: divisions that pay at no price from here on
    std::size_t parts = std::numeric_limits<std::size_t>::max(); ///< where it has more parts than these
    std::size_t most = std::numeric_limits<std::size_t>::max();  ///< and where it gives up with still more of them
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
    /// happens. Returns whether any part was divided that was not before, be it that it has been forgotten since.
    ///
    /// With `forgetting`, memory does not grow with all that is tried: forgotten parts are divided again when
    /// refine is called again.
    bool refine(double finest, double heaviest, const Forgetting& forgetting = {});
    /// Forgets divisions that pay at no price from `price` on, but for parts with weights above `heaviest`.
    void forget(double price, double heaviest);
    /// Whether the last refine() gave up: it divided some of what it was to divide.
    bool full() const { return full_; }
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
    double finest_ = std::numeric_limits<double>::infinity(); ///< of the last call of refine
    bool forgot_ = false, full_ = false;
};

} // namespace acdf::compress
