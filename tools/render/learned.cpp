#include "tools/render/learned.h"

#include "compress/parallel.h"
#include "tools/cli/built.h"
#include "visibility/visible_view.h"

#include <acdf/learn.h>

#include <algorithm>
#include <ctime>

namespace acdf::tools {
namespace {

constexpr std::uint32_t kPasses = 4;       ///< of a sample a point
constexpr std::uint64_t kLightPart = 4;    ///< of the bytes, one in so many is for the light
constexpr std::uint64_t kSlack = 256;      ///< of a chunk
constexpr std::size_t kPointsAtOnce = 256; ///< with random numbers of their own

void find_bounds(const std::vector<measure::ScenePoint>& points, builder::LearnOptions& out) {
    std::copy_n(points.front().shading().position, 3, out.low);
    std::copy_n(points.front().shading().position, 3, out.high);
    float size = 0.0f;
    for (const measure::ScenePoint& point : points)
        for (int k = 0; k < 3; ++k) {
            out.low[k] = std::min(out.low[k], point.shading().position[k]);
            out.high[k] = std::max(out.high[k], point.shading().position[k]);
            size = std::max(size, out.high[k] - out.low[k]);
        }
    for (int k = 0; k < 3; ++k) {
        out.low[k] -= 1e-3f * size;
        out.high[k] += 1e-3f * size;
    }
}

/// One light sample a point, and its shadow ray. Returns how many rays there were.
std::uint64_t learn(const std::vector<measure::ScenePoint>& points, std::uint64_t pass,
                    builder::LearnedVisibility& learned) {
    const std::shared_ptr<const File> file = learned.file();
    const VisibleLocalView view = visible_view(*file);
    const std::size_t groups = (points.size() + kPointsAtOnce - 1) / kPointsAtOnce;
    std::vector<std::uint64_t> rays(groups, 0);
    compress::parallel_for(std::size_t{0}, groups, [&](std::size_t group) {
        measure::Random random(pass * groups + group);
        const std::size_t end = std::min(points.size(), (group + 1) * kPointsAtOnce);
        for (std::size_t i = group * kPointsAtOnce; i < end; ++i) {
            const measure::ShadingPoint& at = points[i].shading();
            const AcdfVisiblePoint point = view.at(at.position, at.n);
            const double u0 = random.uniform(), u1 = random.uniform();
            const DirectionSample s = view.sample(point, u0, u1);
            if (!(s.pdf > 0.0f)) continue;
            ++rays[group];
            learned.add(
                at.position, at.n, s.direction,
                !points[i].hidden({double{s.direction[0]}, double{s.direction[1]}, double{s.direction[2]}}));
        }
    });
    std::uint64_t sum = 0;
    for (const std::uint64_t count : rays) sum += count;
    return sum;
}

class Learned final : public measure::LightSampler {
public:
    Learned(measure::LightSamplerPtr of_file, measure::Making making)
        : of_file_(std::move(of_file)), making_(making) {}
    std::unique_ptr<measure::PointSampler> point_sampler() const override { return of_file_->point_sampler(); }
    std::uint64_t bytes() const override { return of_file_->bytes(); }
    measure::Making making() const override { return making_; }

private:
    measure::LightSamplerPtr of_file_;
    measure::Making making_;
};

} // namespace

LearnedSampler learned_sampler(const builder::Target& target, const std::vector<measure::ScenePoint>& points,
                               std::uint64_t bytes, bool beside_cosine) {
    builder::LocalOptions light;
    light.goal = builder::Goal::of_budget(bytes / kLightPart);
    builder::Local made;
    throw_unless_built(builder::local(target, light, made));

    const std::clock_t begin = std::clock(); // of all threads
    builder::LearnOptions options;
    find_bounds(points, options);
    options.bytes = bytes - std::min(bytes, made.bytes.size() + kSlack);
    options.beside_cosine = beside_cosine;
    builder::LearnedVisibility learned;
    throw_unless_built(builder::LearnedVisibility::make(made.bytes.data(), made.bytes.size(), options, learned));
    measure::Making making;
    for (std::uint64_t pass = 0; pass < kPasses; ++pass) making.shadow_rays += learn(points, pass, learned);
    throw_unless_built(learned.update());
    making.seconds = double(std::clock() - begin) / CLOCKS_PER_SEC;
    LearnedSampler out;
    out.file = learned.file();
    out.sampler = std::make_unique<Learned>(measure::file_sampler(*out.file), making);
    return out;
}

} // namespace acdf::tools
