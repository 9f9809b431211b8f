/* How runtime tables are made by several threads: those of the caller. Plain C99 and C++17. */
#ifndef ACDF_PARALLEL_H
#define ACDF_PARALLEL_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* All null: by the thread that opens the file, alone. The tables are the same either way. */
typedef struct AcdfParallel {
    /* Calls task(of, i) once for each i < count, in any order and by any threads, and returns when all these calls
     * have. (A parallel loop of TBB or OpenMP, of a renderer's own pool.) */
    void (*run)(void* context, size_t count, void (*task)(void* of, size_t i), void* of);
    void* context;
} AcdfParallel;

#ifdef __cplusplus
}
#endif
#endif
