// The loops of LocalBatch, which are compiled for several processors.
#pragma once

#include <acdf/local.h>

#include <cstddef>

namespace acdf {

#if ACDF_BATCH_X86
/// What LocalBatch does of the same names: with a normal each, and at one point. Of files that serves_batches
/// approves; points are such as it approves, too.
struct LocalLoops {
    void (*sample)(const AcdfLocal&, const float (*)[3], const double (*)[2], std::size_t, AcdfDirectionSample*);
    void (*sample_at)(const AcdfLocal&, const AcdfLocalPoint&, const double (*)[2], std::size_t,
                      AcdfDirectionSample*);
    void (*pdf)(const AcdfLocal&, const float (*)[3], const float (*)[3], std::size_t, float*);
    void (*pdf_at)(const AcdfLocal&, const AcdfLocalPoint&, const float (*)[3], std::size_t, float*);
};

extern const LocalLoops local_avx2, local_avx512; // of files whose bins share tiles
extern const LocalLoops fast_avx2, fast_avx512;   // of the fast shape
#endif

} // namespace acdf
