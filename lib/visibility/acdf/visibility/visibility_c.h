/* The view of a local environment file with its visibility cells and portals, in C. Linked (acdf::visibility).
 * Valid C99 and C++17.
 *
 *   AcdfVisibleLocal light;
 *   AcdfVisiblePoint point;
 *   if (!acdf_visible_local(file, &light, &error)) { ... error.message ... }   // once a file
 *   acdf_visible_at(&light, position, normal, &point);                         // once a shading point
 *   s = acdf_visible_sample(&light, &point, u0, u1);
 *   p = acdf_visible_pdf(&light, &point, direction);
 */
#ifndef ACDF_VISIBILITY_C_H
#define ACDF_VISIBILITY_C_H

#include <acdf/acdf.h>
#include <acdf/moved.h>
#include <acdf/visibility/visible_local.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Makes the view of an open local environment file. Checks what the file stores of cells and portals (rules 7009 to
 * 7019 of SPEC.md) in time linear in their size, and allocates nothing. A file without cells gives a view for which
 * the normal alone counts. Returns 1; or 0, and `out` is unset, where a rule is broken or the file is of another
 * kind or null. `error` may be null; it is written on success too. The view is valid while `file` is open. */
int acdf_visible_local(const AcdfFile* file, AcdfVisibleLocal* out, AcdfError* error);

/* The memory that the view points into, to be copied (acdf/moved.h): that of acdf_memory, and a table of the
 * library. moves[ACDF_MAX_VISIBLE_MOVES], `to` of which are null. Returns how many there are. */
enum { ACDF_MAX_VISIBLE_MOVES = ACDF_MAX_MOVES + 1 };
int acdf_visible_memory(const AcdfFile* file, AcdfMove* moves);

/* Points a view into the copies, of which there are `count`. */
static inline void acdf_move_visible_local(AcdfVisibleLocal* view, const AcdfMove* moves, int count) {
    AcdfVisibilityTable* cells = &view->cells;
    AcdfPortalTable* portals = &view->portals;
    acdf_move_local(&view->local, moves, count);
    cells->header = (const AcdfVisibility*)acdf_moved(cells->header, moves, count);
    cells->splits = (const AcdfVisibilitySplit*)acdf_moved(cells->splits, moves, count);
    cells->columns = (const AcdfColumn*)acdf_moved(cells->columns, moves, count);
    cells->set_of_row = (const uint16_t*)acdf_moved(cells->set_of_row, moves, count);
    cells->rows = (const uint8_t*)acdf_moved(cells->rows, moves, count);
    cells->odds = (const double*)acdf_moved(cells->odds, moves, count);
    portals->header = (const AcdfPortals*)acdf_moved(portals->header, moves, count);
    portals->portals = (const AcdfPortal*)acdf_moved(portals->portals, moves, count);
    portals->maps = (const AcdfPortalMap*)acdf_moved(portals->maps, moves, count);
    portals->sums = (const uint32_t*)acdf_moved(portals->sums, moves, count);
    portals->rows = (const uint8_t*)acdf_moved(portals->rows, moves, count);
}

#ifdef __cplusplus
}
#endif
#endif
