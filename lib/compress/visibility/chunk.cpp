#include "compress/visibility/chunk.h"

#include "compress/halvings/codes.h"
#include "compress/visibility/rows.h"

#include <acdf/halvings.h>

namespace acdf::compress {
namespace {

template <class Record>
void append(std::vector<std::uint8_t>& bytes, const Record* records, std::size_t count) {
    const auto* first = reinterpret_cast<const std::uint8_t*>(records);
    bytes.insert(bytes.end(), first, first + count * sizeof(Record));
}

/// What parts would give, and what arrives of it.
struct Given {
    double all = 0.0, seen = 0.0;

    double share(const Given& before) const { return (seen - before.seen) / (all - before.all); }
};

/// The odds of the column that parts [first, end) are parted at, and of those below it.
void encode_odds(const VisibilityParts& parts, const std::vector<Given>& before, std::size_t first, std::size_t end,
                 std::uint8_t*& out, std::size_t& column) {
    static const HalvingCodes codes(ACDF_ODDS_BITS);
    if (end - first < 2) return;
    const std::size_t middle = parts.part_of_column()[column++];
    const double lower = before[middle].share(before[first]), upper = before[end].share(before[middle]);
    *out++ = static_cast<std::uint8_t>(codes.best(ACDF_STEPS, lower, upper, 1.0, 1.0));
    encode_odds(parts, before, first, middle, out, column);
    encode_odds(parts, before, middle, end, out, column);
}

} // namespace

void encode_visibility(const VisibilityParts& parts, const float* light, const float* factors, std::uint8_t* out) {
    constexpr double kUnseen = 1e-6; // of what no point of the cell sees: it has the factor of the cell around it
    Given whole;
    std::vector<Given> before{whole}; // all parts before each
    for (std::size_t p = 0; p < parts.count(); ++p) {
        const double all = double{light[p]} + kUnseen;
        whole = {whole.all + all, whole.seen + all * double{factors[p]}};
        before.push_back(whole);
    }
    *out++ = visibility_code(whole.seen / whole.all);
    std::size_t column = 0;
    encode_odds(parts, before, 0, parts.count(), out, column);
}

Chunk VisibilityChunk::stored() const {
    Chunk out{ACDF_CHUNK_VISIBILITY, {}};
    append(out.bytes, &header, 1);
    append(out.bytes, splits.data(), splits.size());
    append(out.bytes, columns.data(), columns.size());
    append(out.bytes, set_of_row.data(), set_of_row.size());
    append(out.bytes, rows.data(), rows.size());
    return out;
}

} // namespace acdf::compress
