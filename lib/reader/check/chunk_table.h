// The chunk table of a file, and what its payloads hold. Not installed.
#pragma once

#include "check/checker.h"

namespace acdf {

struct ChunkTable {
    const AcdfChunk* chunks;
    u32 count;
    bool inside[ACDF_MAX_CHUNKS]; // the payload lies in the file, where it should
    bool legal;                   // so do all: the gaps between them are padding

    u64 offset_of(u32 i) const { return sizeof(AcdfHeader) + u64{i} * sizeof(AcdfChunk); }
    u64 end() const { return offset_of(count); }
};

/// Types of chunks that are known, in the order of KnownChunk.
constexpr u32 known_types[known_chunks] = {ACDF_CHUNK_DESCRIPTION, ACDF_CHUNK_BINS,       ACDF_CHUNK_TREE,
                                           ACDF_CHUNK_METADATA,    ACDF_CHUNK_LOCAL,      ACDF_CHUNK_VIEWS,
                                           ACDF_CHUNK_PARTNER,     ACDF_CHUNK_VISIBILITY, ACDF_CHUNK_PORTALS,
                                           ACDF_CHUNK_HALVINGS,    ACDF_CHUNK_MAPS,       ACDF_CHUNK_NORMALS};

/// The number of a chunk among those that this reader knows, or -1.
int known_chunk(u32 type) noexcept;

inline bool is_printable(u32 type, int byte) noexcept {
    const u32 c = type >> 8 * byte & 0xFF;
    return c >= 0x20 && c <= 0x7E;
}

/// The four characters of a type, those that do not print as '?'.
struct ChunkName {
    char text[5];
    explicit ChunkName(u32 type) {
        for (int i = 0; i < 4; ++i) text[i] = is_printable(type, i) ? static_cast<char>(type >> 8 * i) : '?';
        text[4] = 0;
    }
};

/// Finds the payloads of all known chunks, and inflates those that are compressed within the limits.
ACDF_ONCE void read_payloads(const ChunkTable& table, const u8* bytes, const LoadOptions& options, Report& report,
                             Parts& parts, Payloads& payloads);

} // namespace acdf
