#include "compress/store/store.h"

#include "compress/store/planes.h"

#include <acdf/sample.h>

#include <zlib.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <stdexcept>

namespace acdf::compress {
namespace {

using Bytes = std::vector<std::uint8_t>;

template <class T>
void append(Bytes& bytes,
            const T& value) { // of a little-endian machine, which CMake checks
    const auto* data = reinterpret_cast<const std::uint8_t*>(&value);
    bytes.insert(bytes.end(), data, data + sizeof value);
}

struct Payload {
    std::uint32_t type;
    std::uint32_t flags;
    Bytes raw;
};

} // namespace

Bytes description_payload(const Description& d) {
    AcdfDescription out = {};
    out.parameterization = d.parameterization;
    out.fit = d.fit;
    out.filter = d.filter;
    out.up_axis = ACDF_UP_Z;
    out.handedness = ACDF_RIGHT_HANDED;
    out.axis_count = static_cast<std::uint32_t>(d.axes.size());
    out.bin_count = static_cast<std::uint32_t>(d.shares.size());
    out.channels = d.channels;
    std::memcpy(out.channel_weights, d.channel_weights, sizeof out.channel_weights);
    out.total = d.total;
    Bytes bytes;
    append(bytes, out);
    for (const AxisDescription& axis : d.axes) {
        AcdfAxis record = {};
        if (axis.name.size() >= sizeof record.name)
            throw std::invalid_argument("an axis name of more than 15 bytes");
        std::memcpy(record.name, axis.name.data(), axis.name.size());
        record.role = axis.role;
        record.measure = axis.measure;
        record.resolution = axis.resolution;
        record.low = axis.low;
        record.high = axis.high;
        append(bytes, record);
    }
    return bytes;
}

namespace {

Bytes bins_payload(const std::vector<std::uint32_t>& roots, const Description& d) {
    if (roots.size() != d.shares.size()) throw std::invalid_argument("one share a bin is needed");
    Bytes bytes;
    for (std::size_t i = 0; i < roots.size(); ++i) append(bytes, AcdfBin{roots[i], d.shares[i]});
    return bytes;
}

} // namespace

Bytes metadata_payload(const Metadata& metadata) {
    Bytes bytes;
    append(bytes, static_cast<std::uint32_t>(metadata.size()));
    const auto text = [&](const std::string& s) {
        append(bytes, static_cast<std::uint32_t>(s.size()));
        bytes.insert(bytes.end(), s.begin(), s.end());
    };
    for (const auto& [key, value] : metadata) text(key), text(value);
    return bytes;
}

namespace {

std::uint32_t crc(const std::uint8_t* data, std::size_t size, std::uint32_t seed = 0) {
    return static_cast<std::uint32_t>(crc32_z(seed, data, size));
}

Bytes deflated(const Bytes& raw) {
    uLongf size = compressBound(static_cast<uLong>(raw.size()));
    Bytes out(size);
    if (compress2(out.data(), &size, raw.data(), static_cast<uLong>(raw.size()), Z_BEST_COMPRESSION) != Z_OK)
        throw std::runtime_error("zlib could not compress a chunk");
    out.resize(size);
    return out;
}

/// Puts deflated bytes in place of the payload, of a tree those of its planes where they are fewer; a chunk that
/// would grow is stored as it is.
void compress_payload(Payload& payload, AcdfChunk& chunk) {
    const Bytes planes = payload.type == ACDF_CHUNK_TREE ? tree_to_planes(payload.raw) : Bytes();
    Bytes small = deflated(payload.raw), smaller = planes.empty() ? Bytes() : deflated(planes);
    // Padding, which planes leave out, could make the tree longer than rule 3011 lets it be.
    const bool take = !planes.empty() && smaller.size() < small.size() && chunk.raw_length / 1032 <= smaller.size();
    if (take) small = std::move(smaller);
    if (small.size() >= payload.raw.size()) return;
    chunk.codec = take ? ACDF_CODEC_PLANES : ACDF_CODEC_ZLIB;
    payload.raw = std::move(small);
}

std::size_t rounded(std::size_t offset) { return (offset + ACDF_ALIGNMENT - 1) / ACDF_ALIGNMENT * ACDF_ALIGNMENT; }

Bytes assemble(AcdfKind kind, std::vector<Payload> payloads, AcdfCodec codec) {
    std::vector<ChunkView> chunks;
    for (Payload& payload : payloads) {
        AcdfChunk chunk = {};
        chunk.raw_length = payload.raw.size();
        if (codec == ACDF_CODEC_ZLIB && payload.type != ACDF_CHUNK_METADATA) compress_payload(payload, chunk);
        chunks.push_back(
            {payload.type, payload.flags, chunk.codec, chunk.raw_length, payload.raw.data(), payload.raw.size()});
    }
    Bytes file(assembled_bytes(chunks.data(), chunks.size()));
    assemble(kind, chunks.data(), chunks.size(), file.data());
    return file;
}

/// What a reader that does not know it may leave out.
bool is_ancillary(std::uint32_t type) { return type == ACDF_CHUNK_VISIBILITY || type == ACDF_CHUNK_PORTALS; }

/// A file of DESC, `trees`, what the kind needs beside them, and META.
Bytes store_chunks(std::vector<Payload> trees, const Description& description, AcdfCodec codec) {
    std::vector<Payload> payloads{
        {ACDF_CHUNK_DESCRIPTION, ACDF_CHUNK_FLAG_CRITICAL, description_payload(description)}};
    for (Payload& tree : trees) payloads.push_back(std::move(tree));
    for (const Chunk& chunk : description.chunks)
        payloads.push_back({chunk.type, is_ancillary(chunk.type) ? 0 : ACDF_CHUNK_FLAG_CRITICAL, chunk.bytes});
    if (!description.metadata.empty())
        payloads.push_back({ACDF_CHUNK_METADATA, 0, metadata_payload(description.metadata)});
    return assemble(description.kind, std::move(payloads), codec);
}

} // namespace

std::size_t assembled_bytes(const ChunkView* chunks, std::size_t count) {
    std::size_t end = sizeof(AcdfHeader) + count * sizeof(AcdfChunk);
    for (std::size_t i = 0; i < count; ++i) end = rounded(end) + chunks[i].size;
    return rounded(end);
}

void assemble(AcdfKind kind, const ChunkView* chunks, std::size_t count, std::uint8_t* file) {
    AcdfHeader header = {};
    const std::uint8_t magic[] = ACDF_MAGIC_BYTES;
    std::memcpy(header.magic, magic, sizeof magic);
    header.version_major = ACDF_VERSION_MAJOR;
    header.version_minor = ACDF_VERSION_MINOR;
    header.file_length = assembled_bytes(chunks, count);
    header.kind = kind;
    header.chunk_count = static_cast<std::uint32_t>(count);
    const std::size_t table = sizeof header, table_bytes = count * sizeof(AcdfChunk);
    std::size_t end = table + table_bytes;
    for (std::size_t i = 0; i < count; ++i) {
        AcdfChunk chunk = {};
        chunk.type = chunks[i].type;
        chunk.flags = chunks[i].flags;
        chunk.codec = chunks[i].codec;
        chunk.raw_length = chunks[i].raw_length;
        chunk.stored_length = chunks[i].size;
        chunk.offset = rounded(end);
        chunk.crc = crc(chunks[i].data, chunks[i].size);
        std::memcpy(file + table + i * sizeof chunk, &chunk, sizeof chunk);
        std::memset(file + end, 0, chunk.offset - end);
        if (chunks[i].size > 0) std::memcpy(file + chunk.offset, chunks[i].data, chunks[i].size);
        end = chunk.offset + chunks[i].size;
    }
    std::memset(file + end, 0, rounded(end) - end);
    header.header_crc = crc(reinterpret_cast<const std::uint8_t*>(&header), offsetof(AcdfHeader, header_crc));
    header.header_crc = crc(file + table, table_bytes, header.header_crc);
    std::memcpy(file, &header, sizeof header);
}

Description environment_description(std::uint32_t columns, std::uint32_t rows,
                                    AcdfParameterization parameterization) {
    Description d;
    d.parameterization = parameterization;
    if (parameterization == ACDF_PARAM_OCTAHEDRAL) {
        d.axes = {{"u", ACDF_AXIS_SAMPLED, ACDF_MEASURE_LINEAR, columns, 0.0, 1.0},
                  {"v", ACDF_AXIS_SAMPLED, ACDF_MEASURE_LINEAR, rows, 0.0, 1.0}};
        return d;
    }
    d.axes = {{"phi", ACDF_AXIS_SAMPLED, ACDF_MEASURE_LINEAR, columns, ACDF_PI, -ACDF_PI},
              {"theta", ACDF_AXIS_SAMPLED, ACDF_MEASURE_COSINE, rows, 0.0, ACDF_PI}};
    return d;
}

Chunk local_chunk(float cosine_share) {
    const AcdfLocalHeader header = {cosine_share, 0};
    const auto* data = reinterpret_cast<const std::uint8_t*>(&header);
    return {ACDF_CHUNK_LOCAL, {data, data + sizeof header}};
}

Chunk partner_chunk(const Partner& partner, float recommended_light_share,
                    const std::vector<AcdfPartnerRecord>& records) {
    Chunk chunk{ACDF_CHUNK_PARTNER, {}};
    append(chunk.bytes,
           AcdfPartner{static_cast<std::uint32_t>(partner.kind), static_cast<std::uint32_t>(partner.heuristic),
                       static_cast<float>(partner.share()), recommended_light_share,
                       static_cast<std::uint32_t>(records.size()), 0});
    for (const AcdfPartnerRecord& record : records) append(chunk.bytes, record);
    return chunk;
}

std::vector<std::uint8_t> store(const EncodedTree& tree, const Description& description, AcdfCodec codec) {
    return store_chunks({{ACDF_CHUNK_BINS, ACDF_CHUNK_FLAG_CRITICAL, bins_payload(tree.roots, description)},
                         {ACDF_CHUNK_TREE, ACDF_CHUNK_FLAG_CRITICAL, tree.bytes}},
                        description, codec);
}

std::vector<std::uint8_t> store(const Halvings& tree, const Description& description, AcdfCodec codec) {
    return store_chunks({{ACDF_CHUNK_HALVINGS, ACDF_CHUNK_FLAG_CRITICAL, halvings_chunk(tree)}}, description,
                        codec);
}

std::vector<std::uint8_t> store(const Halvings& tree, const std::vector<std::uint32_t>& roots,
                                const Description& description, AcdfCodec codec) {
    return store_chunks({{ACDF_CHUNK_BINS, ACDF_CHUNK_FLAG_CRITICAL, bins_payload(roots, description)},
                         {ACDF_CHUNK_HALVINGS, ACDF_CHUNK_FLAG_CRITICAL, halvings_chunk(tree)}},
                        description, codec);
}

std::uint64_t halvings_room(const Description& description, std::uint64_t file_bytes) {
    Halvings leaf;
    leaf.axes = {-1};
    const std::vector<std::uint32_t> roots(description.shares.size(), ACDF_NO_ROOT);
    const std::vector<std::uint8_t> file =
        description.kind == ACDF_KIND_TABLE ? store(leaf, roots, description) : store(leaf, description);
    const std::uint64_t others = file.size() - rounded(halvings_chunk(leaf).size());
    return file_bytes > others ? (file_bytes - others) / ACDF_ALIGNMENT * ACDF_ALIGNMENT : 0;
}

} // namespace acdf::compress
