#include "tests/extremes/fast_math.h"

#ifndef __FAST_MATH__
#error "this file is to be compiled with -ffast-math"
#endif

namespace fast_math {

AcdfDirectionSample environment_sample(const AcdfEnvironment& env, double u0, double u1) {
    return acdf_environment_sample(&env, u0, u1);
}
float environment_pdf(const AcdfEnvironment& env, const float direction[3]) {
    return acdf_environment_pdf(&env, direction);
}
AcdfDirectionSample local_sample(const AcdfLocal& local, const float normal[3], double u0, double u1) {
    return acdf_local_sample(&local, normal, u0, u1);
}
float local_pdf(const AcdfLocal& local, const float normal[3], const float direction[3]) {
    return acdf_local_pdf(&local, normal, direction);
}
AcdfDirectionSample brdf_sample(const AcdfBrdf& brdf, const float wo[3], double u0, double u1) {
    return acdf_brdf_sample(&brdf, wo, u0, u1);
}
float brdf_pdf(const AcdfBrdf& brdf, const float wo[3], const float wi[3]) { return acdf_brdf_pdf(&brdf, wo, wi); }

} // namespace fast_math
