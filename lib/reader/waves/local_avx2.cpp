#if ACDF_WAVEFRONT_X86
#define ACDF_WIDTH 4
#include "waves/local_kernel.h"
#include "waves/local_piece_kernel.h"

const acdf::LocalLoops acdf::local_avx2 = {sample_all, sample_all, pdf_all, pdf_all};
#endif
