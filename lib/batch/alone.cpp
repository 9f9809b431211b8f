#include "batch/alone.h"

namespace acdf::alone {

AcdfDirectionSample local_sample(const AcdfLocal& local, const AcdfLocalPoint& point, const double u[2]) noexcept {
    return acdf_local_sample_at(&local, &point, u[0], u[1]);
}
float local_pdf(const AcdfLocal& local, const AcdfLocalPoint& point, const float w[3]) noexcept {
    return acdf_local_pdf_at(&local, &point, w);
}

AcdfDirectionSample local_sample(const AcdfLocal& local, const float normal[3], const double u[2]) noexcept {
    return acdf_local_sample(&local, normal, u[0], u[1]);
}
float local_pdf(const AcdfLocal& local, const float normal[3], const float w[3]) noexcept {
    return acdf_local_pdf(&local, normal, w);
}

} // namespace acdf::alone
