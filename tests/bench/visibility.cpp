// Files with visibility cells at the points that a camera sees, without the noise of pictures (docs/visibility.md):
//
//   bench_visibility make SCENE DATA local|visibility|portals BYTES OUT    a file as `acdf render` makes it for the
//   scene bench_visibility measure SCENE DATA POINTS SAMPLER...      rows of a table, the first is what others are
//   compared
//                                                          with; samplers as of acdf render: file:/A/FILE, portals,
//                                                          mis(A,B)
//   bench_visibility trimmed SCENE DATA POINTS SAMPLER...      the same but for the noisiest 1 % of points, of a
//                                                          picture of 640 x 480: what is learned, is learned there
//   bench_visibility cost SCENE DATA POINTS FILE...            nanoseconds of a sample
//
// Variances are summed over all texels, with a shadow ray to the middle of each. The same sums are what samples are
// held to: the mean of those of all points, and each point's own, in standard errors.
#include "build/builder/sources.h"
#include "measure/scenes/point_sums.h"
#include "measure/scenes/surface_points.h"
#include "tools/render/portals.h"
#include "tools/render/run.h"
#include "tools/render/sampler_build.h"
#include "visibility/visible_view.h"

#include <acdf/builder.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <numeric>
#include <random>
#include <stdexcept>

namespace {

using namespace acdf;
using measure::ScenePoint;

constexpr std::uint32_t kSamples = 256; ///< at each point

std::string contents(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error(path + ": cannot be read");
    return {std::istreambuf_iterator<char>(file), {}};
}

std::unique_ptr<tools::LoadedScene> scene_of(const std::string& path, const std::string& data,
                                             std::uint32_t width = 96) {
    tools::SceneFile file = tools::parse_scene(contents(path));
    file.width = width;
    file.height = width / 4 * 3;
    return tools::load_scene(file, data);
}

builder::Visibility visibility_of(const compress::VisibilityScene& scene) {
    builder::Visibility out;
    out.point = [scene](std::uint64_t index, builder::VisibilityPoint& told) {
        compress::VisibilityPoint point;
        if (!scene.points(index, point)) return false;
        std::copy_n(point.position.begin(), 3, told.position);
        std::copy_n(point.normal.begin(), 3, told.normal);
        return true;
    };
    out.occluded = [scene](const builder::VisibilityPoint& from, const float direction[3]) {
        compress::VisibilityPoint point;
        std::copy_n(from.position, 3, point.position.begin());
        std::copy_n(from.normal, 3, point.normal.begin());
        return scene.occluded(point, {direction[0], direction[1], direction[2]});
    };
    return out;
}

int make(const tools::LoadedScene& scene, const std::string& kind, const char* bytes, const char* path) {
    builder::TargetRows rows(builder::TargetOptions{});
    rows.begin(scene.probe.width, scene.probe.height);
    rows.take(0, scene.probe.height, scene.probe.rgb.data());
    builder::LocalOptions options;
    options.goal = builder::Goal::of_budget(std::strtoull(bytes, nullptr, 10));
    if (kind != "local") options.visibility = visibility_of(measure::visibility_scene(scene.scene.geometry));
    for (std::size_t i = 0; kind == "portals" && i < scene.scene.geometry.portals.size(); ++i)
        options.visibility.portals.push_back(tools::portal_of(options.visibility, scene.scene.geometry.portals[i]));
    builder::Local made;
    if (const builder::Status status = builder::local(rows.finish(), options, made); !status.ok())
        throw std::runtime_error(status.message);
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(made.bytes.data()), static_cast<std::streamsize>(made.bytes.size()));
    return 0;
}

/// What is measured.
struct Measured {
    tools::SamplerSpec spec;
    measure::SamplerParts parts;
    tools::BuiltSampler built;
};

Measured measured(const std::string& text, tools::SamplerBuilder& builder, std::size_t materials) {
    using tools::SamplerKind;
    Measured out;
    out.spec = tools::parse_sampler(text);
    if (out.spec.kind == SamplerKind::ris || out.spec.kind == SamplerKind::strata || out.spec.power)
        throw std::runtime_error(text + ": its variance is not summed here");
    out.built = builder.build(out.spec, kSamples);
    const bool several = out.spec.kind == SamplerKind::mis;
    const auto specs = several ? out.spec.parts : std::vector<tools::SamplerSpec>{out.spec};
    const auto counts = several ? tools::divided(kSamples, out.spec) : std::vector<std::uint32_t>{kSamples};
    for (std::size_t i = 0; i < specs.size(); ++i) {
        measure::SamplerParts::Part part{{}, counts[i]};
        for (std::size_t m = 0; m < materials; ++m)
            part.of_material.push_back(&builder.single(specs[i], m, counts[i]));
        out.parts.parts.push_back(std::move(part));
    }
    return out;
}

/// Of one point: what is summed, and how far estimates of kSamples samples are off.
struct Sums {
    measure::PointSums exact;
    std::vector<double> deviation;
};
Sums sums_of(const ScenePoint& point, const measure::ProbeLight& light, const std::vector<Measured>& samplers,
             std::uint64_t seed) {
    std::vector<measure::PartsAtPoint> at;
    for (const Measured& sampler : samplers) at.emplace_back(sampler.parts, point);
    Sums out{measure::sums_at(point, light, at), {}};
    std::mt19937_64 random(seed);
    for (const measure::PartsAtPoint& one : at)
        out.deviation.push_back(one.estimate(point, light, random) - out.exact.mean);
    return out;
}

/// Directions with light that a sampler never samples, of 10^5 of a point of the scene, a normal and a direction
/// each.
int support_violations(const tools::LoadedScene& scene, const Measured& sampler) {
    const compress::VisibilityScene visibility = measure::visibility_scene(scene.scene.geometry);
    std::mt19937_64 random(11);
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    const auto direction = [&] {
        const double z = 2.0 * uniform() - 1.0, r = std::sqrt((1.0 - z) * (1.0 + z));
        double sine, cosine;
        acdf_sincospi(2.0 * uniform() - 1.0, &sine, &cosine);
        return std::array<float, 3>{float(r * cosine), float(r * sine), float(z)};
    };
    std::vector<std::unique_ptr<measure::PointSampler>> parts;
    for (const measure::SamplerParts::Part& part : sampler.parts.parts)
        parts.push_back(part.of_material[0]->point_sampler());
    int violations = 0, count = 0;
    for (std::uint64_t i = 0; count < 100000 && i < 10000000; ++i) {
        compress::VisibilityPoint point;
        if (!visibility.points(random() >> 40, point)) continue;
        const std::array<float, 3> n = i % 2 ? point.normal : direction(), d = direction();
        const double cosine =
            double{n[0]} * double{d[0]} + double{n[1]} * double{d[1]} + double{n[2]} * double{d[2]};
        const bool lit = cosine > 1e-3 && measure::luminance(scene.scene.light.radiance(d.data())) > 0.0;
        if (!lit) continue;
        ++count;
        measure::ShadingPoint from;
        std::copy_n(n.begin(), 3, from.n);
        std::copy_n(n.begin(), 3, from.wo);
        std::copy_n(point.position.begin(), 3, from.position);
        bool sampled = false;
        for (const auto& part : parts) {
            part->move_to(from);
            sampled = sampled || part->pdf(d.data()) > 0.0f;
        }
        violations += !sampled;
    }
    return violations;
}

struct Files {
    Files(int count, char** paths) : files(static_cast<std::size_t>(count)) {
        for (int i = 0; i < count; ++i) bytes.push_back(contents(paths[i]));
        for (std::size_t k = 0; k < files.size(); ++k)
            if (const Status status = File::from_memory(bytes[k].data(), bytes[k].size(), files[k]); !status.ok())
                throw std::runtime_error(status.message);
    }
    std::vector<std::string> bytes;
    std::vector<File> files;
};

volatile float sink;

/// Of calls at each point in turn. Each stretch of them counts with its fastest turn, as others use the machine,
/// too.
class CallTimes {
public:
    void time(const File& file, const std::vector<ScenePoint>& seen, std::size_t count, bool sampled) {
        const VisibleLocalView view = visible_view(file);
        std::mt19937_64 random(1);
        for (std::size_t first = 0, stretch = 0; first < kCalls; first += kStretch, ++stretch) {
            timespec time[2]{};
            clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time[0]);
            for (std::size_t i = first; i < first + kStretch; ++i) {
                const measure::ShadingPoint& p = seen[i * 7919 % count * seen.size() / count].shading();
                const AcdfVisiblePoint prepared = view.at(p.position, p.n);
                const double u = static_cast<double>(random() >> 11) * 0x1p-53,
                             v = static_cast<double>(random() >> 11) * 0x1p-53;
                sink = sampled ? view.sample(prepared, u, v).pdf : static_cast<float>(prepared.local.sum + u + v);
            }
            clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time[1]);
            least_[stretch] = std::min(least_[stretch], 1e9 * static_cast<double>(time[1].tv_sec - time[0].tv_sec) +
                                                            static_cast<double>(time[1].tv_nsec - time[0].tv_nsec));
        }
    }
    /// Nanoseconds.
    double mean() const { return std::accumulate(least_.begin(), least_.end(), 0.0) / kCalls; }

private:
    static constexpr std::size_t kCalls = 20000, kStretch = 400;
    std::vector<double> least_ = std::vector<double>(kCalls / kStretch, 1e30);
};

int time_files(const tools::LoadedScene& scene, std::size_t count, const Files& given) {
    const std::vector<ScenePoint>& seen = scene.points.points;
    count = std::min(count, seen.size());
    std::vector<std::array<CallTimes, 2>> times(given.files.size());
    for (int turn = 0; turn < 40; ++turn)
        for (std::size_t k = 0; k < times.size(); ++k)
            for (std::size_t sampled = 0; sampled < 2; ++sampled)
                times[k][sampled].time(given.files[k], seen, count, sampled == 1);
    for (const auto& [prepared, sampled] : times)
        std::printf("at and a sample: %.0f ns, %.2f of the first file's; at: %.0f ns\n", sampled.mean(),
                    sampled.mean() / times[0][1].mean(), prepared.mean());
    return 0;
}

std::string bytes_text(const Measured& one) {
    std::string out = std::to_string(one.built.bytes);
    if (one.built.making.seconds > 0.0) {
        char text[64];
        std::snprintf(text, sizeof text, ", made in %.2f s", one.built.making.seconds);
        out += text;
    }
    return out;
}

void print_row(const tools::LoadedScene& scene, const std::vector<Sums>& sums, const Measured& one, std::size_t k,
               double& baseline) {
    const double count = double(sums.size());
    double mean = 0.0;
    for (const Sums& point : sums) mean += point.exact.mean / count;
    double noise = 0.0, error = 0.0, variance = 0.0, z_square = 0.0;
    int lost = 0, far = 0;
    for (const Sums& point : sums) {
        const double own = point.exact.variance[k] / kSamples;
        noise += own * kSamples / (point.exact.mean * point.exact.mean + 0.01 * mean * mean) / count;
        error += point.deviation[k];
        variance += own;
        lost += static_cast<int>(point.exact.lost[k]);
        if (!(own > 0.0)) continue;
        z_square += point.deviation[k] * point.deviation[k] / own / count;
        far += std::fabs(point.deviation[k]) > 4.0 * std::sqrt(own);
    }
    if (k == 0) baseline = noise;
    // Baselines may have to do with what the camera sees alone.
    if (one.built.ours) lost += support_violations(scene, one);
    std::printf("| `%s` | %s | %.3g | %.3g |", one.spec.text.c_str(), bytes_text(one).c_str(), noise,
                baseline / noise);
    // The border of a portal cuts texels, of which a sum knows the middle alone: samples cannot be held to it.
    if (one.spec.text.find("portals") != std::string::npos) std::printf(" | | | |\n");
    else std::printf(" %.2f | %.2f | %d | %d |\n", error / std::sqrt(variance), std::sqrt(z_square), far, lost);
}

/// The mean relative variance of points but for the noisiest hundredth, and that of the first sampler over it.
void print_trimmed(const std::vector<Sums>& sums, const Measured& one, std::size_t k, double& baseline) {
    const double count = double(sums.size());
    double mean = 0.0, error = 0.0, variance = 0.0;
    for (const Sums& point : sums) {
        mean += point.exact.mean / count;
        error += point.deviation[k];
        variance += point.exact.variance[k] / kSamples;
    }
    std::vector<double> noises;
    for (const Sums& point : sums)
        noises.push_back(point.exact.variance[k] / (point.exact.mean * point.exact.mean + 0.01 * mean * mean));
    std::sort(noises.begin(), noises.end());
    noises.resize(noises.size() - noises.size() / 100);
    const double noise = std::accumulate(noises.begin(), noises.end(), 0.0) / double(noises.size());
    if (k == 0) baseline = noise;
    const double made = one.built.making.seconds;
    std::printf("| `%s` | %.3g | %.3g | %s | %.2f |\n", one.spec.text.c_str(), noise, baseline / noise,
                made > 0.0 ? (std::to_string(std::lround(10.0 * made) / 10) + "." +
                              std::to_string(std::lround(10.0 * made) % 10) + " s")
                                 .c_str()
                           : "",
                error / std::sqrt(variance));
}

int measure_samplers(const tools::LoadedScene& scene, std::size_t count, const std::vector<std::string>& texts,
                     bool trimmed) {
    const std::vector<ScenePoint>& seen = scene.points.points;
    count = std::min(count, seen.size());
    builder::TargetRows rows(builder::TargetOptions{});
    rows.begin(scene.probe.width, scene.probe.height);
    rows.take(0, scene.probe.height, scene.probe.rgb.data());
    const builder::Target target = rows.finish();
    std::vector<const input::Brdf*> brdfs;
    for (const auto& brdf : scene.brdfs) brdfs.push_back(brdf.get());
    tools::SamplerBuilder builder(target, brdfs, ".", {}, &scene.scene.geometry, &seen);
    std::vector<Measured> samplers;
    for (const std::string& text : texts) samplers.push_back(measured(text, builder, brdfs.size()));
    std::vector<Sums> sums(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        sums[i] = sums_of(seen[i * seen.size() / count], scene.scene.light, samplers, i);
    });
    double baseline = 0.0;
    for (std::size_t k = 0; k < samplers.size(); ++k)
        if (trimmed) print_trimmed(sums, samplers[k], k, baseline);
        else print_row(scene, sums, samplers[k], k, baseline);
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    try {
        const std::string what = argc > 1 ? argv[1] : "";
        if (what == "make" && argc == 7) return make(*scene_of(argv[2], argv[3]), argv[4], argv[5], argv[6]);
        const std::size_t points = argc > 5 ? std::strtoull(argv[4], nullptr, 10) : 0;
        const bool trimmed = what == "trimmed";
        if ((what == "measure" || trimmed) && argc > 5)
            return measure_samplers(*scene_of(argv[2], argv[3], trimmed ? 640 : 96), points,
                                    {argv + 5, argv + argc}, trimmed);
        if (what == "cost" && argc > 5)
            return time_files(*scene_of(argv[2], argv[3]), points, Files(argc - 5, argv + 5));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    std::fprintf(stderr, "usage: bench_visibility make SCENE DATA local|visibility|portals BYTES OUT\n"
                         "       bench_visibility measure SCENE DATA POINTS SAMPLER...\n"
                         "       bench_visibility trimmed SCENE DATA POINTS SAMPLER...\n"
                         "       bench_visibility cost SCENE DATA POINTS FILE...\n");
    return 2;
}
