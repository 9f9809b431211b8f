// Draws and densities of EnvironmentWavefront by groups of cells, over vectors: see environment_kernel.h.
//
// Each function is that of the same name in acdf/groups.h, operation by operation. A call waits for up to six
// loads, each of which needs the one before. So all calls of a block make one of them after the other, and what the
// next one needs is asked for. Of the groups that may hold a point, and of the cells, the first is looked at;
// single functions look for another where that is not it.
#pragma once

#include "environment_wavefront.h"
#include "row_vectors.h"
#include "search_vectors.h"

#include <acdf/sample.h>

#include <cstring>

namespace {

/// A cell of a group: its number there, and in the block that has its boxes.
struct GroupCell {
    std::uint32_t number, in_block;
    const std::uint32_t* boxes;
    bool found;
};

ACDF_LANE const AcdfGroup* group_at(const AcdfGroups* groups, std::uint32_t i) {
    return (const AcdfGroup*)(const void*)acdf_group_words(groups, groups->groups) + i;
}

/* The first cell of a group whose boxes, from a word of their block on, may hold a point; where there is none, any.
 */
ACDF_LANE GroupCell cell_of_group(const AcdfGroups* groups, const AcdfGroup* group, std::uint32_t number,
                                  std::uint32_t from, __m256i at0, __m256i at1) {
    const std::uint32_t* boxes = acdf_group_words(groups, groups->boxes + ACDF_GROUP_WORDS * number);
    std::uint32_t first = 0, mask = candidates(boxes + from, at0, at1);
    while (__builtin_expect(mask == 0, 0)) {
        first += ACDF_BLOCK_CELLS;
        if (first >= group->count) return {0, 0, boxes, false};
        boxes = acdf_group_boxes(groups, group, first);
        mask = candidates(boxes + from, at0, at1);
    }
    const std::uint32_t i = acdf_lowest_bit(mask);
    return {first + i, i, boxes, true};
}

// ---- drawing ---------------------------------------------------------------------------------------------------

/// The lanes of a block in their groups and cells.
struct Grouped {
    alignas(64) std::uint64_t left[kBlock][2]; // of the numbers in the group, in steps of 2^-52
    alignas(64) double u[kBlock][2];           // in the cell
    alignas(64) double range[kBlock][4];       // columns of the cell; heights of its rows, or these
    alignas(64) std::uint32_t cell[kBlock];
    std::uint32_t alone, lost; // bits of lanes: in a group of one cell; that tables do not answer
};

/* Sets the positions of a lane's cell; z are heights of rows or null. */
ACDF_LANE void set_range(const double* z, const std::uint32_t low[2], const std::uint32_t high[2], double to[4]) {
    to[0] = (double)(std::int32_t)low[0];
    to[1] = (double)(std::int32_t)high[0];
    to[2] = z ? z[low[1]] : (double)(std::int32_t)low[1];
    to[3] = z ? z[high[1]] : (double)(std::int32_t)high[1];
}

/* Enters the group of a lane, and the first of its cells that may be drawn. */
ACDF_LANE void enter_group(const AcdfGroups* groups, const double* z, const double u[2], std::size_t i,
                           Sought* sought, Grouped* in) {
    const __m256i turned = _mm256_set_m128i(_mm_set1_epi8(0x7F), _mm_set1_epi8((char)0x80));
    const AcdfGroup* group = group_at(groups, sought->cell[i]);
    const __m128d left =
        _mm_add_pd(_mm_mul_pd(_mm_sub_pd(_mm_loadu_pd(u), _mm_load_pd(group->low)), _mm_load_pd(group->scale)),
                   _mm_set1_pd(1.0));
    __m128i n = _mm_xor_si128(_mm_castpd_si128(left), _mm_set1_epi64x(0x3FF0000000000000));
    if (__builtin_expect(!_mm_testz_si128(n, _mm_set1_epi64x((long long)0xFFF0000000000000)), 0)) {
        std::uint64_t steps[2] = {0, 0};
        const AcdfGroup* const other = acdf_group_of_numbers(groups, u[0], u[1], steps);
        if (other) sought->cell[i] = acdf_group_number(groups, group = other);
        else in->lost |= 1u << i;
        n = _mm_loadu_si128((const __m128i*)(const void*)steps);
    }
    _mm_store_si128((__m128i*)(void*)in->left[i], n);
    const __m256i bytes = _mm256_broadcastsi128_si256(_mm_slli_epi64(n, 4)); // bits 44 to 51 of each
    const __m256i at0 = _mm256_xor_si256(_mm256_shuffle_epi8(bytes, _mm256_set1_epi8(6)), turned);
    const __m256i at1 = _mm256_xor_si256(_mm256_shuffle_epi8(bytes, _mm256_set1_epi8(14)), turned);
    const GroupCell cell = cell_of_group(groups, group, sought->cell[i], 0, at0, at1);
    in->cell[i] = group->cells + cell.number;
    ACDF_PREFETCH(acdf_group_words(groups, groups->cells + 4 * in->cell[i]));
    ACDF_PREFETCH(acdf_group_words(groups, groups->densities + in->cell[i]));
    if (__builtin_expect(cell.found, 1)) {
        AcdfRange range[2];
        acdf_group_range(group, cell.boxes + ACDF_GROUP_POSITIONS, cell.in_block, range);
        const std::uint32_t low[2] = {range[0].low, range[1].low}, high[2] = {range[0].high, range[1].high};
        set_range(z, low, high, in->range[i]);
        return;
    }
    set_range(z, group->first, group->last, in->range[i]);
    (group->count == 1 ? in->alone : in->lost) |= 1u << i;
}

/* acdf_group_across of both axes of ACDF_WIDTH / 2 lanes. Returns a bit of each that is next to a border. */
ACDF_LANE std::uint64_t cross_cells(const AcdfGroups* groups, std::size_t first, Grouped* in) {
    const auto* const cells = (const AcdfGroupCell*)(const void*)acdf_group_words(groups, groups->cells);
    alignas(64) AcdfGroupCell cell[ACDF_WIDTH / 2];
    for (std::size_t i = 0; i < ACDF_WIDTH / 2; ++i)
        _mm_store_si128((__m128i*)(void*)&cell[i],
                        _mm_load_si128((const __m128i*)(const void*)&cells[in->cell[first + i]]));
    Integer axis;
    std::memcpy(&axis, cell, sizeof axis);
    const Vector scale = low_floats((Integer)((Unsigned)axis >> 32)), margin = (double)ACDF_GROUP_MARGIN * scale;
    const Integer number = (Integer)((Unsigned)loaded((const long long*)in->left[first]) >> 20);
    const Vector past = converted((number - axis - ACDF_GROUP_MARGIN) & 0xFFFFFFFF) * scale;
    const Integer inside = past < 1.0 - 2.0 * margin;
    const Vector across = select(inside, past + margin, all(1.0));
    stored(in->u[first], across);
    return bits((Integer) !(across < 1.0));
}

/* What is left in its cell of the numbers of all lanes. */
ACDF_LANE void draw_cells(const AcdfGroups* groups, const double* z, const Sought& sought, Grouped* in) {
    std::uint64_t outside = 0; // two bits a lane
    for (std::size_t first = 0; first < kBlock; first += ACDF_WIDTH / 2)
        outside |= cross_cells(groups, first, in) << 2 * first;
    while (outside) {
        const std::uint32_t i = (std::uint32_t)__builtin_ctzll(outside) / 2;
        AcdfRange range[2];
        outside &= ~(std::uint64_t{3} << 2 * i);
        if ((in->alone | in->lost) >> i & 1u) continue;
        if (acdf_group_draw(groups, group_at(groups, sought.cell[i]), in->left[i], in->u[i], range, &in->cell[i])) {
            const std::uint32_t low[2] = {range[0].low, range[1].low}, high[2] = {range[0].high, range[1].high};
            set_range(z, low, high, in->range[i]);
        } else {
            in->lost |= 1u << i;
        }
    }
    for (std::uint32_t alone = in->alone; alone; alone &= alone - 1) {
        const std::uint32_t i = acdf_lowest_bit(alone);
        for (int axis = 0; axis < 2; ++axis) in->u[i][axis] = (double)(std::int64_t)in->left[i][axis] * 0x1p-52;
    }
}

/* acdf_row_direction, or acdf_fold_direction, and densities of kLanes lanes. */
ACDF_LANE void place_lanes(const AcdfEnvironment& env, std::size_t first, Grouped* in, AcdfDirectionSample* out) {
    const bool octahedral = env.groups->heights == 0;
    Drawn d;
    Floats direction[3];
    for (std::size_t half = 0; half < 2; ++half) {
        const std::size_t at = first + ACDF_WIDTH * half;
        Doubles left[2];
        Vector range[4];
        load_pairs(in->u + at, left);
        gather_transposed(in->range[at], numbers_from(0) * 2, range);
        const Vector u[2] = {(Vector)left[0], (Vector)left[1]}, low[2] = {range[0], range[2]};
        const Vector width[2] = {range[1] - range[0], range[3] - range[2]};
        if (octahedral) fold_direction(env.columns, env.rows, low, width, u, (int)half, &d);
        else row_direction(env.columns, range[0], range[1], range[2], range[3], u, (int)half, &d);
    }
    in->lost |= drawn_directions(octahedral, d, direction) << first;
    const std::uint32_t* const densities = acdf_group_words(env.groups, env.groups->densities);
    store_samples(direction, (Floats)gathered(densities, *(const Words*)&in->cell[first]), out + first);
}

/* acdf_environment_sample of a block. */
ACDF_LANE void sample_grouped(const AcdfEnvironment& env, const Search& s, const double (*u)[2],
                              AcdfDirectionSample* out) {
    const AcdfGroups* const groups = env.groups;
    const auto* const z =
        groups->heights ? (const double*)(const void*)acdf_group_words(groups, groups->heights) : nullptr;
    Sought sought;
    Numbers n;
    Grouped in;
    in.alone = in.lost = 0;
    for (std::size_t first = 0; first < kBlock; first += kLanes) {
        Words key[2];
        in.lost |= load_numbers(u, first, &n, key);
        find_blocks(s, key[0], key[1], &sought, first);
    }
    ask_for_blocks(s, sought);
    find_cells(s, &sought, [groups](std::uint32_t group) {
        ACDF_PREFETCH(acdf_group_at(groups, group, 0u));
        ACDF_PREFETCH(acdf_group_words(groups, groups->boxes + ACDF_GROUP_WORDS * group + ACDF_GROUP_POSITIONS));
    });
    for (std::size_t i = 0; i < kBlock; ++i) enter_group(groups, z, u[i], i, &sought, &in);
    draw_cells(groups, z, sought, &in);
    for (std::size_t first = 0; first < kBlock; first += kLanes) place_lanes(env, first, &in, out);
    for (std::uint32_t lost = in.lost; lost; lost &= lost - 1) {
        const std::uint32_t i = acdf_lowest_bit(lost);
        out[i] = acdf_environment_sample(&env, u[i][0], u[i][1]);
    }
}

// ---- finding ---------------------------------------------------------------------------------------------------

/* The cell of a lane's group that holds its square, which stays where it is found. Returns whether there is none.
 */
ACDF_LANE bool locate(const AcdfGroups* groups, std::uint32_t square0, std::uint32_t square1, std::uint32_t* cell) {
    const __m256i turned = _mm256_set_m128i(_mm_set1_epi8(0x7F), _mm_set1_epi8((char)0x80));
    const AcdfGroup* const group = group_at(groups, *cell);
    const std::uint32_t at0 = square0 - group->first[0], at1 = square1 - group->first[1];
    const bool inside = (at0 < group->last[0] - group->first[0]) & (at1 < group->last[1] - group->first[1]);
    const GroupCell found = cell_of_group(groups, group, *cell, ACDF_GROUP_POSITIONS,
                                          _mm256_xor_si256(_mm256_set1_epi8((char)at0), turned),
                                          _mm256_xor_si256(_mm256_set1_epi8((char)at1), turned));
    *cell = group->cells + found.number;
    ACDF_PREFETCH(acdf_group_words(groups, groups->densities + *cell));
    return !(inside & (found.found | (group->count == 1)));
}

/* acdf_environment_pdf of a block. */
ACDF_LANE void pdf_grouped(const AcdfEnvironment& env, const Search& s, const float (*w)[3], float* out) {
    const AcdfGroups* const groups = env.groups;
    Sought sought;
    alignas(64) std::uint32_t square[2][kBlock];
    std::uint32_t lost = 0;
    for (std::size_t first = 0; first < kBlock; first += kLanes) {
        Signed at[2];
        const Signed sure = squares_of(groups->heights == 0, env.columns, env.rows, w + first, at);
        for (int axis = 0; axis < 2; ++axis) *(Words*)&square[axis][first] = (Words)(at[axis] & sure);
        find_blocks(s, (Words)(at[0] & sure) << groups->shift[0], (Words)(at[1] & sure) << groups->shift[1],
                    &sought, first);
        lost |= bits(~sure) << first;
    }
    ask_for_blocks(s, sought);
    find_cells(s, &sought, [groups](std::uint32_t group) {
        ACDF_PREFETCH(acdf_group_at(groups, group, ACDF_GROUP_POSITIONS));
    });
    for (std::size_t i = 0; i < kBlock; ++i)
        lost |= (std::uint32_t)locate(groups, square[0][i], square[1][i], &sought.cell[i]) << i;
    const std::uint32_t* const densities = acdf_group_words(groups, groups->densities);
    for (std::size_t first = 0; first < kBlock; first += kLanes) {
        const Words pdf = gathered(densities, *(const Words*)&sought.cell[first]);
        std::memcpy(out + first, &pdf, sizeof pdf);
    }
    for (; lost; lost &= lost - 1) {
        const std::uint32_t i = acdf_lowest_bit(lost);
        out[i] = acdf_environment_pdf(&env, w[i]);
    }
}

// ---- all of an array -------------------------------------------------------------------------------------------

ACDF_LANE void sample_by_groups(const AcdfEnvironment& env, const double (*u)[2], std::size_t count,
                                AcdfDirectionSample* out) {
    const Search s = search_of(env.groups, env.groups->numbers);
    for_blocks(u, count, out,
               [&](const double(*from)[2], AcdfDirectionSample* to) { sample_grouped(env, s, from, to); });
}
ACDF_LANE void pdf_by_groups(const AcdfEnvironment& env, const float (*w)[3], std::size_t count, float* out) {
    const Search s = search_of(env.groups, env.groups->places);
    for_blocks(w, count, out, [&](const float(*from)[3], float* to) { pdf_grouped(env, s, from, to); });
}

} // namespace
