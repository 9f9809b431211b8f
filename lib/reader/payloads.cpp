// Payloads: which chunks a reader takes, and how those that are compressed are inflated.
#include "check/chunk_table.h"
#include "inflate.h"
#include "memory.h"
#ifndef ACDF_ENVIRONMENT_ONLY
#include "planes.h"
#endif

namespace acdf {
namespace {

constexpr u32 known_types[known_chunks] = {ACDF_CHUNK_DESCRIPTION, ACDF_CHUNK_BINS,       ACDF_CHUNK_TREE,
                                           ACDF_CHUNK_METADATA,    ACDF_CHUNK_LOCAL,      ACDF_CHUNK_VIEWS,
                                           ACDF_CHUNK_PARTNER,     ACDF_CHUNK_VISIBILITY, ACDF_CHUNK_PORTALS,
                                           ACDF_CHUNK_HALVINGS,    ACDF_CHUNK_MAPS,       ACDF_CHUNK_NORMALS};

bool is_compressed(const ChunkTable& table, u32 i) {
    const AcdfChunk& chunk = table.chunks[i];
    return table.inside[i] && known_chunk(chunk.type) >= 0 &&
           (chunk.codec == ACDF_CODEC_ZLIB ||
            (chunk.codec == ACDF_CODEC_PLANES && chunk.type == ACDF_CHUNK_TREE)) &&
           chunk.raw_length / 1032 <= chunk.stored_length;
}

// Memory for all compressed chunks in one block, each part at a multiple of 64; false where there is none.
bool allocate_inflated(const ChunkTable& table, const Limits& limits, const AcdfAllocator& allocator,
                       Report& report, Parts& parts) {
    constexpr u64 addressed = SIZE_MAX / 16; // with what is made of them: 256 MiB where addresses have 32 bits
    const u64 most = limits.max_inflated_bytes < addressed ? limits.max_inflated_bytes : addressed;
    u64 sum = 0, block = 0;
    for (u32 i = 0; i < table.count; ++i) {
        if (!is_compressed(table, i)) continue;
        const u64 length = table.chunks[i].raw_length;
        if (length > most - sum) {
            report.add(3012, table.offset_of(i) + offsetof(AcdfChunk, raw_length),
                       "chunks inflate to more than the limit of %llu bytes", static_cast<ull>(most));
            return false;
        }
        sum += length;
        block += round_up(length, ACDF_ALIGNMENT);
    }
    if (block == 0) return true;
    parts.inflated = take_block(allocator, static_cast<std::size_t>(block));
    if (!parts.inflated.data)
        report.add(1003, 0, "no memory for %llu bytes of inflated chunks", static_cast<ull>(block));
    return parts.inflated.data != nullptr;
}

} // namespace

int known_chunk(u32 type) noexcept {
    for (int i = 0; i < known_chunks; ++i)
        if (known_types[i] == type) return i;
    return -1;
}

void read_payloads(const ChunkTable& table, const u8* bytes, const Limits& limits, const AcdfAllocator& allocator,
                   Report& report, Parts& parts, Payloads& payloads) {
    const bool have_memory = allocate_inflated(table, limits, allocator, report, parts);
    u8* block = static_cast<u8*>(parts.inflated.data);
    for (u32 i = 0; i < table.count && !report.stopped(); ++i) {
        const AcdfChunk& chunk = table.chunks[i];
        const int known = known_chunk(chunk.type);
        if (known < 0 || !table.inside[i] || payloads.of[known].data) continue;
        Payload payload{bytes + chunk.offset, chunk.stored_length, chunk.offset, false};
        if (chunk.codec == ACDF_CODEC_NONE && chunk.raw_length == chunk.stored_length) payloads.of[known] = payload;
        if (!is_compressed(table, i) || !have_memory) continue;
        static u8 nothing; // zlib wants an address even for no bytes
        u8* const out = chunk.raw_length ? block : &nothing;
        u8* const after = block + round_up(chunk.raw_length, ACDF_ALIGNMENT);
#ifndef ACDF_ENVIRONMENT_ONLY
        if (chunk.codec == ACDF_CODEC_PLANES) {
            if (const char* wrong =
                    inflate_planes(bytes + chunk.offset, chunk.stored_length, out, chunk.raw_length))
                report.add(wrong == no_memory_for_planes ? 1003 : 4005, chunk.offset, "planes: %s", wrong);
            else payloads.of[known] = {out, chunk.raw_length, chunk.offset, true};
            block = after;
            continue;
        }
#endif
        payload = {out, chunk.raw_length, chunk.offset, true};
        if (const char* wrong = inflate(bytes + chunk.offset, chunk.stored_length, out, chunk.raw_length)) {
            report.add(4003, chunk.offset, "'%s': %s", ChunkName(chunk.type).text, wrong);
            continue;
        }
        block = after;
        payloads.of[known] = payload;
    }
}

} // namespace acdf
