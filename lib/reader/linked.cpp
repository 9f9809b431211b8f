// Samples and pdfs as symbols: loops over the inline functions, and waves.
#include "c_file.h"
#include "memory.h"

#include <acdf/wavefront.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <utility>

namespace {

using acdf::DirectionSample;

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr size_t kWave = 256; // directions and views of so many stay in the first cache

// A direction that was sampled, if any.
float keep(const DirectionSample& sample, float direction[3]) {
    if (sample.pdf > 0.0f) std::memcpy(direction, sample.direction, sizeof sample.direction);
    return sample.pdf;
}

void put(const DirectionSample& sample, std::size_t i, float* directions, float* pdfs) {
    std::memcpy(directions + 3 * i, sample.direction, sizeof sample.direction);
    pdfs[i] = sample.pdf;
}

// Calls serve(j, i) for each of `count` items i, of the place j that serves it.
template <class Serve>
void for_each_item(std::size_t count, std::size_t each, Serve&& serve) {
    for (std::size_t i = 0, j = 0; i < count; ++j)
        for (const std::size_t end = each < count - i ? i + each : count; i < end; ++i) serve(j, i);
}

// Samples `count` directions by sample(first, n, sampled), some of them at once.
template <class Draw>
void draw_in_waves(std::size_t count, float* directions, float* pdfs, Draw&& draw) {
    DirectionSample sampled[kWave];
    for (std::size_t first = 0; first < count; first += kWave) {
        const std::size_t n = count - first < kWave ? count - first : kWave;
        draw(first, n, sampled);
        for (std::size_t i = 0; i < n; ++i) put(sampled[i], first + i, directions, pdfs);
    }
}

// Arrays of vectors and of pairs of numbers, from item i on.
const float (*vectors_at(const float* array, std::size_t i))[3] {
    return reinterpret_cast<const float(*)[3]>(array + 3 * i);
}
const double (*pairs_at(const double* array, std::size_t i))[2] {
    return reinterpret_cast<const double(*)[2]>(array + 2 * i);
}

// Whether a file can serve arrays of this kind, with `each` items a place: 0 would never come to an end.
bool serves(const AcdfFile* file, AcdfKind kind, size_t each) { return file->file.kind() == kind && each > 0; }

void put_numbers(bool found, int axes, double* u) {
    for (int axis = 0; axis < axes && !found; ++axis) u[axis] = kNoNumber;
}

} // namespace

float acdf_sample_environment(const AcdfFile* file, double u0, double u1, float direction[3]) {
    if (file->file.kind() != ACDF_KIND_ENVIRONMENT) return 0.0f;
    return keep(acdf_environment_sample(&file->environment, u0, u1), direction);
}

float acdf_pdf_environment(const AcdfFile* file, const float direction[3]) {
    return file->file.kind() == ACDF_KIND_ENVIRONMENT ? acdf_environment_pdf(&file->environment, direction) : 0.0f;
}

int acdf_sample_environment_array(const AcdfFile* file, const double* u, size_t count, float* directions,
                                  float* pdfs) {
    if (file->file.kind() != ACDF_KIND_ENVIRONMENT) return 0;
    for (size_t i = 0; i < count; ++i)
        put(acdf_environment_sample(&file->environment, u[2 * i], u[2 * i + 1]), i, directions, pdfs);
    return 1;
}

int acdf_pdf_environment_array(const AcdfFile* file, const float* directions, size_t count, float* pdfs) {
    if (file->file.kind() != ACDF_KIND_ENVIRONMENT) return 0;
    for (size_t i = 0; i < count; ++i) pdfs[i] = acdf_environment_pdf(&file->environment, directions + 3 * i);
    return 1;
}

int acdf_invert_environment_array(const AcdfFile* file, const float* directions, size_t count, double* u) {
    if (file->file.kind() != ACDF_KIND_ENVIRONMENT) return 0;
    for (size_t i = 0; i < count; ++i)
        put_numbers(acdf_environment_invert(&file->environment, directions + 3 * i, u + 2 * i) != 0, 2, u + 2 * i);
    return 1;
}

float acdf_sample_local(const AcdfFile* file, const float normal[3], double u0, double u1, float direction[3]) {
    if (file->file.kind() != ACDF_KIND_LOCAL) return 0.0f;
    return keep(acdf_local_sample(&file->local, normal, u0, u1), direction);
}

float acdf_pdf_local(const AcdfFile* file, const float normal[3], const float direction[3]) {
    return file->file.kind() == ACDF_KIND_LOCAL ? acdf_local_pdf(&file->local, normal, direction) : 0.0f;
}

int acdf_sample_local_array(const AcdfFile* file, const float* normals, size_t each, const double* u, size_t count,
                            float* directions, float* pdfs) {
    if (!serves(file, ACDF_KIND_LOCAL, each)) return 0;
    if (each == 1) {
        const acdf::LocalWavefront wavefront(file->file.local());
        draw_in_waves(count, directions, pdfs, [&](size_t first, size_t n, DirectionSample* sampled) {
            wavefront.sample(vectors_at(normals, first), pairs_at(u, first), n, sampled);
        });
        return 1;
    }
    const acdf::LocalEnvironmentView view = file->file.local();
    const acdf::LocalWavefront wavefront(view);
    for (size_t j = 0, first = 0; first < count; first += each, ++j) { // a point, looked up once, serves several
        const AcdfLocalPoint point = view.at(normals + 3 * j);
        draw_in_waves(std::min(each, count - first), directions + 3 * first, pdfs + first,
                      [&](size_t from, size_t n, DirectionSample* sampled) {
                          wavefront.sample(point, pairs_at(u, first + from), n, sampled);
                      });
    }
    return 1;
}

int acdf_pdf_local_array(const AcdfFile* file, const float* normals, size_t each, const float* directions,
                         size_t count, float* pdfs) {
    if (!serves(file, ACDF_KIND_LOCAL, each)) return 0;
    if (each == 1) {
        acdf::LocalWavefront(file->file.local())
            .pdf(vectors_at(normals, 0), vectors_at(directions, 0), count, pdfs);
        return 1;
    }
    const acdf::LocalEnvironmentView view = file->file.local();
    const acdf::LocalWavefront wavefront(view);
    for (size_t j = 0, first = 0; first < count; first += each, ++j)
        wavefront.pdf(view.at(normals + 3 * j), vectors_at(directions, first), std::min(each, count - first),
                      pdfs + first);
    return 1;
}

int acdf_irradiance_local_array(const AcdfFile* file, const float* normals, size_t count, double* irradiances) {
    if (file->file.kind() != ACDF_KIND_LOCAL) return 0;
    for (size_t i = 0; i < count; ++i) irradiances[i] = acdf_local_irradiance(&file->local, normals + 3 * i);
    return 1;
}

float acdf_sample_brdf(const AcdfFile* file, const float wo[3], double u0, double u1, float wi[3]) {
    if (file->file.kind() != ACDF_KIND_BRDF) return 0.0f;
    return keep(acdf_brdf_sample(&file->brdf, wo, u0, u1), wi);
}

float acdf_pdf_brdf(const AcdfFile* file, const float wo[3], const float wi[3]) {
    return file->file.kind() == ACDF_KIND_BRDF ? acdf_brdf_pdf(&file->brdf, wo, wi) : 0.0f;
}

int acdf_sample_brdf_array(const AcdfFile* file, const float* wo, size_t each, const double* u, size_t count,
                           float* wi, float* pdfs) {
    if (!serves(file, ACDF_KIND_BRDF, each)) return 0;
    for_each_item(count, each, [&](size_t j, size_t i) {
        put(acdf_brdf_sample(&file->brdf, wo + 3 * j, u[2 * i], u[2 * i + 1]), i, wi, pdfs);
    });
    return 1;
}

int acdf_pdf_brdf_array(const AcdfFile* file, const float* wo, size_t each, const float* wi, size_t count,
                        float* pdfs) {
    if (!serves(file, ACDF_KIND_BRDF, each)) return 0;
    for_each_item(count, each,
                  [&](size_t j, size_t i) { pdfs[i] = acdf_brdf_pdf(&file->brdf, wo + 3 * j, wi + 3 * i); });
    return 1;
}

int acdf_invert_brdf_array(const AcdfFile* file, const float* wo, size_t each, const float* wi, size_t count,
                           double* u) {
    if (!serves(file, ACDF_KIND_BRDF, each)) return 0;
    for_each_item(count, each, [&](size_t j, size_t i) {
        put_numbers(acdf_brdf_invert(&file->brdf, wo + 3 * j, wi + 3 * i, u + 2 * i) != 0, 2, u + 2 * i);
    });
    return 1;
}

int acdf_albedo_brdf_array(const AcdfFile* file, const float* wo, size_t count, double* albedos) {
    if (file->file.kind() != ACDF_KIND_BRDF) return 0;
    for (size_t i = 0; i < count; ++i) albedos[i] = acdf_brdf_albedo(&file->brdf, wo + 3 * i);
    return 1;
}

// ---- waves ----

struct AcdfBrdfWaves {
    acdf::BrdfWavefront wavefront;
    AcdfAllocator allocator;
    AcdfBlock block;
};

namespace {

// The views of items first to first + n - 1.
const float (*views_of(const float* wo, size_t each, size_t first, size_t n, float (&room)[kWave][3]))[3] {
    if (each == 1) return vectors_at(wo, first);
    for (size_t i = 0; i < n; ++i) std::memcpy(room[i], wo + 3 * ((first + i) / each), sizeof room[i]);
    return room;
}

} // namespace

AcdfBrdfWaves* acdf_brdf_waves(const AcdfFile* file, AcdfError* error) {
    acdf::BrdfWavefront made;
    acdf::Status status;
    if (file->file.kind() != ACDF_KIND_BRDF) {
        status.code = acdf::ErrorCode::unsupported;
        std::memcpy(status.message, "not a BRDF file", sizeof "not a BRDF file");
    } else {
        status = acdf::BrdfWavefront::prepare(file->file.brdf(), made);
    }
    AcdfBlock block = {};
    if (status.ok()) {
        block = acdf::take_block(file->allocator, sizeof(AcdfBrdfWaves));
        if (!block.data) status.code = acdf::ErrorCode::out_of_memory;
    }
    acdf::report(status, error);
    return block.data ? new (block.data) AcdfBrdfWaves{std::move(made), file->allocator, block} : nullptr;
}

int acdf_brdf_waves_draw(const AcdfBrdfWaves* waves, const float* wo, size_t each, const double* u, size_t count,
                         float* wi, float* pdfs) {
    if (each == 0) return 0;
    float room[kWave][3];
    draw_in_waves(count, wi, pdfs, [&](size_t first, size_t n, DirectionSample* sampled) {
        waves->wavefront.sample(views_of(wo, each, first, n, room), pairs_at(u, first), n, sampled);
    });
    return 1;
}

int acdf_brdf_waves_density(const AcdfBrdfWaves* waves, const float* wo, size_t each, const float* wi, size_t count,
                            float* pdfs) {
    if (each == 0) return 0;
    float room[kWave][3];
    for (size_t first = 0; first < count; first += kWave) {
        const size_t n = count - first < kWave ? count - first : kWave;
        waves->wavefront.pdf(views_of(wo, each, first, n, room), vectors_at(wi, first), n, pdfs + first);
    }
    return 1;
}

uint64_t acdf_brdf_waves_bytes(const AcdfBrdfWaves* waves) { return waves->wavefront.bytes(); }

void acdf_brdf_waves_close(AcdfBrdfWaves* waves) {
    if (!waves) return;
    const AcdfAllocator allocator = waves->allocator;
    AcdfBlock block = waves->block;
    waves->~AcdfBrdfWaves();
    acdf::give_block(allocator, block);
}

// ---- tables ----

namespace {

// Whether an index is given where the table has indexed axes.
bool has_index(const AcdfTable& table, const uint32_t* index) { return index || table.indexed_count == 0; }

// The index of item group j; a table without indexed axes is given none.
const uint32_t* index_of(const AcdfTable& table, const uint32_t* index, size_t j) {
    return index ? index + table.indexed_count * j : nullptr;
}

} // namespace

uint32_t acdf_table_sampled_axes(const AcdfFile* file) {
    return file->file.kind() == ACDF_KIND_TABLE ? acdf_table_sampled_count(&file->table) : 0;
}
uint32_t acdf_table_indexed_axes(const AcdfFile* file) { return file->table.indexed_count; }

double acdf_sample_table(const AcdfFile* file, const uint32_t* index, const double* u, double* x) {
    if (file->file.kind() != ACDF_KIND_TABLE || !has_index(file->table, index)) return 0.0;
    return acdf_table_sample(&file->table, index, u, x);
}

double acdf_pdf_table(const AcdfFile* file, const uint32_t* index, const double* x) {
    if (file->file.kind() != ACDF_KIND_TABLE || !has_index(file->table, index)) return 0.0;
    return acdf_table_pdf(&file->table, index, x);
}

int acdf_sample_table_array(const AcdfFile* file, const uint32_t* index, size_t each, const double* u, size_t count,
                            double* x, double* pdfs) {
    if (!serves(file, ACDF_KIND_TABLE, each) || !has_index(file->table, index)) return 0;
    const AcdfTable& table = file->table;
    const uint32_t axes = acdf_table_sampled_count(&table);
    for_each_item(count, each, [&](size_t j, size_t i) {
        pdfs[i] = acdf_table_sample(&table, index_of(table, index, j), u + axes * i, x + axes * i);
        put_numbers(pdfs[i] > 0.0, static_cast<int>(axes), x + axes * i);
    });
    return 1;
}

int acdf_pdf_table_array(const AcdfFile* file, const uint32_t* index, size_t each, const double* x, size_t count,
                         double* pdfs) {
    if (!serves(file, ACDF_KIND_TABLE, each) || !has_index(file->table, index)) return 0;
    const AcdfTable& table = file->table;
    const uint32_t axes = acdf_table_sampled_count(&table);
    for_each_item(count, each, [&](size_t j, size_t i) {
        pdfs[i] = acdf_table_pdf(&table, index_of(table, index, j), x + axes * i);
    });
    return 1;
}

int acdf_invert_table_array(const AcdfFile* file, const uint32_t* index, size_t each, const double* x, size_t count,
                            double* u) {
    if (!serves(file, ACDF_KIND_TABLE, each) || !has_index(file->table, index)) return 0;
    const AcdfTable& table = file->table;
    const uint32_t axes = acdf_table_sampled_count(&table);
    for_each_item(count, each, [&](size_t j, size_t i) {
        put_numbers(acdf_table_invert(&table, index_of(table, index, j), x + axes * i, u + axes * i) != 0,
                    static_cast<int>(axes), u + axes * i);
    });
    return 1;
}
