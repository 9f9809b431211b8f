#include "compress/local/mixed_rows.h"
#include "compress/local/triangles.h"
#include "compress/parallel.h"

#include <acdf/local.h>

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace acdf::compress {
namespace {

constexpr int kDescents = 2; // towards the minimum: most of what is gained comes with the first
/// Of a corner's own best part, what stays at least, and the cosine below which all stays, times the subdivisions:
/// both bound weights.
constexpr double kLeastPart = 0.25, kLeastCosine = 0.06;
/// Samples in vain count so many times more where they are many, fully from `kManyVain` on.
constexpr double kVainCost = 6.0, kFewVain = 0.01, kManyVain = 0.02;
/// Of what a bin's normals count, the corner itself.
constexpr double kCornerShare = 0.2;
constexpr std::size_t kNearby = 3; // normals of a triangle follow each other: nearly the same tiles are cut
static_assert(kNearby <= TileLight::views_at_once, "");

/// A normal that samples from a mixture, on a face of the octahedron that the bins divide: |x| + |y| + |z| is its
/// number of subdivisions.
struct MixedNormal {
    Direction place{};
    std::array<std::uint32_t, 3> bin{};
    std::array<double, 3> weight{}; ///< as a reader weighs the rows
    std::size_t count = 0;
    double frequency = 0.0;
};

class MixedNormals {
public:
    explicit MixedNormals(const NormalBins& bins) : bins_(bins), near_(bins.normals.size()) {
        for_each_triangle(static_cast<std::int32_t>(bins.subdivisions),
                          [&](const std::array<OctahedronCorner, 3>& corners) { add_triangle(corners); });
        for (std::uint32_t b = 0; b < near_.size(); ++b) add_corner(b);
    }

    double subdivisions() const { return bins_.subdivisions; }
    const std::vector<MixedNormal>& near(std::size_t bin) const { return near_[bin]; }

private:
    static double length(const OctahedronCorner& c) {
        return std::sqrt(double(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]));
    }

    void add_triangle(const std::array<OctahedronCorner, 3>& corners) {
        MixedNormal normal;
        normal.count = 3;
        normal.frequency = 1.0;
        for (std::size_t i = 0; i < 3; ++i) {
            normal.bin[i] = acdf_octahedral_corner(bins_.subdivisions, corners[i][0], corners[i][1], corners[i][2]);
            normal.frequency = std::min(normal.frequency, bins_.weight[normal.bin[i]]);
        }
        if (!(normal.frequency > 0.0)) return;          // it has no mixture
        normal.frequency *= (1.0 - kCornerShare) / 6.0; // there are two triangles a bin
        for (std::size_t nearest = 0; nearest < 3; ++nearest) {
            normal.place = {};
            for (std::size_t i = 0; i < 3; ++i) {
                const double share = i == nearest ? 2.0 / 3.0 : 1.0 / 6.0;
                normal.weight[i] = share * length(corners[i]);
                for (std::size_t k = 0; k < 3; ++k) normal.place[k] += share * corners[i][k];
            }
            for (const std::uint32_t b : normal.bin) near_[b].push_back(normal);
        }
    }

    void add_corner(std::uint32_t bin) {
        MixedNormal normal;
        normal.place = bins_.normals[bin];
        normal.bin[0] = bin;
        normal.weight[0] = 1.0;
        normal.count = 1;
        normal.frequency = kCornerShare * bins_.weight[bin];
        if (normal.frequency > 0.0) near_[bin].push_back(normal);
    }

    const NormalBins& bins_;
    std::vector<std::vector<MixedNormal>> near_; ///< of each bin, those that its row serves
};

/// What is positive stays so.
float as_part(double value) {
    return value > 0.0 ? std::max(static_cast<float>(value), std::numeric_limits<float>::min()) : 0.0f;
}

/// What bright tiles sample at a position on a face.
double light_weights(const std::vector<AcdfBrightTile>& bright_tiles, const Direction& place, double length) {
    AcdfScaledNormal at = {};
    std::copy(place.begin(), place.end(), at.normal);
    at.length = length;
    double sum = 0.0;
    for (const AcdfBrightTile& light : bright_tiles) sum += acdf_bright_tile_weight(&light, &at);
    return sum;
}

/// Arrays of a thread, one number a tile.
struct MixedScratch {
    std::array<TileView, TileLight::views_at_once> views;
    std::vector<double> mixed, raise, lower;
};

/// A step for one row. The relative variance at a normal is A S / E^2 - 1, with A = sum of cost^2 / r over tiles
/// and S = sum of r, where r is what the mixture gives to each tile. Its derivatives by the row are a difference of
/// two positive sums; the square root of their ratio leads towards the minimum (as in Lee and Seung's
/// factorizations).
class Step {
public:
    Step(const TileLight& light, const std::vector<AcdfBrightTile>& bright_tiles, const MixedNormals& normals,
         const TileParts& own, const TileParts& parts)
        : light_(light), bright_tiles_(bright_tiles), normals_(normals), own_(own), parts_(parts),
          least_cosine_(kLeastCosine / normals.subdivisions()) {}

    void run(std::size_t bin, MixedScratch& s, std::vector<float>& out) const {
        s.mixed.resize(light_.size());
        s.raise.assign(light_.size(), 0.0);
        s.lower.assign(light_.size(), 0.0);
        const std::vector<MixedNormal>& near = normals_.near(bin);
        for (std::size_t begin = 0; begin < near.size(); begin += kNearby) {
            const std::size_t count = std::min(kNearby, near.size() - begin);
            std::array<Direction, kNearby> units;
            for (std::size_t k = 0; k < count; ++k) units[k] = unit(near[begin + k].place);
            light_.look(units.data(), count, s.views.data());
            for (std::size_t k = 0; k < count; ++k) add(near[begin + k], s.views[k], bin, s);
        }
        double before = 0.0, after = 0.0;
        for (std::size_t t = 0; t < out.size(); ++t) {
            const double part = double{parts_[bin][t]};
            if (part > 0.0 && s.lower[t] > 0.0) s.mixed[t] = part * std::sqrt(s.raise[t] / s.lower[t]);
            else s.mixed[t] = part;
            before += double{own_[bin][t]};
            after += s.mixed[t];
        }
        // The sum stays: it is the irradiance, and the row's weight in mixtures.
        for (std::size_t t = 0; t < out.size(); ++t) {
            const double own = double{own_[bin][t]};
            const double least = std::max(kLeastPart * own, std::min(own, least_cosine_ * light_.whole(t)));
            if (own > 0.0) out[t] = as_part(std::max(s.mixed[t] * (before / after), least));
        }
    }

private:
    static Direction unit(const Direction& place) {
        const double length = std::sqrt(dot(place, place));
        return {place[0] / length, place[1] / length, place[2] / length};
    }

    void add(const MixedNormal& normal, const TileView& view, std::size_t bin, MixedScratch& s) const {
        const double length = std::sqrt(dot(normal.place, normal.place));
        std::fill(s.mixed.begin(), s.mixed.end(), 0.0);
        double own_weight = 0.0;
        for (std::size_t i = 0; i < normal.count; ++i) {
            const std::vector<float>& row = parts_[normal.bin[i]];
            for (std::size_t t = 0; t < row.size(); ++t) s.mixed[t] += normal.weight[i] * double{row[t]};
            if (normal.bin[i] == bin) own_weight = normal.weight[i];
        }
        // Of bright tiles, what they sample is what they should.
        const double sampled = light_weights(bright_tiles_, normal.place, length);
        double irradiance = sampled, moments = sampled, sum = sampled, vain = 0.0;
        for (std::size_t t = 0; t < s.mixed.size(); ++t) {
            if (!(s.mixed[t] > 0.0)) continue;
            const double cost = length * view.cost[t];
            irradiance += cost;
            moments += cost * cost / s.mixed[t];
            sum += s.mixed[t];
            vain += s.mixed[t] * view.hidden[t];
        }
        if (!(irradiance > 0.0)) return;
        const double penalty = kVainCost * std::clamp((vain / sum - kFewVain) / (kManyVain - kFewVain), 0.0, 1.0);
        const double scale = own_weight * normal.frequency / (irradiance * irradiance);
        for (std::size_t t = 0; t < s.mixed.size(); ++t) {
            if (!(s.mixed[t] > 0.0)) continue;
            const double ratio = length * view.cost[t] / s.mixed[t];
            s.raise[t] += scale * (sum + penalty * vain) * ratio * ratio;
            s.lower[t] += scale * moments * (1.0 + penalty * view.hidden[t]);
        }
    }

    const TileLight& light_;
    const std::vector<AcdfBrightTile>& bright_tiles_;
    const MixedNormals& normals_;
    const TileParts &own_, &parts_;
    const double least_cosine_;
};

} // namespace

TileParts mixed_rows(const TileLight& light, const NormalBins& bins,
                     const std::vector<AcdfBrightTile>& bright_tiles) {
    tbb::enumerable_thread_specific<MixedScratch> scratch;
    TileParts own(bins.normals.size());
    parallel_for(std::size_t{0}, own.size(), [&](std::size_t b) {
        if (!(bins.weight[b] > 0.0)) return;
        const std::vector<double> costs = light.costs(bins.normals[b]);
        own[b].resize(costs.size());
        std::transform(costs.begin(), costs.end(), own[b].begin(), as_part);
    });
    const MixedNormals normals(bins);
    TileParts parts = own, next = own;
    for (int step = 0; step < kDescents; ++step) {
        const Step towards(light, bright_tiles, normals, own, parts);
        parallel_for(std::size_t{0}, parts.size(), [&](std::size_t b) {
            if (!parts[b].empty()) towards.run(b, scratch.local(), next[b]);
        });
        std::swap(parts, next);
    }
    return parts;
}

} // namespace acdf::compress
