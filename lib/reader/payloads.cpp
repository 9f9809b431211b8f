// Payloads: which chunks a reader takes, and how those that are compressed are inflated.
#include "check/chunk_table.h"
#include "inflate.h"
#include "memory.h"

#include <acdf/curves_interface.h>

namespace acdf {
namespace {

// Whether a chunk is compressed and can be read: TREE by `curves` alone.
bool is_compressed(const ChunkTable& table, const AcdfCurves* curves, u32 i) {
    const AcdfChunk& chunk = table.chunks[i];
    const bool is_tree = chunk.type == ACDF_CHUNK_TREE;
    return table.inside[i] && known_chunk(chunk.type) >= 0 && (!is_tree || curves) &&
           (chunk.codec == ACDF_CODEC_ZLIB || (chunk.codec == ACDF_CODEC_PLANES && is_tree)) &&
           chunk.raw_length / 1032 <= chunk.stored_length;
}

// Memory for all compressed chunks in one block, each part at a multiple of 64; false where there is none.
bool allocate_inflated(const ChunkTable& table, const LoadOptions& options, Report& report, Parts& parts) {
    constexpr u64 addressed = SIZE_MAX / 16; // with what is made of them: 256 MiB where addresses have 32 bits
    const u64 limit = options.limits.max_inflated_bytes, most = limit < addressed ? limit : addressed;
    u64 sum = 0, block = 0;
    for (u32 i = 0; i < table.count; ++i) {
        if (!is_compressed(table, options.curves, i)) continue;
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
    parts.inflated = take_block(options.allocator, static_cast<std::size_t>(block));
    if (!parts.inflated.data)
        report.add(1003, 0, "no memory for %llu bytes of inflated chunks", static_cast<ull>(block));
    return parts.inflated.data != nullptr;
}

// Inflates a chunk to `raw_length` bytes. Returns 0, or the rule that is broken, and what is wrong.
int inflate_chunk(const AcdfChunk& chunk, const u8* bytes, const AcdfCurves* curves, u8* out, const char*& wrong) {
    const u8* const in = bytes + chunk.offset;
    if (chunk.codec == ACDF_CODEC_PLANES)
        return curves->inflate(in, chunk.stored_length, out, chunk.raw_length, &wrong);
    wrong = inflate(in, chunk.stored_length, out, chunk.raw_length);
    return wrong ? 4003 : 0;
}

} // namespace

int known_chunk(u32 type) noexcept {
    for (int i = 0; i < known_chunks; ++i)
        if (known_rules[i].type == type) return i;
    return -1;
}

void read_payloads(const ChunkTable& table, const u8* bytes, const LoadOptions& options, Report& report,
                   Parts& parts, Payloads& payloads) {
    const bool have_memory = allocate_inflated(table, options, report, parts);
    u8* block = static_cast<u8*>(parts.inflated.data);
    for (u32 i = 0; i < table.count && !report.stopped(); ++i) {
        const AcdfChunk& chunk = table.chunks[i];
        const int known = known_chunk(chunk.type);
        if (known < 0 || !table.inside[i] || payloads.of[known].data) continue;
        if (chunk.codec == ACDF_CODEC_NONE && chunk.raw_length == chunk.stored_length)
            payloads.of[known] = {bytes + chunk.offset, chunk.stored_length, chunk.offset, false};
        if (!is_compressed(table, options.curves, i) || !have_memory) continue;
        static u8 nothing; // zlib wants an address even for no bytes
        u8* const out = chunk.raw_length ? block : &nothing;
        const char* wrong = nullptr;
        if (const int rule = inflate_chunk(chunk, bytes, options.curves, out, wrong))
            report.add(rule, chunk.offset, "'%s': %s", ChunkName(chunk.type).text, wrong);
        else payloads.of[known] = {out, chunk.raw_length, chunk.offset, true};
        block += round_up(chunk.raw_length, ACDF_ALIGNMENT);
    }
}

} // namespace acdf
