// Tables of arrays.
#include "build/table.h"

#include "build/builder/arrays.h"
#include "build/builder/guard.h"
#include "build/builder/options.h"
#include "build/builder/sources.h"

#include <algorithm>
#include <stdexcept>

namespace acdf::builder {
namespace {

/// The bins that the first axes make; more than the limit is refused later.
std::uint64_t bin_count(const build::Array& array, std::uint32_t indexed) {
    constexpr std::uint64_t kMost = 1u << 28;
    std::uint64_t bins = 1;
    for (std::size_t axis = 0; axis < indexed && axis < array.shape.size(); ++axis)
        bins = std::min(kMost, bins * array.shape[axis]);
    return bins;
}

Table make(const build::Array& array, const BadNumbers& bad, const TableOptions& options,
           const build::Progress& progress) {
    build::TableOptions asked = internal(options, bin_count(array, options.indexed));
    build::Array other;
    if (options.mis.kind != ACDF_PARTNER_NONE) {
        check(options.other);
        BadNumbers bad_other;
        other = to_floats(options.other, bad_other);
        if (bad_other.count() > 0 && !options.bad_as_zero)
            throw std::invalid_argument("the partner: " + build::text(bad_other, other.shape));
        asked.other = &other;
    }
    build::Table made = build::build_table(array, options.source.name, options.source.sha256, asked, progress);
    Table out;
    out.bytes = std::move(made.bytes);
    out.accuracy = made.accuracy;
    out.total = made.total;
    out.bad = bad;
    return out;
}

} // namespace

Status table(const build::Array& array, const BadNumbers& bad, const TableOptions& options, Table& result,
             const Control& control) noexcept {
    return make_into(result, control, [&](Gate& gate) {
        check(options);
        return make(array, bad, options, gate.part(0.0, 1.0));
    });
}

Status table(const Array& array, const TableOptions& options, Table& result, const Control& control) noexcept {
    return make_into(result, control, [&](Gate& gate) {
        check(array);
        check(options);
        BadNumbers bad;
        const build::Array floats = to_floats(array, bad);
        if (bad.count() > 0 && !options.bad_as_zero) throw std::invalid_argument(build::text(bad, array.shape));
        gate.tell(0.1, "fitting");
        return make(floats, bad, options, gate.part(0.1, 0.9));
    });
}

} // namespace acdf::builder
