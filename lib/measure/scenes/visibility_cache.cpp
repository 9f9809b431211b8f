#include "measure/scenes/visibility_cache.h"

#include "measure/samplers/light_samplers.h"
#include "measure/samplers/point_samplers.h"
#include "measure/sequences.h"
#include "measure/stopwatch.h"

#include <algorithm>
#include <cmath>

namespace acdf::measure {
namespace {

constexpr double kRadius = 0.04;     // how far a cache point serves, of the diagonal of the box of all points
constexpr double kLeastCosine = 0.9; // between normals
constexpr std::uint32_t kRays = 4;   // a tile; a power of 2
constexpr float kFloor = 0.05f;

double diagonal(const std::vector<ScenePoint>& points) {
    Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    for (const ScenePoint& point : points)
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], double{point.shading().position[k]});
            high[k] = std::max(high[k], double{point.shading().position[k]});
        }
    return points.empty() ? 0.0 : std::sqrt(dot(high - low, high - low));
}

double square_distance(const float a[3], const float b[3]) {
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) sum += (double{a[k]} - b[k]) * (double{a[k]} - b[k]);
    return sum;
}

} // namespace

VisibilityCache::VisibilityCache(const TilingOnTheFly& tiling, const std::vector<ScenePoint>& points)
    : radius_(std::max(kRadius * diagonal(points), 1e-6)), tiles_(tiling.tiles()) {
    const Stopwatch watch;
    for (const ScenePoint& point : points)
        if (!factors(point.shading())) add(tiling, point);
    making_.seconds = 1e-9 * watch.nanoseconds();
}

std::uint64_t VisibilityCache::cell(const double at[3]) const {
    std::uint64_t hash = 0;
    for (int k = 0; k < 3; ++k) // cells that share a number only have more entries
        hash = hash * 0x9E3779B97F4A7C15u + static_cast<std::uint64_t>(std::llround(std::floor(at[k] / radius_)));
    return hash;
}

void VisibilityCache::add(const TilingOnTheFly& tiling, const ScenePoint& point) {
    Entry entry{};
    std::copy_n(point.shading().position, 3, entry.position);
    std::copy_n(point.shading().n, 3, entry.n);
    const auto index = static_cast<std::uint32_t>(entries_.size());
    entries_.push_back(entry);
    for (int neighbour = 0; neighbour < 27; ++neighbour) {
        const double at[3] = {entry.position[0] + (neighbour % 3 - 1) * radius_,
                              entry.position[1] + (neighbour / 3 % 3 - 1) * radius_,
                              entry.position[2] + (neighbour / 9 - 1) * radius_};
        cells_[cell(at)].push_back(index);
    }
    for (std::size_t tile = 0; tile < tiles_; ++tile) factors_.push_back(kFloor + share_seen(tiling, tile, point));
}

float VisibilityCache::share_seen(const TilingOnTheFly& tiling, std::size_t tile, const ScenePoint& point) {
    if (!(tiling.flux()[tile] > 0.0)) return 1.0f;
    std::uint32_t above = 0, seen = 0;
    for (std::uint32_t ray = 0; ray < kRays; ++ray) {
        const auto u = sobol_point(ray);
        const double middle = 0.5 / kRays; // of the strata that the first points have one each of
        const AcdfDirectionSample s =
            tiling.sample_tile(tile, below_one(u[0] * 0x1p-32 + middle), below_one(u[1] * 0x1p-32 + middle));
        const Vec3 d{double{s.direction[0]}, double{s.direction[1]}, double{s.direction[2]}};
        const float* n = point.shading().n;
        if (!(d[0] * n[0] + d[1] * n[1] + d[2] * n[2] > 0.0)) continue;
        ++above;
        seen += !point.hidden(d);
    }
    making_.shadow_rays += above;
    // A tile that only touches the hemisphere weighs little by its cosine alone.
    return above > 0 ? static_cast<float>(seen) / static_cast<float>(above) : 1.0f;
}

const float* VisibilityCache::factors(const ShadingPoint& point) const {
    const double at[3] = {double{point.position[0]}, double{point.position[1]}, double{point.position[2]}};
    const auto found = cells_.find(cell(at));
    if (found == cells_.end()) return nullptr;
    double nearest = radius_ * radius_;
    const float* best = nullptr;
    for (const std::uint32_t i : found->second) {
        const Entry& entry = entries_[i];
        const double distance = square_distance(entry.position, point.position);
        const double cosine = double{entry.n[0]} * double{point.n[0]} + double{entry.n[1]} * double{point.n[1]} +
                              double{entry.n[2]} * double{point.n[2]};
        if (!(distance <= nearest && cosine >= kLeastCosine)) continue;
        nearest = distance;
        best = factors_.data() + i * tiles_;
    }
    return best;
}

std::uint64_t VisibilityCache::bytes() const {
    std::uint64_t sum = entries_.size() * sizeof(Entry) + factors_.size() * sizeof(float);
    for (const auto& cell : cells_) sum += sizeof cell + cell.second.size() * sizeof(std::uint32_t);
    return sum;
}

namespace {

class CachedTiling final : public LightSampler {
public:
    CachedTiling(const compress::Target& target, std::uint32_t columns, std::uint32_t rows,
                 const std::vector<ScenePoint>& points)
        : tiling_(target, columns, rows), cache_(tiling_, points) {}

    std::unique_ptr<PointSampler> point_sampler() const override { return std::make_unique<Point>(*this); }
    std::uint64_t bytes() const override { return tiling_.bytes() + cache_.bytes(); }
    Making making() const override { return cache_.making(); }

private:
    class Point final : public PointSampler {
    public:
        explicit Point(const CachedTiling& cached) : cached_(cached) {}
        void move_to(const ShadingPoint& point) override {
            cached_.tiling_.at(point.n, point_, cached_.cache_.factors(point));
        }
        AcdfDirectionSample sample(double u0, double u1) const override {
            return cached_.tiling_.sample(point_, below_one(u0), u1);
        }
        float pdf(const float wi[3]) const override { return cached_.tiling_.pdf(point_, wi); }

    private:
        const CachedTiling& cached_;
        TilingOnTheFly::Point point_;
    };

    TilingOnTheFly tiling_;
    VisibilityCache cache_;
};

} // namespace

LightSamplerPtr visibility_sampler(const compress::Target& target, std::uint32_t columns, std::uint32_t rows,
                                   const std::vector<ScenePoint>& points) {
    return std::make_unique<CachedTiling>(target, columns, rows, points);
}

} // namespace acdf::measure
