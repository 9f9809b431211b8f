// The views at which a BRDF is looked at before it is fitted, and which of them are worth storing.
#pragma once

#include "compress/brdf/row_mixtures.h"
#include "compress/brdf/target.h"

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Views on a grid of x and phi, their targets x-major.
struct BrdfViews {
    HalfGrid grid;
    SharedGrid measures; ///< of that grid
    std::vector<double> x, phi;
    std::vector<double> x_weight; ///< of the views at x in the mean over views: cos(theta_o) uniform
    std::vector<ViewTarget> targets;

    const ViewTarget& at(std::size_t ix, std::size_t iphi) const { return targets[ix * phi.size() + iphi]; }
    double weight(std::size_t ix) const { return x_weight[ix] / static_cast<double>(phi.size()); }
};

/// Looks at every view of a grid of x (increasing) and phi. Throws std::invalid_argument where a value is not
/// finite.
BrdfViews look_at(const Reflected& reflected, const HalfGrid& grid, const std::vector<double>& x,
                  const std::vector<double>& phi);

/// Azimuths -pi + 2 pi k / count; of an isotropic BRDF, count 1, it is 0.
std::vector<double> azimuths(std::size_t count);

/// Where views are stored: `count` x, fewer where no more can help, the least and the largest first and then in the
/// order of what they gain. Each is put where a mixture of its neighbours is worst at what lies between them, so
/// that they are dense where the distribution changes fast.
std::vector<double> choose_nodes(const Reflected& reflected, const BrdfSymmetry& symmetry, std::size_t count);

/// `nodes` (increasing), and `parts` - 1 views between each two of them.
std::vector<double> subdivided(const std::vector<double>& nodes, std::size_t parts);

} // namespace acdf::compress
