// The directions of acdf/pieces.h and acdf/shader_square.h over vectors of floats, operation by operation. Internal
// linkage: see environment_kernel.h.
#pragma once

#include "environment_vectors.h"

namespace {

ACDF_LANE Floats sine(Floats y) {
    const Floats q = y * y;
    return y + y * q * (-0.16666651f + q * (0.0083320351f + q * -0.00019503819f));
}
ACDF_LANE Floats cosine(Floats y) {
    const Floats q = y * y;
    return 1.0f + q * (-0.5f + q * (0.041666616f + q * (-0.0013886617f + q * 2.4379725e-5f)));
}

ACDF_LANE void piece_direction(Floats azimuth, Floats cap, Words quarter, Words south, Floats out[3]) {
    const Floats radius = root(cap * (2.0f - cap));
    const Words major = (Words)(radius * cosine(azimuth)), minor = (Words)(radius * sine(azimuth));
    const Words swapped = (major ^ minor) & (0u - (quarter & 1u));
    out[0] = (Floats)((major ^ swapped) ^ (((quarter + 1u) & 2u) << 30));
    out[1] = (Floats)((minor ^ swapped) ^ ((quarter & 2u) << 30));
    out[2] = (Floats)((Words)(1.0f - cap) ^ (south << 31));
}

ACDF_LANE void square_direction(Floats across, Floats along, Floats out[3]) {
    const Floats a = absolute(across), b = absolute(along), beyond = (a - 0.5f) + (b - 0.5f);
    const Floats r = most(least(a + b, (1.0f - a) + (1.0f - b)), Floats{} + 1e-30f);
    const Floats radius = r * root(1.0f - 0.5f * r * r), turn = (b - a) / r * 0.78539816f;
    const Floats s = sine(turn), c = cosine(turn);
    out[0] = (Floats)((Words)(radius * (c - s)) ^ ((Words)across & 0x80000000u));
    out[1] = (Floats)((Words)(radius * (c + s)) ^ ((Words)along & 0x80000000u));
    out[2] = -beyond * (1.0f + r);
}

ACDF_LANE Floats arc_tangent(Floats t) {
    const Floats q = t * t, q2 = q * q;
    const Floats low = (0.99999988f + q * -0.33331813f) + q2 * (0.19966962f + q * -0.14003290f);
    const Floats high = (0.098688655f + q * -0.058829753f) + q2 * (0.023780519f + q * -0.0045597920f);
    return t * (low + q2 * q2 * high);
}

} // namespace
