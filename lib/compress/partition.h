// A partition of the target into boxes by repeated splits: the tree that the variance fit grows and prunes.
#pragma once

#include "compress/cascade.h"
#include "compress/target.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace acdf::compress {

/// Rows [row_begin, row_end) and columns [column_begin, column_end) of the target.
struct Box {
    std::uint32_t row_begin = 0, row_end = 0, column_begin = 0, column_end = 0;

    std::uint64_t texels() const { return std::uint64_t{row_end - row_begin} * (column_end - column_begin); }
};

/// Integrals over a part of the target.
struct Moments {
    double measure = 0.0;
    double energy = 0.0; ///< of f^2
    double flux = 0.0;   ///< of f

    void add(const Moments& other) {
        measure += other.measure;
        energy += other.energy;
        flux += other.flux;
    }
    /// C: what the part adds to sqrt(E[(f/p)^2]) as one cell of the best constant density. At least `flux`,
    /// which is what it adds however finely it is divided.
    double cost() const;
};

/// A box, and how it is divided: not at all, or along one axis into two parts or more.
struct Part {
    enum class Split : std::uint8_t { none, rows, columns };

    Box box;
    Moments moments;
    Split split = Split::none;
    std::uint32_t first_child = 0; ///< children lie side by side
    std::uint32_t children = 0;
};

/// Divides a target, normalised to an integral of 1. parts()[0] is everything; children come after their parents.
/// The same for any number of threads.
class Partition {
public:
    /// `total` is the integral of the target, which must outlive this. `first` is the axis along which everything
    /// is divided first, `none` to choose it as for any other part.
    Partition(const Target& target, double total, Part::Split first = Part::Split::none);

    /// Divides on until no part is left whose cost could fall by more than `finest`. May be called again with a
    /// smaller value; a part is divided in the same way whenever that happens.
    void refine(double finest);
    const std::vector<Part>& parts() const { return parts_; }
    const Target& target() const { return target_; }

private:
    const Target& target_;
    double total_;
    Part::Split first_;
    std::vector<Part> parts_;
};

} // namespace acdf::compress
