/* Samples and pdfs as symbols of a library, singly and in arrays, of files that acdf/acdf.h opens. Python, Rust,
 * Julia or C# call them where they cannot compile the inline functions of acdf/sample.h, local.h, brdf.h and
 * table.h. All arguments are numbers and pointers to them. Each returns the result of the inline function, bit for
 * bit, where that is compiled with -ffp-contract=off as the library is. Else directions may differ in the last bit
 * on processors that fuse products and sums (gcc's -march=native). All are thread-safe and allocate nothing.
 *
 * Where acdf::batch is built, arrays of environments, local environments and BRDFs are sampled and evaluated by it,
 * in a third of the time, about.
 *
 * Arrays are packed: two doubles u in [0, 1] a sample, three floats a direction, normal or view (unit vectors;
 * normals of any length > 0), a float a pdf (sr^-1). They may not overlap. Results have `count` items. Where
 * normals, views or indices are given, each serves `each` samples that follow one another (at least 1): item i is
 * of normal i / each; count: one serves all. A function returns 0 and writes nothing where the file is of another
 * kind, `each` is 0, or the index is null and the table has indexed axes. Arrays return 1 else. */
#ifndef ACDF_ARRAYS_ARRAYS_H
#define ACDF_ARRAYS_ARRAYS_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct AcdfFile AcdfFile;

/* ---- environments ---- */

/* Samples a direction; returns its pdf in sr^-1, > 0. */
float acdf_sample_environment(const AcdfFile* file, double u0, double u1, float direction[3]);
/* The pdf of a direction in sr^-1; 0 where none falls, for NaN and for directions that are not of unit length. */
float acdf_pdf_environment(const AcdfFile* file, const float direction[3]);
int acdf_sample_environment_array(const AcdfFile* file, const double* u, size_t count, float* directions,
                                  float* pdfs);
int acdf_pdf_environment_array(const AcdfFile* file, const float* directions, size_t count, float* pdfs);
/* The random numbers that sample each direction; NaN where the pdf is 0. */
int acdf_invert_environment_array(const AcdfFile* file, const float* directions, size_t count, double* u);

/* ---- local environments ---- */

/* The pdf is 0, and the direction unset, where the normal is zero or NaN or nothing shines on it. */
float acdf_sample_local(const AcdfFile* file, const float normal[3], double u0, double u1, float direction[3]);
float acdf_pdf_local(const AcdfFile* file, const float normal[3], const float direction[3]);
/* Directions are 0 where their pdf is. A point is looked up once for all that it serves. */
int acdf_sample_local_array(const AcdfFile* file, const float* normals, size_t each, const double* u, size_t count,
                            float* directions, float* pdfs);
int acdf_pdf_local_array(const AcdfFile* file, const float* normals, size_t each, const float* directions,
                         size_t count, float* pdfs);
/* Luminance times sr, of `count` normals: acdf_local_irradiance. */
int acdf_irradiance_local_array(const AcdfFile* file, const float* normals, size_t count, double* irradiances);

/* ---- BRDFs: wo and wi in the surface's frame, z its normal ---- */

/* The pdf is 0, and wi unset, where wo is not a unit vector above the surface. */
float acdf_sample_brdf(const AcdfFile* file, const float wo[3], double u0, double u1, float wi[3]);
float acdf_pdf_brdf(const AcdfFile* file, const float wo[3], const float wi[3]);
int acdf_sample_brdf_array(const AcdfFile* file, const float* wo, size_t each, const double* u, size_t count,
                           float* wi, float* pdfs);
int acdf_pdf_brdf_array(const AcdfFile* file, const float* wo, size_t each, const float* wi, size_t count,
                        float* pdfs);
/* The random numbers that sample each wi; NaN where the table's pdf is 0. */
int acdf_invert_brdf_array(const AcdfFile* file, const float* wo, size_t each, const float* wi, size_t count,
                           double* u);
/* In [0, 1], about, of `count` views: acdf_brdf_albedo. */
int acdf_albedo_brdf_array(const AcdfFile* file, const float* wo, size_t count, double* albedos);

/* ---- tables: u and x have a number a sampled axis, `index` one an indexed axis (null where there is none) ---- */

/* How many axes are sampled and indexed; 0 where the file is of another kind. */
uint32_t acdf_table_sampled_axes(const AcdfFile* file);
uint32_t acdf_table_indexed_axes(const AcdfFile* file);
/* The pdf per product of the units of the sampled axes; 0, and x unset, where the bin has no energy or an index is
 * out of range. */
double acdf_sample_table(const AcdfFile* file, const uint32_t* index, const double* u, double* x);
double acdf_pdf_table(const AcdfFile* file, const uint32_t* index, const double* x);
/* Points are NaN where their pdf is 0. */
int acdf_sample_table_array(const AcdfFile* file, const uint32_t* index, size_t each, const double* u, size_t count,
                            double* x, double* pdfs);
int acdf_pdf_table_array(const AcdfFile* file, const uint32_t* index, size_t each, const double* x, size_t count,
                         double* pdfs);
/* The random numbers that sample each point; NaN where the pdf is 0. */
int acdf_invert_table_array(const AcdfFile* file, const uint32_t* index, size_t each, const double* x, size_t count,
                            double* u);

#ifdef __cplusplus
}
#endif
#endif
