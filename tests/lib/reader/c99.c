/* acdf/sample.h as C99: the same source must give the same samples. */
#include <acdf/sample.h>

void acdf_c_sample(const AcdfEnvironment* env, double u0, double u1, AcdfDirectionSample* out);

void acdf_c_sample(const AcdfEnvironment* env, double u0, double u1, AcdfDirectionSample* out) {
    *out = acdf_environment_sample(env, u0, u1);
}
