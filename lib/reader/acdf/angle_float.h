/* The arc tangent, sine and cosine in floats. One text for processors and for shaders of every language, which have
 * words of their own for functions and constants (acdf/shader/dialect.h). */
#ifndef ACDF_ANGLE_FLOAT_H
#define ACDF_ANGLE_FLOAT_H

#ifndef ACDF_FN1
#define ACDF_ANGLES_IN_C
#define ACDF_F32 float
#define ACDF_LET(type, name) const type name
#define ACDF_FN1(result, name, type, x) ACDF_INLINE result name(type x)
#include <acdf/elementary.h>
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- angles ---------------------------------------------------------------------------------------- */

/* atan(t) for t in [-1, 1], interpolated at the Chebyshev nodes of t^2; error below 2e-7. */
ACDF_FN1(ACDF_F32, acdf_atan_float, ACDF_F32, t) {
    ACDF_LET(ACDF_F32, q) = t * t;
    ACDF_LET(ACDF_F32, q2) = q * q;
    ACDF_LET(ACDF_F32, low) = (0.99999988f + q * -0.33331813f) + q2 * (0.19966962f + q * -0.14003290f);
    ACDF_LET(ACDF_F32, high) = (0.098688655f + q * -0.058829753f) + q2 * (0.023780519f + q * -0.0045597920f);
    return t * (low + q2 * q2 * high);
}

/* Sine and cosine for |y| <= pi/4, interpolated at the Chebyshev nodes of y^2; error below 1e-7. */
ACDF_FN1(ACDF_F32, acdf_sine_float, ACDF_F32, y) {
    ACDF_LET(ACDF_F32, q) = y * y;
    return y + y * q * (-0.16666651f + q * (0.0083320351f + q * -0.00019503819f));
}
ACDF_FN1(ACDF_F32, acdf_cosine_float, ACDF_F32, y) {
    ACDF_LET(ACDF_F32, q) = y * y;
    return 1.0f + q * (-0.5f + q * (0.041666616f + q * (-0.0013886617f + q * 2.4379725e-5f)));
}

#ifdef __cplusplus
}
#endif

#ifdef ACDF_ANGLES_IN_C
#undef ACDF_ANGLES_IN_C
#undef ACDF_F32
#undef ACDF_LET
#undef ACDF_FN1
#endif
#endif
