// Samples and pdfs as symbols: loops over the inline functions. Single calls are arrays of one, so that the code is
// there once.
#include "opened_file.h"

#include <cmath>
#include <cstring>
#include <limits>

namespace {

using DirectionSample = AcdfDirectionSample;

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

// A direction that was sampled, if any.
float keep(const DirectionSample& sample, float direction[3]) {
    if (sample.pdf > 0.0f) std::memcpy(direction, sample.direction, sizeof sample.direction);
    return sample.pdf;
}

// The first sample of an array, if any: call(u, direction, pdf).
template <class Call>
float keep_first(double u0, double u1, float direction[3], const Call& call) {
    const double u[2] = {u0, u1};
    DirectionSample sample = {};
    call(u, sample.direction, &sample.pdf);
    return keep(sample, direction);
}

void put(const DirectionSample& sample, std::size_t i, float* directions, float* pdfs) {
    std::memcpy(directions + 3 * i, sample.direction, sizeof sample.direction);
    pdfs[i] = sample.pdf;
}

// Calls serve(j, i) for each of `count` items i, of the condition j that serves it.
template <class Serve>
void for_each_item(std::size_t count, std::size_t each, Serve&& serve) {
    for (std::size_t i = 0, j = 0; i < count; ++j)
        for (const std::size_t end = each < count - i ? i + each : count; i < end; ++i) serve(j, i);
}

// Calls serve(point, i) for each of `count` items i; a point is looked up once for all that it serves.
template <class Serve>
void for_each_point(const AcdfLocal& local, const float* normals, std::size_t each, std::size_t count,
                    Serve&& serve) {
    AcdfLocalPoint point;
    for (std::size_t i = 0; i < count; ++i) {
        if (i % each == 0) acdf_local_at(&local, normals + 3 * (i / each), &point);
        serve(point, i);
    }
}

// Whether a file can serve arrays of this kind, with `each` items a condition: 0 would never come to an end.
bool serves(const AcdfFile* file, AcdfKind kind, size_t each) { return file->kind() == kind && each > 0; }

void put_numbers(bool found, int axes, double* u) {
    for (int axis = 0; axis < axes && !found; ++axis) u[axis] = kNoNumber;
}

} // namespace

float acdf_sample_environment(const AcdfFile* file, double u0, double u1, float direction[3]) {
    return keep_first(u0, u1, direction, [file](const double* u, float* out, float* pdf) {
        acdf_sample_environment_array(file, u, 1, out, pdf);
    });
}

float acdf_pdf_environment(const AcdfFile* file, const float direction[3]) {
    float pdf = 0.0f;
    acdf_pdf_environment_array(file, direction, 1, &pdf);
    return pdf;
}

int acdf_sample_environment_array(const AcdfFile* file, const double* u, size_t count, float* directions,
                                  float* pdfs) {
    if (file->kind() != ACDF_KIND_ENVIRONMENT) return 0;
    for (size_t i = 0; i < count; ++i)
        put(acdf_environment_sample(&file->environment, u[2 * i], u[2 * i + 1]), i, directions, pdfs);
    return 1;
}

int acdf_pdf_environment_array(const AcdfFile* file, const float* directions, size_t count, float* pdfs) {
    if (file->kind() != ACDF_KIND_ENVIRONMENT) return 0;
    for (size_t i = 0; i < count; ++i) pdfs[i] = acdf_environment_pdf(&file->environment, directions + 3 * i);
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
    for_each_point(file->local, normals, each, count, [&](const AcdfLocalPoint& point, size_t i) {
        put(acdf_local_sample_at(&file->local, &point, u[2 * i], u[2 * i + 1]), i, directions, pdfs);
    });
    return 1;
}

int acdf_pdf_local_array(const AcdfFile* file, const float* normals, size_t each, const float* directions,
                         size_t count, float* pdfs) {
    if (!serves(file, ACDF_KIND_LOCAL, each)) return 0;
    for_each_point(file->local, normals, each, count, [&](const AcdfLocalPoint& point, size_t i) {
        pdfs[i] = acdf_local_pdf_at(&file->local, &point, directions + 3 * i);
    });
    return 1;
}

int acdf_irradiance_local_array(const AcdfFile* file, const float* normals, size_t count, double* irradiances) {
    if (file->kind() != ACDF_KIND_LOCAL) return 0;
    for (size_t i = 0; i < count; ++i) irradiances[i] = acdf_local_irradiance(&file->local, normals + 3 * i);
    return 1;
}

float acdf_sample_brdf(const AcdfFile* file, const float wo[3], double u0, double u1, float wi[3]) {
    return keep_first(u0, u1, wi, [file, wo](const double* u, float* out, float* pdf) {
        acdf_sample_brdf_array(file, wo, 1, u, 1, out, pdf);
    });
}

float acdf_pdf_brdf(const AcdfFile* file, const float wo[3], const float wi[3]) {
    float pdf = 0.0f;
    acdf_pdf_brdf_array(file, wo, 1, wi, 1, &pdf);
    return pdf;
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
