// Any bytes: loading must neither crash nor read outside them, `validate` must agree with it, and whatever is
// accepted must give good samples. The mutator keeps layout and CRCs right most of the time, so that the
// checks behind them are reached.
#include "fuzz/sample_file.h"
#include "reader_builder.h"

#include <check.h>

using namespace acdf_test;

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

// The chunks of a file whose table and payloads lie inside it; empty where they do not.
FileSpec taken_apart(const Bytes& file) {
    FileSpec spec;
    if (file.size() < header_size) return spec;
    const std::uint64_t count = get(file, 36, 4);
    if (count > 64 || chunk_at(static_cast<std::size_t>(count)) > file.size()) return spec;
    spec.kind = static_cast<std::uint32_t>(get(file, 24, 4));
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint64_t offset = get(file, chunk_at(i) + 16, 8), stored = get(file, chunk_at(i) + 24, 8);
        const auto codec = get(file, chunk_at(i) + 8, 4);
        if (offset > file.size() || stored > file.size() - offset) return FileSpec();
        const auto* begin = file.data() + offset;
        ChunkSpec chunk;
        chunk.type.assign(reinterpret_cast<const char*>(file.data() + chunk_at(i)), 4);
        chunk.flags = static_cast<std::uint32_t>(get(file, chunk_at(i) + 4, 4));
        chunk.zlib = codec == 1 || codec == 2;
        if (codec == 2) chunk.planes_of = get(file, chunk_at(i) + 32, 8);
        chunk.raw.assign(begin, begin + stored);
        if (chunk.zlib) {
            uLongf size = 1 << 16;
            chunk.raw.resize(size);
            if (uncompress(chunk.raw.data(), &size, begin, static_cast<uLong>(stored)) != Z_OK) return FileSpec();
            chunk.raw.resize(size);
        }
        spec.chunks.push_back(chunk);
    }
    return spec;
}

// Mutates one payload, with its length, and writes the file anew.
Bytes mutated_payload(FileSpec spec, std::size_t max_size, FuzzRandom& rng) {
    ChunkSpec& chunk = spec.chunks[rng.next() % spec.chunks.size()];
    const std::size_t size = chunk.raw.size();
    chunk.raw.resize(std::max(size + 64, size) + 1);
    chunk.raw.resize(LLVMFuzzerMutate(chunk.raw.data(), size, chunk.raw.size()));
    if (chunk.type == "TREE" && chunk.planes_of == 0 && rng.next() % 8 != 0) pad_to(chunk.raw, 2);
    if (chunk.planes_of != 0 && rng.next() % 8 == 0) chunk.planes_of = rng.next() % (4 * size + 2);
    else if (rng.next() % 16 == 0) chunk.zlib = !chunk.zlib;
    Bytes file = spec.encode();
    return file.size() <= max_size ? file : Bytes();
}

} // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
    FuzzRandom rng(seed);
    const FileSpec spec = taken_apart(Bytes(data, data + size));
    Bytes file;
    if (!spec.chunks.empty() && rng.next() % 8 != 0) file = mutated_payload(spec, max_size, rng);
    if (file.empty()) {
        file.assign(data, data + size);
        file.resize(max_size);
        file.resize(LLVMFuzzerMutate(file.data(), size, max_size));
        if (rng.next() % 4 != 0 && file.size() >= header_size) seal(file);
    }
    std::memcpy(data, file.data(), file.size());
    return file.size();
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    acdf::Limits limits;
    limits.max_inflated_bytes = 1 << 24;
    // As long as the input and not a byte longer: malloc'ed, so aligned and used in place.
    std::uint8_t* bytes = static_cast<std::uint8_t*>(std::malloc(size));
    if (size != 0) std::memcpy(bytes, data, size);
    {
        acdf::File file;
        const acdf::Status status = acdf::File::from_memory(bytes, size, file, limits);
        const acdf::Verdict verdict = acdf::validate(
            bytes, size, [](const acdf::Finding&) {}, limits);
        require(status.ok() == verdict.valid() && file.empty() == !status.ok());
        require(status.ok() || (status.rule != 0 && status.message[0] != 0 && status.offset <= size));
        if (status.ok()) sample_everything(file, bytes, size);
    }
    std::free(bytes);
    return 0;
}
