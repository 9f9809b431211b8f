#include "measure/samplers/compensated_cdf.h"

#include <algorithm>

namespace acdf::measure {
namespace {

compress::Target subtracted(const compress::Target& target, double radiance) {
    compress::Target out = target;
    bool lit = false;
    for (float& value : out.values) {
        value = static_cast<float>(std::max(0.0, value - radiance));
        lit = lit || value > 0.0f;
    }
    if (!lit) std::fill(out.values.begin(), out.values.end(), 1.0f);
    return out;
}

} // namespace

CompensatedCdf::CompensatedCdf(const compress::Target& target, double s)
    : grid_(target), cdf_(subtracted(target, s * grid_.flux() / (4.0 * ACDF_PI))) {}

AcdfDirectionSample CompensatedCdf::sample(double u0, double u1) const {
    return grid_.place(cdf_.sample(static_cast<float>(u0), static_cast<float>(u1)));
}

float CompensatedCdf::pdf(const float direction[3]) const {
    std::uint32_t texel[2];
    return grid_.find(direction, texel) ? static_cast<float>(cdf_.pdf(texel[0], texel[1])) : 0.0f;
}

} // namespace acdf::measure
