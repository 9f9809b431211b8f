// The elementary functions of acdf/sample.h over vectors: see brdf_kernel.h.
#pragma once

#include "batch/batch_vectors.h"

namespace {

ACDF_LANE Vector polynomial4(Vector q, double c0, double c1, double c2, double c3) {
    return (c0 + q * c1) + q * q * (c2 + q * c3);
}
ACDF_LANE Vector polynomial8(Vector q, double c0, double c1, double c2, double c3, double c4, double c5, double c6,
                             double c7) {
    const Vector q2 = q * q;
    return polynomial4(q, c0, c1, c2, c3) + q2 * q2 * polynomial4(q, c4, c5, c6, c7);
}

ACDF_LANE void sincospi(Vector x, Vector* sine, Vector* cosine) {
    const Integer quadrant = truncated(2.0 * x + 4.5) - 4;
    // converted() takes what is not negative: the multiple of 1/2 that x is measured from is exact.
    const Vector y = (x - 0.5 * (converted(quadrant + 4) - 4.0)) * ACDF_PI, q = y * y;
    const Vector s = y * polynomial8(q, 1.0, -1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880, -1.0 / 39916800,
                                     1.0 / 6227020800.0, -1.0 / 1307674368000.0);
    const Vector c = 1.0 + q * polynomial8(q, -1.0 / 2, 1.0 / 24, -1.0 / 720, 1.0 / 40320, -1.0 / 3628800,
                                           1.0 / 479001600.0, -1.0 / 87178291200.0, 1.0 / 20922789888000.0);
    const Integer odd = (quadrant & 1) != 0;
    *sine = (Vector)((Integer)select(odd, c, s) ^ (quadrant & 2) << 62);
    *cosine = (Vector)((Integer)select(odd, s, c) ^ ((quadrant + 1) & 2) << 62);
}

ACDF_LANE Vector azimuth(Vector y, Vector x) {
    const Vector ax = absolute(x), high = select(ax > y, ax, y), low = select(ax > y, y, ax);
    const Vector wide = one_if(low > 0.41421356237309503 * high), steep = one_if(y > ax), left = one_if(x < 0.0);
    const Vector w = select(high > 0.0, (low - wide * high) / (high + wide * low), all(0.0));
    const Vector q = w * w, q4 = (q * q) * (q * q);
    const Vector series =
        polynomial8(q, 0.31830988618379064, -0.10610329539458131, 0.063661977233113842, -0.045472840550007838,
                    0.035367749436769451, -0.028936829427649351, 0.024477882221680791, -0.0211365210662873) +
        q4 * q4 * (0.018106577949592299 + q * (-0.01384028005905886 + q * 0.0067275982242772812));
    return left + (1.0 - 2.0 * left) * (0.5 * steep + (1.0 - 2.0 * steep) * (0.25 * wide + w * series));
}

} // namespace
