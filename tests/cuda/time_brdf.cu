#include "views_timed.h"

namespace acdf_cuda {
namespace {

struct Above {
    acdf::BrdfView view;
    __device__ AcdfDirectionSample sample(const float n[3], float u0, float u1) const {
        const float wo[3] = {n[0], n[1], fabsf(n[2])};
        return view.sample(wo, u0, u1);
    }
    __device__ float pdf(const float n[3], const float w[3]) const {
        const float wo[3] = {n[0], n[1], fabsf(n[2])}, wi[3] = {w[0], w[1], fabsf(w[2])};
        return view.pdf(wo, wi);
    }
};

} // namespace

Timed time_sample(const acdf::BrdfView& view, const Asked& asked) { return time(SampleAt<Above>{{view}, asked}); }
Timed time_pdf(const acdf::BrdfView& view, const Asked& asked) { return time(PdfAt<Above>{{view}, asked}); }

} // namespace acdf_cuda
