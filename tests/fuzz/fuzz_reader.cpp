// Any bytes: loading must neither crash nor read outside them, `validate` must agree with it, and whatever is
// accepted must give good samples. The mutator keeps layout and CRCs right most of the time, so that the
// checks behind them are reached.
#include "reader_builder.h"

#include <check.h>

#include <cmath>
#include <cstdlib>
#include <random>

using namespace acdf_test;

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

void require(bool condition) {
    if (!condition) std::abort();
}

void sample_everything(const acdf::EnvironmentView& view, std::uint32_t seed) {
    const double edges[] = {0.0, 1.0, 0.5, 1.0 - 0x1p-24, 0x1p-30};
    std::mt19937 rng(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int n = 0; n < 64; ++n) {
        const double u0 = n < 25 ? edges[n / 5] : uniform(rng), u1 = n < 25 ? edges[n % 5] : uniform(rng);
        const acdf::DirectionSample s = view.sample(u0, u1);
        const double length2 = double{s.direction[0]} * s.direction[0] + double{s.direction[1]} * s.direction[1] +
                               double{s.direction[2]} * s.direction[2];
        require(std::fabs(length2 - 1.0) < 1e-6 && s.pdf > 0.0f && std::isfinite(s.pdf));
        require(view.pdf(s.direction) > 0.0f);
        double u[2];
        require(view.invert(s.direction, u) && u[0] >= 0.0 && u[0] <= 1.0 + 1e-9 && u[1] >= 0.0 &&
                u[1] <= 1.0 + 1e-9);
        const float any[3] = {static_cast<float>(2 * uniform(rng) - 1), s.direction[1], s.direction[2]};
        require(view.pdf(any) >= 0.0f);
    }
}

void sample_everything(const acdf::LocalEnvironmentView& view, std::uint32_t seed) {
    const double edges[] = {0.0, 1.0, 0.5, 1.0 - 0x1p-24, 0x1p-30};
    std::mt19937 rng(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int n = 0; n < 96; ++n) {
        float normal[3], any[3];
        for (int k = 0; k < 3; ++k) {
            normal[k] = n % 3 == 0 ? static_cast<float>(static_cast<int>(rng() % 5) - 2)
                                   : static_cast<float>(2 * uniform(rng) - 1);
            any[k] = static_cast<float>(2 * uniform(rng) - 1);
        }
        const double u0 = n < 25 ? edges[n / 5] : uniform(rng), u1 = n < 25 ? edges[n % 5] : uniform(rng);
        const acdf::DirectionSample s = view.sample(normal, u0, u1);
        require(s.pdf >= 0.0f && std::isfinite(s.pdf));
        require(std::isfinite(view.irradiance(normal)) && view.irradiance(normal) >= 0.0);
        require(view.pdf(normal, any) >= 0.0f);
        if (s.pdf == 0.0f) continue;
        const double length2 = double{s.direction[0]} * s.direction[0] + double{s.direction[1]} * s.direction[1] +
                               double{s.direction[2]} * s.direction[2];
        require(std::fabs(length2 - 1.0) < 1e-6);
        require(view.pdf(normal, s.direction) > 0.0f); // of tilted curves it may differ by rounding
    }
}

void sample_everything(const acdf::BrdfView& view, std::uint32_t seed) {
    std::mt19937 rng(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int n = 0; n < 64; ++n) {
        const double z = n < 8 ? 1.0 - n / 8.0 : uniform(rng), phi = 6.283 * uniform(rng),
                     r = std::sqrt(1.0 - z * z);
        const float wo[3] = {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
                             static_cast<float>(z)};
        const acdf::DirectionSample s = view.sample(wo, n % 3 ? uniform(rng) : 1.0, n % 5 ? uniform(rng) : 0.0);
        require(std::isfinite(s.pdf) && s.pdf >= 0.0f && std::isfinite(view.albedo(wo)));
        const float pdf = view.pdf(wo, s.direction);
        require(std::isfinite(pdf) && pdf >= 0.0f);
        double back[2];
        view.invert(wo, s.direction, back);
    }
}

void sample_everything(const acdf::TableView& view, std::uint32_t seed) {
    const double edges[] = {0.0, 1.0, 0.5, 1.0 - 0x1p-24, 0x1p-30};
    std::mt19937 rng(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int n = 0; n < 64; ++n) {
        std::uint32_t index[ACDF_MAX_AXES];
        double u[ACDF_MAX_AXES], x[ACDF_MAX_AXES], back[ACDF_MAX_AXES];
        for (std::uint32_t i = 0; i < ACDF_MAX_AXES; ++i) {
            index[i] = i < view.indexed_count() ? rng() % (view.data().axes[i].resolution + 1) : 0;
            u[i] = rng() % 4 ? uniform(rng) : edges[rng() % 5];
            x[i] = 0.0;
        }
        const double pdf = view.sample(index, u, x);
        require(pdf >= 0.0 && std::isfinite(pdf) && (pdf > 0.0) == (view.share(index) > 0.0));
        require(view.pdf(index, x) == pdf || pdf == 0.0);
        require(view.invert(index, x, back) || pdf == 0.0);
        require(view.pdf(index, u) >= 0.0);
    }
}

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
Bytes mutated_payload(FileSpec spec, std::size_t max_size, std::mt19937& rng) {
    ChunkSpec& chunk = spec.chunks[rng() % spec.chunks.size()];
    const std::size_t size = chunk.raw.size();
    chunk.raw.resize(std::max(size + 64, size) + 1);
    chunk.raw.resize(LLVMFuzzerMutate(chunk.raw.data(), size, chunk.raw.size()));
    if (chunk.type == "TREE" && chunk.planes_of == 0 && rng() % 8 != 0) pad_to(chunk.raw, 2);
    if (chunk.planes_of != 0 && rng() % 8 == 0) chunk.planes_of = rng() % (4 * size + 2);
    else if (rng() % 16 == 0) chunk.zlib = !chunk.zlib;
    Bytes file = spec.encode();
    return file.size() <= max_size ? file : Bytes();
}

} // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
    std::mt19937 rng(seed);
    const FileSpec spec = taken_apart(Bytes(data, data + size));
    Bytes file;
    if (!spec.chunks.empty() && rng() % 8 != 0) file = mutated_payload(spec, max_size, rng);
    if (file.empty()) {
        file.assign(data, data + size);
        file.resize(max_size);
        file.resize(LLVMFuzzerMutate(file.data(), size, max_size));
        if (rng() % 4 != 0 && file.size() >= header_size) seal(file);
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
        if (status.ok()) {
            acdf::Text key, value;
            for (std::uint32_t i = 0; i < file.metadata_count(); ++i) file.metadata(i, key, value);
            if (file.kind() == ACDF_KIND_ENVIRONMENT)
                sample_everything(file.environment(), static_cast<std::uint32_t>(size));
            if (file.kind() == ACDF_KIND_LOCAL) {
                sample_everything(file.local(), static_cast<std::uint32_t>(size));
                sample_everything(file.local().environment(), static_cast<std::uint32_t>(size));
            }
            if (file.kind() == ACDF_KIND_BRDF) sample_everything(file.brdf(), static_cast<std::uint32_t>(size));
            if (file.kind() == ACDF_KIND_TABLE) sample_everything(file.table(), static_cast<std::uint32_t>(size));
        }
    }
    std::free(bytes);
    return 0;
}
