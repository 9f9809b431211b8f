/* The view of an environment of several maps whose memory was copied elsewhere: acdf/moved.h, with
 * acdf_indexed_memory in place of acdf_memory. Freestanding, valid C99 and C++17.
 *
 *   AcdfMove moves[ACDF_MAX_MOVES];
 *   int i, count = acdf_indexed_memory(file, &day, moves);
 *   for (i = 0; i < count; ++i) moves[i].to = ...;
 *   AcdfIndexed there = day;
 *   acdf_move_indexed(&there, moves, count);    // mixtures are made of it where the copies are */
#ifndef ACDF_INDEXED_MOVED_H
#define ACDF_INDEXED_MOVED_H

#include <acdf/indexed/indexed.h>
#include <acdf/moved.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Points a view into the copies, of which there are `count`. It owns nothing: only the view that acdf_indexed made
 * is closed. */
static inline void acdf_move_indexed(AcdfIndexed* maps, const AcdfMove* moves, int count) {
    const AcdfBlock none = {0, 0};
    maps->coordinates = (const double*)acdf_moved(maps->coordinates, moves, count);
    maps->maps = (const AcdfMap*)acdf_moved(maps->maps, moves, count);
    maps->halved = (const AcdfHalvedTree*)acdf_moved(maps->halved, moves, count);
    maps->top = (const AcdfTop*)acdf_moved(maps->top, moves, count);
    maps->tables = none;
}

#ifdef __cplusplus
}
#endif
#endif
