// Shading points of product sampling whose light is a local environment file of the fast shape
// (acdf/product/product.h): which share of the samples its bright tiles, groups of tiles and tiles get. C++17,
// header only, freestanding.
//
// All bright tiles and groups that have much light are looked at at once, so that a lobe which returns many pdfs
// together does, and nothing waits for what was seen before. Then the groups that reflect most are opened: their
// tiles are looked at. Numbers are of all parts, one after the other, without a branch: compilers take vectors.
#pragma once

#include <acdf/product/fast_cut.h>
#include <acdf/product/product_point.h>

namespace acdf {

/// A point while it is prepared. Its parts, by number: bright tiles, one that is none, groups, and the tiles of
/// open groups. Bright tiles and groups that give nothing are no parts.
template <class AnyLobe>
class GroupRating {
public:
    ACDF_METHOD explicit GroupRating(const PointOfLobe<AnyLobe>& of) noexcept : of_(of) {}

    /// Makes the cut. Returns the share of samples that is left to the lobe's own sampler.
    ACDF_METHOD double make(AcdfFastCut& cut) noexcept;

    /// What weigh_parts asks for.
    ACDF_METHOD float light(int i) const noexcept { return light_in_[i]; }
    ACDF_METHOD float mean(int i) const noexcept { return mean_[i]; }
    ACDF_METHOD float mass(int i) const noexcept { return mass_[i]; }
    ACDF_METHOD float around(int i) const noexcept { return around_[i]; }
    ACDF_METHOD float spread(int i) const noexcept { return spread_[i]; }

private:
    static constexpr int group_size = ACDF_FAST_GROUP, no_tile = -1;
    static constexpr int most_parts = ACDF_FAST_CUT_PARTS, most = most_parts + group_size * ACDF_FAST_CUT_OPEN;
    static constexpr int parts_per_open = 5;                                     ///< of what is asked for beyond 8
    static constexpr float least_light = 1.0f / 512.0f, least_reflected = 0.01f; ///< to be looked at, to be opened
    /// Of the lobe's own sampler: neighbours are a weaker estimate than parents, and the weakest where no group is
    /// open.
    static constexpr double least_share = 0.1, of_few = 0.3;
    static constexpr int few_parts = 16;
    /// Where the lobe is looked at: directions in the surface's frame, each of a part.
    struct Looks {
        int count = 0;
        std::uint16_t part[most_parts];
        float wi[most_parts][3];
    };

    ACDF_METHOD int add(int number, int entry, float light, float solid_angle) noexcept;
    ACDF_METHOD void measure() noexcept;
    ACDF_METHOD void sample_guides() noexcept;
    ACDF_METHOD std::uint32_t nearest_row() const noexcept;
    ACDF_METHOD void look_at_much() noexcept;
    ACDF_METHOD void look(const Looks& looks) noexcept;
    ACDF_METHOD void rate(int first, int end) noexcept;
    ACDF_METHOD void rate_guide(int part, int guide) noexcept;
    ACDF_METHOD void rate_groups() noexcept;
    ACDF_METHOD void compare(int first, int end, float scale, float hoped) noexcept;
    ACDF_METHOD void choose() noexcept;
    ACDF_METHOD void open_chosen() noexcept;
    ACDF_METHOD void rate_tiles(int part, int first) noexcept;
    ACDF_METHOD std::uint32_t group_of(int part) const noexcept {
        return static_cast<std::uint32_t>(entry_[part] - first_entry_);
    }
    ACDF_METHOD void finish(AcdfFastCut& cut, float* probability) const noexcept;

    const PointOfLobe<AnyLobe>& of_;
    int first_entry_;                           ///< of the groups in the cut
    int bright_tiles_, count_, all_;            ///< of parts: bright tiles, bright tiles and groups, and all
    int open_ = 0, opened_[ACDF_FAST_CUT_OPEN]; ///< parts that are groups whose tiles are looked at
    std::uint16_t entry_[most_parts + 1], part_of_[most_parts]; ///< of a part in the cut, and of that
    LobeGuides guides_;
    int guide_tile_[LobeGuides::most]; ///< no_tile: a bright tile's
    float light_in_[most + 8], solid_angle_[most + 8], value_[most + 8], pdf_[most + 8], mean_[most + 8],
        mass_[most + 8], around_[most + 8], spread_[most + 8];
};

/// Part `number`, if it has light: returns the number of the next one.
template <class AnyLobe>
ACDF_METHOD int GroupRating<AnyLobe>::add(int number, int entry, float light, float solid_angle) noexcept {
    light_in_[number] = light;
    solid_angle_[number] = solid_angle;
    entry_[number] = static_cast<std::uint16_t>(entry);
    part_of_[entry] = static_cast<std::uint16_t>(number);
    return number + (light > 0.0f);
}

/// Light and solid angle of bright tiles and groups.
template <class AnyLobe>
ACDF_METHOD void GroupRating<AnyLobe>::measure() noexcept {
    const float* angles = acdf_local_group_angles(of_.light.tables);
    const int ends = static_cast<int>(of_.light.fast.ends),
              bright_tiles = static_cast<int>(of_.light.bright_tile_count);
    const double of_all = 1.0 / of_.at.sum;
    const float unit = static_cast<float>(255.0 * of_.at.by.fast.unit);
    std::int32_t masses[ACDF_FAST_CUT_GROUPS];
    double weight[ACDF_MAX_BRIGHT_TILES];
    int count = 0;
    first_entry_ = static_cast<int>(acdf_fast_cut_bright_tiles(&of_.light));
    acdf_fast_group_masses(&of_.light.fast, &of_.at.by.fast.mix, masses);
    acdf_fast_bright_tile_weights(&of_.light, &of_.at, weight);
    for (int i = 0; i < bright_tiles; ++i) count = add(count, i, static_cast<float>(weight[i] * of_all), 0.0f);
    add(count, first_entry_ - 1, 0.0f, 0.0f);
    bright_tiles_ = ++count;
    for (int i = 0; i < ends; ++i)
        count = add(count, first_entry_ + i, static_cast<float>(masses[i]) * unit, angles[i]);
    for (int i = 0; i < count; ++i) value_[i] = pdf_[i] = 0.0f;
    all_ = count_ = count;
}

/// Samples of the lobe's own sampler, and which light is there.
template <class AnyLobe>
ACDF_METHOD void GroupRating<AnyLobe>::sample_guides() noexcept {
    const AcdfGrid grid = acdf_environment_grid(&of_.light.environment);
    float world[LobeGuides::most][3], light[LobeGuides::most];
    of_.sample_guides(world, guides_);
    for (int i = 0; i < guides_.count; ++i) {
        const std::uint32_t square[2] = {guides_.square[0][i], guides_.square[1][i]};
        AcdfRange range[2];
        const std::uint32_t tile = acdf_local_fast_tile(&of_.light, square, range);
        const AcdfFastShare share = acdf_local_fast_find(&of_.light, &of_.at, tile, square, range);
        light[i] = acdf_local_fast_cell_pdf(&of_.light, &grid, range, &share);
        guide_tile_[i] = acdf_local_bright_tile_of(&of_.light, tile) > 0 ? no_tile : static_cast<int>(tile);
    }
    guides_.weigh(light);
}

/// The row that weighs most.
template <class AnyLobe>
ACDF_METHOD std::uint32_t GroupRating<AnyLobe>::nearest_row() const noexcept {
    const std::int32_t* weight = of_.at.by.fast.mix.weight;
    const int of_two = weight[1] > weight[0], nearest = weight[2] > weight[of_two] ? 2 : of_two;
    return static_cast<std::uint32_t>(
        static_cast<std::size_t>(of_.at.by.fast.mix.group[nearest] - of_.light.fast.groups) / of_.light.fast.ends);
}

/// At bright tiles that are bright, and where groups with much light are lit most. In other groups the lobe is
/// taken to be what it is in the one before.
template <class AnyLobe>
ACDF_METHOD void GroupRating<AnyLobe>::look_at_much() noexcept {
    const std::uint8_t* hearts = acdf_local_group_hearts(of_.light.tables, nearest_row(), of_.light.fast.ends);
    Looks much;
    int count = 0;
    for (int i = 0, end = count_; i < end; ++i) {
        much.part[count] = static_cast<std::uint16_t>(i);
        count += light_in_[i] > least_light;
    }
    much.count = count;
    for (int k = 0; k < count; ++k) {
        const int part = much.part[k];
        if (part < bright_tiles_) {
            of_.above_surface(of_.light.bright_tiles[entry_[part]].direction, much.wi[k]);
        } else {
            const std::uint32_t group = group_of(part);
            of_.above_surface(acdf_local_middle(of_.light.tables, ACDF_FAST_GROUP * group + hearts[group]),
                              much.wi[k]);
        }
    }
    look(much);
    for (int i = bright_tiles_ + 1; i < count_; ++i)
        value_[i] = light_in_[i] > least_light ? value_[i] : value_[i - 1];
}

template <class AnyLobe>
ACDF_METHOD void GroupRating<AnyLobe>::look(const Looks& looks) noexcept {
    of_.look(looks.count, looks.wi, [&](int i, float value, float pdf) {
        value_[looks.part[i]] = value;
        pdf_[looks.part[i]] = pdf;
    });
}

/// Mean and mass of parts, from what was seen there.
template <class AnyLobe>
ACDF_METHOD void GroupRating<AnyLobe>::rate(int first, int end) noexcept {
    const float sampled = static_cast<float>(guides_.sampled);
    for (int i = first; i < end; ++i) {
        const float own = 1.0f / (1.0f + solid_angle_[i] * sampled * pdf_[i]);
        mean_[i] = own * value_[i];
        mass_[i] = own * pdf_[i] * solid_angle_[i];
    }
}
/// The same from a guide that lies in a part.
template <class AnyLobe>
ACDF_METHOD void GroupRating<AnyLobe>::rate_guide(int part, int guide) noexcept {
    const float expected = solid_angle_[part] * static_cast<float>(guides_.sampled);
    const float weight = 1.0f / (1.0f + expected * guides_.pdf[guide]);
    mean_[part] += weight * guides_.value[guide];
    mass_[part] += weight * guides_.pdf[guide] * solid_angle_[part];
}

template <class AnyLobe>
ACDF_METHOD void GroupRating<AnyLobe>::rate_groups() noexcept {
    rate(bright_tiles_, count_);
    for (int k = 0; k < guides_.count; ++k) {
        if (guide_tile_[k] == no_tile) continue;
        const int entry = first_entry_ + guide_tile_[k] / group_size, part = part_of_[entry];
        if (part < count_ && entry_[part] == entry) rate_guide(part, k);
    }
    compare(bright_tiles_, count_, 0.7f, 0.0f);
    for (int i = 0; i < bright_tiles_; ++i) {
        mean_[i] = value_[i];
        mass_[i] = around_[i] = spread_[i] = 0.0f;
    }
}

/// How much the lobe changes from part to part, its square scaled, and what it may be in one as its neighbours
/// suggest, besides what is hoped for. Parts before the first one and behind the last one are others' neighbours.
template <class AnyLobe>
ACDF_METHOD void GroupRating<AnyLobe>::compare(int first, int end, float scale, float hoped) noexcept {
    const float before_first = mean_[first - 1];
    mean_[first - 1] = mean_[first];
    mean_[end] = mean_[end - 1];
    for (int i = first; i < end; ++i) {
        const float one = mean_[i], before = mean_[i - 1], after = mean_[i + 1];
        const float larger = before > after ? before : after, smaller = before < after ? before : after;
        const float most_seen = larger > one ? larger : one, least_seen = smaller < one ? smaller : one;
        const float change = 1.0f - least_seen / (most_seen > 1e-30f ? most_seen : 1e-30f);
        spread_[i] = scale * change * change;
        around_[i] = 0.5f * most_seen + hoped;
    }
    mean_[first - 1] = before_first;
}

/// The groups to open, at most so many: those that reflect most, the larger ones first.
template <class AnyLobe>
ACDF_METHOD void GroupRating<AnyLobe>::choose() noexcept {
    const int wanted = (of_.parts - 8) / parts_per_open,
              room = wanted < ACDF_FAST_CUT_OPEN ? wanted : ACDF_FAST_CUT_OPEN;
    float square[ACDF_FAST_CUT_GROUPS], reflected[room_for<float>(ACDF_FAST_CUT_GROUPS)], best[ACDF_FAST_CUT_OPEN];
    const int groups = count_ - bright_tiles_;
    if (room <= 0) return;
    for (int i = 0; i < groups; ++i) {
        const int part = bright_tiles_ + i;
        reflected[i] = light_in_[part] * (mean_[part] + 0.3f * around_[part]);
        square[i] = reflected[i] * reflected[i] * solid_angle_[part];
    }
    const float least = least_reflected * padded_sum(reflected, groups);
    for (int i = 0; i < groups; ++i) square[i] = reflected[i] > least ? square[i] : 0.0f;
    for (int i = 0; i < groups; ++i) {
        if (!(square[i] > (open_ < room ? 0.0f : best[room - 1]))) continue;
        int at = open_ < room ? open_++ : room - 1;
        for (; at > 0 && best[at - 1] < square[i]; --at) {
            best[at] = best[at - 1];
            opened_[at] = opened_[at - 1];
        }
        best[at] = square[i];
        opened_[at] = bright_tiles_ + i;
    }
}

/// Looks at the tiles of the chosen groups, all at once. They take the numbers of their groups.
template <class AnyLobe>
ACDF_METHOD void GroupRating<AnyLobe>::open_chosen() noexcept {
    const std::uint32_t last = of_.light.blend.tiles->tile_count - 1;
    Looks tiles;
    for (int k = 0; k < open_; ++k) {
        const std::uint32_t group = group_of(opened_[k]), begin = ACDF_FAST_GROUP * group;
        const AcdfFastGroup mixture = acdf_fast_find_group(&of_.at.by.fast.mix, group);
        const float of_all = static_cast<float>(255.0 * (mixture.whole > 1.0 ? mixture.whole : 1.0));
        const float unit = light_in_[opened_[k]] / of_all;
        std::int32_t masses[group_size];
        acdf_fast_tile_masses(&of_.at.by.fast.mix, &mixture, begin, masses);
        for (int i = 0; i < group_size; ++i, ++all_) {
            const std::uint32_t tile = begin + static_cast<std::uint32_t>(i);
            const float* middle = acdf_local_middle(of_.light.tables, tile < last ? tile : last);
            light_in_[all_] = static_cast<float>(masses[i]) * unit;
            solid_angle_[all_] = middle[3];
            value_[all_] = pdf_[all_] = 0.0f;
            of_.above_surface(middle, tiles.wi[tiles.count]);
            tiles.part[tiles.count] = static_cast<std::uint16_t>(all_);
            tiles.count += masses[i] > 0;
        }
    }
    look(tiles);
    for (int k = 0; k < open_; ++k) rate_tiles(opened_[k], count_ + group_size * k);
}

/// The tiles of a group, which take its place.
template <class AnyLobe>
ACDF_METHOD void GroupRating<AnyLobe>::rate_tiles(int part, int first) noexcept {
    const int begin = group_size * static_cast<int>(group_of(part));
    rate(first, first + group_size);
    for (int k = 0; k < guides_.count; ++k) {
        const int inside = guide_tile_[k] - begin; // below 0 of no tile
        if (inside >= 0 && inside < group_size) rate_guide(first + inside, k);
    }
    compare(first, first + group_size, 1.0f, 0.5f * mean_[part] + 0.25f * around_[part]);
    light_in_[part] = 0.0f;
}

/// What all parts were given, as a cut has it.
template <class AnyLobe>
ACDF_METHOD void GroupRating<AnyLobe>::finish(AcdfFastCut& cut, float* probability) const noexcept {
    float share[most_parts];
    memset(cut.open, 0, sizeof cut.open);
    cut.bright_tiles = static_cast<std::uint32_t>(first_entry_);
    cut.count = cut.bright_tiles + of_.light.fast.ends;
    for (int k = 0; k < open_; ++k) {
        float* tile = probability + count_ + group_size * k;
        const float inside = padded_sum(tile, group_size);
        if (!(inside > 0.0f)) continue;
        probability[opened_[k]] = inside;
        for (int i = 0; i < group_size; ++i) tile[i] /= inside;
        acdf_fast_cut_ends(tile, group_size, cut.tile[k]);
        cut.open[group_of(opened_[k])] = static_cast<std::uint8_t>(k + 1);
    }
    const float sum = padded_sum(probability, count_); // and no more of tiles
    if (!(sum > 0.0f)) return;
    const float scale = 1.0f / sum;
    for (std::uint32_t i = 0; i < cut.count; ++i) share[i] = 0.0f;
    for (int i = 0; i < count_; ++i) share[entry_[i]] = probability[i] * scale;
    acdf_fast_cut_finish(&cut, share);
}

template <class AnyLobe>
ACDF_METHOD double GroupRating<AnyLobe>::make(AcdfFastCut& cut) noexcept {
    float probability[room_for<float>(most)];
    measure();
    sample_guides();
    look_at_much();
    rate_groups();
    choose();
    open_chosen();
    const double share = weigh_parts<std::size_t{most}>(all_, guides_, of_.parts < few_parts ? of_few : least_share,
                                                        *this, probability);
    if (share < 1.0) finish(cut, probability);
    return share;
}

} // namespace acdf
