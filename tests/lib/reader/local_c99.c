/* acdf/local.h as C99: the same source must give the same samples. */
#include <acdf/local.h>

void acdf_c_local_sample(const AcdfLocal* local, const float normal[3], double u0, double u1,
                         AcdfDirectionSample* out);

void acdf_c_local_sample(const AcdfLocal* local, const float normal[3], double u0, double u1,
                         AcdfDirectionSample* out) {
    *out = acdf_local_sample(local, normal, u0, u1);
}
