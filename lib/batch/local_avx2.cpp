#if ACDF_BATCH_X86
#define ACDF_WIDTH 4
#include "batch/local_kernel.h"
#include "batch/local_piece_kernel.h"

const acdf::LocalLoops acdf::local_avx2 = {sample_all, sample_all, pdf_all, pdf_all};
#endif
