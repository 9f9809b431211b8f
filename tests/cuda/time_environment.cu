#include "views_timed.h"

namespace acdf_cuda {

Timed time_draw(const acdf::EnvironmentView& view, const Asked& asked) {
    return time(DrawOf<acdf::EnvironmentView>{view, asked});
}
Timed time_density(const acdf::EnvironmentView& view, const Asked& asked) {
    return time(DensityOf<acdf::EnvironmentView>{view, asked});
}

} // namespace acdf_cuda
