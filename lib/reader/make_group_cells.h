// What draws and densities look up of the cells of groups (acdf/groups.h).
#pragma once

#include "make_sides.h"

#include <acdf/groups.h>
#include <acdf/sample.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

/// A curve of whose segments groups are made: those that follow each other.
struct GroupCurve {
    const AcdfCurve& curve;
    const Cell& above; ///< that it divides
    std::uint32_t at;
};

/// Writes down the cells of groups, one group after the other. The tables are as long as the groups tell.
class GroupCells {
public:
    struct Tables {
        AcdfGroup* groups;
        std::uint32_t *boxes, *more;
        AcdfGroupCell* cells;
        float* densities;
    };
    explicit GroupCells(const AcdfEnvironment& environment) : environment_(environment) {}

    /// Heights of rows, which are looked up afterwards; not on the octahedral square. False where memory fails.
    bool remember_heights() noexcept;
    const Growable<double>& heights() const noexcept { return heights_; }

    /// Of a group that is in the tables, the cells of segments [first, last).
    void write(const Tables& tables, std::size_t group, const GroupCurve& curve, std::uint32_t first,
               std::uint32_t last) const noexcept;

private:
    class Writer;
    bool square() const noexcept { return environment_.parameterization == ACDF_PARAM_OCTAHEDRAL; }
    double height(std::uint32_t first, std::uint32_t last) const noexcept;

    AcdfEnvironment environment_;
    double step_[2] = {2.0 * ACDF_PI / environment_.columns,
                       2.0 * ACDF_PI /
                           environment_.rows}; ///< radians, of positions on an axis that is not of heights
    Growable<double> heights_, sines_;         ///< of each row: of the angle to the pole
};

} // namespace acdf
