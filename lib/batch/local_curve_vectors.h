// Curves in tiles, one of each lane in turn: acdf/short_curves.h by instructions that come with AVX2, operation by
// operation. Vectors of curves take longer: lanes have curves of many kinds, and few at the same time. Internal
// linkage: see local_kernel.h.
#pragma once

#include "batch/local_tile_vectors.h"

#include <acdf/short_curves.h>

#include <algorithm>
#include <cstddef>
#include <cstring>

namespace {

/// A lane in curves.
struct alignas(64) CurveLane {
    double u[2]; // of samples: the random numbers, rescaled to [0, 1) in the cell
    AcdfRange range[2];
    double inside; // product of the curves
    const std::uint8_t* at;
};

/// Numbers of lanes.
struct LanesOnWay {
    std::uint32_t count, lane[kBlock];
};

/// What is the same for all curves of up to eight segments whose cumulative values have one byte, or two.
struct alignas(64) CurveKind {
    std::uint8_t from[16];   // of cumulative values as numbers of two bytes: which byte it is, 0x80: 0
    std::uint16_t beyond[8]; // the largest value, where there is none of the curve's own
    double maximum[2];       // the largest value, twice
    double below;            // the largest number below it
    std::uint32_t inner;     // how many values there are
    std::uint32_t positions; // where positions begin
};
struct CurveKinds {
    CurveKind kind[16]; // 2 * inner, and 1 where values have two bytes
    constexpr CurveKinds() : kind() {
        for (std::uint32_t number = 0; number < 16; ++number) {
            CurveKind& k = kind[number];
            const std::uint32_t wide = number % 2;
            k.inner = number / 2;
            k.positions = 2 + (k.inner << wide);
            k.maximum[0] = k.maximum[1] = wide ? 65535.0 : 255.0;
            k.below = k.maximum[0] * (1.0 - 0x1p-53);
            for (std::uint32_t i = 0; i < 8; ++i) {
                const bool own = i < k.inner;
                k.from[2 * i] = own ? (std::uint8_t)(i << wide) : 0x80;
                k.from[2 * i + 1] = own && wide ? (std::uint8_t)(2 * i + 1) : 0x80;
                k.beyond[i] = own ? 0 : wide ? 0xFFFF : 0xFF;
            }
        }
    }
};
constexpr CurveKinds kCurveKinds;

ACDF_LANE __m128i sixteen_bytes(const void* at) { return _mm_loadu_si128((const __m128i*)at); }

/* How many bytes of numbers stand before the first that is above a key. */
ACDF_LANE std::uint32_t bytes_before(__m128i not_above) {
    return acdf_lowest_bit(~(std::uint32_t)_mm_movemask_epi8(not_above));
}

/* A curve's header less one segment. As acdf_short_curve has it: all bits that are not the axis, the size of
 * cumulative values, whether there are links of one byte, and three of the segments. */
constexpr std::uint32_t kOneSegment = 1u << ACDF_CURVE_SEGMENTS_SHIFT, kOtherBits = 0xFFFFE370u;

/* acdf_short_curve_sample, or a step of acdf_tree_locate, of a curve that has no other bits. Returns the distance
 * to the child, 0 where it ends. */
template <bool Finds>
ACDF_LANE std::uint32_t turn_of(std::uint32_t header, const std::uint32_t* square, CurveLane* lane) {
    const std::uint8_t* const bytes = lane->at;
    const std::uint32_t axis = header & ACDF_CURVE_AXIS_MASK;
    const CurveKind& kind = kCurveKinds.kind[(header >> (ACDF_CURVE_SEGMENTS_SHIFT - 1) & 14) | (header >> 3 & 1)];
    AcdfRange& range = lane->range[axis];
    const std::uint32_t origin = range.low, inner = kind.inner;
    const std::uint8_t* position = bytes + kind.positions;
    const __m128d maximum = _mm_load_pd(kind.maximum);
    const __m128i values = _mm_or_si128(_mm_shuffle_epi8(sixteen_bytes(bytes + 2), sixteen_bytes(kind.from)),
                                        sixteen_bytes(kind.beyond));
    __m128d scaled = maximum;
    std::uint32_t segment;
    if (Finds) {
        const std::uint32_t step = square[axis] - origin;
        const __m128i key = _mm_set1_epi8((char)(step < 255 ? step : 255));
        const __m128i own = _mm_loadl_epi64((const __m128i*)(const void*)position);
        const std::uint32_t before = bytes_before(_mm_cmpeq_epi8(_mm_min_epu8(own, key), own));
        segment = before < inner ? before : inner;
    } else {
        scaled = _mm_min_sd(_mm_mul_sd(_mm_load_sd(&lane->u[axis]), maximum), _mm_load_sd(&kind.below));
        const __m128i key = _mm_broadcastw_epi16(_mm_cvttpd_epi32(scaled));
        segment = bytes_before(_mm_cmpeq_epi16(_mm_min_epu16(values, key), values)) / 2;
    }
    /* The values below and above the segment, 0 below the first. */
    const __m128i around = _mm_add_epi8(
        _mm_setr_epi8(-2, -1, -128, -128, 0, 1, -128, -128, -128, -128, -128, -128, -128, -128, -128, -128),
        _mm_set1_epi8((char)(2 * segment)));
    const __m128d bound = _mm_cvtepi32_pd(_mm_shuffle_epi8(values, around));
    /* What the number is above the one, and how far the other is; then parts of that, and of all. */
    const __m128d from = _mm_sub_pd(Finds ? bound : _mm_move_sd(bound, scaled), _mm_movedup_pd(bound));
    const __m128d part = _mm_div_pd(from, _mm_shuffle_pd(from, maximum, 1));
    if (!Finds) _mm_store_sd(&lane->u[axis], part);
    lane->inside *= _mm_cvtsd_f64(_mm_unpackhi_pd(part, part));
    position += segment;
    /* All bits where there is something below, and above: compilers make branches of comparisons here. */
    const auto below = (std::uint32_t)((std::int32_t)(0u - segment) >> 31);
    const auto above = (std::uint32_t)((std::int32_t)(segment - inner) >> 31);
    const std::uint32_t high = origin + position[0];
    range.low = origin + (position[-1] & below);
    range.high ^= (high ^ range.high) & above;
    return position[inner] & (std::uint32_t)((std::int32_t)(header << 24) >> 31);
}

/* All lanes on their way, in turns. Returns those whose cells have tilts, a bit each. */
template <bool Finds>
__attribute__((noinline)) std::uint64_t take_turns(const AcdfLocal& local, const std::uint32_t (*square)[2],
                                                   LanesOnWay& on_way, CurveLane* lanes) {
    const std::uint8_t* const tree = local.blend.tree;
    const std::size_t units = local.environment.tree_units; /* a curve is not loaded in full at the end */
    const std::uint8_t* const near_end = tree + 2 * (units > 15 ? units - 15 : 0);
    std::uint64_t tilted = 0;
    while (const std::uint32_t count = on_way.count) {
        std::uint32_t left = 0;
        for (std::uint32_t k = 0; k < count; ++k) {
            const std::uint32_t number = on_way.lane[k];
            CurveLane& lane = lanes[number];
            std::uint16_t header;
            std::uint32_t link;
            std::memcpy(&header, lane.at, 2);
            const std::uint32_t rest = header - kOneSegment;
            if ((rest & kOtherBits) == 0 && lane.at < near_end) {
                link = turn_of<Finds>(rest, square[number], &lane);
            } else {
                const auto at = (std::uint32_t)((std::size_t)(lane.at - tree) / 2);
                link = Finds ? acdf_curve_find(tree, at, square[number], lane.range, nullptr, &lane.inside)
                             : acdf_curve_sample(tree, at, lane.u, lane.range, &lane.inside);
                tilted |= (std::uint64_t)(lane.range[0].tilt != 0.0 || lane.range[1].tilt != 0.0) << number;
            }
            lane.at += 2 * std::size_t{link};
            ACDF_PREFETCH(lane.at);
            on_way.lane[left] = number;
            left += link != 0;
        }
        on_way.count = left;
    }
    return tilted;
}

/* All lanes at where their tiles begin. Returns those whose tiles have curves. */
template <bool Finds>
ACDF_LANE LanesOnWay enter_tiles(const AcdfLocal& local, const Cells& cells, std::uint32_t (*square)[2],
                                 CurveLane* lane) {
    LanesOnWay on_way;
    on_way.count = 0;
    for (std::uint32_t i = 0; i < cells.count; ++i) {
        const AcdfTileRecord* const tile = acdf_local_tile(local.tables, (std::uint32_t)cells.tile[i]);
        acdf_local_ahead(&local, tile);
        for (int axis = 0; axis < 2; ++axis) {
            if (Finds) square[i][axis] = (std::uint32_t)cells.square[axis][i];
            else lane[i].u[axis] = cells.u[axis][i];
            lane[i].range[axis].tilt = 0.0;
        }
        acdf_tile_range(tile, lane[i].range);
        lane[i].inside = 1.0;
        lane[i].at = local.blend.tree + 2 * std::size_t{tile->root == ACDF_NO_ROOT ? 0 : tile->root};
        on_way.lane[on_way.count] = i;
        on_way.count += tile->root != ACDF_NO_ROOT;
    }
    return on_way;
}

/* Follows the curves of all tiles. */
template <bool Finds>
ACDF_LANE void find_cells(const AcdfLocal& local, const Cells& cells, Boxes* done) {
    CurveLane lane[kBlock];
    std::uint32_t square[kBlock][2];
    LanesOnWay on_way = enter_tiles<Finds>(local, cells, square, lane);
    const std::uint64_t tilted = take_turns<Finds>(local, square, on_way, lane);
    for (std::size_t i = 0; i < cells.count; ++i) {
        for (int axis = 0; axis < 2; ++axis) {
            if (!Finds) done->u[axis][i] = lane[i].u[axis];
            done->low[axis][i] = lane[i].range[axis].low;
            done->high[axis][i] = lane[i].range[axis].high;
        }
        done->product[i] = lane[i].inside;
        done->lost[i] = (tilted >> i & 1) != 0;
    }
    end_boxes(cells.count, done);
}

/* Asks for the curves of all tiles while something else is done. */
ACDF_LANE void ask_for_curves(const AcdfLocal& local, const Cells& cells) {
    for (std::size_t i = 0; i < cells.count; ++i)
        acdf_local_ahead(&local, acdf_local_tile(local.tables, (std::uint32_t)cells.tile[i]));
}

} // namespace
