// The reader's sampling functions compiled with -ffast-math, as some renderers compile all they have.
#pragma once

#include <acdf/brdf.h>
#include <acdf/local.h>
#include <acdf/sample.h>

namespace fast_math {

AcdfDirectionSample environment_sample(const AcdfEnvironment& env, double u0, double u1);
float environment_pdf(const AcdfEnvironment& env, const float direction[3]);
AcdfDirectionSample local_sample(const AcdfLocal& local, const float normal[3], double u0, double u1);
float local_pdf(const AcdfLocal& local, const float normal[3], const float direction[3]);
AcdfDirectionSample brdf_sample(const AcdfBrdf& brdf, const float wo[3], double u0, double u1);
float brdf_pdf(const AcdfBrdf& brdf, const float wo[3], const float wi[3]);

} // namespace fast_math
