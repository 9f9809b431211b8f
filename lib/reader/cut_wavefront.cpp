// Which loops serve products.
#include "cut_wavefront.h"

#include "instructions.h"

#include <algorithm>

namespace acdf {

const AcdfLocalVectors* local_vectors(Instructions most) noexcept {
#if ACDF_WAVEFRONT_X86
    static constexpr AcdfLocalVectors avx2 = {cut_sample_avx2, cut_pdf_avx2};
    static constexpr AcdfLocalVectors avx512 = {cut_sample_avx512, cut_pdf_avx512};
    switch (std::min(most, instructions_of_this_processor())) {
    case Instructions::avx512:
        return &avx512;
    case Instructions::avx2:
        return &avx2;
    case Instructions::none:
        break;
    }
#endif
    (void)most;
    return nullptr;
}

} // namespace acdf
