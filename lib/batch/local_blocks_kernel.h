// Arrays of samples and pdfs in blocks of lanes, with a normal each or at one point: what LocalBatch's loops
// of both shapes share. Internal linkage: see local_kernel.h.
#pragma once

#include "batch/alone.h"
#include "batch/local_tile_vectors.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace {

/* How many lanes of a vector from a lane on are there. */
ACDF_LANE std::size_t lanes_there(std::size_t first, std::size_t count) {
    return std::min<std::size_t>(count - std::min(first, count), ACDF_WIDTH);
}

/* The numbers of a vector of lanes, of which `count` are there, in [0, 1]. */
ACDF_LANE void numbers_of(const double (*u)[2], std::size_t count, Vector out[2]) {
    double last[ACDF_WIDTH][2] = {};
    Doubles given[2];
    if (count < ACDF_WIDTH) std::memcpy(last, u, count * sizeof *u);
    load_pairs(count < ACDF_WIDTH ? last : u, given);
    for (int axis = 0; axis < 2; ++axis) out[axis] = unit_interval((Vector)given[axis]);
}

/* The mask of the first `count` lanes of a block. */
ACDF_LANE std::uint64_t first_lanes(std::size_t count) {
    return count < kBlock ? (std::uint64_t{1} << count) - 1 : ~std::uint64_t{0};
}

/* Calls alone(i) for the lanes of a mask, of which `count` are there. */
template <class Alone>
ACDF_LANE void leave_alone(std::uint64_t lost, std::size_t count, const Alone& alone) {
    for (lost &= first_lanes(count); lost; lost &= lost - 1) alone((std::size_t)__builtin_ctzll(lost));
}

/* Calls block(points, alone, in, count, out) for up to Size lanes at a time. points(first): those of the lanes from
 * number `first` on; alone(i): leaves number i to the single call. */
template <std::size_t Size, class PointsFrom, class Alone, class In, class Out, class Block>
ACDF_LANE void in_blocks(const PointsFrom& points, const Alone& alone, const In* in, std::size_t count, Out* out,
                         const Block& block) {
    for (std::size_t first = 0; first < count; first += Size)
        block(
            points(first), [&alone, first](std::size_t lane) { alone(first + lane); }, in + first,
            std::min(count - first, Size), out + first);
}

/* Samples, by points of a type: of normals of their own, and at one point. */
template <class P, class Block>
ACDF_LANE void draws_in_blocks(const AcdfLocal& local, const float (*normals)[3], const double (*u)[2],
                               std::size_t count, AcdfDirectionSample* out, const Block& block) {
    in_blocks<kBlock>(
        [&](std::size_t first) {
            return PointsOf<P>{local, normals + first};
        },
        [&](std::size_t i) { out[i] = acdf::alone::local_sample(local, normals[i], u[i]); }, u, count, out, block);
}
template <class P, class Block>
ACDF_LANE void draws_in_blocks(const AcdfLocal& local, const AcdfLocalPoint& point, const double (*u)[2],
                               std::size_t count, AcdfDirectionSample* out, const Block& block) {
    const OnePoint<P> points(local, point);
    in_blocks<kBlock>([&](std::size_t) -> const OnePoint<P>& { return points; },
                      [&](std::size_t i) { out[i] = acdf::alone::local_sample(local, point, u[i]); }, u, count, out,
                      block);
}

/* The same of pdfs. */
template <std::size_t Size, class P, class Block>
ACDF_LANE void pdfs_in_blocks(const AcdfLocal& local, const float (*normals)[3], const float (*directions)[3],
                              std::size_t count, float* out, const Block& block) {
    in_blocks<Size>(
        [&](std::size_t first) {
            return PointsOf<P>{local, normals + first};
        },
        [&](std::size_t i) { out[i] = acdf::alone::local_pdf(local, normals[i], directions[i]); }, directions,
        count, out, block);
}
template <std::size_t Size, class P, class Block>
ACDF_LANE void pdfs_in_blocks(const AcdfLocal& local, const AcdfLocalPoint& point, const float (*directions)[3],
                              std::size_t count, float* out, const Block& block) {
    const OnePoint<P> points(local, point);
    in_blocks<Size>([&](std::size_t) -> const OnePoint<P>& { return points; },
                    [&](std::size_t i) { out[i] = acdf::alone::local_pdf(local, point, directions[i]); },
                    directions, count, out, block);
}

} // namespace
