#include "views_timed.h"

namespace acdf_cuda {
namespace {

constexpr unsigned kDraws = 16;

/// As many samples at one point.
struct Draws {
    acdf::LocalEnvironmentView view;
    Asked asked;
    __device__ float operator()(unsigned i) const {
        float n[3], sum = 0.0f;
        asked.normal(i, n);
        const AcdfLocalPoint point = view.at(n);
        for (unsigned k = 0; k < kDraws; ++k) {
            const float2 u = asked.numbers[(i + k * (kCalls / kDraws)) % kCalls];
            const AcdfDirectionSample s = view.sample(point, u.x, u.y);
            sum += s.direction[0] + s.direction[1] + s.direction[2] + s.pdf;
        }
        return sum;
    }
};

} // namespace

Timed time_sample(const acdf::LocalEnvironmentView& view, const Asked& asked) {
    return time(SampleAt<acdf::LocalEnvironmentView>{view, asked});
}
Timed time_samples(const acdf::LocalEnvironmentView& view, const Asked& asked) {
    return time(Draws{view, asked}, kDraws);
}
Timed time_pdf(const acdf::LocalEnvironmentView& view, const Asked& asked) {
    return time(PdfAt<acdf::LocalEnvironmentView>{view, asked});
}

} // namespace acdf_cuda
