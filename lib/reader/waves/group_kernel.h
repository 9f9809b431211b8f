// Draws and densities of EnvironmentWavefront by groups of cells, over vectors: see environment_kernel.h.
//
// Each function is that of the same name in acdf/groups.h, operation by operation. A call waits for up to six
// loads, each of which needs the one before. So all calls of a block make one of them after the other, and what the
// next one needs is asked for. Of the groups that may hold a point, and of the cells, the first is looked at;
// single functions look for another where that is not it.
#pragma once

#include "waves/alone.h"
#include "waves/environment.h"
#include "waves/row_vectors.h"
#include "waves/search_vectors.h"

#include <acdf/sample.h>

#include <cstring>

namespace {

/// The arrays of AcdfGroups.
struct GroupArrays {
    const AcdfGroups* all;
    const AcdfGroup* groups;
    const std::uint8_t *boxes, *more;
    const AcdfGroupCell* cells;
    const std::uint32_t* densities;
    const double* heights; // null on the octahedral square
    bool several;          // whether groups have several blocks of cells
};

ACDF_LANE GroupArrays arrays_of(const AcdfGroups* groups) {
    const auto at = [groups](std::uint32_t offset) { return (const void*)acdf_group_words(groups, offset); };
    return {groups,
            (const AcdfGroup*)at(groups->groups),
            (const std::uint8_t*)at(groups->boxes),
            (const std::uint8_t*)at(groups->more),
            (const AcdfGroupCell*)at(groups->cells),
            acdf_group_words(groups, groups->densities),
            groups->heights ? (const double*)at(groups->heights) : nullptr,
            groups->cells > groups->more};
}

constexpr std::size_t kGroupBytes = 4 * ACDF_GROUP_WORDS, kPositions = 4 * ACDF_GROUP_POSITIONS;

/* The boxes of a group's cells of numbers 16 * block and up. */
ACDF_LANE const std::uint8_t* boxes_of(const GroupArrays& g, const AcdfGroup* group, std::size_t number,
                                       std::size_t block) {
    return block == 0 ? g.boxes + kGroupBytes * number : g.more + kGroupBytes * (group->more + block - 1);
}

/* Asks for the boxes of the groups of all lanes, from some byte of each block on, that do not stand where the
 * number of a group tells. */
ACDF_LANE void ask_for_more(const GroupArrays& g, const Sought& sought, std::size_t from) {
    for (std::size_t i = 0; i < kSearched; ++i) {
        const AcdfGroup* const group = g.groups + sought.cell[i];
        const std::uint8_t* const boxes = g.more + kGroupBytes * group->more + from;
        if (group->count > ACDF_BLOCK_CELLS) ACDF_PREFETCH(boxes);
        if (group->count > 2 * ACDF_BLOCK_CELLS) {
            ACDF_PREFETCH(boxes + kGroupBytes);
            ACDF_PREFETCH(boxes + 2 * kGroupBytes);
        }
    }
}

/* The first cell of a group that may hold a point, by boxes from some byte of each block on; kNone where there is
 * none. No branch on which block it is in. */
constexpr std::uint32_t kNone = ~0u;
ACDF_LANE std::uint32_t cell_of_group(const GroupArrays& g, const AcdfGroup* group, std::size_t number,
                                      std::size_t from, __m256i at0, __m256i at1) {
    std::uint64_t mask = candidates(boxes_of(g, group, number, 0) + from, at0, at1);
    if (g.several) {
        const std::uint8_t* const more = boxes_of(g, group, number, 1) + from;
        const std::uint32_t count = group->count;
        if (count > ACDF_BLOCK_CELLS) mask |= (std::uint64_t)candidates(more, at0, at1) << 16;
        if (count > 2 * ACDF_BLOCK_CELLS) {
            const std::size_t last = count > 3 * ACDF_BLOCK_CELLS ? 2 * kGroupBytes : kGroupBytes;
            mask |= (std::uint64_t)candidates(more + kGroupBytes, at0, at1) << 32;
            mask |= (std::uint64_t)candidates(more + last, at0, at1) << 48; // maybe the third once more
        }
        for (std::uint32_t first = 64; __builtin_expect((mask == 0) & (first < count), 0); first += 16) {
            mask = candidates(boxes_of(g, group, number, first / 16) + from, at0, at1);
            if (mask != 0) return first + acdf_lowest_bit((std::uint32_t)mask);
        }
    }
    return mask != 0 ? (std::uint32_t)__builtin_ctzll(mask) : kNone;
}

// ---- drawing ---------------------------------------------------------------------------------------------------

/// The lanes of a block in their groups and cells.
struct Grouped {
    alignas(64) std::uint64_t left[kSearched][2]; // of the numbers in the group, in steps of 2^-52
    alignas(64) double u[kSearched][2];           // in the cell
    alignas(64) double range[kSearched][4];       // columns of the cell; heights of its rows, or these
    alignas(64) std::uint32_t cell[kSearched], in_group[kSearched];
    std::uint32_t alone, lost; // bits of lanes: in a group of one cell; that tables do not answer
};

/* Enters the group of a lane, and the first of its cells that may be drawn, which is asked for. */
ACDF_LANE void enter_group(const GroupArrays& g, const double u[2], std::size_t i, Sought* sought, Grouped* in) {
    const __m256i turned = _mm256_set_m128i(_mm_set1_epi8(0x7F), _mm_set1_epi8((char)0x80));
    std::size_t number = sought->cell[i];
    const AcdfGroup* group = g.groups + number;
    const __m128d left =
        _mm_add_pd(_mm_mul_pd(_mm_sub_pd(_mm_loadu_pd(u), _mm_load_pd(group->low)), _mm_load_pd(group->scale)),
                   _mm_set1_pd(1.0));
    __m128i n = _mm_xor_si128(_mm_castpd_si128(left), _mm_set1_epi64x(0x3FF0000000000000));
    if (__builtin_expect(!_mm_testz_si128(n, _mm_set1_epi64x((long long)0xFFF0000000000000)), 0)) {
        std::uint64_t steps[2] = {0, 0};
        const AcdfGroup* const other = acdf_group_of_numbers(g.all, u[0], u[1], steps);
        if (other) sought->cell[i] = (std::uint32_t)(number = acdf_group_number(g.all, group = other));
        else in->lost |= 1u << i;
        n = _mm_loadu_si128((const __m128i*)(const void*)steps);
    }
    _mm_store_si128((__m128i*)(void*)in->left[i], n);
    const __m256i bytes = _mm256_broadcastsi128_si256(_mm_slli_epi64(n, 4)); // bits 44 to 51 of each
    const __m256i at0 = _mm256_xor_si256(_mm256_shuffle_epi8(bytes, _mm256_set1_epi8(6)), turned);
    const __m256i at1 = _mm256_xor_si256(_mm256_shuffle_epi8(bytes, _mm256_set1_epi8(14)), turned);
    std::uint32_t cell = cell_of_group(g, group, number, 0, at0, at1);
    if (__builtin_expect(cell == kNone, 0)) {
        (group->count == 1 ? in->alone : in->lost) |= 1u << i;
        cell = 0;
    }
    in->in_group[i] = cell;
    in->cell[i] = group->cells + cell;
    ACDF_PREFETCH(boxes_of(g, group, number, cell / 16) + kPositions);
    ACDF_PREFETCH(&g.cells[in->cell[i]]);
    ACDF_PREFETCH(&g.densities[in->cell[i]]);
}

/* Sets the positions of a lane's cell, low and high of both axes. */
ACDF_LANE void set_range(const double* heights, __m128i range, double to[4]) {
    _mm_store_pd(to, _mm_cvtepi32_pd(range));
    if (heights) {
        const auto rows = (std::uint64_t)_mm_extract_epi64(range, 1);
        _mm_store_pd(to + 2, _mm_loadh_pd(_mm_load_sd(&heights[rows & 0xFFFFFFFF]), &heights[rows >> 32]));
    } else {
        _mm_store_pd(to + 2, _mm_cvtepi32_pd(_mm_unpackhi_epi64(range, range)));
    }
}

/* acdf_group_range of a lane. */
ACDF_LANE void find_range(const GroupArrays& g, const Sought& sought, std::size_t i, Grouped* in) {
    const AcdfGroup* const group = g.groups + sought.cell[i];
    const std::uint32_t cell = in->in_group[i];
    const std::uint8_t* const side = boxes_of(g, group, sought.cell[i], cell / 16) + kPositions + cell % 16;
    __m128i bytes = _mm_cvtsi32_si128(side[0]);
    bytes = _mm_insert_epi8(bytes, side[16], 1);
    bytes = _mm_insert_epi8(bytes, side[32], 2);
    bytes = _mm_insert_epi8(bytes, side[48], 3);
    const __m128i first = _mm_loadl_epi64((const __m128i*)(const void*)group->first);
    const __m128i corner = _mm_add_epi32(_mm_unpacklo_epi32(first, first), _mm_setr_epi32(128, 129, 128, 129));
    set_range(g.heights, _mm_add_epi32(_mm_cvtepi8_epi32(bytes), corner), in->range[i]);
}

/* acdf_group_across of both axes of ACDF_WIDTH / 2 lanes. Returns a bit of each that is next to a border. */
ACDF_LANE std::uint64_t cross_cells(const GroupArrays& g, std::size_t first, Grouped* in) {
    const auto at = [&](std::size_t i) {
        return _mm_load_si128((const __m128i*)(const void*)&g.cells[in->cell[first + i]]);
    };
#if ACDF_WIDTH == 8
    const __m256i half[2] = {_mm256_set_m128i(at(1), at(0)), _mm256_set_m128i(at(3), at(2))};
    const Integer axis = (Integer)_mm512_inserti64x4(_mm512_castsi256_si512(half[0]), half[1], 1);
#else
    const Integer axis = (Integer)_mm256_set_m128i(at(1), at(0));
#endif
    const Vector scale = low_floats((Integer)((Unsigned)axis >> 32)), margin = (double)ACDF_GROUP_MARGIN * scale;
    const Integer number = (Integer)((Unsigned)loaded((const long long*)in->left[first]) >> 20);
    const Vector past = converted((number - axis - ACDF_GROUP_MARGIN) & 0xFFFFFFFF) * scale;
    const Vector across = choose(less(past, 1.0 - 2.0 * margin), past + margin, all(1.0));
    stored(in->u[first], across);
    return ~lanes(less(across, all(1.0))) & ((1u << ACDF_WIDTH) - 1u);
}

/* What is left in its cell of the numbers of all lanes, and where these lie. */
ACDF_LANE void draw_cells(const GroupArrays& g, const Sought& sought, Grouped* in) {
    std::uint64_t outside = 0;                          // two bits a lane
    const std::uint32_t without = in->alone | in->lost; // boxes of theirs would lead past all heights
    for (std::size_t i = 0; i < kSearched; ++i) {
        if (__builtin_expect(without >> i & 1u, 0)) _mm256_store_pd(in->range[i], _mm256_setzero_pd());
        else find_range(g, sought, i, in);
    }
    for (std::size_t first = 0; first < kSearched; first += ACDF_WIDTH / 2)
        outside |= cross_cells(g, first, in) << 2 * first;
    while (outside) {
        const std::uint32_t i = (std::uint32_t)__builtin_ctzll(outside) / 2;
        AcdfRange r[2];
        outside &= ~(std::uint64_t{3} << 2 * i);
        if ((in->alone | in->lost) >> i & 1u) continue;
        if (acdf_group_draw(g.all, g.groups + sought.cell[i], in->left[i], in->u[i], r, &in->cell[i]))
            set_range(g.heights, _mm_setr_epi32((int)r[0].low, (int)r[0].high, (int)r[1].low, (int)r[1].high),
                      in->range[i]);
        else in->lost |= 1u << i;
    }
    for (std::uint32_t alone = in->alone; alone; alone &= alone - 1) {
        const std::uint32_t i = acdf_lowest_bit(alone);
        const AcdfGroup* const group = g.groups + sought.cell[i];
        for (int axis = 0; axis < 2; ++axis) in->u[i][axis] = (double)(std::int64_t)in->left[i][axis] * 0x1p-52;
        set_range(
            g.heights,
            _mm_setr_epi32((int)group->first[0], (int)group->last[0], (int)group->first[1], (int)group->last[1]),
            in->range[i]);
    }
}

/* acdf_row_direction, or acdf_fold_direction, and densities of kLanes lanes. */
ACDF_LANE void place_lanes(const AcdfEnvironment& env, const GroupArrays& g, std::size_t first, Grouped* in,
                           AcdfDirectionSample* out) {
    Drawn d;
    Floats direction[3];
    for (std::size_t half = 0; half < 2; ++half) {
        const std::size_t at = first + ACDF_WIDTH * half;
        Doubles left[2];
        Vector range[4];
        load_pairs(in->u + at, left);
        gather_transposed(in->range[at], numbers_from(0) * 2, range);
        const Vector u[2] = {(Vector)left[0], (Vector)left[1]};
        if (g.heights) {
            row_direction(env.columns, range[0], range[1], range[2], range[3], u, (int)half, &d);
        } else {
            const Vector low[2] = {range[0], range[2]}, width[2] = {range[1] - range[0], range[3] - range[2]};
            fold_direction(env.columns, env.rows, low, width, u, (int)half, &d);
        }
    }
    in->lost |= drawn_directions(!g.heights, d, direction) << first;
    store_samples(direction, (Floats)gathered(g.densities, *(const Words*)&in->cell[first]), out + first);
}

/// Numbers that are drawn with: on their way to groups.
struct GroupDraws {
    Sought sought;
    std::uint32_t lost; // bits of lanes that tables do not answer
};

/* The last stage of acdf_environment_sample. */
ACDF_LANE void end_draws(const AcdfEnvironment& env, const GroupArrays& g, const double (*u)[2], GroupDraws* draws,
                         AcdfDirectionSample* out) {
    Grouped in;
    in.alone = 0;
    in.lost = draws->lost;
    if (g.several) ask_for_more(g, draws->sought, 0);
    for (std::size_t i = 0; i < kSearched; ++i) enter_group(g, u[i], i, &draws->sought, &in);
    draw_cells(g, draws->sought, &in);
    for (std::size_t first = 0; first < kSearched; first += kLanes) place_lanes(env, g, first, &in, out);
    for (; in.lost; in.lost &= in.lost - 1) {
        const std::uint32_t i = acdf_lowest_bit(in.lost);
        out[i] = acdf::alone::environment_sample(env, u[i]);
    }
}

ACDF_LANE void sample_by_groups(const AcdfEnvironment& env, const double (*u)[2], std::size_t count,
                                AcdfDirectionSample* out) {
    const Search s = search_of(env.groups, env.groups->numbers);
    const GroupArrays g = arrays_of(env.groups);
    in_stages<GroupDraws>(
        u, count, out,
        [&](const double(*from)[2], GroupDraws* draws) {
            draws->lost = 0;
            for (std::size_t first = 0; first < kSearched; first += kLanes) {
                Words key[2];
                Doubles shifted[2][2];
                draws->lost |= load_numbers(from + first, shifted, key) << first;
                find_blocks(s, key[0], key[1], &draws->sought, first);
            }
            ask_for_blocks(s, draws->sought);
        },
        [&](GroupDraws* draws) {
            draws->lost |= find_cells(s, &draws->sought, [&g](std::size_t group) {
                ACDF_PREFETCH(g.groups + group);
                ACDF_PREFETCH(g.boxes + kGroupBytes * group);
            });
        },
        [&](const double(*from)[2], GroupDraws* draws, AcdfDirectionSample* to) {
            end_draws(env, g, from, draws, to);
        });
}

// ---- finding ---------------------------------------------------------------------------------------------------

/* The cell of a lane's group that holds its square. Returns whether there is none. */
ACDF_LANE bool locate(const GroupArrays& g, std::uint32_t square0, std::uint32_t square1, std::uint32_t* sought) {
    const __m256i turned = _mm256_set_m128i(_mm_set1_epi8(0x7F), _mm_set1_epi8((char)0x80));
    const AcdfGroup* const group = g.groups + *sought;
    const std::uint32_t at0 = square0 - group->first[0], at1 = square1 - group->first[1];
    const bool inside = (at0 < group->last[0] - group->first[0]) & (at1 < group->last[1] - group->first[1]);
    const std::uint32_t cell =
        cell_of_group(g, group, *sought, kPositions, _mm256_xor_si256(_mm256_set1_epi8((char)at0), turned),
                      _mm256_xor_si256(_mm256_set1_epi8((char)at1), turned));
    *sought = group->cells + (cell == kNone ? 0 : cell);
    ACDF_PREFETCH(&g.densities[*sought]);
    return !(inside & ((cell != kNone) | (group->count == 1)));
}

/// Directions on their way to groups.
struct GroupPlaces {
    Sought sought;
    alignas(64) std::uint32_t square[2][kSearched];
    std::uint32_t lost;
};

/* The squares of directions, and the blocks that lead to their groups. */
ACDF_LANE void begin_densities(const AcdfEnvironment& env, const GroupArrays& g, const Search& s,
                               const float (*w)[3], GroupPlaces* places) {
    places->lost = 0;
    for (std::size_t first = 0; first < kSearched; first += kLanes) {
        Signed square[2];
        Words key[2];
        const Signed sure = squares_of(!g.heights, env.columns, env.rows, w + first, square);
        for (int axis = 0; axis < 2; ++axis) {
            const Words at = (Words)(square[axis] & sure);
            *(Words*)&places->square[axis][first] = at;
            key[axis] = at << g.all->shift[axis];
        }
        find_blocks(s, key[0], key[1], &places->sought, first);
        places->lost |= bits(~sure) << first;
    }
    ask_for_blocks(s, places->sought);
}

/* The last stage of acdf_environment_pdf. */
ACDF_LANE void end_densities(const AcdfEnvironment& env, const GroupArrays& g, const float (*w)[3],
                             GroupPlaces* places, float* out) {
    std::uint32_t* const sought = places->sought.cell;
    std::uint32_t lost = places->lost;
    if (g.several) ask_for_more(g, places->sought, kPositions);
    for (std::size_t i = 0; i < kSearched; ++i)
        lost |= (std::uint32_t)locate(g, places->square[0][i], places->square[1][i], &sought[i]) << i;
    for (std::size_t first = 0; first < kSearched; first += kLanes) {
        const Words pdf = gathered(g.densities, *(const Words*)&sought[first]);
        std::memcpy(out + first, &pdf, sizeof pdf);
    }
    for (; lost; lost &= lost - 1) {
        const std::uint32_t i = acdf_lowest_bit(lost);
        out[i] = acdf::alone::environment_pdf(env, w[i]);
    }
}

ACDF_LANE void pdf_by_groups(const AcdfEnvironment& env, const float (*w)[3], std::size_t count, float* out) {
    const Search s = search_of(env.groups, env.groups->places);
    const GroupArrays g = arrays_of(env.groups);
    in_stages<GroupPlaces>(
        w, count, out,
        [&](const float(*from)[3], GroupPlaces* places) { begin_densities(env, g, s, from, places); },
        [&](GroupPlaces* places) {
            places->lost |= find_cells(s, &places->sought, [&g](std::size_t group) {
                ACDF_PREFETCH(g.groups + group);
                ACDF_PREFETCH(g.boxes + kGroupBytes * group + kPositions);
            });
        },
        [&](const float(*from)[3], GroupPlaces* places, float* to) { end_densities(env, g, from, places, to); });
}

} // namespace
