#if ACDF_WAVEFRONT_X86
#define ACDF_WIDTH 8
#include "waves/fast_density_kernel.h"
#include "waves/fast_kernel.h"

const acdf::LocalLoops acdf::fast_avx512 = {sample_all_fast, sample_all_fast, pdf_all_fast, pdf_all_fast};
#endif
