#include "compress/visibility/parts.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace acdf::compress {
namespace {

std::uint32_t split_count(const AcdfLocal& local) { return local.blend.tiles->tile_count - 1; }

/// The boxes of tiles: two ranges each, behind one another.
std::vector<AcdfRange> boxes_of(const AcdfLocal& local) {
    const std::uint32_t splits = split_count(local);
    std::vector<AcdfRange> of_split(2 * std::size_t{splits} + 2), out(2 * (std::size_t{splits} + 1));
    acdf_sphere_ranges(local.environment.columns, local.environment.rows, of_split.data());
    if (splits == 0) return of_split;
    for (std::uint32_t s = 0; s < splits; ++s) {
        const AcdfSplit& split = local.blend.splits[s];
        for (std::uint32_t k = 0; k < 2; ++k) {
            const std::uint32_t child = split.child[k];
            AcdfRange* box = child & ACDF_TILE_FLAG ? &out[2 * std::size_t{child & ~ACDF_TILE_FLAG}]
                                                    : &of_split[2 * std::size_t{child}];
            box[0] = of_split[2 * std::size_t{s}];
            box[1] = of_split[2 * std::size_t{s} + 1];
            acdf_range_cut(&box[split.place & 7u], split.place >> 3, static_cast<int>(k));
        }
    }
    return out;
}

/// The bits of a number below 2^6 in reverse, over 2^6: van der Corput.
double reversed(std::uint32_t k) {
    double out = 0.0, digit = 0.5;
    for (; k > 0; k >>= 1, digit *= 0.5) out += digit * (k & 1u);
    return out;
}

} // namespace

VisibilityParts::VisibilityParts(const AcdfLocal& local, std::uint32_t bins, std::uint32_t columns)
    : local_(local), light_(mean_tiles(bins)), boxes_(boxes_of(local)) {
    cut(light_, columns);
}

VisibilityParts::VisibilityParts(const VisibilityParts& coarse, const std::vector<double>& loss)
    : local_(coarse.local_), light_(coarse.light_), boxes_(coarse.boxes_) {
    constexpr double kElsewhere = 0.02; // of all: where no ray has found an edge there may be one
    double sum = 0.0;
    for (std::size_t p = 0; p < coarse.boxes(); ++p) sum += loss[p];
    double all = 0.0;
    for (const double light : light_) all += light;
    std::vector<double> worth(light_.size(), 0.0);
    for (std::size_t p = 0; p < coarse.boxes(); ++p) {
        double own = 0.0;
        for (const std::uint32_t tile : coarse.tiles_of_part_[p]) own += light_[tile];
        for (const std::uint32_t tile : coarse.tiles_of_part_[p])
            worth[tile] = (sum > 0.0 && own > 0.0 ? loss[p] / sum * light_[tile] / own : 0.0) +
                          kElsewhere * light_[tile] / all;
    }
    cut(worth, coarse.column_count());
}

void VisibilityParts::cut(const std::vector<double>& worth, std::uint32_t columns) {
    choose(worth, columns);
    number(split_count(local_) > 0 ? 0 : ACDF_TILE_FLAG);
    box_count_ = tiles_of_part_.size();
    part_of_tile_.resize(light_.size());
    for (std::uint32_t p = 0; p < box_count_; ++p)
        for (const std::uint32_t tile : tiles_of_part_[p]) part_of_tile_[tile] = p;
    for (std::uint32_t k = 0; k < local_.bright_tile_count; ++k)
        part_of_tile_[local_.bright_tiles[k].tile] = static_cast<std::uint32_t>(box_count_) + k;
    aim();
}

/// What the bins give to each tile, in the mean.
std::vector<double> VisibilityParts::mean_tiles(std::uint32_t bins) const {
    const std::uint32_t splits = split_count(local_);
    std::vector<double> out(splits + 1, splits == 0 ? 1.0 : 0.0), below(splits);
    for (std::uint32_t b = 0; b < bins; ++b) {
        const AcdfBin& bin = local_.bins[b];
        if (bin.root == ACDF_NO_ROOT || !(bin.share > 0.0f) || splits == 0) continue;
        const std::uint8_t* row = local_.blend.rows + std::size_t{bin.root} * splits;
        below[0] = 1.0;
        for (std::uint32_t s = 0; s < splits; ++s) {
            const double lower = local_.blend.tiles->codebook[row[s]] / 65535.0;
            for (std::uint32_t k = 0; k < 2; ++k) {
                const std::uint32_t child = local_.blend.splits[s].child[k];
                const double p = below[s] * (k == 0 ? lower : 1.0 - lower);
                if (child & ACDF_TILE_FLAG) out[child & ~ACDF_TILE_FLAG] += p;
                else below[child] = p;
            }
        }
    }
    return out;
}

std::vector<double> VisibilityParts::mass_below(const std::vector<double>& tiles) const {
    std::vector<double> out(split_count(local_), 0.0);
    for (std::size_t s = out.size(); s-- > 0;)
        for (const std::uint32_t child : local_.blend.splits[s].child)
            out[s] += child & ACDF_TILE_FLAG ? tiles[child & ~ACDF_TILE_FLAG] : out[child];
    return out;
}

/// Marks the splits that are columns, in columns_ with any number but ACDF_NO_COLUMN.
void VisibilityParts::choose(const std::vector<double>& worth, std::uint32_t columns) {
    const std::vector<double> mass = mass_below(worth);
    const AcdfGrid grid = acdf_environment_grid(&local_.environment);
    std::vector<double> angle(mass.size(), 0.0);
    for (std::size_t s = mass.size(); s-- > 0;)
        for (const std::uint32_t child : local_.blend.splits[s].child)
            angle[s] += child & ACDF_TILE_FLAG
                            ? acdf_grid_solid_angle(&grid, &boxes_[2 * std::size_t{child & ~ACDF_TILE_FLAG}])
                            : angle[child];
    columns_.assign(mass.size(), ACDF_NO_COLUMN);
    using Entry = std::pair<double, std::uint32_t>; // worth, and number from the back: of equal ones the first
    std::priority_queue<Entry> queue;
    // An edge of what hides light crosses a box the more likely the wider it is.
    const auto push = [&](std::uint32_t s) { queue.push({mass[s] * std::sqrt(angle[s]), ~s}); };
    if (!mass.empty()) push(0);
    for (std::uint32_t count = 0; count < columns && !queue.empty(); ++count) {
        const std::uint32_t split = ~queue.top().second;
        queue.pop();
        columns_[split] = 0;
        for (const std::uint32_t child : local_.blend.splits[split].child)
            if (!(child & ACDF_TILE_FLAG)) push(child);
    }
}

/// Numbers cuts and parts from a node on; returns what it is as a child.
std::uint32_t VisibilityParts::number(std::uint32_t node) {
    if (!(node & ACDF_TILE_FLAG) && columns_[node] != ACDF_NO_COLUMN) {
        const auto cut = static_cast<std::uint32_t>(cuts_.size());
        columns_[node] = static_cast<std::uint16_t>(cut);
        cuts_.push_back({node, {}});
        for (std::size_t k = 0; k < 2; ++k) {
            const std::uint32_t child = number(local_.blend.splits[node].child[k]);
            cuts_[cut].child[k] = child;
        }
        return cut;
    }
    std::vector<std::uint32_t> open{node}, tiles;
    while (!open.empty()) {
        const std::uint32_t now = open.back();
        open.pop_back();
        if (now & ACDF_TILE_FLAG) tiles.push_back(now & ~ACDF_TILE_FLAG);
        else open.insert(open.end(), {local_.blend.splits[now].child[1], local_.blend.splits[now].child[0]});
    }
    tiles_of_part_.push_back(std::move(tiles));
    return part | static_cast<std::uint32_t>(tiles_of_part_.size() - 1);
}

std::array<float, 3> VisibilityParts::place(std::uint32_t tile, double u0, double u1) const {
    AcdfRange range[2] = {boxes_[2 * std::size_t{tile}], boxes_[2 * std::size_t{tile} + 1]};
    double u[2] = {u0, u1};
    const AcdfBlend& blend = local_.blend;
    if (blend.roots && blend.roots[tile] != ACDF_NO_ROOT) acdf_tree_sample(blend.tree, blend.roots[tile], u, range);
    const AcdfGrid grid = acdf_environment_grid(&local_.environment);
    const AcdfDirectionSample s = acdf_grid_position(&grid, range, u, 1.0);
    return {s.direction[0], s.direction[1], s.direction[2]};
}

/// Directions of each part, as its light is spread.
void VisibilityParts::aim() {
    for (const std::vector<std::uint32_t>& own : tiles_of_part_) {
        double sum = 0.0;
        for (const std::uint32_t tile : own) sum += light_[tile];
        const auto weight = [&](std::uint32_t tile) {
            return sum > 0.0 ? light_[tile] / sum : 1.0 / double(own.size());
        };
        std::size_t at = 0;
        double before = 0.0;
        for (std::uint32_t i = 0; i < directions; ++i) {
            const double u = (i + 0.5) / directions;
            while (at + 1 < own.size() && u >= before + weight(own[at])) before += weight(own[at++]);
            const double inside = weight(own[at]) > 0.0 ? (u - before) / weight(own[at]) : 0.5;
            directions_.push_back(place(own[at], acdf_clamp(inside, 0.0, 1.0), reversed(i) + 0.5 / directions));
        }
    }
    for (std::uint32_t k = 0; k < local_.bright_tile_count; ++k)
        for (std::uint32_t i = 0; i < directions; ++i)
            directions_.push_back(
                place(local_.bright_tiles[k].tile, (i + 0.5) / directions, reversed(i) + 0.5 / directions));
}

std::vector<VisibilityParts::Tile> VisibilityParts::tiles(std::size_t part) const {
    const AcdfGrid grid = acdf_environment_grid(&local_.environment);
    std::vector<Tile> out;
    const auto add = [&](std::uint32_t number) {
        const AcdfRange* box = &boxes_[2 * std::size_t{number}];
        double middle[2] = {0.5, 0.5};
        const AcdfRange range[2] = {box[0], box[1]};
        const AcdfDirectionSample s = acdf_grid_position(&grid, range, middle, 1.0);
        out.push_back(
            {{s.direction[0], s.direction[1], s.direction[2]}, acdf_grid_solid_angle(&grid, box), light_[number]});
    };
    if (part >= box_count_) add(local_.bright_tiles[part - box_count_].tile);
    else
        for (const std::uint32_t number : tiles_of_part_[part]) add(number);
    return out;
}

bool VisibilityParts::find(const float direction[3], std::uint32_t& part) const {
    const AcdfGrid grid = acdf_environment_grid(&local_.environment);
    std::uint32_t square[2], node = acdf_blend_root(&local_.blend);
    if (!acdf_local_square(&grid, direction, square)) return false;
    while (!(node & ACDF_TILE_FLAG)) {
        const AcdfSplit& split = local_.blend.splits[node];
        node = split.child[square[split.place & 7u] >= split.place >> 3];
    }
    part = part_of_tile_[node & ~ACDF_TILE_FLAG];
    return true;
}

void VisibilityParts::weigh(const AcdfLocalPoint& point, float* out) const {
    std::fill_n(out, count(), 0.0f);
    if (point.what != ACDF_LOCAL_BLEND) return;
    std::vector<AcdfMixture> mixes(cuts_.size() + 1, point.mix);
    if (cuts_.empty()) out[0] = static_cast<float>(acdf_mixture_sum(&point.mix));
    for (std::size_t c = 0; c < cuts_.size(); ++c) {
        AcdfMixture sides[2] = {mixes[c], mixes[c]};
        double sum[2];
        acdf_mixture_split(&mixes[c], &local_.blend, cuts_[c].split, sides, sum);
        for (std::size_t k = 0; k < 2; ++k) {
            const std::uint32_t child = cuts_[c].child[k];
            if (child & part) out[child & ~part] = static_cast<float>(sum[k]);
            else mixes[child] = sides[k];
        }
    }
    const AcdfScaledNormal normal = acdf_local_scaled_normal(&point);
    for (std::uint32_t k = 0; k < local_.bright_tile_count; ++k)
        out[box_count_ + k] = static_cast<float>(acdf_bright_tile_weight(&local_.bright_tiles[k], &normal));
}

std::vector<std::array<double, 2>> VisibilityParts::sides(const double* amount) const {
    std::vector<std::array<double, 2>> out(cuts_.size());
    for (std::size_t c = cuts_.size(); c-- > 0;)
        for (std::size_t k = 0; k < 2; ++k) {
            const std::uint32_t child = cuts_[c].child[k];
            out[c][k] = child & part ? amount[child & ~part] : out[child][0] + out[child][1];
        }
    return out;
}

} // namespace acdf::compress
