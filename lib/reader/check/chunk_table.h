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

/// What is known of a type of chunk.
struct ChunkRule {
    u32 type;
    /// In files of which kinds it may be, and must be with HALV and without it, a bit each.
    u8 may, must_halved, must_curved;
    bool critical; ///< whether readers that do not know it must refuse the file
};
/// In the order of KnownChunk. LOCL and VIEW that are missing are rules 7005 and 8003.
constexpr ChunkRule known_rules[known_chunks] = {
    {ACDF_CHUNK_DESCRIPTION, 0x3E, 0x3E, 0x3E, true}, {ACDF_CHUNK_BINS, 0x3E, 0x1C, 0x1E, true},
    {ACDF_CHUNK_TREE, 0x2E, 0x00, 0x0E, true},        {ACDF_CHUNK_METADATA, 0x3E, 0x00, 0x00, false},
    {ACDF_CHUNK_LOCAL, 0x04, 0x00, 0x00, true},       {ACDF_CHUNK_VIEWS, 0x08, 0x00, 0x00, true},
    {ACDF_CHUNK_PARTNER, 0x16, 0x00, 0x00, true},     {ACDF_CHUNK_VISIBILITY, 0x04, 0x00, 0x00, false},
    {ACDF_CHUNK_PORTALS, 0x04, 0x00, 0x00, false},    {ACDF_CHUNK_HALVINGS, 0x3E, 0x3E, 0x30, true},
    {ACDF_CHUNK_MAPS, 0x20, 0x20, 0x20, true},        {ACDF_CHUNK_NORMALS, 0x0C, 0x0C, 0x00, true}};

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
