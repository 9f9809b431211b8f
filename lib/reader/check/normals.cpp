// Rows of codes at the top of a tree of halvings, of normals or of views: chunks NORM and BINS.
#include "check/kinds.h"
#include "check/row_codes.h"

#include <cmath>

namespace acdf {

namespace {

bool check_normal_counts(const Payload& payload, const AcdfNormalsHeader& normals, Report& report,
                         const Parts& parts) {
    const bool right = normals.row_count > 0 && normals.row_count <= parts.description->bin_count &&
                       normals.split_count <= parts.halving_count &&
                       normals.code_bits >= ACDF_LEAST_MAP_CODE_BITS &&
                       normals.code_bits <= ACDF_MOST_ROW_CODE_BITS && normals.reserved == 0 &&
                       u64{normals.row_count} * normals.split_count <= ACDF_MOST_NORMAL_RATIO * payload.size;
    if (!right)
        report.add(6039, payload.at(0),
                   "NORM has %u rows, %u splits, codes of %u bits: too many, or `reserved` is not zero",
                   normals.row_count, normals.split_count, normals.code_bits);
    return right;
}

void check_normal_codes(const Payload& payload, u64 begin, const AcdfNormalsHeader& normals, Report& report,
                        const Parts& parts) {
    RowCodes codes(parts.halvings, payload.data + sizeof normals, normals.code_bits);
    Bits bits(payload, begin, payload.size);
    for (u32 row = 0; normals.split_count > 0 && row < normals.row_count; ++row)
        if (!codes.row(bits, [](u32, u32) {}))
            return report.add(6040, bits.place(), "row %u of NORM: %s", row, codes.wrong);
    if (bits.has(32)) return report.add(6039, bits.place(), "bytes are left over in NORM");
    while (bits.has(1))
        if (bits.take(1))
            return report.add(6038, payload.at(payload.size - 1), "padding behind the codes of NORM is not zero");
}

void check_normal_bins(const Payload& payload, u32 rows, Report& report, Parts& parts) {
    check_bins(payload, report, parts);
    for (u32 b = 0; parts.bins && b < parts.description->bin_count && !report.stopped(); ++b)
        if (parts.bins[b].root != ACDF_NO_ROOT && parts.bins[b].root >= rows)
            report.add(6026, payload.at(b * sizeof(AcdfBin)), "bin %u has row %u of %u", b, parts.bins[b].root,
                       rows);
}

} // namespace

void check_rows(const Payloads& payloads, Report& report, Parts& parts) noexcept {
    const Payload &payload = payloads.of[chunk_normals], &bins = payloads.of[chunk_bins];
    if (!payload.data || !bins.data || !parts.halvings || report.stopped()) return; // rule 3004
    const auto& normals = *reinterpret_cast<const AcdfNormalsHeader*>(payload.data);
    const u64 begin = sizeof normals + 4 * words_for(parts.halving_count);
    if (payload.size < begin || payload.size % 4 != 0)
        return report.add(6039, payload.at(0), "NORM has %llu bytes", static_cast<ull>(payload.size));
    if (!check_normal_counts(payload, normals, report, parts)) return;
    Bits splits(payload, sizeof normals, begin);
    if (!check_top(splits, normals.split_count, report, parts)) return;
    check_normal_codes(payload, begin, normals, report, parts);
    if (!report.stopped()) check_normal_bins(bins, normals.row_count, report, parts);
    parts.normal_splits = payload.data + sizeof normals;
    parts.normals_size = payload.size - sizeof normals;
    parts.normals = &normals;
}

void check_normals(const Payloads& payloads, Report& report, Parts& parts) noexcept {
    check_local_axes(payloads.of[chunk_description], report, parts);
    check_local_header(payloads.of[chunk_description], payloads.of[chunk_local], report, parts);
    check_rows(payloads, report, parts);
}

} // namespace acdf
