// Grids of directions of acdf/row_heights.h over vectors, operation by operation: the squares of directions in
// floats, and the directions of cells without tilts. Internal linkage: see local_kernel.h.
#pragma once

#include "batch/local_vectors.h"

#include <acdf/row_heights.h>

namespace {

// ---- finding ---------------------------------------------------------------------------------------------------

ACDF_LANE Floats with_sign(Floats size, Floats of) {
    return (Floats)(((Words)size & 0x7FFFFFFFu) | ((Words)of & 0x80000000u));
}

/* acdf_turn_float */
ACDF_LANE Floats turn_of(Floats y, Floats x) {
    const Floats ax = absolute(x), ay = absolute(y), one = Floats{} + 1.0f;
    const Floats level = with_sign(one, ax - ay), east = with_sign(one, x);
    const Floats eighth = arc_tangent(least(ay, ax) / most(ay, ax)) * (float)(0.5 / ACDF_PI);
    const Floats quarter = (0.125f - 0.125f * level) + level * eighth;
    return with_sign((0.25f - 0.25f * east) + east * quarter, y);
}

/* acdf_sure_step of lanes. Returns those that are sure. */
ACDF_LANE Signed sure_step(Floats place, float border, Signed refused, Signed* step) {
    *step = __builtin_convertvector(select(refused, Floats{}, place), Signed);
    const Floats inside = place - __builtin_convertvector(*step, Floats);
    return (inside > border) & (inside < 1.0f - border);
}

/* acdf_row_square, or acdf_fold_square, of kLanes directions. Returns the lanes that floats decide. */
ACDF_LANE Signed squares_of(bool octahedral, std::uint32_t column_count, std::uint32_t row_count,
                            const float (*directions)[3], Signed square[2]) {
    const auto columns = (float)column_count, rows = (float)row_count;
    Floats w[3], place[2];
    Signed refused;
    float border[2];
    load_vectors(directions, w);
    if (octahedral) {
        Floats across, along;
        Words key[2];
        refused = direction_place(true, w, &across, &along, key);
        place[0] = columns * (0.5f - 0.5f * across);
        place[1] = rows * (0.5f + 0.5f * along);
        border[0] = columns * 2.0f * ACDF_FOLD_BORDER;
        border[1] = rows * 2.0f * ACDF_FOLD_BORDER;
    } else {
        const Floats sin2 = w[0] * w[0] + w[1] * w[1];
        const float step = 2.0f * ACDF_FLOAT_BORDER * (float)(0.5 / ACDF_PI);
        refused = are_not_directions(sin2, sin2 + w[2] * w[2]);
        place[0] = columns * (0.5f - turn_of(w[1], w[0]));
        place[1] = rows * 2.0f * turn_of(root(sin2), w[2]);
        border[0] = columns * step;
        border[1] = rows * 2.0f * step;
    }
    Signed sure = ~refused;
    for (int axis = 0; axis < 2; ++axis) sure &= sure_step(place[axis], border[axis], refused, &square[axis]);
    return sure;
}

// ---- sampling ---------------------------------------------------------------------------------------------------

/// Halves of kLanes cells, and where in them directions are sampled: azimuth from the middle of a quarter and 1 -
/// |z|, or the position across and along the octahedral square.
struct Drawn {
    Vector angle[2], cap[2];
    Longs quarter[2], south[2];
    Integer refused[2];
};

/* acdf_row_direction of half of some lanes up to where floats go on; z0 and z1 are the heights of rows. */
ACDF_LANE void row_direction(double columns, Vector low, Vector high, Vector z0, Vector z1, const Vector u[2],
                             int half, Drawn* out) {
    const double border = columns * (ACDF_FLOAT_BORDER / (2.0 * ACDF_PI));
    const Vector west = u[0] * (high - low), x = low + west;
    const Vector height = z0 + u[1] * (z1 - z0), cap = 1.0 - absolute(height);
    const Vector from_north = z0 - height, from_south = height - z1;
    const Vector nearest = select(from_north < from_south, from_north, from_south);
    const Vector turn = 1.0 - x * (2.0 / columns), quarter = whole_part(2.0 * turn + 4.5) - 4.0;
    out->refused[half] = (west < border) | (high - x < border) |
                         (cap < (double)(ACDF_FLOAT_BORDER * ACDF_FLOAT_BORDER)) |
                         (nearest * nearest < 2.0 * ACDF_FLOAT_BORDER * ACDF_FLOAT_BORDER * cap);
    out->angle[half] = (turn - 0.5 * quarter) * ACDF_PI;
    out->cap[half] = cap;
    out->quarter[half] = (Longs)truncated(quarter + 4.0) & 3u;
    out->south[half] = (Longs)(height < 0.0) & 1u;
}

/* acdf_fold_direction of the same. */
ACDF_LANE void fold_direction(double columns, double rows, const Vector low[2], const Vector width[2],
                              const Vector u[2], int half, Drawn* out) {
    const double steps[2] = {columns, rows};
    Vector place[2];
    out->refused[half] = Integer{};
    for (int axis = 0; axis < 2; ++axis) {
        const double border = steps[axis] * ACDF_FOLD_BORDER;
        const Vector from = u[axis] * width[axis];
        out->refused[half] |= (from < border) | (width[axis] - from < border);
        place[axis] = 2.0 * (low[axis] + from) / steps[axis];
    }
    out->angle[half] = 1.0 - place[0];
    out->cap[half] = place[1] - 1.0;
}

/* What both end with. Returns the lanes that are refused. */
ACDF_LANE std::uint32_t sampled_directions(bool octahedral, const Drawn& d, Floats out[3]) {
    const Floats angle = to_floats((Doubles)d.angle[0], (Doubles)d.angle[1]);
    const Floats cap = to_floats((Doubles)d.cap[0], (Doubles)d.cap[1]);
    if (octahedral) square_direction(angle, cap, out);
    else piece_direction(angle, cap, low_words(d.quarter[0], d.quarter[1]), low_words(d.south[0], d.south[1]), out);
    return bits(d.refused[0]) | bits(d.refused[1]) << ACDF_WIDTH;
}

} // namespace
