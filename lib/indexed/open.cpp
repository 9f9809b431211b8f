// Views of environments of several maps.
#include "indexed/check.h"
#include "indexed/tables.h"
#include "reader/memory.h"

#include <acdf/indexed/open.h>

namespace acdf {
namespace {

AcdfIndexed view_of(const AcdfFile& file, const Maps& maps) {
    AcdfIndexed out = {};
    out.columns = file.axes[ACDF_AXIS_PHI].resolution;
    out.rows = file.axes[ACDF_AXIS_THETA].resolution;
    out.parameterization = file.description->parameterization;
    out.axes = file.description->axis_count - 2;
    for (u32 axis = 0; axis < out.axes; ++axis) out.counts[axis] = file.axes[2 + axis].resolution;
    out.sun = maps.header->sun;
    out.total = file.description->total;
    out.coordinates = maps.coordinates;
    out.maps = maps.maps;
    out.halved = file.environment.halved;
    out.allocator = file.allocator;
    return out;
}

// `out`, which is zero, stays so where this fails.
void open_maps(const AcdfFile* file, AcdfIndexed& out, AcdfError& error) noexcept {
    Report report(first_error, &error);
    if (!file || file->kind() != ACDF_KIND_INDEXED)
        return report.add(2006, offsetof(AcdfHeader, kind), "the file holds no environments of several maps");
    Parts parts;
    take_parts(*file, parts);
    const Maps maps = check_maps(*file, parts, report);
    if (error.code != ACDF_OK) return;
    AcdfIndexed view = view_of(*file, maps);
    view.top = make_top(parts, maps, acdf_halved_heights(view.halved), file->allocator, view.tables);
    if (view.top) out = view;
    else
        report.add(1003, 0, "no memory for %u maps of %u splits", maps.header->map_count, maps.header->split_count);
}

} // namespace
} // namespace acdf

int acdf_indexed(const AcdfFile* file, AcdfIndexed* out, AcdfError* error) {
    AcdfError found = {};
    *out = {};
    acdf::open_maps(file, *out, found);
    if (error) *error = found;
    return found.code == ACDF_OK;
}

void acdf_indexed_close(AcdfIndexed* maps) {
    acdf::give_block(maps->allocator, maps->tables);
    *maps = {};
}

int acdf_indexed_memory(const AcdfFile* file, const AcdfIndexed* maps, AcdfMove* moves) {
    int count = acdf_memory(file, moves);
    if (maps->tables.data) moves[count++] = {maps->tables.data, maps->tables.bytes, nullptr};
    return count;
}
