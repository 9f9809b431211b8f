/* Opens the view of an environment of several maps: of a file that acdf/acdf.h opened. Valid C99 and C++17.
 *
 *   AcdfIndexed day;
 *   if (!acdf_indexed(file, &day, &error)) { ... error.message ... }
 *   acdf_indexed_at(&day, coordinates, &sky);  // acdf/indexed/indexed.h
 *   acdf_indexed_close(&day);                  // before or after acdf_close(file); `day` and `sky` end with either
 *
 * Whoever opens a file checks all but chunk MAPS and the axes of maps. These are checked here, in time linear in
 * their bytes: any file may be passed in. What was accepted can be sampled for ever without reading outside it. */
#ifndef ACDF_INDEXED_OPEN_H
#define ACDF_INDEXED_OPEN_H

#include <acdf/acdf.h>
#include <acdf/indexed/indexed.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Checks the maps of an open file, and makes their view. Its tables come from the file's allocator: for each map
 * and split some 8 bytes, 16 times the chunk MAPS at most. Returns 1. Returns 0, and leaves `out` zero, where
 * `file` is null or of another kind (ACDF_UNSUPPORTED), where a rule is broken (ACDF_MALFORMED), and where memory
 * fails. `error` may be null; it is written on success, too. */
int acdf_indexed(const AcdfFile* file, AcdfIndexed* out, AcdfError* error);

/* Gives back the tables that acdf_indexed made, and sets the view to zero. A view that is zero is allowed, one that
 * was moved (acdf/indexed/moved.h) or copied is not. */
void acdf_indexed_close(AcdfIndexed* maps);

/* The memory that the view of `file` points into, to be copied: moves[ACDF_MAX_MOVES], `to` of which are null.
 * Returns how many there are (acdf/indexed/moved.h). */
int acdf_indexed_memory(const AcdfFile* file, const AcdfIndexed* maps, AcdfMove* moves);

#ifdef __cplusplus
}
#endif
#endif
