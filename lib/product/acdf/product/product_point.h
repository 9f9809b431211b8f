// A shading point of product sampling while its parts are rated (acdf/product/product_cut.h): its light and its
// lobe. C++17, header only, freestanding.
#pragma once

#include <acdf/product/lobe.h>
#include <acdf/product/part_rating.h>
#include <acdf/visibility/visible_local.h>

namespace acdf {

template <class AnyLobe>
struct PointOfLobe {
    const AcdfVisibleLocal& light;
    const AcdfVisiblePoint& at; ///< of the light
    const SurfaceFrame& frame;
    const AnyLobe& lobe;
    const typename AnyLobe::Point& lobe_at;
    int parts; ///< about how many are wanted

    /// Values and pdfs of the lobe are clamped to this, so that no sum of products overflows.
    static constexpr float most_value = 1e18f;

    ACDF_METHOD static float bounded(float x) noexcept { return x < most_value ? x > 0.0f ? x : 0.0f : most_value; }

    /// A direction in the surface's frame, or the one above the horizon that is next to it: a part whose middle
    /// lies below has light above, if it has any.
    ACDF_METHOD void above_surface(const float world[3], float wi[3]) const noexcept {
        constexpr float least = 0.02f;
        frame.to_local(world, wi);
        if (wi[2] >= least) return;
        wi[2] = least;
        const float scale = 1.0f / sqrtf(wi[0] * wi[0] + wi[1] * wi[1] + wi[2] * wi[2]);
        for (int k = 0; k < 3; ++k) wi[k] *= scale;
    }

    /// The lobe's value and pdf in directions above the surface, in its frame: calls report(i, value, pdf) for
    /// each.
    template <class Report>
    ACDF_METHOD void look(int count, const float (*wi)[3], const Report& report) const noexcept {
        for (int i = 0; i < count; ++i) {
            const float pdf = lobe.pdf(lobe_at, wi[i]);
            report(i, bounded(lobe.value(lobe_at, wi[i], pdf)), bounded(pdf));
        }
    }

    /// Adds samples of the lobe's own sampler, without weights, to none; their directions into `world`. In their
    /// place: what is written in pieces and copied at once would be waited for.
    ACDF_METHOD void sample_guides(float (*world)[3], LobeGuides& out) const noexcept {
        const AcdfGrid grid = acdf_environment_grid(&light.local.environment);
        const int sampled = parts < 12 ? 2 : LobeGuides::most;
        out.sampled = sampled;
        for (int i = 0; i < sampled; ++i) {
            const ProductSample s = guide(lobe, lobe_at, i, sampled);
            if (!(s.pdf > 0.0f && s.direction[2] > 0.0f)) continue;
            frame.to_world(s.direction, world[out.count]);
            const AcdfRowSpot spot = acdf_rows_spot(light.local.rows_of_normals, &grid, world[out.count]);
            if (!spot.valid) continue;
            const float value = bounded(lobe.value(lobe_at, s.direction, s.pdf)), pdf = bounded(s.pdf);
            if (!(value > 0.0f && pdf > 0.0f)) continue;
            for (int axis = 0; axis < 2; ++axis) out.square[axis][out.count] = spot.square[axis];
            out.value[out.count] = value;
            out.pdf[out.count] = pdf;
            if (value > out.brightest) out.brightest = value;
            ++out.count;
        }
    }
};

} // namespace acdf
