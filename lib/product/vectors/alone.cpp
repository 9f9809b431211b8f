#include "product/vectors/alone.h"

namespace acdf::alone {

AcdfDirectionSample cut_sample(const AcdfLocal& local, const AcdfLocalPoint& point, const AcdfCut& cut,
                               const double u[2]) noexcept {
    return acdf_cut_sample(&local, &point, &cut, u[0], u[1]);
}
AcdfDirectionSample cut_sample(const AcdfLocal& local, const AcdfLocalPoint& point, const AcdfFastCut& cut,
                               const double u[2]) noexcept {
    return acdf_fast_cut_sample(&local, &point, &cut, u[0], u[1]);
}
float cut_pdf(const AcdfLocal& local, const AcdfLocalPoint& point, const AcdfCut& cut, const float w[3]) noexcept {
    return acdf_cut_pdf(&local, &point, &cut, w);
}
float cut_pdf(const AcdfLocal& local, const AcdfLocalPoint& point, const AcdfFastCut& cut,
              const float w[3]) noexcept {
    return acdf_fast_cut_pdf(&local, &point, &cut, w);
}

} // namespace acdf::alone
