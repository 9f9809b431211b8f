// The chunk table of a file, and what its payloads hold. Not installed.
#pragma once

#include "check/checker.h"

namespace acdf {

struct ChunkTable {
    const AcdfChunk* chunks;
    std::uint32_t count;
    bool inside[ACDF_MAX_CHUNKS]; // the payload lies in the file, where it should
    bool legal;                   // so do all: the gaps between them are padding

    std::uint64_t offset_of(std::uint32_t i) const {
        return sizeof(AcdfHeader) + std::uint64_t{i} * sizeof(AcdfChunk);
    }
    std::uint64_t end() const { return offset_of(count); }
};

/// The number of a chunk among those that this reader knows, or -1.
int known_chunk(std::uint32_t type) noexcept;

inline bool is_printable(std::uint32_t type, int byte) noexcept {
    const std::uint32_t c = type >> 8 * byte & 0xFF;
    return c >= 0x20 && c <= 0x7E;
}

/// The four characters of a type, those that do not print as '?'.
struct ChunkName {
    char text[5];
    explicit ChunkName(std::uint32_t type) {
        for (int i = 0; i < 4; ++i) text[i] = is_printable(type, i) ? static_cast<char>(type >> 8 * i) : '?';
        text[4] = 0;
    }
};

/// Finds the payloads of all known chunks, and inflates those that are compressed within `limits`.
ACDF_ONCE void read_payloads(const ChunkTable& table, const std::uint8_t* bytes, const Limits& limits,
                             const AcdfAllocator& allocator, Report& report, Parts& parts, Payloads& payloads);

} // namespace acdf
