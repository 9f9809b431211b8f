// What WebAssembly exports: the reader, over buffers of the module's memory. acdf.mjs makes classes of it.
#include <acdf/reader.h>
#include <acdf/shader/tables.h>
#include <acdf/views.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>
#include <utility>

#define ACDF_EXPORT extern "C" __attribute__((visibility("default")))

namespace {

using u32 = std::uint32_t;

struct Opened {
    acdf::File file;
    acdf::Status status;
    acdf::ShaderTables tables;
    void* bytes;
};

/// What `at` points to says which of a file's pdfs is meant: a normal, or a view; nothing for environments.
acdf::DirectionSample sample(const acdf::File& file, const float* at, double u0, double u1) {
    switch (file.kind()) {
    case ACDF_KIND_ENVIRONMENT:
        return file.environment().sample(u0, u1);
    case ACDF_KIND_LOCAL:
        return file.local().sample(at, u0, u1);
    case ACDF_KIND_BRDF:
        return file.brdf().sample(at, u0, u1);
    case ACDF_KIND_TABLE:
    case ACDF_KIND_INDEXED:
        break;
    }
    return {};
}

float density(const acdf::File& file, const float* at, const float direction[3]) {
    switch (file.kind()) {
    case ACDF_KIND_ENVIRONMENT:
        return file.environment().pdf(direction);
    case ACDF_KIND_LOCAL:
        return file.local().pdf(at, direction);
    case ACDF_KIND_BRDF:
        return file.brdf().pdf(at, direction);
    case ACDF_KIND_TABLE:
    case ACDF_KIND_INDEXED:
        break;
    }
    return 0.0f;
}

/// Positions of cells: the first `most` are written, four numbers each, and all are counted.
struct Cells {
    u32* out;
    std::size_t most, count = 0;

    void add(u32 first_column, u32 last_column, u32 first_row, u32 last_row) {
        if (count < most) {
            const u32 ends[4] = {first_column, last_column, first_row, last_row};
            std::memcpy(out + 4 * count, ends, sizeof ends);
        }
        ++count;
    }
    /// Below a node of halvings. A path passes at most 62.
    void add(const AcdfHalving* nodes, u32 at, const AcdfSpan box[2]) {
        if (at == ACDF_LEAF) return add(box[0].end[0], box[0].end[1], box[1].end[0], box[1].end[1]);
        const AcdfHalving node = nodes[at];
        const u32 axis = node.link & 7u;
        for (u32 upper = 0; upper < 2; ++upper) {
            AcdfSpan half[2] = {box[0], box[1]};
            half[axis].end[1 - upper] = acdf_span_middle(&box[axis]);
            const bool leaf = node.link >> (3 + upper) & 1u;
            add(nodes, leaf ? ACDF_LEAF : upper ? at + (node.link >> 5) : at + 1, half);
        }
    }
};

} // namespace

/// Memory for `size` bytes; null where there is none.
ACDF_EXPORT void* acdf_web_allocate(std::size_t size) { return std::aligned_alloc(64, (size / 64 + 1) * 64); }
ACDF_EXPORT void acdf_web_free(void* memory) { std::free(memory); }

/// Checks `size` bytes from acdf_web_allocate, which now belong to what is returned. Null: no memory.
/// acdf_web_error of the result says whether the file is accepted; it is closed in either case.
ACDF_EXPORT Opened* acdf_web_open(void* bytes, std::size_t size) {
    void* place = std::malloc(sizeof(Opened));
    if (!place) {
        std::free(bytes);
        return nullptr;
    }
    auto* opened = new (place) Opened();
    opened->bytes = bytes;
    opened->status = acdf::File::from_memory(bytes, size, opened->file);
    return opened;
}
ACDF_EXPORT void acdf_web_close(Opened* opened) {
    void* bytes = opened->bytes;
    opened->~Opened();
    std::free(opened);
    std::free(bytes);
}
/// One line; empty where the file is accepted. Or what acdf_web_shader_tables found.
ACDF_EXPORT const char* acdf_web_error(const Opened* opened) { return opened->status.message; }
ACDF_EXPORT u32 acdf_web_rule(const Opened* opened) { return static_cast<u32>(opened->status.rule); }

/// The description and the axes as they lie (format/acdf/layout.h), for JavaScript to read by their offsets.
ACDF_EXPORT u32 acdf_web_kind(const Opened* opened) { return static_cast<u32>(opened->file.kind()); }
ACDF_EXPORT const AcdfDescription* acdf_web_description(const Opened* opened) {
    return &opened->file.description();
}
ACDF_EXPORT const AcdfAxis* acdf_web_axes(const Opened* opened) { return &opened->file.axis(0); }
ACDF_EXPORT u32 acdf_web_table_bytes(const Opened* opened) { return static_cast<u32>(opened->file.table_bytes()); }
ACDF_EXPORT u32 acdf_web_metadata_count(const Opened* opened) { return opened->file.metadata_count(); }
/// Address and size of a key and of its value.
ACDF_EXPORT void acdf_web_metadata(const Opened* opened, u32 i, u32 out[4]) {
    acdf::Text key, value;
    opened->file.metadata(i, key, value);
    out[0] = static_cast<u32>(reinterpret_cast<std::uintptr_t>(key.data));
    out[1] = static_cast<u32>(key.size);
    out[2] = static_cast<u32>(reinterpret_cast<std::uintptr_t>(value.data));
    out[3] = static_cast<u32>(value.size);
}
ACDF_EXPORT double acdf_web_share(const Opened* opened, const float* at) {
    if (opened->file.kind() == ACDF_KIND_ENVIRONMENT)
        return static_cast<double>(opened->file.environment().recommended_light_share());
    return opened->file.kind() == ACDF_KIND_LOCAL
               ? static_cast<double>(opened->file.local().recommended_light_share(at))
               : 1.0;
}

/// Samples for `count` pairs of random numbers: x y z pdf each.
ACDF_EXPORT void acdf_web_sample(const Opened* opened, const float* at, const double* u, std::size_t count,
                                 float* out) {
    for (std::size_t i = 0; i < count; ++i) {
        const acdf::DirectionSample s = sample(opened->file, at, u[2 * i], u[2 * i + 1]);
        std::memcpy(out + 4 * i, &s, sizeof s);
    }
}
/// Pdfs of `count` directions, x y z each.
ACDF_EXPORT void acdf_web_pdf(const Opened* opened, const float* at, const float* directions, std::size_t count,
                              float* out) {
    for (std::size_t i = 0; i < count; ++i) out[i] = density(opened->file, at, directions + 3 * i);
}

/// Pdfs of the middles of width x height texels of a lat-long map as docs/conventions.md has it: phi = pi at
/// the left, theta = 0 at the top.
ACDF_EXPORT void acdf_web_map(const Opened* opened, const float* at, u32 width, u32 height, float* out) {
    for (u32 y = 0; y < height; ++y)
        for (u32 x = 0; x < width; ++x) {
            double sine, cosine, sin_theta, cos_theta;
            acdf_sincospi((y + 0.5) / height, &sin_theta, &cos_theta);
            acdf_sincospi(1.0 - 2.0 * (x + 0.5) / width, &sine, &cosine);
            const float direction[3] = {static_cast<float>(sin_theta * cosine),
                                        static_cast<float>(sin_theta * sine), static_cast<float>(cos_theta)};
            *out++ = density(opened->file, at, direction);
        }
}

/// The cells of an environment's tree: positions column first and last, row first and last on its axes. Writes at
/// most `most`, and returns how many there are.
ACDF_EXPORT std::size_t acdf_web_cells(const Opened* opened, u32* out, std::size_t most) {
    if (opened->file.kind() != ACDF_KIND_ENVIRONMENT) return 0;
    const AcdfEnvironment environment = opened->file.environment().data();
    Cells cells{out, most};
    const AcdfSpan whole[2] = {{{0, environment.columns}}, {{0, environment.rows}}};
    cells.add(acdf_halvings_nodes(environment.halved), environment.halved->count ? 0 : ACDF_LEAF, whole);
    return cells.count;
}

/// How many words of tables for shaders there are; 0, and an error, where there are none.
ACDF_EXPORT std::size_t acdf_web_shader_tables(Opened* opened) {
    opened->status = acdf::ShaderTables::make(opened->file, opened->tables);
    return opened->tables.size();
}
ACDF_EXPORT const u32* acdf_web_shader_words(const Opened* opened) { return opened->tables.words(); }
