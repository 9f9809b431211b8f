// Payloads: which chunks a reader takes, and how those that are compressed are inflated.
#include "check/chunk_table.h"
#include "memory.h"
#include "planes.h"

#include <zlib.h>

#include <cstdlib>

namespace acdf {
namespace {

using u8 = std::uint8_t;
using u32 = std::uint32_t;
using u64 = std::uint64_t;
using ull = unsigned long long; // for printf

constexpr u32 known_types[known_chunks] = {
    ACDF_CHUNK_DESCRIPTION, ACDF_CHUNK_BINS,  ACDF_CHUNK_TREE,  ACDF_CHUNK_METADATA, ACDF_CHUNK_TILES,
    ACDF_CHUNK_ROWS,        ACDF_CHUNK_LOCAL, ACDF_CHUNK_VIEWS, ACDF_CHUNK_PARTNER,  ACDF_CHUNK_VISIBILITY,
    ACDF_CHUNK_PORTALS,     ACDF_CHUNK_SUMS,  ACDF_CHUNK_GRID,  ACDF_CHUNK_HALVINGS};

// Inflates a whole zlib stream to at most `out_size` bytes, and sets that to how many; null, or what is wrong.
const char* inflate_within(const u8* in, u64 in_size, u8* out, u64& out_size) {
    constexpr u64 step = u64{1} << 30; // zlib counts in 32 bits
    z_stream stream = {};
    if (inflateInit(&stream) != Z_OK) return "zlib cannot start";
    stream.next_in = const_cast<u8*>(in);
    stream.next_out = out;
    u64 in_left = in_size, out_left = out_size;
    int result = Z_OK;
    while (result == Z_OK) {
        const uInt in_now = static_cast<uInt>(in_left < step ? in_left : step);
        const uInt out_now = static_cast<uInt>(out_left < step ? out_left : step);
        stream.avail_in = in_now;
        stream.avail_out = out_now;
        result = inflate(&stream, Z_NO_FLUSH);
        in_left -= in_now - stream.avail_in;
        out_left -= out_now - stream.avail_out;
        if (result == Z_OK && stream.avail_in == in_now && stream.avail_out == out_now) break; // no progress
    }
    inflateEnd(&stream);
    if (result != Z_STREAM_END) return out_left == 0 ? "it goes on after `raw_length`" : "the stream is damaged";
    out_size -= out_left;
    return in_left != 0 ? "bytes follow the stream" : nullptr;
}

// The same to exactly `size` bytes.
const char* inflate_exactly(const u8* in, u64 in_size, u8* out, u64 size) {
    u64 inflated = size;
    const char* wrong = inflate_within(in, in_size, out, inflated);
    if (inflated != size) return "it ends before `raw_length`";
    return wrong;
}

// Inflates the planes of a tree of `size` bytes, and puts it together.
void inflate_tree(const AcdfChunk& chunk, const u8* in, u8* tree, Report& report, Payload& payload) {
    u64 size = 2 * chunk.raw_length + sizeof(AcdfPlanes); // more than those of any tree
    auto* planes = static_cast<u8*>(std::malloc(size));
    if (!planes) return report.add(1003, 0, "%llu bytes for planes", static_cast<ull>(size));
    const char* wrong = inflate_within(in, chunk.stored_length, planes, size);
    if (!wrong && !planes_to_tree(planes, size, tree, chunk.raw_length))
        wrong = "they are not those of such a tree";
    std::free(planes);
    if (wrong) return report.add(4005, chunk.offset, "planes: %s", wrong);
    payload = {tree, chunk.raw_length, chunk.offset, true};
}

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
                       "more than the limit of %llu bytes", static_cast<ull>(most));
            return false;
        }
        sum += length;
        block += round_up(length, ACDF_ALIGNMENT);
    }
    if (block == 0) return true;
    parts.inflated = take_block(allocator, static_cast<std::size_t>(block));
    if (!parts.inflated.data) report.add(1003, 0, "%llu bytes for inflated chunks", static_cast<ull>(block));
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
        if (chunk.codec == ACDF_CODEC_PLANES) {
            inflate_tree(chunk, bytes + chunk.offset, out, report, payloads.of[known]);
            block = after;
            continue;
        }
        payload = {out, chunk.raw_length, chunk.offset, true};
        if (const char* wrong = inflate_exactly(bytes + chunk.offset, chunk.stored_length, out, chunk.raw_length)) {
            report.add(4003, chunk.offset, "'%s': %s", ChunkName(chunk.type).text, wrong);
            continue;
        }
        block = after;
        payloads.of[known] = payload;
    }
}

} // namespace acdf
