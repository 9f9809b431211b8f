// Samples and pdfs as symbols: the inline functions, loops over them, and batches where those are built.
#include "reader/opened_file.h"

#include <acdf/arrays/arrays.h>
#if ACDF_BATCH
#include <acdf/batch/batch.h>
#endif
#include <acdf/views.h>

#include <cstring>
#include <limits>

namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

// A direction that was sampled, if any.
float keep(const AcdfDirectionSample& sample, float direction[3]) {
    if (sample.pdf > 0.0f) std::memcpy(direction, sample.direction, sizeof sample.direction);
    return sample.pdf;
}

// Calls serve(j, i) for each of `count` items i, of the condition j that serves it.
template <class Serve>
void for_each_item(std::size_t count, std::size_t each, Serve&& serve) {
    for (std::size_t i = 0, j = 0; i < count; ++j)
        for (const std::size_t end = each < count - i ? i + each : count; i < end; ++i) serve(j, i);
}

// Whether a file can serve arrays of this kind, with `each` items a condition: 0 would never come to an end.
bool serves(const AcdfFile* file, AcdfKind kind, size_t each) { return file->kind() == kind && each > 0; }

void put_numbers(bool found, int axes, double* u) {
    for (int axis = 0; axis < axes && !found; ++axis) u[axis] = kNoNumber;
}

#if ACDF_BATCH
using acdf::pdf_batch;
using acdf::sample_batch;
#else
// The functions of acdf/batch/batch.h as loops.

void put(const AcdfDirectionSample& sample, float direction[3], float& pdf) {
    std::memcpy(direction, sample.direction, sizeof sample.direction);
    pdf = sample.pdf;
}

void sample_batch(const acdf::EnvironmentView& view, const double (*u)[2], std::size_t count,
                  float (*directions)[3], float* pdfs) {
    for (std::size_t i = 0; i < count; ++i) put(view.sample(u[i][0], u[i][1]), directions[i], pdfs[i]);
}

void pdf_batch(const acdf::EnvironmentView& view, const float (*directions)[3], std::size_t count, float* pdfs) {
    for (std::size_t i = 0; i < count; ++i) pdfs[i] = view.pdf(directions[i]);
}

void sample_batch(const acdf::LocalEnvironmentView& view, const float (*normals)[3], std::size_t each,
                  const double (*u)[2], std::size_t count, float (*directions)[3], float* pdfs) {
    AcdfLocalPoint point; // looked up once for all that it serves
    for_each_item(count, each, [&](std::size_t j, std::size_t i) {
        if (i % each == 0) point = view.at(normals[j]);
        put(view.sample(point, u[i][0], u[i][1]), directions[i], pdfs[i]);
    });
}

void pdf_batch(const acdf::LocalEnvironmentView& view, const float (*normals)[3], std::size_t each,
               const float (*directions)[3], std::size_t count, float* pdfs) {
    AcdfLocalPoint point;
    for_each_item(count, each, [&](std::size_t j, std::size_t i) {
        if (i % each == 0) point = view.at(normals[j]);
        pdfs[i] = view.pdf(point, directions[i]);
    });
}

void sample_batch(const acdf::BrdfView& view, const float (*wo)[3], std::size_t each, const double (*u)[2],
                  std::size_t count, float (*wi)[3], float* pdfs) {
    for_each_item(count, each,
                  [&](std::size_t j, std::size_t i) { put(view.sample(wo[j], u[i][0], u[i][1]), wi[i], pdfs[i]); });
}

void pdf_batch(const acdf::BrdfView& view, const float (*wo)[3], std::size_t each, const float (*wi)[3],
               std::size_t count, float* pdfs) {
    for_each_item(count, each, [&](std::size_t j, std::size_t i) { pdfs[i] = view.pdf(wo[j], wi[i]); });
}
#endif

// Arrays of pairs of numbers and of vectors, as those have them.
const double (*pairs(const double* array))[2] { return reinterpret_cast<const double(*)[2]>(array); }
const float (*vectors(const float* array))[3] { return reinterpret_cast<const float(*)[3]>(array); }
float (*vectors(float* array))[3] { return reinterpret_cast<float(*)[3]>(array); }

} // namespace

float acdf_sample_environment(const AcdfFile* file, double u0, double u1, float direction[3]) {
    if (file->kind() != ACDF_KIND_ENVIRONMENT) return 0.0f;
    return keep(acdf_environment_sample(&file->environment, u0, u1), direction);
}

float acdf_pdf_environment(const AcdfFile* file, const float direction[3]) {
    return file->kind() == ACDF_KIND_ENVIRONMENT ? acdf_environment_pdf(&file->environment, direction) : 0.0f;
}

int acdf_sample_environment_array(const AcdfFile* file, const double* u, size_t count, float* directions,
                                  float* pdfs) {
    if (file->kind() != ACDF_KIND_ENVIRONMENT) return 0;
    sample_batch(acdf::EnvironmentView(file->environment), pairs(u), count, vectors(directions), pdfs);
    return 1;
}

int acdf_pdf_environment_array(const AcdfFile* file, const float* directions, size_t count, float* pdfs) {
    if (file->kind() != ACDF_KIND_ENVIRONMENT) return 0;
    pdf_batch(acdf::EnvironmentView(file->environment), vectors(directions), count, pdfs);
    return 1;
}

int acdf_invert_environment_array(const AcdfFile* file, const float* directions, size_t count, double* u) {
    if (file->kind() != ACDF_KIND_ENVIRONMENT) return 0;
    for (size_t i = 0; i < count; ++i)
        put_numbers(acdf_environment_invert(&file->environment, directions + 3 * i, u + 2 * i) != 0, 2, u + 2 * i);
    return 1;
}

float acdf_sample_local(const AcdfFile* file, const float normal[3], double u0, double u1, float direction[3]) {
    if (file->kind() != ACDF_KIND_LOCAL) return 0.0f;
    return keep(acdf_local_sample(&file->local, normal, u0, u1), direction);
}

float acdf_pdf_local(const AcdfFile* file, const float normal[3], const float direction[3]) {
    return file->kind() == ACDF_KIND_LOCAL ? acdf_local_pdf(&file->local, normal, direction) : 0.0f;
}

int acdf_sample_local_array(const AcdfFile* file, const float* normals, size_t each, const double* u, size_t count,
                            float* directions, float* pdfs) {
    if (!serves(file, ACDF_KIND_LOCAL, each)) return 0;
    sample_batch(acdf::LocalEnvironmentView(file->local), vectors(normals), each, pairs(u), count,
                 vectors(directions), pdfs);
    return 1;
}

int acdf_pdf_local_array(const AcdfFile* file, const float* normals, size_t each, const float* directions,
                         size_t count, float* pdfs) {
    if (!serves(file, ACDF_KIND_LOCAL, each)) return 0;
    pdf_batch(acdf::LocalEnvironmentView(file->local), vectors(normals), each, vectors(directions), count, pdfs);
    return 1;
}

int acdf_irradiance_local_array(const AcdfFile* file, const float* normals, size_t count, double* irradiances) {
    if (file->kind() != ACDF_KIND_LOCAL) return 0;
    for (size_t i = 0; i < count; ++i) irradiances[i] = acdf_local_irradiance(&file->local, normals + 3 * i);
    return 1;
}

float acdf_sample_brdf(const AcdfFile* file, const float wo[3], double u0, double u1, float wi[3]) {
    return file->kind() == ACDF_KIND_BRDF ? keep(acdf_brdf_sample(&file->brdf, wo, u0, u1), wi) : 0.0f;
}

float acdf_pdf_brdf(const AcdfFile* file, const float wo[3], const float wi[3]) {
    return file->kind() == ACDF_KIND_BRDF ? acdf_brdf_pdf(&file->brdf, wo, wi) : 0.0f;
}

int acdf_sample_brdf_array(const AcdfFile* file, const float* wo, size_t each, const double* u, size_t count,
                           float* wi, float* pdfs) {
    if (!serves(file, ACDF_KIND_BRDF, each)) return 0;
    sample_batch(acdf::BrdfView(file->brdf), vectors(wo), each, pairs(u), count, vectors(wi), pdfs);
    return 1;
}

int acdf_pdf_brdf_array(const AcdfFile* file, const float* wo, size_t each, const float* wi, size_t count,
                        float* pdfs) {
    if (!serves(file, ACDF_KIND_BRDF, each)) return 0;
    pdf_batch(acdf::BrdfView(file->brdf), vectors(wo), each, vectors(wi), count, pdfs);
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
    if (file->kind() != ACDF_KIND_BRDF) return 0;
    for (size_t i = 0; i < count; ++i) albedos[i] = acdf_brdf_albedo(&file->brdf, wo + 3 * i);
    return 1;
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
    return file->kind() == ACDF_KIND_TABLE ? acdf_table_sampled_count(&file->table) : 0;
}
uint32_t acdf_table_indexed_axes(const AcdfFile* file) { return file->table.indexed_count; }

double acdf_sample_table(const AcdfFile* file, const uint32_t* index, const double* u, double* x) {
    if (file->kind() != ACDF_KIND_TABLE || !has_index(file->table, index)) return 0.0;
    return acdf_table_sample(&file->table, index, u, x);
}

double acdf_pdf_table(const AcdfFile* file, const uint32_t* index, const double* x) {
    if (file->kind() != ACDF_KIND_TABLE || !has_index(file->table, index)) return 0.0;
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
