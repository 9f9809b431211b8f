// The view of a local environment file with its visibility cells and portals. C++17; freestanding over
// acdf/visibility/visible_local.h but for VisibleLocalView::of, which calls acdf::visibility. For kernels
// define ACDF_FN and ACDF_METHOD as for acdf/views.h.
//
//   acdf::VisibleLocalView light;
//   if (acdf::Status status = acdf::VisibleLocalView::of(file, light); !status.ok()) { ... status.message ... }
//   AcdfVisiblePoint point = light.at(position, normal);      // once a shading point
//   acdf::DirectionSample s = light.sample(point, u0, u1);    // s.direction, s.pdf in sr^-1
//   float p = light.pdf(point, s.direction);
#pragma once

#include <acdf/reader.h>
#include <acdf/views.h>
#include <acdf/visibility/visibility_c.h>
#include <acdf/visibility/visible_local.h>

namespace acdf {

/// For each position and normal a probability density over the sphere that follows the light above the horizon,
/// times the cosine, as far as it reaches the position. Normals are of any length > 0, in the frame of directions.
class VisibleLocalView : public ViewOf<AcdfVisibleLocal> {
public:
    using ViewOf<AcdfVisibleLocal>::ViewOf;
    VisibleLocalView() noexcept = default;
    /// Without cells, whatever the file has: for each position the normal alone counts.
    ACDF_METHOD explicit VisibleLocalView(const LocalEnvironmentView& local) noexcept
        : ViewOf(acdf_visible_everywhere(&local.data())) {}

    /// Makes the view of a local environment file. Checks what the file stores of cells and portals, in time linear
    /// in their size; allocates nothing. A file without cells gives a view for which the normal alone counts.
    /// Fails, and leaves `view` empty, where a rule of SPEC.md is broken or the file is of another kind.
    static Status of(const File& file, VisibleLocalView& view) noexcept {
        Status status;
        if (!acdf_visible_local(file.get(), &view.data_, &status)) view = VisibleLocalView();
        return status;
    }

    /// Whether it was made by default: then only this may be asked.
    ACDF_METHOD bool empty() const noexcept { return data_.local.environment.columns == 0; }
    /// What serves a normal, wherever it is.
    ACDF_METHOD LocalEnvironmentView local() const noexcept { return LocalEnvironmentView(data_.local); }
    /// Whether there are visibility cells.
    ACDF_METHOD bool has_cells() const noexcept { return data_.cells.header != nullptr; }
    /// Whether there are portals that light comes through: samples go through them where a position sees them.
    ACDF_METHOD bool has_portals() const noexcept { return data_.portals.header != nullptr; }

    /// A shading point of the scene that the file was made for, `position` in the scene's own coordinates.
    /// Samples go towards light that reaches it, but for a small share. Outside of the scene's bounds, and of files
    /// that do not store visibility cells, the normal alone counts. Where the scene has changed since, sampling
    /// stays unbiased, and is noisier. 216 bytes at most by value; valid while the File lives.
    ACDF_METHOD AcdfVisiblePoint at(const float position[3], const float normal[3]) const noexcept {
        AcdfVisiblePoint point;
        acdf_visible_at(&data_, position, normal, &point);
        return point;
    }
    /// The same anywhere: the normal alone counts.
    ACDF_METHOD AcdfVisiblePoint at(const float normal[3]) const noexcept { return at(nullptr, normal); }
    /// Samples a direction; u0 (azimuth) and u1 (elevation) in [0, 1]. pdf in sr^-1, finite and > 0. It is 0 where
    /// the normal is zero or NaN or no light can reach it. A direction may lie below the horizon: it counts as 0.
    ACDF_METHOD DirectionSample sample(const AcdfVisiblePoint& point, double u0, double u1) const noexcept {
        return acdf_visible_sample(&data_, &point, u0, u1);
    }
    /// The pdf in sr^-1 of a unit direction; exactly that of `sample` for what it returned, but for rounding where
    /// cells are tilted (`--fit pdf`; SPEC.md §14.1).
    ACDF_METHOD float pdf(const AcdfVisiblePoint& point, const float direction[3]) const noexcept {
        return acdf_visible_pdf(&data_, &point, direction);
    }
};

} // namespace acdf
