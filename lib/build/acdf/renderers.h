// Renderers of which it is known how they look an environment map up: the options that suit each, and the axes of
// its light. `acdf env --for NAME` uses the same table; docs/notes/conventions.md says where each line is read off.
//
//     if (const acdf::builder::Renderer* cycles = acdf::builder::find_renderer("cycles")) {
//         options.target = cycles->target;
//         ...
//         float there[3];
//         cycles->axes.turn(sample.direction, there); // in the frame of the light
//     }
#pragma once

#include <acdf/builder.h>

#include <cstddef>
#include <optional>
#include <string>

namespace acdf::builder {

/// The axes of one frame by those of another: each is x, y or z of that (1, 2, 3), or its opposite (-1, -2, -3).
struct Axes {
    int x = 1, y = 2, z = 3;

    /// A vector of the other frame in this one.
    void turn(const float from[3], float to[3]) const noexcept;
    /// The axes of the other frame by those of this one.
    Axes inverse() const noexcept;
    /// "(-x, y, z)", with the letters of the other frame.
    std::string text(const char* letters = "xyz") const;
};

/// How a renderer looks an environment map up, and the axes of the light that it makes of it.
struct Renderer {
    const char* name;     ///< as --for takes it
    TargetOptions target; ///< domain, filter, wrap and channels as the renderer has them; the rest is by default
    Axes axes;            ///< of its light's frame, by ours, for lat-long and octahedral maps
    std::optional<Axes> mirrorball; ///< the same for mirror balls, where it reads them and it is known how

    /// Whether its environment light is given the normal of the surface that it lights: files of kind local need
    /// it.
    bool has_normal = false;
    /// Whether its path integrator adds BSDF samples to those of the light, and how it weighs them.
    bool adds_bsdf_samples = false;
    AcdfHeuristic heuristic = ACDF_HEURISTIC_BALANCE;
    const char* why = ""; ///< where the three are read off

    /// Those for a map of that projection; null for others.
    const Axes* axes_of(Projection projection) const noexcept;
    /// The kind of file that has the least noise there: ACDF_KIND_LOCAL or ACDF_KIND_ENVIRONMENT.
    AcdfKind kind() const noexcept;
    /// The MIS partner that suits a file of these options, with the heuristic; kind ACDF_PARTNER_NONE where the
    /// file may be used alone, or its options go without a partner. A file for a partner may not be used alone.
    Partner partner(const EnvironmentOptions& options) const noexcept;
    Partner partner(const LocalOptions& options) const noexcept;
};

/// A range of them.
struct Renderers {
    const Renderer* first;
    std::size_t count;

    /// For loops over all.
    const Renderer* begin() const noexcept { return first; }
    /// For loops over all.
    const Renderer* end() const noexcept { return first + count; }
};

/// All that are known.
Renderers renderers() noexcept;

/// The one of that name; null where there is none.
const Renderer* find_renderer(const char* name) noexcept;

} // namespace acdf::builder
