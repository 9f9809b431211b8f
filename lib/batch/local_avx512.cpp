#if ACDF_BATCH_X86
#define ACDF_WIDTH 8
#include "batch/local_kernel.h"
#include "batch/local_piece_kernel.h"

const acdf::LocalLoops acdf::local_avx512 = {sample_all, sample_all, pdf_all, pdf_all};
#endif
