#include "compress/visibility/chunk.h"

#include "compress/fit/shared.h"
#include "compress/visibility/rows.h"

namespace acdf::compress {
namespace {

template <class Record>
void append(std::vector<std::uint8_t>& bytes, const Record* records, std::size_t count) {
    const auto* first = reinterpret_cast<const std::uint8_t*>(records);
    bytes.insert(bytes.end(), first, first + count * sizeof(Record));
}

} // namespace

void encode_visibility(const VisibilityParts& parts, const float* light, const float* factors, std::uint8_t* out) {
    constexpr double kUnseen = 1e-6; // of what no point of the cell sees: it has the factor of the cell around it
    std::vector<double> all(parts.boxes()), seen(parts.boxes());
    double whole = 0.0, visible = 0.0;
    for (std::size_t p = 0; p < parts.boxes(); ++p) {
        all[p] = double{light[p]} + kUnseen;
        seen[p] = all[p] * double{factors[p]};
        whole += all[p];
        visible += seen[p];
    }
    *out++ = visibility_code(whole > 0.0 ? visible / whole : 1.0);
    for (std::size_t p = parts.boxes(); p < parts.count(); ++p) *out++ = visibility_code(double{factors[p]});
    const std::vector<std::array<double, 2>> without = parts.sides(all.data()), with = parts.sides(seen.data());
    for (std::size_t c = 0; c < with.size(); ++c) {
        const double lower = with[c][0] / without[c][0], upper = with[c][1] / without[c][1];
        *out++ = row_code(lower, upper);
    }
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
