#if ACDF_BATCH_X86
#define ACDF_WIDTH 8
#include "batch/fast_kernel.h"
#include "batch/fast_pdf_kernel.h"

const acdf::LocalLoops acdf::fast_avx512 = {sample_all_fast, sample_all_fast, pdf_all_fast, pdf_all_fast};
#endif
