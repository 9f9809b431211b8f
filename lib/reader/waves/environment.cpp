// Which loops serve EnvironmentWavefront.
#include "waves/environment.h"

#include "instructions.h"
#include "waves/alone.h"

#include <algorithm>

namespace acdf {

EnvironmentWavefront::EnvironmentWavefront(const EnvironmentView& view, Instructions most) noexcept
    : environment_(view.data()) {
    if (environment_.cells || environment_.groups) instructions_ = std::min(most, instructions_of_this_processor());
}

void EnvironmentWavefront::sample(const double (*u)[2], std::size_t count, DirectionSample* out) const noexcept {
#if ACDF_WAVEFRONT_X86
    if (instructions_ == Instructions::avx512) return environment_sample_avx512(environment_, u, count, out);
    if (instructions_ == Instructions::avx2) return environment_sample_avx2(environment_, u, count, out);
#endif
    for (std::size_t i = 0; i < count; ++i) out[i] = alone::environment_sample(environment_, u[i]);
}

void EnvironmentWavefront::pdf(const float (*directions)[3], std::size_t count, float* out) const noexcept {
#if ACDF_WAVEFRONT_X86
    if (instructions_ == Instructions::avx512) return environment_pdf_avx512(environment_, directions, count, out);
    if (instructions_ == Instructions::avx2) return environment_pdf_avx2(environment_, directions, count, out);
#endif
    for (std::size_t i = 0; i < count; ++i) out[i] = alone::environment_pdf(environment_, directions[i]);
}

} // namespace acdf
