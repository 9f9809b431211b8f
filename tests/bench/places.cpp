// Files of places at the points that a camera sees, without the noise of pictures (docs/places.md):
//
//   bench_places make SCENE DATA local|places BYTES OUT    a file as `acdf render` makes it for the scene
//   bench_places measure SCENE DATA POINTS FILE...         rows of a table, the first file is what others are
//   compared with
//
// Variances are summed over all texels, with a shadow ray to the middle of each. The same sums are what samples are
// held to: the mean of those of all points, and each point's own, in standard errors.
#include "build/builder/sources.h"
#include "measure/surface_points.h"
#include "tools/render/run.h"

#include <acdf/builder.h>
#include <acdf/reader.h>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>

namespace {

using namespace acdf;
using measure::ScenePoint;
using measure::Vec3;

constexpr int kSamples = 256; ///< at each point

std::string contents(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error(path + ": cannot be read");
    return {std::istreambuf_iterator<char>(file), {}};
}

std::unique_ptr<tools::LoadedScene> scene_of(const std::string& path, const std::string& data) {
    tools::SceneFile file = tools::parse_scene(contents(path));
    file.width = 96;
    file.height = 72;
    return tools::load_scene(file, data);
}

builder::Places places_of(const compress::PlaceScene& scene) {
    builder::Places out;
    out.point = [scene](std::uint64_t index, builder::PlacePoint& told) {
        compress::PlacePoint point;
        if (!scene.points(index, point)) return false;
        std::copy_n(point.position.begin(), 3, told.position);
        std::copy_n(point.normal.begin(), 3, told.normal);
        return true;
    };
    out.occluded = [scene](const builder::PlacePoint& from, const float direction[3]) {
        compress::PlacePoint point;
        std::copy_n(from.position, 3, point.position.begin());
        std::copy_n(from.normal, 3, point.normal.begin());
        return scene.occluded(point, {direction[0], direction[1], direction[2]});
    };
    return out;
}

int make(const tools::LoadedScene& scene, bool places, const char* bytes, const char* path) {
    builder::TargetRows rows(builder::TargetOptions{});
    rows.begin(scene.probe.width, scene.probe.height);
    rows.take(0, scene.probe.height, scene.probe.rgb.data());
    builder::LocalOptions options;
    options.goal = builder::Goal::of_budget(std::strtoull(bytes, nullptr, 10));
    if (places) options.places = places_of(measure::place_scene(scene.scene.geometry));
    builder::Local made;
    if (const builder::Status status = builder::local(rows.finish(), options, made); !status.ok())
        throw std::runtime_error(status.message);
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(made.bytes.data()), static_cast<std::streamsize>(made.bytes.size()));
    return 0;
}

AcdfLocalPoint at(const File& file, const float position[3], const float normal[3]) {
    const LocalEnvironmentView view = file.local();
    return view.has_places() ? view.at(position, normal) : view.at(normal);
}

struct Texel {
    Vec3 direction;
    float rounded[3];
    double solid_angle;
};
Texel texel(const measure::ProbeLight& light, std::uint32_t column, std::uint32_t row) {
    const double above = acdf_row_z(row, light.rows), below = acdf_row_z(row + 1, light.rows);
    const double z = 0.5 * (above + below), radius = std::sqrt((1.0 - z) * (1.0 + z));
    double sine, cosine;
    acdf_sincospi(1.0 - 2.0 * (column + 0.5) / light.columns, &sine, &cosine);
    Texel out{{radius * cosine, radius * sine, z}, {}, (above - below) * 2.0 * ACDF_PI / light.columns};
    for (std::size_t k = 0; k < 3; ++k) out.rounded[k] = static_cast<float>(out.direction[k]);
    return out;
}

/// What is integrated, told for the middle of a texel.
double value(const ScenePoint& point, const measure::ProbeLight& light, std::uint32_t column, std::uint32_t row,
             const Texel& t) {
    measure::Rgb out = point.reflected(t.direction);
    const measure::Rgb radiance = light.texel(column, row);
    for (std::size_t k = 0; k < 3; ++k) out[k] *= radiance[k];
    const double f = measure::luminance(out);
    return f > 0.0 && !point.hidden(t.direction) ? f : 0.0;
}

/// Of one point.
struct Sums {
    double mean = 0.0;
    std::vector<double> square, deviation; ///< one a file; deviation: of the mean of samples
    std::vector<int> lost;                 ///< texels with light that are never drawn
};

Sums sums_at(const ScenePoint& point, const measure::ProbeLight& light, const std::vector<File>& files,
             std::uint64_t seed) {
    Sums out;
    out.square.assign(files.size(), 0.0);
    out.deviation.assign(files.size(), 0.0);
    out.lost.assign(files.size(), 0);
    std::vector<AcdfLocalPoint> prepared;
    for (const File& file : files) prepared.push_back(at(file, point.shading().position, point.shading().n));
    for (std::uint32_t row = 0; row < light.rows; ++row)
        for (std::uint32_t column = 0; column < light.columns; ++column) {
            const Texel t = texel(light, column, row);
            const double f = value(point, light, column, row, t);
            if (!(f > 0.0)) continue;
            out.mean += f * t.solid_angle;
            for (std::size_t k = 0; k < files.size(); ++k) {
                const double p = double{files[k].local().pdf(prepared[k], t.rounded)};
                out.lost[k] += !(p > 0.0);
                if (p > 0.0) out.square[k] += f * f / p * t.solid_angle;
            }
        }
    std::mt19937_64 random(seed);
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    for (std::size_t k = 0; k < files.size(); ++k) {
        for (int i = 0; i < kSamples; ++i) {
            const double u = uniform(), v = uniform();
            const DirectionSample s = files[k].local().sample(prepared[k], u, v);
            std::uint32_t square[2];
            double position;
            if (!(s.pdf > 0.0f) || !acdf_sphere_square(light.columns, light.rows, s.direction, square, &position))
                continue;
            out.deviation[k] +=
                value(point, light, square[0], square[1], texel(light, square[0], square[1])) / double{s.pdf};
        }
        out.deviation[k] = out.deviation[k] / kSamples - out.mean;
    }
    return out;
}

/// Directions with light that a file never draws, of 10^5 of a point of the scene, a normal and a direction each.
int support_violations(const tools::LoadedScene& scene, const File& file) {
    const compress::PlaceScene places = measure::place_scene(scene.scene.geometry);
    std::mt19937_64 random(11);
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    const auto direction = [&] {
        const double z = 2.0 * uniform() - 1.0, r = std::sqrt((1.0 - z) * (1.0 + z));
        double sine, cosine;
        acdf_sincospi(2.0 * uniform() - 1.0, &sine, &cosine);
        return std::array<float, 3>{float(r * cosine), float(r * sine), float(z)};
    };
    int violations = 0, count = 0;
    for (std::uint64_t i = 0; count < 100000 && i < 10000000; ++i) {
        compress::PlacePoint point;
        if (!places.points(random() >> 40, point)) continue;
        const std::array<float, 3> n = i % 2 ? point.normal : direction(), d = direction();
        const double cosine =
            double{n[0]} * double{d[0]} + double{n[1]} * double{d[1]} + double{n[2]} * double{d[2]};
        const bool lit = cosine > 1e-3 && measure::luminance(scene.scene.light.radiance(d.data())) > 0.0;
        if (!lit) continue;
        ++count;
        const AcdfLocalPoint prepared = at(file, point.position.data(), n.data());
        violations += !(file.local().pdf(prepared, d.data()) > 0.0f);
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

/// Nanoseconds of one call at each point in turn.
double time_calls(const File& file, const std::vector<ScenePoint>& seen, std::size_t count, bool drawn) {
    constexpr std::size_t calls = 20000;
    std::mt19937_64 random(1);
    timespec time[2]{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time[0]);
    for (std::size_t i = 0; i < calls; ++i) {
        const measure::ShadingPoint& p = seen[i * 7919 % count * seen.size() / count].shading();
        const AcdfLocalPoint prepared = at(file, p.position, p.n);
        const double u = static_cast<double>(random() >> 11) * 0x1p-53,
                     v = static_cast<double>(random() >> 11) * 0x1p-53;
        sink = drawn ? file.local().sample(prepared, u, v).pdf : static_cast<float>(prepared.sum + u + v);
    }
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time[1]);
    return (1e9 * static_cast<double>(time[1].tv_sec - time[0].tv_sec) +
            static_cast<double>(time[1].tv_nsec - time[0].tv_nsec)) /
           double(calls);
}

int time_files(const tools::LoadedScene& scene, std::size_t count, const Files& given) {
    const std::vector<ScenePoint>& seen = scene.points.points;
    count = std::min(count, seen.size());
    std::vector<std::array<double, 2>> best(given.files.size(), {1e30, 1e30});
    for (int turn = 0; turn < 15; ++turn)
        for (std::size_t k = 0; k < best.size(); ++k)
            for (std::size_t drawn = 0; drawn < 2; ++drawn)
                best[k][drawn] = std::min(best[k][drawn], time_calls(given.files[k], seen, count, drawn == 1));
    for (const auto& [prepared, drawn] : best)
        std::printf("at and a draw: %.0f ns, %.2f of the first file's; at: %.0f ns\n", drawn, drawn / best[0][1],
                    prepared);
    return 0;
}

int measure_files(const tools::LoadedScene& scene, std::size_t count, const Files& given) {
    const std::vector<std::string>& bytes = given.bytes;
    const std::vector<File>& files = given.files;
    const std::vector<ScenePoint>& seen = scene.points.points;
    count = std::min(count, seen.size());
    std::vector<Sums> sums(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        sums[i] = sums_at(seen[i * seen.size() / count], scene.scene.light, files, i);
    });
    double mean = 0.0, baseline = 0.0;
    for (const Sums& point : sums) mean += point.mean / double(count);
    for (std::size_t k = 0; k < files.size(); ++k) {
        double noise = 0.0, error = 0.0, variance = 0.0, z_square = 0.0;
        int lost = 0, far = 0;
        for (const Sums& point : sums) {
            const double own = std::max(point.square[k] - point.mean * point.mean, 0.0) / kSamples;
            noise += own * kSamples / (point.mean * point.mean + 0.01 * mean * mean) / double(count);
            error += point.deviation[k];
            variance += own;
            lost += point.lost[k];
            if (!(own > 0.0)) continue;
            z_square += point.deviation[k] * point.deviation[k] / own / double(count);
            far += std::fabs(point.deviation[k]) > 4.0 * std::sqrt(own);
        }
        if (k == 0) baseline = noise;
        std::printf("| `%s` | %zu | %.3g | %.3g | %.2f | %.2f | %d | %d |\n",
                    files[k].local().has_places() ? "places" : "local", bytes[k].size(), noise, baseline / noise,
                    error / std::sqrt(variance), std::sqrt(z_square), far,
                    lost + support_violations(scene, files[k]));
    }
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    try {
        const std::string what = argc > 1 ? argv[1] : "";
        if (what == "make" && argc == 7)
            return make(*scene_of(argv[2], argv[3]), argv[4] == std::string("places"), argv[5], argv[6]);
        if ((what == "measure" || what == "cost") && argc > 5)
            return (what == "cost" ? time_files : measure_files)(
                *scene_of(argv[2], argv[3]), std::strtoull(argv[4], nullptr, 10), Files(argc - 5, argv + 5));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    std::fprintf(stderr, "usage: bench_places make SCENE DATA local|places BYTES OUT\n"
                         "       bench_places measure|cost SCENE DATA POINTS FILE...\n");
    return 2;
}
