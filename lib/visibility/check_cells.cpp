// How much of the light reaches a position: PLAC. Linear in its bytes.
#include "visibility/check.h"

#include <cmath>

namespace acdf {

namespace {

u64 columns_at(const AcdfVisibility& header) {
    return sizeof header + u64{header.split_count} * sizeof(AcdfVisibilitySplit);
}
u64 sets_at(const AcdfVisibility& header) {
    return columns_at(header) + (1 + u64{header.further_sets}) * header.column_count * sizeof(AcdfColumn);
}
// Rows begin where columns and their sets end: they need no alignment.
u64 rows_at(const AcdfVisibility& header) {
    return sets_at(header) + (header.further_sets > 0 ? u64{header.row_count} * sizeof(u16) : 0);
}

bool check_size(const Payload& payload, u32 top_splits, Report& report) {
    if (payload.size < sizeof(AcdfVisibility)) {
        report.add(7009, payload.at(0), "PLAC has %llu bytes", static_cast<ull>(payload.size));
        return false;
    }
    const AcdfVisibility& h = *reinterpret_cast<const AcdfVisibility*>(payload.data);
    if (h.row_count < 1 || h.row_count >= ACDF_VISIBILITY_ROW || h.split_count >= ACDF_VISIBILITY_ROW ||
        h.column_count > top_splits || h.column_count >= ACDF_MAX_COLUMNS || h.further_sets > 0xFFFF) {
        report.add(7009, payload.at(0), "PLAC has %u splits, %u rows, %u columns, %u further sets of them",
                   h.split_count, h.row_count, h.column_count, h.further_sets);
        return false;
    }
    const u64 size = rows_at(h) + u64{h.row_count} * (1 + u64{h.column_count});
    if (payload.size != size)
        report.add(7009, payload.at(0), "PLAC has %llu bytes instead of %llu", static_cast<ull>(payload.size),
                   static_cast<ull>(size));
    return payload.size == size;
}

void check_bounds(const Payload& payload, const AcdfVisibility& h, Report& report) {
    for (u32 k = 0; k < 3; ++k) {
        bool right = std::isfinite(h.low[k]) && std::isfinite(h.high[k]) && h.low[k] < h.high[k];
        for (const float t : h.transform[k]) right = right && std::isfinite(t);
        if (!right)
            report.add(7010, payload.at(offsetof(AcdfVisibility, low)),
                       "coordinate %u of cells: bounds and transform must be finite, `low` less than `high`", k);
    }
}

// Visits the splits in preorder. A path's upper parts wait on a stack as deep as paths may be.
bool check_splits(const Payload& payload, const AcdfVisibility& h, const AcdfVisibilitySplit* splits,
                  Report& report) {
    struct Open {
        u32 node, depth;
    } open[ACDF_MAX_VISIBILITY_DEPTH + 1];
    const auto at = [&](u32 split) { return payload.at(sizeof h + u64{split} * sizeof *splits); };
    u32 count = 0, next = 0;
    open[count++] = {h.split_count > 0 ? 0 : ACDF_VISIBILITY_ROW, 0};
    while (count > 0) {
        const Open now = open[--count];
        if (now.node & ACDF_VISIBILITY_ROW) {
            if ((now.node & ~ACDF_VISIBILITY_ROW) < h.row_count) continue;
            report.add(7011, at(0), "a cell has row %u of %u", now.node & ~ACDF_VISIBILITY_ROW, h.row_count);
            return false;
        }
        if (now.node != next || next >= h.split_count || now.depth == ACDF_MAX_VISIBILITY_DEPTH) {
            report.add(7011, at(0), "split %u of cells, %u deep, comes where %u of %u is due", now.node, now.depth,
                       next, h.split_count);
            return false;
        }
        const AcdfVisibilitySplit& split = splits[next];
        if ((split.lower & 7u) > 5 || !std::isfinite(split.position))
            report.add(7012, at(next), "split %u of cells is on axis %u, or at no finite position", next,
                       split.lower & 7u);
        ++next;
        open[count++] = {split.upper, now.depth + 1};
        open[count++] = {split.lower >> 3, now.depth + 1};
    }
    if (next != h.split_count) report.add(7011, at(0), "%u of %u splits of cells are met", next, h.split_count);
    return next == h.split_count;
}

// Visits the columns of a set in preorder. The upper parts of a path wait on a stack as deep as paths may be.
bool are_columns(const AcdfColumn* columns, u32 count, u32 top_splits) {
    struct Open {
        u32 column, first, end, depth;
    } open[ACDF_MAX_COLUMNS_DEEP + 1];
    u32 waiting = 0, next = 0;
    if (count > 0) open[waiting++] = {0, 0, top_splits + 1, 1};
    while (waiting > 0) {
        const Open now = open[--waiting];
        if (now.column != next || next == count || now.depth > ACDF_MAX_COLUMNS_DEEP) return false;
        const AcdfColumn& column = columns[next++];
        if (column.tile <= now.first || column.tile >= now.end) return false;
        if (column.parts & 0x7FFFu) open[waiting++] = {column.parts & 0x7FFFu, column.tile, now.end, now.depth + 1};
        if (!(column.parts & 0x8000u)) open[waiting++] = {next, now.first, column.tile, now.depth + 1};
    }
    return next == count;
}

bool check_columns(const Payload& payload, const AcdfVisibility& h, const AcdfColumn* columns, u32 top_splits,
                   Report& report) {
    for (u32 set = 0; set <= h.further_sets; ++set) {
        if (are_columns(columns + u64{set} * h.column_count, h.column_count, top_splits)) continue;
        report.add(7013, payload.at(columns_at(h)), "set %u of %u columns is no tree in preorder over the tiles",
                   set, h.column_count);
        return false;
    }
    return true;
}

bool check_sets(const Payload& payload, const AcdfVisibility& h, const u16* set_of_row, Report& report) {
    for (u32 row = 0; set_of_row && row < h.row_count; ++row) {
        if (set_of_row[row] <= h.further_sets) continue;
        report.add(7015, payload.at(sets_at(h) + u64{row} * sizeof *set_of_row), "row %u has set %u of %u", row,
                   set_of_row[row], h.further_sets + 1);
        return false;
    }
    return true;
}

void check_odds(const Payload& payload, const AcdfVisibilityTable& table, Report& report) {
    const AcdfVisibility& h = *table.header;
    const u64 width = 1 + u64{h.column_count};
    for (u32 row = 0; row < h.row_count; ++row)
        for (u64 i = 1; i < width; ++i) {
            const u8 code = table.rows[row * width + i];
            if (code != 0 && code != 255) continue;
            report.add(7014, payload.at(rows_at(h) + row * width + i),
                       "row %u gives nothing to a side of a column: code %u", row, code);
            return;
        }
}

} // namespace

void check_cells(const Payload& payload, u32 splits, Report& report, AcdfVisibilityTable& cells) noexcept {
    if (!check_size(payload, splits, report)) return;
    const auto* header = reinterpret_cast<const AcdfVisibility*>(payload.data);
    const auto* parts = reinterpret_cast<const AcdfVisibilitySplit*>(header + 1);
    const auto* columns = reinterpret_cast<const AcdfColumn*>(parts + header->split_count);
    const auto* set_of_row = reinterpret_cast<const u16*>(payload.data + sets_at(*header));
    const AcdfVisibilityTable table{header,
                                    parts,
                                    columns,
                                    header->further_sets > 0 ? set_of_row : nullptr,
                                    payload.data + rows_at(*header),
                                    visibility_odds};
    check_bounds(payload, *header, report);
    const bool split = check_splits(payload, *header, parts, report);
    const bool sets = check_sets(payload, *header, table.set_of_row, report);
    const bool right = check_columns(payload, *header, columns, splits, report);
    check_odds(payload, table, report);
    if (split && sets && right) cells = table;
}

} // namespace acdf
