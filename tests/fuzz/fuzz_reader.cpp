// Any bytes: loading must neither crash nor read outside them, `validate` must agree with it, and whatever is
// accepted must give good samples. The mutator keeps layout and CRCs right most of the time, so that the
// checks behind them are reached.
#include "tests/fuzz/fuzz_random.h"
#include "tests/fuzz/mutate_halvings.h"
#include "tests/fuzz/require.h"
#include "tests/fuzz/sample_file.h"
#include "tests/lib/reader/builder.h"

#include "reader/check/check.h"

#include <acdf/curves/curves.h>
#include <algorithm>

using namespace acdf_test;

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

// Mutates one payload, with its length, and writes the file anew.
Bytes mutated_payload(FileSpec spec, std::size_t max_size, FuzzRandom& rng) {
    ChunkSpec& chunk = spec.chunks[rng.next() % spec.chunks.size()];
    const std::size_t size = chunk.raw.size();
    if (chunk.type == "HALV" && spec.kind != 4 && rng.next() % 8 != 0) { // of one tree
        chunk.raw = mutated_halvings(chunk.raw, rng);
    } else {
        chunk.raw.resize(std::max(size + 64, size) + 1);
        chunk.raw.resize(LLVMFuzzerMutate(chunk.raw.data(), size, chunk.raw.size()));
    }
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
        const acdf::Status status = acdf::File::from_memory(bytes, size, file, acdf::with_curves(limits));
        const acdf::Verdict verdict = acdf::validate(
            bytes, size, [](const acdf::Finding&) {}, acdf::with_curves(limits));
        require(status.ok() == verdict.valid() && file.empty() == !status.ok());
        require(status.ok() || (status.rule != 0 && status.message[0] != 0 && status.offset <= size));
        if (status.ok()) sample_everything(file, bytes, size);
    }
    std::free(bytes);
    return 0;
}
