// Time of a sample of the irradiance integrand by the baselines of a local environment map. Every shading point has
// another normal; tiling on the fly builds its weights there and shares them among the samples of the point.
#include "build/local.h"
#include "tests/inputs/synthetic.h"

#include "measure/samplers/local_baselines.h"
#include "measure/samplers/tiling.h"

#include <benchmark/benchmark.h>

#include <array>
#include <map>

namespace {

using namespace acdf;

constexpr std::size_t kPoints = 1 << 14; // so many before normals and random numbers repeat

/// A smooth sky of noisy texels and a small sun, columns x columns/2.
const compress::Target& sky(std::uint32_t columns) {
    static std::map<std::uint32_t, compress::Target> made;
    const auto [found, missing] = made.try_emplace(columns);
    if (!missing) return found->second;
    const std::uint32_t rows = columns / 2;
    std::mt19937_64 random(1);
    found->second = acdf_test::texel_target(columns, rows, [&](std::uint32_t c, std::uint32_t r) {
        const double phi = acdf_test::centre_phi(c, columns), z = acdf_test::centre_z(r, rows);
        const bool sun = std::hypot(phi - 0.6, z - 0.7) < 0.01;
        return (sun ? 3e4 : acdf_test::smooth_sky(phi, z)) * (0.8 + 0.4 * acdf_test::uniform(random));
    });
    return found->second;
}

struct Point {
    std::array<float, 3> normal;
    std::array<double, 2> u;
};

const std::vector<Point>& points() {
    static const std::vector<Point> made = [] {
        std::mt19937_64 random(2);
        std::vector<Point> out(kPoints);
        for (Point& p : out) {
            const double z = 2.0 * acdf_test::uniform(random) - 1.0;
            acdf_test::direction_of(2.0 * acdf_test::kPi * acdf_test::uniform(random), z, p.normal.data());
            p.u = {acdf_test::uniform(random), acdf_test::uniform(random)};
        }
        return out;
    }();
    return made;
}

/// Runs work(point, next random numbers) once for each of `samples` samples at each shading point; begin(point)
/// first.
template <class Begin, class Work>
void run(benchmark::State& state, std::size_t samples, const Begin& begin, const Work& work) {
    const std::vector<Point>& all = points();
    std::size_t i = 0, draw = 0;
    for (auto _ : state) {
        begin(all[i]);
        for (std::size_t k = 0; k < samples; ++k, draw = (draw + 1) % kPoints) work(all[i], all[draw].u);
        i = (i + 1) % kPoints;
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(samples));
}
void nothing(const Point&) {}

void full_cdf(benchmark::State& state) {
    const measure::LocalFullCdf baseline(sky(static_cast<std::uint32_t>(state.range(0))));
    run(state, 64, nothing, [&](const Point&, const std::array<double, 2>& u) {
        benchmark::DoNotOptimize(baseline.sample(u[0], u[1]));
    });
}

void cosine_hemisphere(benchmark::State& state) {
    run(state, 64, nothing, [&](const Point& p, const std::array<double, 2>& u) {
        benchmark::DoNotOptimize(measure::CosineHemisphere::sample(p.normal.data(), u[0], u[1]));
    });
}

void tiling(benchmark::State& state) {
    const measure::TilingOnTheFly baseline(sky(static_cast<std::uint32_t>(state.range(0))), 32, 16);
    measure::TilingOnTheFly::Point built;
    run(
        state, static_cast<std::size_t>(state.range(1)),
        [&](const Point& p) { baseline.at(p.normal.data(), built); },
        [&](const Point&, const std::array<double, 2>& u) {
            benchmark::DoNotOptimize(baseline.sample(built, u[0], u[1]));
        });
}

void tiling_pdf(benchmark::State& state) {
    const measure::TilingOnTheFly baseline(sky(static_cast<std::uint32_t>(state.range(0))), 32, 16);
    const measure::TilingOnTheFly::Point built = baseline.at(points()[0].normal.data());
    std::size_t i = 0;
    run(state, 64, nothing, [&](const Point&, const std::array<double, 2>&) {
        benchmark::DoNotOptimize(baseline.pdf(built, points()[i].normal.data()));
        i = (i + 1) % kPoints;
    });
}

void resampling_32(benchmark::State& state) {
    const measure::Resampling baseline(sky(static_cast<std::uint32_t>(state.range(0))), 32);
    std::mt19937_64 random(3);
    std::vector<double> u(std::size_t{1} << 16);
    for (double& value : u) value = acdf_test::uniform(random);
    std::size_t next = 0;
    run(state, 1, nothing, [&](const Point& p, const std::array<double, 2>&) {
        benchmark::DoNotOptimize(baseline.sample(p.normal.data(), [&] { return u[next++ % u.size()]; }));
    });
}

/// Ours, a file of 1 MB. Everything of a normal is looked up once a shading point.
const build::Local& local_map(std::uint32_t columns) {
    static std::map<std::uint32_t, build::Local> made;
    const auto [found, missing] = made.try_emplace(columns);
    if (missing) {
        build::LocalOptions options;
        options.goal.budget = 1000000;
        found->second = build::build_local(sky(columns), {}, options);
    }
    return found->second;
}

File open_map(std::uint32_t columns) {
    const build::Local& map = local_map(columns);
    File file;
    File::from_memory(map.bytes.data(), map.bytes.size(), file);
    return file;
}

void local(benchmark::State& state) {
    const File file = open_map(static_cast<std::uint32_t>(state.range(0)));
    const LocalEnvironmentView view = file.local();
    AcdfLocalPoint at = {};
    run(
        state, static_cast<std::size_t>(state.range(1)), [&](const Point& p) { at = view.at(p.normal.data()); },
        [&](const Point&, const std::array<double, 2>& u) {
            benchmark::DoNotOptimize(view.sample(at, u[0], u[1]));
        });
}

void local_pdf(benchmark::State& state) {
    const File file = open_map(static_cast<std::uint32_t>(state.range(0)));
    const LocalEnvironmentView view = file.local();
    AcdfLocalPoint at = {};
    std::size_t i = 0;
    run(
        state, 16, [&](const Point& p) { at = view.at(p.normal.data()); },
        [&](const Point&, const std::array<double, 2>&) {
            benchmark::DoNotOptimize(view.pdf(at, points()[i].normal.data()));
            i = (i + 1) % kPoints;
        });
}

void samples_a_point(benchmark::internal::Benchmark* benchmark) {
    for (const int columns : {1024, 4096})
        for (const int samples : {1, 4, 16, 64}) benchmark->Args({columns, samples});
}

BENCHMARK(full_cdf)->Arg(1024)->Arg(4096);
BENCHMARK(local)->Apply(samples_a_point);
BENCHMARK(local_pdf)->Arg(1024)->Arg(4096);
BENCHMARK(tiling)->Apply(samples_a_point);
BENCHMARK(resampling_32)->Arg(1024)->Arg(4096);
BENCHMARK(cosine_hemisphere);
BENCHMARK(tiling_pdf)->Arg(1024)->Arg(4096);

} // namespace

BENCHMARK_MAIN();
