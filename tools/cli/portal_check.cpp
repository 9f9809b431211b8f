#include "tools/cli/portal_check.h"

#include "build/own_terms.h"

#include <acdf/sample.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace acdf::tools {
namespace {

using Vec = std::array<double, 3>;

constexpr int kSide = 8, kRays = 32;          // of a grid on the portal; from each of its points
constexpr double kNotable = 0.05;             // share of a portal through which nothing comes in
constexpr double kLift = 1e-4, kSlack = 1e-2; // of the size of the scene

Vec sum(const Vec& a, const Vec& b, double scale) {
    return {a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]};
}

/// In the frame of the mesh as it was read.
struct Window {
    Vec corner{}, across{}, up{}, outside{}; // outside: unit

    Window(const builder::Portal& portal, const float (&transform)[3][4]) {
        for (std::size_t k = 0; k < 3; ++k) {
            const float* t = transform[k];
            const auto turned = [t](const float(&v)[3]) {
                return double{t[0]} * double{v[0]} + double{t[1]} * double{v[1]} + double{t[2]} * double{v[2]};
            };
            corner[k] = turned(portal.corner) + double{t[3]};
            across[k] = turned(portal.across);
            up[k] = turned(portal.up);
        }
        outside = {across[1] * up[2] - across[2] * up[1], across[2] * up[0] - across[0] * up[2],
                   across[0] * up[1] - across[1] * up[0]};
        const double length = std::hypot(outside[0], outside[1], outside[2]);
        for (double& x : outside) x /= length;
    }

    /// The other way round: light comes from either side (lib/compress/visibility/portal_sides.h).
    Window turned() const {
        Window out = *this;
        for (double& x : out.outside) x = -x;
        return out;
    }
    Vec at(double u, double v) const { return sum(sum(corner, across, u), up, v); }
};

/// How many of the rays around `axis` from a point meet nothing: directions by Fibonacci's spiral, the first one
/// about the axis itself.
int open_rays(const input::TriangleTree& tree, const Vec& from, const Vec& axis) {
    const Vec side = std::abs(axis[2]) < 0.9 ? Vec{-axis[1], axis[0], 0.0} : Vec{axis[2], 0.0, -axis[0]};
    const double length = std::hypot(side[0], side[1], side[2]);
    const Vec x{side[0] / length, side[1] / length, side[2] / length},
        y{axis[1] * x[2] - axis[2] * x[1], axis[2] * x[0] - axis[0] * x[2], axis[0] * x[1] - axis[1] * x[0]};
    int open = 0;
    for (int i = 0; i < kRays; ++i) {
        const double z = 1.0 - (i + 0.25) / kRays, r = std::sqrt(1.0 - z * z);
        double sine, cosine;
        acdf_sincospi(2.0 * std::fmod(0.618033988749895 * i, 1.0), &sine, &cosine);
        const Vec direction = sum(sum({axis[0] * z, axis[1] * z, axis[2] * z}, x, r * cosine), y, r * sine);
        open += !tree.any(from, direction, 0.0);
    }
    return open;
}

/// The share of a portal that is walled up, or that leads past the scene.
double useless_share(const input::MeshSurface& surface, const Window& window) {
    const input::TriangleTree& tree = surface.tree();
    const double lift = kLift * tree.size();
    const Vec inside{-window.outside[0], -window.outside[1], -window.outside[2]};
    int useless = 0;
    for (int i = 0; i < kSide; ++i)
        for (int j = 0; j < kSide; ++j) {
            const Vec p = window.at((i + 0.5) / kSide, (j + 0.5) / kSide);
            const bool walled = open_rays(tree, sum(p, window.outside, -lift), window.outside) == 0;
            const Vec before = sum(p, window.outside, lift);
            const bool past =
                !walled && !tree.any(before, inside, 0.0) && 2 * open_rays(tree, before, inside) > kRays;
            useless += walled || past;
        }
    return double(useless) / (kSide * kSide);
}

bool is_outside(const input::MeshSurface& surface, const Window& window) {
    const double slack = kSlack * surface.tree().size();
    const Vec corners[] = {window.at(0, 0), window.at(1, 0), window.at(1, 1), window.at(0, 1)};
    for (std::size_t k = 0; k < 3; ++k) {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const input::Triangles::Corner& corner : surface.triangles().corners) {
            low = std::min(low, double{corner.position[k]});
            high = std::max(high, double{corner.position[k]});
        }
        const auto beyond = [&](const Vec& c) { return c[k] > high + slack; };
        const auto below = [&](const Vec& c) { return c[k] < low - slack; };
        if (std::all_of(std::begin(corners), std::end(corners), beyond) ||
            std::all_of(std::begin(corners), std::end(corners), below))
            return true;
    }
    return false;
}

} // namespace

void note_portals(const builder::Visibility& visibility, const input::MeshSurface& surface, const Note& note) {
    if (surface.triangles().corners.empty()) return;
    for (std::size_t i = 0; i < visibility.portals.size(); ++i) {
        const Window window(visibility.portals[i], visibility.transform);
        if (!(std::abs(window.outside[0]) <= 1.0)) continue; // no rectangle: refused when it is built
        const std::string name = "portal " + std::to_string(i + 1);
        if (is_outside(surface, window)) {
            note(name +
                 " lies outside of the box around the scene; are its corners in the mesh's own coordinates?");
            continue;
        }
        const double share = std::min(useless_share(surface, window), useless_share(surface, window.turned()));
        if (share > kNotable)
            note(name + " is larger than its opening: no light comes through " +
                 std::to_string(std::lround(100.0 * share)) +
                 " % of it, and samples there are lost; give the corners of the opening alone");
    }
}

} // namespace acdf::tools
