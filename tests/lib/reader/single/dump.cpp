// What a reader says of files, as text that another build of it must print, too: dump [--environments] FILE.acdf...
// Linked with the library, and with the two files that are made of it (SINGLE).
//   FILE status DIGEST          of samples, pdfs and inverses, by random inputs
//   FILE hostile COUNT DIGEST   of the outcomes of truncated and of damaged bytes, with and without right CRCs
// --environments: environments of fit `variance` alone, and of what is refused no messages.
#ifdef SINGLE
#include "acdf.h"
#else
#include <acdf/acdf.h>
#include <acdf/reader.h>
#include <acdf/views.h>
#endif

#include <cinttypes>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

namespace {

using Bytes = std::vector<unsigned char>;

/// FNV-1a.
struct Digest {
    std::uint64_t value = 0xCBF29CE484222325u;

    void add(const void* data, std::size_t size) {
        const auto* bytes = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < size; ++i) value = (value ^ bytes[i]) * 0x100000001B3u;
    }
    template <class T>
    void add(const T& number) {
        add(&number, sizeof number);
    }
};

struct Random {
    std::uint64_t state;

    std::uint64_t next() {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        return state * 0x2545F4914F6CDD1Du;
    }
    double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }
    std::size_t below(std::size_t n) { return static_cast<std::size_t>(next() % n); }
    /// Now and then what is no number between 0 and 1.
    double number() {
        const double odd[] = {0.0, 1.0, -1.0, 2.0, NAN, INFINITY, 0x1p-1074, 0x1.fffffffffffffp-1};
        return below(16) == 0 ? odd[below(8)] : unit();
    }
    /// Now and then no direction.
    void direction(float out[3]) {
        double v[3], square;
        do {
            square = 0.0;
            for (double& x : v) {
                x = 2.0 * unit() - 1.0;
                square += x * x;
            }
        } while (square > 1.0 || square < 1e-4);
        const double scale = (below(32) == 0 ? 1.0 + 0.01 * unit() : 1.0) / std::sqrt(square);
        for (int i = 0; i < 3; ++i) out[i] = static_cast<float>(v[i] * scale);
        if (below(32) == 0) out[below(3)] = below(2) ? 0.0f : NAN;
    }
};

Bytes read(const char* path) {
    Bytes out;
    if (std::FILE* file = std::fopen(path, "rb")) {
        for (int c; (c = std::fgetc(file)) != EOF;) out.push_back(static_cast<unsigned char>(c));
        std::fclose(file);
    }
    return out;
}

std::uint32_t crc(std::uint32_t seed, const unsigned char* bytes, std::size_t size) {
    std::uint32_t out = ~seed;
    for (std::size_t i = 0; i < size; ++i) {
        out ^= bytes[i];
        for (int bit = 0; bit < 8; ++bit) out = out >> 1 ^ (0xEDB88320u & (0u - (out & 1u)));
    }
    return ~out;
}

/// Makes the CRCs right, where the chunk table and what it names are there: what is damaged else goes farther.
void repair(Bytes& bytes) {
    AcdfHeader header;
    if (bytes.size() < sizeof header) return;
    std::memcpy(&header, bytes.data(), sizeof header);
    const std::size_t table = header.chunk_count * sizeof(AcdfChunk);
    if (header.chunk_count > ACDF_MAX_CHUNKS || bytes.size() < sizeof header + table) return;
    for (std::size_t i = 0; i < header.chunk_count; ++i) {
        unsigned char* const at = bytes.data() + sizeof header + i * sizeof(AcdfChunk);
        AcdfChunk chunk;
        std::memcpy(&chunk, at, sizeof chunk);
        if (chunk.offset > bytes.size() || chunk.stored_length > bytes.size() - chunk.offset) continue;
        chunk.crc = crc(0, bytes.data() + chunk.offset, static_cast<std::size_t>(chunk.stored_length));
        std::memcpy(at, &chunk, sizeof chunk);
    }
    header.header_crc =
        crc(crc(0, bytes.data(), offsetof(AcdfHeader, header_crc)), bytes.data() + sizeof header, table);
    std::memcpy(bytes.data(), &header, sizeof header);
}

using File = std::unique_ptr<AcdfFile, decltype(&acdf_close)>;

File open(const Bytes& bytes, bool plain, AcdfError& error) {
    AcdfLoadOptions options = {};
    options.plain = plain;
    return {acdf_from_memory_with(bytes.data(), bytes.size(), &options, &error), acdf_close};
}

void sample(const AcdfEnvironment& sky, Random random, int count, Digest& digest) {
    for (int i = 0; i < count; ++i) {
        const double u0 = random.number(), u1 = random.number();
        const AcdfDirectionSample s = acdf_environment_sample(&sky, u0, u1);
        float w[3];
        double u[2] = {-1.0, -1.0};
        random.direction(w);
        digest.add(s);
        digest.add(acdf_environment_pdf(&sky, s.direction));
        digest.add(acdf_environment_pdf(&sky, w));
        digest.add(acdf_environment_invert(&sky, w, u));
        digest.add(u);
    }
}

#ifndef ACDF_ENVIRONMENT_ONLY
void sample(const AcdfLocal& light, Random random, int count, Digest& digest) {
    for (int i = 0; i < count; ++i) {
        float n[3], w[3];
        random.direction(n);
        random.direction(w);
        const double u0 = random.number(), u1 = random.number();
        const AcdfDirectionSample s = acdf_local_sample(&light, n, u0, u1);
        digest.add(s.pdf);
        if (s.pdf > 0.0f) digest.add(s.direction);
        digest.add(acdf_local_pdf(&light, n, w));
        digest.add(acdf_local_irradiance(&light, n));
        AcdfLocalPoint point;
        acdf_local_at(&light, n, &point);
        const AcdfDirectionSample at = acdf_local_sample_at(&light, &point, u1, u0);
        digest.add(at.pdf);
        digest.add(acdf_local_pdf_at(&light, &point, w));
    }
}

void sample(const AcdfBrdf& brdf, Random random, int count, Digest& digest) {
    for (int i = 0; i < count; ++i) {
        float wo[3], wi[3];
        double u[2] = {-1.0, -1.0};
        random.direction(wo);
        random.direction(wi);
        wo[2] = std::fabs(wo[2]);
        const double u0 = random.number(), u1 = random.number();
        const AcdfDirectionSample s = acdf_brdf_sample(&brdf, wo, u0, u1);
        digest.add(s.pdf);
        if (s.pdf > 0.0f) digest.add(s.direction);
        digest.add(acdf_brdf_pdf(&brdf, wo, wi));
        digest.add(acdf_brdf_invert(&brdf, wo, wi, u));
        digest.add(u);
        digest.add(acdf_brdf_albedo(&brdf, wo));
    }
}

void sample(const AcdfTable& table, Random random, int count, Digest& digest) {
    for (int i = 0; i < count; ++i) {
        std::uint32_t index[ACDF_MAX_AXES];
        double u[ACDF_MAX_AXES], x[ACDF_MAX_AXES] = {}, back[ACDF_MAX_AXES] = {};
        for (std::uint32_t& k : index) k = static_cast<std::uint32_t>(random.below(4));
        for (double& number : u) number = random.number();
        digest.add(acdf_table_sample(&table, index, u, x));
        digest.add(x);
        digest.add(acdf_table_pdf(&table, index, x));
        digest.add(acdf_table_invert(&table, index, x, back));
        digest.add(back);
    }
}
#endif

void sample(const AcdfFile* file, Random random, int count, Digest& digest) {
    AcdfEnvironment sky;
    if (acdf_environment(file, &sky)) sample(sky, random, count, digest);
#ifndef ACDF_ENVIRONMENT_ONLY
    AcdfLocal light;
    AcdfBrdf brdf;
    AcdfTable table;
    if (acdf_local(file, &light)) sample(light, random, count, digest);
    if (acdf_brdf(file, &brdf)) sample(brdf, random, count, digest);
    if (acdf_table(file, &table)) sample(table, random, count, digest);
#endif
    digest.add(acdf_size(file));
    digest.add(acdf_table_bytes(file));
    for (std::uint32_t i = 0; i < acdf_metadata_count(file); ++i) {
        AcdfText key, value;
        acdf_metadata_pair(file, i, &key, &value);
        digest.add(key.data, key.size);
        digest.add(value.data, value.size);
        digest.add(acdf_metadata_value(file, std::string(key.data, key.size).c_str()).size);
    }
}

class Dump {
public:
    Dump(const char* path, bool environments) : path_(path), environments_(environments), bytes_(read(path)) {}

    void print() {
        const char* slash = std::strrchr(path_, '/');
        const char* name = slash ? slash + 1 : path_;
        Digest digest;
        AcdfError error;
        for (const bool plain : {false, true})
            if (const File file = open(bytes_, plain, error)) sample(file.get(), {0x1234567}, 3000, digest);
            else report(error, digest);
        std::printf("%s %d %d %016" PRIx64 "\n", name, static_cast<int>(error.code), error.rule, digest.value);
        if (environments_ && error.code != ACDF_OK) return;
        Digest hostile;
        std::size_t count = 0;
        const std::size_t step = bytes_.size() / 400 + 1;
        for (std::size_t size = 0; size < bytes_.size(); size += step)
            count += try_one(Bytes(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(size)), hostile);
        Random random{0x89ABCDEF};
        for (int i = 0; i < 1500; ++i) {
            Bytes damaged = bytes_;
            // Half of them where headers and small chunks lie.
            const std::size_t reach = i % 2 && damaged.size() > 768 ? 768 : damaged.size();
            for (std::size_t k = 0; k <= random.below(3); ++k)
                damaged[random.below(reach)] ^= static_cast<unsigned char>(1u << random.below(8));
            count += try_one(damaged, hostile);
            repair(damaged);
            count += try_one(damaged, hostile);
        }
        std::printf("%s hostile %zu %016" PRIx64 "\n", name, count, hostile.value);
    }

private:
    void report(const AcdfError& error, Digest& digest) const {
        digest.add(static_cast<int>(error.code));
        digest.add(error.rule);
        digest.add(error.offset);
        if (!environments_) digest.add(error.message, std::strlen(error.message));
    }
    /// Whether the bytes are tried: not those of which another kind was made, where there is but one.
    bool try_one(const Bytes& bytes, Digest& digest) const {
        AcdfHeader header;
        if (environments_ && bytes.size() >= sizeof header) {
            std::memcpy(&header, bytes.data(), sizeof header);
            if (header.kind >= ACDF_KIND_LOCAL && header.kind <= ACDF_KIND_TABLE) return false;
        }
        AcdfError error;
        const File file = open(bytes, false, error);
        report(error, digest);
        if (file) sample(file.get(), {0x7654321}, 20, digest);
        return true;
    }

    const char* path_;
    bool environments_;
    Bytes bytes_;
};

} // namespace

int main(int argc, char** argv) {
    const bool environments = argc > 1 && std::strcmp(argv[1], "--environments") == 0;
    for (int i = 1 + environments; i < argc; ++i) Dump(argv[i], environments).print();
    return 0;
}
