#include "views_timed.h"

namespace acdf_cuda {

Timed time_sample(const acdf::EnvironmentView& view, const Asked& asked) {
    return time(SampleOf<acdf::EnvironmentView>{view, asked});
}
Timed time_pdf(const acdf::EnvironmentView& view, const Asked& asked) {
    return time(PdfOf<acdf::EnvironmentView>{view, asked});
}

} // namespace acdf_cuda
