// The functions of the table that acdf_curves() returns (acdf/curves_interface.h). Not installed.
#pragma once

#include <acdf/brdf.h>
#include <acdf/local.h>

#include <cstdint>

namespace acdf {

/// Of files.
void check_curves(const AcdfUncheckedFile* file);
int inflate_planes(const std::uint8_t* bytes, std::uint64_t size, std::uint8_t* tree, std::uint64_t tree_size,
                   const char** wrong);

/// Of environments.
AcdfDirectionSample curves_sample(const AcdfEnvironment* env, double u0, double u1);
float curves_pdf(const AcdfEnvironment* env, const float direction[3]);
int curves_invert(const AcdfEnvironment* env, const float direction[3], double u[2]);
double curves_find(const AcdfEnvironment* env, const std::uint32_t square[2], AcdfRange range[2],
                   AcdfStratum strata[2]);

/// Of local environments.
int curves_local_bins(const AcdfLocal* local, const float normal[3], AcdfNormalBins* out);
void curves_local_at(const AcdfLocal* local, const float normal[3], AcdfLocalPoint* out);
double curves_local_irradiance(const AcdfLocal* local, const float normal[3]);

/// Of BRDFs.
int curves_brdf_view(const AcdfBrdf* brdf, const float wo[3], AcdfBrdfView* view);
double curves_brdf_find(const AcdfBrdf* brdf, const AcdfBrdfView* view, const AcdfBrdfPosition* place,
                        AcdfRange range[2], AcdfStratum* strata);
AcdfDirectionSample curves_brdf_sample(const AcdfBrdf* brdf, const AcdfBrdfView* view, double u0, double u1);
float curves_brdf_pdf(const AcdfBrdf* brdf, const AcdfBrdfView* view, const float wi[3]);
int curves_brdf_invert(const AcdfBrdf* brdf, const float wo[3], const float wi[3], double u[2]);

} // namespace acdf
