// Samples of LocalBatch in files of the fast shape over vectors: acdf/local_fast.h, operation by operation; see
// local_kernel.h. All lanes of a block take a step before any takes the next one, and what that will read is asked
// for before: so none waits for memory.
#pragma once

#include "batch/fast_cells.h"
#include "batch/fast_light_vectors.h"
#include "batch/local.h"
#include "batch/local_blocks_kernel.h"
#include "batch/row_vectors.h"

#include <algorithm>
#include <cstring>

namespace {

// ---- tiles -----------------------------------------------------------------------------------------------------

/// Samples of a block.
struct FastDraws : FastPointLanes {
    FastCells cells;
    std::uint64_t lit, mixed; // lanes that sample bright tiles, and those that sample from the mixture
    alignas(64) double x[kRoom], before[kRoom];                    // of the mixture, or of bright tiles
    alignas(64) double step[kRoom];                                // AcdfLocalPoint::step
    alignas(64) long long upper[kRows][kRoom], is_lit[kRoom];      // is_lit: all ones, or 0
    alignas(64) std::int32_t at[kRoom], below[kRoom], mass[kRoom]; // at: x or what is next; the others of tiles
    alignas(64) std::int32_t end[kRows][kRoom], ends[2][kRoom];    // of groups, of cells; as they lie
    alignas(64) std::int32_t number[kRoom], tile[kRoom];
    alignas(64) std::int32_t pair[kRoom], last[kRoom]; // weights of the first two rows, and of the third
    alignas(64) double group_mass[kRoom], group_below[kRoom], group_whole[kRoom];
};

/* Samples of points of a vector from a lane on. */
ACDF_LANE void keep_draws(const FastPoints<true>& p, std::size_t at, FastDraws* d) {
    keep_points(p, at, d);
    stored(&d->step[at], p.step);
    stored(&d->pair[at], p.share[0] | p.share[1] << 16);
    stored(&d->last[at], p.share[2]);
    for (int i = 0; i < kRows; ++i) stored(&d->upper[i][at], p.upper[i]);
}

/* Begins the lanes of a vector by their numbers: where they sample bright tiles, and else what they look for. */
ACDF_LANE void begin_draws(const Vector u[2], std::size_t at, FastDraws* d) {
    const Vector sum = loaded(&d->bright_tiles.sum[at]), bright_tiles = loaded(&d->bright_tiles.bright_tiles[at]);
    const Vector x = u[0] * sum, of_mixture = (x - bright_tiles) * loaded(&d->step[at]);
    const Vector most = 32767.0 * loaded(&d->whole[at]) * (1.0 - 0x1p-53);
    const Vector mixed = select(of_mixture < most, of_mixture, most);
    const Integer is_lit = x < bright_tiles;
    for (int i = 0; i < kRows; ++i) stored(&d->end[i][at], Ints{});
    stored(&d->number[at], Ints{});
    stored(&d->cells.of[at], all(0.0));
    stored(&d->x[at], select(is_lit, x, mixed));
    stored(&d->before[at], all(0.0));
    stored(&d->at[at], to_integers(mixed));
    stored(&d->is_lit[at], is_lit);
    stored(&d->tile[at], Ints{});
    stored(&d->cells.u[1][at], u[1]);
    stored(&d->cells.all[at], sum * ACDF_FAST_STEPS);
    stored(&d->below[at], Ints{});
    stored(&d->mass[at], Ints{});
    d->lit |= (std::uint64_t)bits(is_lit) << at;
}

/* acdf_local_fast_bright_tile of the lanes that sample bright tiles. Returns those that it does not decide: next to
 * borders. */
template <class At>
ACDF_LANE std::uint64_t draw_lights(const AcdfLocal& local, const At& at, FastDraws* d) {
    std::uint64_t lost = 0;
    if (!d->lit) return 0;
    const auto lights = lights_of(local, at);
    for (std::uint64_t left = d->lit; left;) {
        alignas(64) long long lane[ACDF_WIDTH], number[ACDF_WIDTH];
        alignas(64) double weight[ACDF_WIDTH], before[ACDF_WIDTH];
        left = next_lanes(left, lane);
        LightDraws draws(gathered_doubles(d->x, loaded(lane)));
        offer_lights(local, lights, *d, lane, &draws);
        stored(number, draws.number);
        stored(weight, draws.weight);
        stored(before, draws.before);
        for (int i = 0; i < ACDF_WIDTH; ++i) {
            const std::uint32_t tile = local.bright_tiles[number[i]].tile;
            ACDF_PREFETCH(acdf_local_tile(local.tables, tile));
            d->tile[lane[i]] = (std::int32_t)tile;
            d->cells.of[lane[i]] = weight[i];
            d->before[lane[i]] = before[i];
            lost |= (std::uint64_t) !(weight[i] > 0.0) << lane[i];
        }
    }
    return lost;
}

/* acdf_fast_group_of of all lanes that sample from the mixture. */
ACDF_LANE void search_groups(FastDraws* d) {
    FastLanes& w = d->rows;
    for (std::uint64_t left = d->mixed; left; left &= left - 1) {
        const auto i = (std::uint32_t)__builtin_ctzll(left);
        const std::uint16_t* const upper[kRows] = {(const std::uint16_t*)d->upper[0][i],
                                                   (const std::uint16_t*)d->upper[1][i],
                                                   (const std::uint16_t*)d->upper[2][i]};
        const std::uint32_t first = 16u * search_words(upper, 0, d->pair[i], d->last[i], d->at[i]);
        d->number[i] = (std::int32_t)first;
    }
    for (std::uint64_t left = d->mixed; left; left &= left - 1) {
        const auto i = (std::uint32_t)__builtin_ctzll(left);
        const std::uint16_t* const group[kRows] = {(const std::uint16_t*)w.group[0][i],
                                                   (const std::uint16_t*)w.group[1][i],
                                                   (const std::uint16_t*)w.group[2][i]};
        const std::uint32_t number =
            search_words(group, (std::uint32_t)d->number[i], d->pair[i], d->last[i], d->at[i]);
        for (int row = 0; row < kRows; ++row) d->end[row][i] = ends_of(w, row, i, number);
        d->number[i] = (std::int32_t)number;
    }
}

/* acdf_fast_tile_of of the same. */
ACDF_LANE void search_tiles(const AcdfLocal& local, FastDraws* d) {
    const FastLanes& w = d->rows;
    for (std::uint64_t left = d->mixed; left; left &= left - 1) {
        const auto i = (std::uint32_t)__builtin_ctzll(left), first = ACDF_FAST_GROUP * (std::uint32_t)d->number[i];
        Sixteen ends;
        std::int32_t sum[4 + 16];
        ends.mix(sixteen_widened((const std::uint8_t*)w.tile_row[0][i] + first),
                 sixteen_widened((const std::uint8_t*)w.tile_row[1][i] + first),
                 sixteen_widened((const std::uint8_t*)w.tile_row[2][i] + first), d->pair[i], d->last[i]);
        const std::uint32_t tile = acdf_lowest_bit(ends.above(d->at[i])) / Sixteen::kBits;
        sum[3] = 0;
        ends.store(sum + 4);
        d->below[i] = sum[3 + tile];
        d->mass[i] = sum[4 + tile] - sum[3 + tile];
        d->tile[i] = (std::int32_t)(first + tile);
        ACDF_PREFETCH(acdf_local_tile(local.tables, first + tile));
    }
}

/* acdf_fast_sample_tile of all lanes; of those that sample a bright tile it is known before. */
ACDF_LANE void draw_tiles(const AcdfLocal& local, std::size_t count, FastDraws* d) {
    alignas(64) double y[kRoom];
    search_groups(d);
    for (std::size_t at = 0; at < count; at += ACDF_WIDTH) {
        const Ints ends[kRows] = {loaded(&d->end[0][at]), loaded(&d->end[1][at]), loaded(&d->end[2][at])};
        const FastGroups g = find_groups(d->rows, ends, loaded(&d->number[at]) > 0, at);
        stored(&d->pair[at], g.part[0] | g.part[1] << 16); // in the group from now on
        stored(&d->last[at], g.part[2]);
        stored(&d->group_mass[at], g.mass);
        stored(&d->group_below[at], g.below);
        stored(&d->group_whole[at], g.whole);
        const Vector scaled_u = scaled(loaded(&d->cells.u[1][at]), 255.0 * g.whole);
        stored(&y[at], scaled_u);
        stored(&d->at[at], to_integers(scaled_u));
    }
    search_tiles(local, d);
    for (std::size_t at = 0; at < count; at += ACDF_WIDTH) {
        FastCells& c = d->cells;
        const Integer lit = loaded(&d->is_lit[at]);
        const Vector of_group = loaded(&d->group_mass[at]), of_tile = to_doubles(loaded(&d->mass[at]));
        const Vector light = loaded(&c.of[at]),
                     below = select(lit, loaded(&d->before[at]), loaded(&d->group_below[at]));
        const Vector left = (loaded(&d->x[at]) - below) / select(lit, light, of_group);
        const Vector in_group = (loaded(&y[at]) - to_doubles(loaded(&d->below[at]))) / of_tile;
        stored(&c.u[0][at], select(lit, unit_interval(left), left));
        stored(&c.u[1][at], select(lit, loaded(&c.u[1][at]), in_group));
        stored(&c.of[at], select(lit, light, of_group * of_tile * loaded(&d->rows.unit[at])));
        stored(&c.all[at], select(lit, loaded(&c.all[at]), loaded(&d->group_whole[at]) * ACDF_FAST_STEPS));
    }
}

// ---- cells -----------------------------------------------------------------------------------------------------

/* acdf_fast_sample_cell of all lanes, but for what they share with pdfs. */
ACDF_LANE void draw_cells(const AcdfLocal& local, std::size_t count, FastDraws* d) {
    FastCells& c = d->cells;
    alignas(64) double z[2][kRoom];
    alignas(64) std::int32_t least[2][kRoom];
    for (std::size_t i = 0; i < count; ++i) enter_tile(local, (std::uint32_t)d->tile[i], i, &c);
    for (std::size_t at = 0; at < count; at += ACDF_WIDTH)
        for (int axis = 0; axis < 2; ++axis) {
            const Vector scaled_u = scaled(loaded(&c.u[axis][at]), all(255.0));
            stored(&z[axis][at], scaled_u);
            stored(&least[axis][at], to_integers(scaled_u) + 1);
        }
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t line = end_at_least(c.list[i], least[1][i]);
        d->ends[1][i] = ends_at(c.list[i], line);
        c.index[1][i] = (std::int32_t)line;
        c.list[i] = line_of(c, i, line);
        ACDF_PREFETCH(c.list[i]);
    }
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t cell = end_at_least(c.list[i], least[0][i]);
        d->ends[0][i] = ends_at(c.list[i], cell);
        c.index[0][i] = (std::int32_t)cell;
    }
    for (std::size_t at = 0; at < count; at += ACDF_WIDTH)
        for (int axis = 0; axis < 2; ++axis) {
            Ints before, end;
            split_ends(loaded(&d->ends[axis][at]), loaded(&c.index[axis][at]), &before, &end);
            stored(&c.u[axis][at], (loaded(&z[axis][at]) - to_doubles(before)) / to_doubles(end - before));
        }
}

// ---- directions ------------------------------------------------------------------------------------------------

/* Half of some directions up to where floats go on; pdfs as acdf_local_fast_cell_pdf has them. */
ACDF_LANE Vector begin_directions(const AcdfLocal& local, const FastDraws& d, std::size_t at, int half,
                                  Drawn* out) {
    const FastCells& c = d.cells;
    const double columns = local.environment.columns, rows = local.environment.rows;
    const FastBoxes box = narrowed(c, at);
    const Vector u[2] = {loaded(&c.u[0][at]), loaded(&c.u[1][at])};
    const Vector low[2] = {to_doubles(box.low[0]), to_doubles(box.low[1])};
    Vector z[2];
    const Vector height = heights_of(local, box, z);
    if (local.tables->octahedral) {
        const Vector width[2] = {to_doubles(box.high[0] - box.low[0]), to_doubles(box.high[1] - box.low[1])};
        fold_direction(columns, rows, low, width, u, half, out);
    } else {
        row_direction(columns, low[0], to_doubles(box.high[0]), z[0], z[1], u, half, out);
    }
    const Ints ends[2] = {loaded(&d.ends[0][at]), loaded(&d.ends[1][at])};
    return fast_cell_pdf(local, c, ends, box, height, at);
}

/* The samples of lanes whose tiles are sampled, but for those of a mask and others that are left to single calls.
 */
template <class Alone>
ACDF_LANE void end_draws(const AcdfLocal& local, FastDraws* d, std::uint64_t lost, const Alone& alone,
                         std::size_t count, AcdfDirectionSample* out) {
    const std::size_t whole = (count + kLanes - 1) / kLanes * kLanes;
    draw_cells(local, whole, d);
    for (std::size_t first = 0; first < whole; first += kLanes) {
        Drawn drawn;
        Vector pdf[2];
        Floats direction[3];
        const std::size_t more = std::min(count - first, kLanes);
        AcdfDirectionSample last[kLanes];
        for (int half = 0; half < 2; ++half)
            pdf[half] = begin_directions(local, *d, first + ACDF_WIDTH * (std::size_t)half, half, &drawn);
        const std::uint32_t refused = sampled_directions(local.tables->octahedral != 0, drawn, direction);
        store_samples(direction, to_floats((Doubles)pdf[0], (Doubles)pdf[1]), more < kLanes ? last : out + first);
        if (more < kLanes) std::memcpy(out + first, last, more * sizeof *out);
        lost |= (std::uint64_t)refused << first;
    }
    leave_alone(lost, count, alone);
}

/* Samples of up to kBlock lanes; `at` and `alone` as draw_block of local_kernel.h has them. */
template <class At, class Alone>
ACDF_LANE void draw_fast_block(const AcdfLocal& local, const At& at, const Alone& alone, const double (*u)[2],
                               std::size_t count, AcdfDirectionSample* out) {
    FastDraws d;
    const std::size_t whole = (count + kLanes - 1) / kLanes * kLanes; // those behind the last one are not served
    std::uint64_t lost = 0;
    at(whole, count, [&](const FastPoints<true>& p, std::size_t first) {
        keep_draws(p, first, &d);
        lost |= not_served(p, first);
    });
    end_points(local, &d);
    d.lit = 0;
    for (std::size_t first = 0; first < whole; first += ACDF_WIDTH) {
        Vector v[2];
        numbers_of(u + first, lanes_there(first, count), v);
        begin_draws(v, first, &d);
    }
    const std::uint64_t there = first_lanes(count) & ~lost;
    d.mixed = ~d.lit & there;
    d.lit &= there;
    lost |= draw_lights(local, at, &d);
    draw_tiles(local, whole, &d);
    end_draws(local, &d, lost, alone, count, out);
}

// ---- all of an array -------------------------------------------------------------------------------------------

/* `of`: normals, one each, or the point of all. */
template <class Of>
ACDF_LANE void sample_all_fast(const AcdfLocal& local, Of of, const double (*u)[2], std::size_t count,
                               AcdfDirectionSample* out) {
    draws_in_blocks<FastPoints<true>>(local, of, u, count, out,
                                      [&](const auto&... rest) { draw_fast_block(local, rest...); });
}

} // namespace
