/* Views of an open file whose memory was copied elsewhere: to a GPU, another process, an archive of the
 * caller's. Freestanding, valid C99 and C++17.
 *
 *   AcdfMove moves[ACDF_MAX_MOVES];
 *   int i, count = acdf_memory(file, moves);          // what the views of an open file point into
 *   for (i = 0; i < count; ++i) moves[i].to = ...;    // a copy of moves[i].bytes bytes at moves[i].from
 *   acdf_move_environment(&sky, moves, count);        // `sky` now is for where the copies are
 *
 * Views of curves cannot be moved, for functions are not copied: they become empty.
 * Copies are aligned to 64 bytes, and are followed by up to 3 bytes that may be read, of any value. Nothing is read
 * or written here but the view. Pointers that are null stay null; others all point into a file's memory. */
#ifndef ACDF_MOVED_H
#define ACDF_MOVED_H

#include <acdf/brdf.h>
#include <acdf/local.h>
#include <acdf/table.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Memory of an open file, and its copy. */
typedef struct AcdfMove {
    const void* from;
    size_t bytes; /* > 0 */
    const void* to;
} AcdfMove;

/* The file's bytes, what was inflated of them, and runtime tables: two where normals or views have rows of
 * halvings. */
enum { ACDF_MAX_MOVES = 4 };

/* Where what is at `pointer` lies in the copies. */
static inline const void* acdf_moved(const void* pointer, const AcdfMove* moves, int count) {
    const uintptr_t at = (uintptr_t)pointer;
    int i;
    for (i = 0; i < count; ++i)
        if (at - (uintptr_t)moves[i].from < moves[i].bytes)
            return (const void*)((uintptr_t)moves[i].to + (at - (uintptr_t)moves[i].from));
    return 0; /* also of arrays without elements */
}
#define ACDF_MOVE(type, pointer) (pointer) = (const type*)acdf_moved((pointer), moves, count)

/* Points a view into the copies, of which there are `count`. */
static inline void acdf_move_environment(AcdfEnvironment* environment, const AcdfMove* moves, int count) {
    if (environment->curves) environment->columns = 0;
    environment->curves = 0;
    environment->tree = 0;
    ACDF_MOVE(AcdfHalvedTree, environment->halved);
    ACDF_MOVE(AcdfPartner, environment->partner);
}

/* The same of a local environment. */
static inline void acdf_move_local(AcdfLocal* local, const AcdfMove* moves, int count) {
    acdf_move_environment(&local->environment, moves, count);
    ACDF_MOVE(AcdfBin, local->bins);
    ACDF_MOVE(AcdfPartner, local->partner);
    ACDF_MOVE(AcdfNormalRows, local->rows_of_normals);
}

/* The same of a BRDF. */
static inline void acdf_move_brdf(AcdfBrdf* brdf, const AcdfMove* moves, int count) {
    if (brdf->curves) brdf->columns = 0;
    brdf->curves = 0;
    brdf->tree = 0;
    ACDF_MOVE(AcdfHalvedTree, brdf->halved);
    ACDF_MOVE(AcdfNormalRows, brdf->rows_of_views);
    ACDF_MOVE(AcdfBin, brdf->bins);
    ACDF_MOVE(AcdfViews, brdf->views);
    ACDF_MOVE(float, brdf->nodes);
}

/* The same of a table. */
static inline void acdf_move_table(AcdfTable* table, const AcdfMove* moves, int count) {
    ACDF_MOVE(AcdfHalving, table->nodes);
    ACDF_MOVE(AcdfBin, table->bins);
    ACDF_MOVE(AcdfAxis, table->axes);
    ACDF_MOVE(AcdfPartner, table->partner);
}
#undef ACDF_MOVE

#ifdef __cplusplus
}
#endif
#endif
