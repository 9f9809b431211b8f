// Time of a sample and of a density, beside the full-resolution CDF on the same map in the same run: read the
// ratios, not the nanoseconds, which depend on the machine. The `Evicted` variants touch 64 MiB between batches,
// as the rest of a renderer does.
#include "compress/fit.h"
#include "compress/store.h"
#include "measure/full_cdf.h"

#include <acdf/reader.h>

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <vector>

namespace {

using namespace acdf;

constexpr std::size_t kBatch = 1024;
constexpr std::size_t kSamples =
    1 << 20; // so many before random numbers repeat: tables must not stay in the cache by that

/// A sky of smooth clouds, texel noise and a small sun, columns x columns/2.
const compress::Target& sky(std::uint32_t columns) {
    static std::map<std::uint32_t, compress::Target> made;
    const auto [found, missing] = made.try_emplace(columns);
    if (!missing) return found->second;
    const std::uint32_t rows = columns / 2;
    std::vector<float> rgb(std::size_t{columns} * rows * 3);
    std::mt19937 random(1);
    for (std::uint32_t r = 0; r < rows; ++r)
        for (std::uint32_t c = 0; c < columns; ++c) {
            const double x = double(c) / columns, y = double(r) / rows;
            const double clouds = 1.0 + std::sin(17.0 * x + 3.0 * std::sin(11.0 * y)) * std::sin(23.0 * y);
            const bool sun = std::hypot(2.0 * (x - 0.6), y - 0.25) < 0.003;
            const double value =
                sun ? 30000.0 : (y < 0.5 ? 0.3 + clouds : 0.1) * (0.8 + 0.4 * double(random() % 1000) / 1000.0);
            for (std::size_t k = 0; k < 3; ++k)
                rgb[3 * (std::size_t{r} * columns + c) + k] = static_cast<float>(value);
        }
    found->second = compress::environment_target(rgb.data(), columns, rows, {});
    return found->second;
}

/// A file in memory and its view.
struct Built {
    std::vector<std::uint8_t> bytes;
    File file;
};

const Built& built(std::uint32_t columns, compress::Shape shape) {
    static std::map<std::pair<std::uint32_t, int>, Built> made;
    const auto [found, missing] = made.try_emplace({columns, static_cast<int>(shape)});
    if (!missing) return found->second;
    compress::FitOptions options;
    options.shape = shape;
    options.goal.cells = 16384;
    options.order = compress::Order::z;
    const compress::Fitted fitted = compress::fit(sky(columns), options);
    compress::Description description = compress::environment_description(columns, columns / 2);
    description.total = compress::integral(sky(columns));
    found->second.bytes = compress::store(fitted.tree, description);
    File::from_memory(found->second.bytes.data(), found->second.bytes.size(), found->second.file);
    return found->second;
}

std::vector<float> numbers(std::size_t count) {
    std::mt19937_64 random(7);
    std::vector<float> u(count);
    for (float& value : u) value = static_cast<float>(random() >> 40) * 0x1p-24f;
    return u;
}

/// Runs `work` on batches; with `evict` the caches are filled with something else before each.
template <class Work>
void run(benchmark::State& state, bool evict, const Work& work) {
    static std::vector<std::uint64_t> other(evict ? std::size_t{8} << 20 : 0);
    std::size_t begin = 0;
    for (auto _ : state) {
        if (evict) {
            state.PauseTiming();
            for (std::size_t i = 0; i < other.size(); i += 8) ++other[i];
            state.ResumeTiming();
        }
        for (std::size_t i = begin; i < begin + kBatch; ++i) work(i);
        begin = (begin + kBatch) % kSamples;
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * kBatch));
}

void sample_acdf(benchmark::State& state, compress::Shape shape, bool evict) {
    const EnvironmentView view = built(static_cast<std::uint32_t>(state.range(0)), shape).file.environment();
    const std::vector<float> u = numbers(2 * kSamples);
    run(state, evict, [&](std::size_t i) { benchmark::DoNotOptimize(view.sample(u[2 * i], u[2 * i + 1])); });
}

void pdf_acdf(benchmark::State& state, compress::Shape shape, bool evict) {
    const EnvironmentView view = built(static_cast<std::uint32_t>(state.range(0)), shape).file.environment();
    const std::vector<float> u = numbers(2 * kSamples);
    std::vector<DirectionSample> samples;
    for (std::size_t i = 0; i < kSamples; ++i) samples.push_back(view.sample(u[2 * i], u[2 * i + 1]));
    run(state, evict, [&](std::size_t i) { benchmark::DoNotOptimize(view.pdf(samples[i].direction)); });
}

/// The full table, and like ours from random numbers to a direction.
void sample_full_cdf(benchmark::State& state, bool evict) {
    const auto columns = static_cast<std::uint32_t>(state.range(0));
    const measure::FullCdf table(sky(columns));
    const std::vector<float> u = numbers(2 * kSamples);
    const double phi_scale = 2.0 * ACDF_PI / columns, theta_scale = 2.0 * ACDF_PI / columns;
    run(state, evict, [&](std::size_t i) {
        const measure::FullCdf::Draw draw = table.sample(u[2 * i], u[2 * i + 1]);
        const auto phi = static_cast<float>(ACDF_PI - draw.column * phi_scale);
        const auto theta = static_cast<float>(draw.row * theta_scale);
        const float direction[3] = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                    std::cos(theta)};
        benchmark::DoNotOptimize(direction);
        benchmark::DoNotOptimize(draw.pdf);
    });
}

void pdf_full_cdf(benchmark::State& state, bool evict) {
    const auto columns = static_cast<std::uint32_t>(state.range(0));
    const measure::FullCdf table(sky(columns));
    const EnvironmentView view = built(columns, compress::Shape::tree).file.environment();
    const std::vector<float> u = numbers(2 * kSamples);
    std::vector<DirectionSample> samples;
    for (std::size_t i = 0; i < kSamples; ++i) samples.push_back(view.sample(u[2 * i], u[2 * i + 1]));
    run(state, evict, [&](std::size_t i) {
        const float* w = samples[i].direction;
        const double column = columns * (0.5 - std::atan2(w[1], w[0]) / (2.0 * ACDF_PI));
        const double row = columns / 2 * (std::acos(w[2]) / ACDF_PI);
        benchmark::DoNotOptimize(table.pdf(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row)));
    });
}

void widths(benchmark::internal::Benchmark* benchmark) { benchmark->Arg(1024)->Arg(4096); }

BENCHMARK_CAPTURE(sample_full_cdf, hot, false)->Apply(widths);
BENCHMARK_CAPTURE(sample_acdf, tree_hot, compress::Shape::tree, false)->Apply(widths);
BENCHMARK_CAPTURE(sample_acdf, cascade_hot, compress::Shape::cascade, false)->Apply(widths);
BENCHMARK_CAPTURE(sample_full_cdf, evicted, true)->Apply(widths);
BENCHMARK_CAPTURE(sample_acdf, tree_evicted, compress::Shape::tree, true)->Apply(widths);
BENCHMARK_CAPTURE(sample_acdf, cascade_evicted, compress::Shape::cascade, true)->Apply(widths);
BENCHMARK_CAPTURE(pdf_full_cdf, hot, false)->Apply(widths);
BENCHMARK_CAPTURE(pdf_acdf, tree_hot, compress::Shape::tree, false)->Apply(widths);
BENCHMARK_CAPTURE(pdf_acdf, cascade_hot, compress::Shape::cascade, false)->Apply(widths);

} // namespace

BENCHMARK_MAIN();
