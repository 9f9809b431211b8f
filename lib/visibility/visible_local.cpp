// Views of local environment files with their visibility cells and portals.
#include "reader/message.h"
#include "reader/opened_file.h"
#include "visibility/check.h"

#include <acdf/visibility/visibility_c.h>

namespace acdf {
namespace {

/// acdf_halving_share, by the compiler.
constexpr double share_of(unsigned code) {
    const double q = (1u << ACDF_ODDS_BITS) - 1u, j = 2.0 * code - q;
    const double even = 14.0 * q * q * q, odd = j * (11.0 * q * q + 3.0 * j * j);
    const double lower = even + odd, upper = even - odd;
    return static_cast<u32>(lower * lower / (lower * lower + upper * upper) * 2147483648.0 + 0.5) * 0x1p-31;
}

struct Odds {
    double of[256] = {};
    constexpr Odds() {
        for (unsigned code = 0; code < 256; ++code) of[code] = share_of(code);
    }
};
constexpr Odds odds;

} // namespace

const double (&visibility_odds)[256] = odds.of;

Verdict check_visibility(const AcdfFile& file, FindingSink sink, void* context, AcdfVisibleLocal& view) noexcept {
    Report report(sink, context);
    const Payload &cells = file.payloads.of[chunk_visibility], &portals = file.payloads.of[chunk_portals];
    if (cells.data && !file.rows)
        report.add(7009, cells.at(0), "there are visibility cells, but no rows of normals");
    else if (cells.data) check_cells(cells, file.rows->splits, report, view.cells);
    if (!portals.data || report.stopped()) return report.verdict();
    if (view.cells.header) check_portals(portals, view.cells.header->row_count, report, view.portals);
    else if (report.verdict().errors == 0)
        report.add(7016, portals.at(0), "there are portals, but no visibility cells");
    return report.verdict();
}

Verdict validate_visibility(const File& file, FindingSink sink, void* context) noexcept {
    AcdfVisibleLocal view = {};
    return check_visibility(*file.get(), sink, context, view);
}

} // namespace acdf

int acdf_visible_local(const AcdfFile* file, AcdfVisibleLocal* out, AcdfError* error) {
    AcdfError found = {};
    *out = {};
    if (!acdf_local(file, &out->local)) {
        found.code = ACDF_UNSUPPORTED;
        acdf::write_message(found.message, sizeof found.message, "the file has no local environment map");
    } else acdf::check_visibility(*file, acdf::first_error, &found, *out);
    if (error) *error = found;
    return found.code == ACDF_OK;
}

int acdf_visible_memory(const AcdfFile* file, AcdfMove* moves) {
    const int count = acdf_memory(file, moves);
    moves[count] = {acdf::visibility_odds, sizeof acdf::visibility_odds, nullptr};
    return count + 1;
}
