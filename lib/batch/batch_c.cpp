// The C interface of batches.
#include <acdf/acdf.h>
#include <acdf/batch/batch.h>
#include <acdf/batch/batch_c.h>

namespace {

// Arrays of pairs of numbers and of vectors.
const double (*pairs(const double* array))[2] { return reinterpret_cast<const double(*)[2]>(array); }
const float (*vectors(const float* array))[3] { return reinterpret_cast<const float(*)[3]>(array); }
float (*vectors(float* array))[3] { return reinterpret_cast<float(*)[3]>(array); }

} // namespace

int acdf_sample_environment_batch(const AcdfFile* file, const double* u, size_t count, float* directions,
                                  float* pdfs) {
    AcdfEnvironment environment;
    if (!acdf_environment(file, &environment)) return 0;
    acdf::sample_batch(acdf::EnvironmentView(environment), pairs(u), count, vectors(directions), pdfs);
    return 1;
}

int acdf_pdf_environment_batch(const AcdfFile* file, const float* directions, size_t count, float* pdfs) {
    AcdfEnvironment environment;
    if (!acdf_environment(file, &environment)) return 0;
    acdf::pdf_batch(acdf::EnvironmentView(environment), vectors(directions), count, pdfs);
    return 1;
}

int acdf_sample_local_batch(const AcdfFile* file, const float* normals, size_t each, const double* u, size_t count,
                            float* directions, float* pdfs) {
    AcdfLocal local;
    if (!acdf_local(file, &local) || each == 0) return 0;
    acdf::sample_batch(acdf::LocalEnvironmentView(local), vectors(normals), each, pairs(u), count,
                       vectors(directions), pdfs);
    return 1;
}

int acdf_pdf_local_batch(const AcdfFile* file, const float* normals, size_t each, const float* directions,
                         size_t count, float* pdfs) {
    AcdfLocal local;
    if (!acdf_local(file, &local) || each == 0) return 0;
    acdf::pdf_batch(acdf::LocalEnvironmentView(local), vectors(normals), each, vectors(directions), count, pdfs);
    return 1;
}

int acdf_sample_brdf_batch(const AcdfFile* file, const float* wo, size_t each, const double* u, size_t count,
                           float* wi, float* pdfs) {
    AcdfBrdf brdf;
    if (!acdf_brdf(file, &brdf) || each == 0) return 0;
    acdf::sample_batch(acdf::BrdfView(brdf), vectors(wo), each, pairs(u), count, vectors(wi), pdfs);
    return 1;
}

int acdf_pdf_brdf_batch(const AcdfFile* file, const float* wo, size_t each, const float* wi, size_t count,
                        float* pdfs) {
    AcdfBrdf brdf;
    if (!acdf_brdf(file, &brdf) || each == 0) return 0;
    acdf::pdf_batch(acdf::BrdfView(brdf), vectors(wo), each, vectors(wi), count, pdfs);
    return 1;
}
