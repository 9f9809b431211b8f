#include "build/probe/source_target.h"

#include "build/probe/overlap.h"
#include "build/probe/repeated_rows.h"
#include "build/probe/source_lookup.h"
#include "compress/parallel.h"
#include "compress/sum.h"

#include <acdf/grid.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <vector>

namespace acdf::build {
namespace {

using compress::Sum;
using compress::Target;

constexpr int kMaxHalvings = 6;
constexpr int kRowsAtOnce = 64;
/// Of a dark texel beside a lit one: its g, of the largest beside it. A border that was cut a hair off leaves no
/// light without pdf then.
constexpr double kGlimpse = 1e-4;
// Solid angles are added up as integers: their sum is the same in any order, so on any number of threads.
constexpr double kUnits = 0x1p61 / (4.0 * ACDF_PI);

/// What a texel of the grid overlaps.
struct Overlapped {
    std::array<double, 3> flux{};
    double energy = 0.0, peak = 0.0;
};

class Overlay {
public:
    Overlay(const SourceLookup& source, const Domain& domain, Target& target)
        : source_(source), map_(source.map()), domain_(domain), target_(target),
          covered_(static_cast<std::size_t>(map_.width) * static_cast<std::size_t>(map_.height)),
          kept_(map_, domain.columns, domain.rows) {}

    SourceTarget run() {
        const std::size_t texels = std::size_t{domain_.columns} * domain_.rows;
        target_.values.assign(texels, 0.0f);
        target_.peaks.assign(texels, 0.0f);
        target_.means.assign(source_.planes(), std::vector<float>(texels, 0.0f));
        compress::parallel_for(std::uint32_t{0}, domain_.rows, [&](std::uint32_t row) { cover(row); });
        const double error = scale_what_is_covered();
        std::vector<std::array<double, 3>> flux(domain_.rows);
        compress::parallel_for(std::uint32_t{0}, domain_.rows, [&](std::uint32_t row) { flux[row] = gather(row); });
        std::array<Sum, 3> total;
        for (const auto& row : flux)
            for (std::size_t plane = 0; plane < 3; ++plane) total[plane].add(row[plane]);
        hand_out_missed(total);
        light_borders();
        compress::refuse_overflow(target_);
        for (const Sum& plane : total) {
            target_.total += plane.value();
            target_.mean_square += plane.value() * plane.value();
        }
        return {std::move(target_), error};
    }

private:
    template <class Visit>
    void overlaps(std::uint32_t column, std::uint32_t row, const Visit& visit) const {
        const double columns = domain_.columns, rows = domain_.rows;
        if (domain_.parameterization == ACDF_PARAM_OCTAHEDRAL)
            for_each_overlap(map_,
                             SquareCell{column / columns, (column + 1) / columns, row / rows, (row + 1) / rows},
                             kMaxHalvings, visit, source_.parts());
        else
            for_each_overlap(map_,
                             SphereCell{1.0 - 2.0 * column / columns, 1.0 - 2.0 * (column + 1) / columns,
                                        row / rows, (row + 1) / rows},
                             kMaxHalvings, visit, source_.parts());
    }
    std::size_t width() const { return static_cast<std::size_t>(map_.width); }
    std::size_t texel_of(int column, int row) const { // of a part
        return static_cast<std::size_t>(row / source_.parts()) * width() +
               static_cast<std::size_t>(column / source_.parts());
    }
    double covered(std::size_t texel) const {
        return static_cast<double>(covered_[texel].load(std::memory_order_relaxed)) / kUnits;
    }
    /// By what a texel's overlaps are scaled; negative where there are none. Takes the place of what was covered.
    double scale(std::size_t texel) const {
        const std::uint64_t bits = covered_[texel].load(std::memory_order_relaxed);
        double scale;
        std::memcpy(&scale, &bits, sizeof scale);
        return scale;
    }
    void set_scale(std::size_t texel, double scale) {
        std::uint64_t bits;
        std::memcpy(&bits, &scale, sizeof bits);
        covered_[texel].store(bits, std::memory_order_relaxed);
    }

    void cover(std::uint32_t row) {
        std::vector<Overlap> found;
        for (std::uint32_t column = 0; column < domain_.columns; ++column)
            overlaps(column, row, [&](int x, int y, double omega, const Polygon&) {
                const std::size_t texel = texel_of(x, y);
                covered_[texel].fetch_add(static_cast<std::uint64_t>(omega * kUnits), std::memory_order_relaxed);
                if (keeps()) found.push_back(overlap(column, texel, omega));
            });
        if (keeps()) kept_.keep(row, found);
    }
    bool keeps() const { return kept_.any() && source_.parts() == 1; } // else polygons would be needed, too

    /// Each texel of the map is to hand out its own solid angle: the covered part is scaled by about 1. Returns how
    /// much of the energy that moves.
    double scale_what_is_covered() {
        Sum missed, all;
        const auto width = static_cast<std::size_t>(map_.width);
        std::vector<double> omegas(width * kRowsAtOnce); // the rim of a disc takes long
        for (int first = 0; first < map_.height; first += kRowsAtOnce) {
            const int rows = std::min(kRowsAtOnce, map_.height - first);
            compress::parallel_for(0, rows, [&](int row) {
                for (int x = 0; x < map_.width; ++x)
                    omegas[static_cast<std::size_t>(row) * width + static_cast<std::size_t>(x)] =
                        texel_solid_angle(map_, x, first + row);
            });
            for (std::size_t i = 0; i < width * static_cast<std::size_t>(rows); ++i) {
                const std::size_t texel = static_cast<std::size_t>(first) * width + i;
                const double omega = omegas[i], cover = covered(texel);
                if (omega > 0.0) {
                    const int parts = source_.parts();
                    const double square =
                        at_middle(parts * static_cast<int>(texel % width), parts * static_cast<int>(texel / width))
                            .square;
                    missed.add(square * std::abs(cover - omega));
                    all.add(square * omega);
                }
                set_scale(texel, cover > 0.0 ? omega / cover : -1.0);
            }
        }
        return all.value() > 0.0 ? missed.value() / all.value() : 0.0;
    }

    std::array<double, 3> gather(std::uint32_t row) {
        std::vector<Overlapped> sums(domain_.columns);
        const auto add_part = [&](std::size_t column, int x, int y, double omega, const Polygon& part) {
            const double scaled = scale(texel_of(x, y));
            if (scaled >= 0.0) add(source_.moments(x, y, part), omega * scaled, sums[column]);
        };
        if (keeps()) {
            Polygon any; // of the part that is overlapped: such maps are looked up by texels
            for (const Overlap& o : kept_[row])
                add_part(o.of, static_cast<int>(o.texel % width()), static_cast<int>(o.texel / width()), o.omega,
                         any);
        } else {
            for (std::uint32_t column = 0; column < domain_.columns; ++column)
                overlaps(column, row, [&](int x, int y, double omega, const Polygon& part) {
                    add_part(column, x, y, omega, part);
                });
        }
        std::array<double, 3> flux{};
        for (std::uint32_t column = 0; column < domain_.columns; ++column) {
            for (std::size_t plane = 0; plane < 3; ++plane) flux[plane] += sums[column].flux[plane];
            put(column, row, sums[column]);
        }
        return flux;
    }
    LookupMoments at_middle(int column, int row) const { // of a part
        Polygon point;
        point.size = 1;
        point.x[0] = column + 0.5;
        point.y[0] = row + 0.5;
        return source_.moments(column, row, point);
    }
    static void add(const LookupMoments& f, double omega, Overlapped& sum) {
        for (std::size_t plane = 0; plane < 3; ++plane) sum.flux[plane] += omega * f.mean[plane];
        sum.energy += omega * f.square;
        sum.peak = std::max(sum.peak, f.peak);
    }
    /// Adds to what a texel of the grid has.
    void put(std::uint32_t column, std::uint32_t row, const Overlapped& sum) {
        const std::size_t i = std::size_t{row} * domain_.columns + column;
        const double own = target_.row_measure[row] * target_.column_measure[column], g = target_.values[i];
        target_.values[i] = compress::positive_float(std::sqrt(g * g + sum.energy / own));
        target_.peaks[i] = std::max(target_.peaks[i], compress::positive_float(sum.peak));
        for (std::size_t plane = 0; plane < target_.means.size(); ++plane)
            target_.means[plane][i] += static_cast<float>(sum.flux[plane] / own);
    }

    /// Slivers at the rim of a disc may have been missed by all: each goes where its middle points.
    void hand_out_missed(std::array<Sum, 3>& total) {
        const AcdfGrid grid{domain_.columns, domain_.rows, static_cast<std::uint32_t>(domain_.parameterization)};
        for (std::size_t texel = 0; texel < covered_.size(); ++texel) {
            if (scale(texel) >= 0.0) continue;
            const int x = static_cast<int>(texel % static_cast<std::size_t>(map_.width)),
                      y = static_cast<int>(texel / static_cast<std::size_t>(map_.width)), parts = source_.parts();
            const double omega = texel_solid_angle(map_, x, y);
            if (!(omega > 0.0)) continue;
            Direction d{-1.0, 0.0, 0.0}; // the rim of both discs
            to_direction(map_, (x + 0.5) / map_.width, (y + 0.5) / map_.height, d);
            const float direction[3] = {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)};
            std::uint32_t square[2];
            double position[2];
            if (!acdf_grid_square(&grid, direction, square, position)) continue;
            Overlapped sum;
            for (int k = 0; k < parts * parts; ++k)
                add(at_middle(parts * x + k % parts, parts * y + k / parts), omega / (parts * parts), sum);
            for (std::size_t plane = 0; plane < 3; ++plane) total[plane].add(sum.flux[plane]);
            put(square[0], square[1], sum);
        }
    }

    void light_borders() {
        const Map grid{domain_.parameterization == ACDF_PARAM_OCTAHEDRAL ? Layout::octahedral : Layout::latlong,
                       static_cast<int>(domain_.columns), static_cast<int>(domain_.rows)};
        const std::vector<float> values = target_.values;
        compress::parallel_for(0, grid.height, [&](int row) {
            for (int column = 0; column < grid.width; ++column) {
                const std::size_t i =
                    static_cast<std::size_t>(row) * domain_.columns + static_cast<std::size_t>(column);
                if (values[i] > 0.0f) continue;
                float largest = 0.0f;
                for (int k = 0; k < 9; ++k) {
                    const TexelPosition at = texel_beside(grid, column, row, column + k % 3 - 1, row + k / 3 - 1);
                    largest = std::max(largest, values[static_cast<std::size_t>(at.row) * domain_.columns +
                                                       static_cast<std::size_t>(at.column)]);
                }
                if (!(largest > 0.0f)) continue;
                target_.values[i] = target_.peaks[i] = compress::positive_float(kGlimpse * double{largest});
            }
        });
    }

    const SourceLookup& source_;
    const Map map_;
    const Domain domain_;
    Target& target_;
    std::vector<std::atomic<std::uint64_t>> covered_;
    KeptOverlaps kept_;
};

} // namespace

std::optional<Domain> own_domain(const Map& map) {
    const auto columns = static_cast<std::uint32_t>(map.width), rows = static_cast<std::uint32_t>(map.height);
    if (map.layout == Layout::latlong) return Domain{ACDF_PARAM_LATLONG, columns, rows};
    if (map.layout == Layout::octahedral) return Domain{ACDF_PARAM_OCTAHEDRAL, columns, rows};
    return {};
}

Domain domain_for(const Map& map, AcdfParameterization parameterization) {
    if (const auto own = own_domain(map); own && own->parameterization == parameterization) return *own;
    if (parameterization == ACDF_PARAM_OCTAHEDRAL) {
        const auto side = static_cast<std::uint32_t>(octahedral_side(map));
        return {parameterization, side, side};
    }
    const auto width = static_cast<std::uint32_t>(latlong_width(map));
    return {parameterization, width, width / 2};
}

SourceTarget source_target(const Map& map, const float* rgb, const Domain& domain,
                           const compress::TargetOptions& options) {
    compress::TargetOptions own = options;
    own.parameterization = domain.parameterization;
    if (own_domain(map) == domain) {
        Target target = compress::environment_target(rgb, domain.columns, domain.rows, own);
        const std::size_t row = std::size_t{3} * domain.columns;
        if (has_repeated_rows(map, own)) repeat_rows(target, rgb, rgb + row * (domain.rows - 1), own);
        return {std::move(target), 0.0};
    }
    const SourceLookup source(map, rgb, own);
    Target target = compress::empty_target(domain.columns, domain.rows, domain.parameterization);
    return Overlay(source, domain, target).run();
}

SourceTarget source_target_losing_least(const Map& map, const float* rgb, const compress::TargetOptions& options) {
    SourceTarget latlong = source_target(map, rgb, domain_for(map, ACDF_PARAM_LATLONG), options);
    SourceTarget octahedral = source_target(map, rgb, domain_for(map, ACDF_PARAM_OCTAHEDRAL), options);
    const bool square = least_second_moment(octahedral.target) < least_second_moment(latlong.target);
    return std::move(square ? octahedral : latlong);
}

} // namespace acdf::build
