// Time of the reader's own views in kernels.
#pragma once

#include "timing.h"

#include <acdf/views.h>

namespace acdf_cuda {

Timed time_sample(const acdf::EnvironmentView& view, const Asked& asked);
Timed time_pdf(const acdf::EnvironmentView& view, const Asked& asked);

/// A shading point, and a sample, 16 samples or a pdf there.
Timed time_sample(const acdf::LocalEnvironmentView& view, const Asked& asked);
Timed time_samples(const acdf::LocalEnvironmentView& view, const Asked& asked);
Timed time_pdf(const acdf::LocalEnvironmentView& view, const Asked& asked);

/// Normals are views; directions are turned above the surface.
Timed time_sample(const acdf::BrdfView& view, const Asked& asked);
Timed time_pdf(const acdf::BrdfView& view, const Asked& asked);

#ifdef __CUDACC__
/// Of all views and baselines that sample without a normal.
template <class View>
struct SampleOf {
    View view;
    Asked asked;
    __device__ float operator()(unsigned i) const {
        const float2 u = asked.numbers[i];
        const AcdfDirectionSample s = view.sample(u.x, u.y);
        return s.direction[0] + s.direction[1] + s.direction[2] + s.pdf;
    }
};
template <class View>
struct PdfOf {
    View view;
    Asked asked;
    __device__ float operator()(unsigned i) const {
        float w[3];
        asked.direction(i, w);
        return view.pdf(w);
    }
};
/// The same given a normal or a view.
template <class View>
struct SampleAt {
    View view;
    Asked asked;
    __device__ float operator()(unsigned i) const {
        float n[3];
        asked.normal(i, n);
        const float2 u = asked.numbers[i];
        const AcdfDirectionSample s = view.sample(n, u.x, u.y);
        return s.direction[0] + s.direction[1] + s.direction[2] + s.pdf;
    }
};
template <class View>
struct PdfAt {
    View view;
    Asked asked;
    __device__ float operator()(unsigned i) const {
        float n[3], w[3];
        asked.normal(i, n);
        asked.direction(i, w);
        return view.pdf(n, w);
    }
};
#endif

} // namespace acdf_cuda
