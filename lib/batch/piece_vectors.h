// The directions of acdf/pieces.h and acdf/octahedral_float.h over vectors of floats, operation by operation.
// Internal linkage: see shared_vectors.h.
#pragma once

#include "batch/shared_vectors.h"

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

ACDF_LANE Words whole(Floats x) { return (Words) __builtin_convertvector(x, Signed); }

ACDF_LANE void place_of(const Floats w[3], Floats cap, Signed refused, Floats* along, Words key[2]) {
    const Signed steep = absolute(w[1]) > absolute(w[0]);
    const Floats minor = select(steep, -w[0], w[1]), major = select(steep, w[1], w[0]), slope = minor / major;
    const Words quarter = ((Words)steep & 1u) | (((Words)major >> 30) & 2u);
    const Floats step = select(refused, Floats{}, slope * ACDF_SLOPE_STEPS + ACDF_SLOPE_STEPS);
    key[0] = ((quarter << 23) + whole(step)) & ACDF_DIRECTION_MASK;
    key[1] =
        (whole(select(refused, Floats{}, cap * ACDF_CAP_STEPS)) ^ (0u - ((Words)w[2] >> 31))) & ACDF_DIRECTION_MASK;
    *along = arc_tangent(slope);
}

ACDF_LANE void square_place(const Floats w[3], Floats* cap, Signed refused, Floats* along, Words key[2]) {
    const Floats r = root(*cap), ax = absolute(w[0]), ay = absolute(w[1]);
    const Floats minor = 0.63661977f * arc_tangent(least(ax, ay) / most(ax, ay)) * r, major = r - minor;
    const Signed south = w[2]<0.0f, steep = ay> ax;
    const Floats more = select(south, 1.0f - minor, major), less = select(south, 1.0f - major, minor);
    *along = (Floats)((Words)select(steep, less, more) | ((Words)w[0] & 0x80000000u));
    *cap = (Floats)((Words)select(steep, more, less) | ((Words)w[1] & 0x80000000u));
    const Floats last = Floats{} + ACDF_SQUARE_LAST;
    key[0] = whole(select(refused, Floats{}, least((1.0f - *along) * ACDF_SQUARE_HALF, last)));
    key[1] = whole(select(refused, Floats{}, least((1.0f + *cap) * ACDF_SQUARE_HALF, last)));
}

/* Lanes whose directions floats cannot decide. */
ACDF_LANE Signed are_not_directions(Floats sin2, Floats length2) {
    return ((Words)length2 - 0x3F7FF972u > 0x000009D4u) | ((Words)sin2 < 0x2B800000u);
}

/* acdf_keys_of_direction: local azimuth, or position across the square, cap or position along it, and keys. Returns
 * the lanes that floats cannot decide. */
ACDF_LANE Signed direction_place(bool octahedral, const Floats w[3], Floats* along, Floats* cap, Words key[2]) {
    const Floats sin2 = w[0] * w[0] + w[1] * w[1], length2 = sin2 + w[2] * w[2];
    const Signed refused = are_not_directions(sin2, length2);
    *cap = least(sin2 * (2.0f - length2) / (1.0f + absolute(w[2]) * (1.5f - 0.5f * length2)), Floats{} + 1.0f);
    if (octahedral) square_place(w, cap, refused, along, key);
    else place_of(w, *cap, refused, along, key);
    return refused;
}

} // namespace
