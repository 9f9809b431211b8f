// Angles in half turns (units of pi), and functions of them that are the same on every machine, as those of libm
// are not: the reader's.
#pragma once

#include <acdf/sample.h>

#include <cmath>

namespace acdf::compress {

constexpr double pi = ACDF_PI;

struct SineCosine {
    double sine, cosine;
};

/// Of pi * `half_turns`, in [-2, 2].
inline SineCosine sine_cosine(double half_turns) {
    SineCosine of{};
    acdf_sincospi(half_turns, &of.sine, &of.cosine);
    return of;
}

/// atan2(y, x) / pi, in [-1, 1].
inline double half_turns(double y, double x) { return acdf_atan2pi(y, x); }

/// Unlike std::hypot, rounded the same everywhere; for components of unit vectors.
template <class Real>
Real norm(Real x, Real y) {
    return std::sqrt(x * x + y * y);
}

} // namespace acdf::compress
