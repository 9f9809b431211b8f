// How long a rebuilt environment takes, beside the full table of all texels that renderers make: milliseconds of
// processor time of a thread, or of the clock where there are two. Counters: `to_table`, times the table's;
// `variance`, relative, of one sample; `to_best`, times that of quality best.
#include <acdf/builder.h>

#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace {

using namespace acdf::builder;

/// Clouds, texel noise and a small sun: columns x columns / 2 texels of RGB.
const std::vector<float>& sky(std::uint32_t columns) {
    static std::map<std::uint32_t, std::vector<float>> all;
    std::vector<float>& rgb = all[columns];
    if (!rgb.empty()) return rgb;
    std::mt19937 random(1);
    const std::uint32_t rows = columns / 2;
    for (std::uint32_t r = 0; r < rows; ++r)
        for (std::uint32_t c = 0; c < columns; ++c) {
            const double x = double(c) / columns, y = double(r) / rows;
            const double clouds = 1.0 + std::sin(17.0 * x + 3.0 * std::sin(11.0 * y)) * std::sin(23.0 * y);
            const bool sun = std::hypot(2.0 * (x - 0.6), y - 0.25) < 0.003;
            const double light =
                sun ? 30000.0 : (y < 0.5 ? 0.3 + clouds : 0.1) * (0.8 + 0.4 * double(random() % 1000) / 1000.0);
            for (const double channel : {1.0, 0.9, 1.1}) rgb.push_back(static_cast<float>(light * channel));
        }
    return rgb;
}

Pixels pixels_of(std::uint32_t columns) {
    Pixels pixels;
    pixels.data = sky(columns).data();
    pixels.width = columns;
    pixels.height = columns / 2;
    return pixels;
}

/// Cumulative sums of luminance times the sine, a row after the other, and of the rows: what a renderer makes again
/// where its map has changed.
class FullTable {
public:
    explicit FullTable(std::uint32_t columns)
        : columns_(columns), rows_(columns / 2), sums_((std::size_t{columns} + 1) * rows_), row_sums_(rows_ + 1) {}

    void make(const float* rgb) {
        float total = 0.0f;
        for (std::uint32_t r = 0; r < rows_; ++r) {
            const auto sine = static_cast<float>(std::sin(3.14159265358979 * (r + 0.5) / rows_));
            float* out = sums_.data() + (std::size_t{columns_} + 1) * r;
            float sum = 0.0f;
            for (std::uint32_t c = 0; c < columns_; ++c, rgb += 3) {
                out[c] = sum;
                sum += sine * (0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2]);
            }
            out[columns_] = sum;
            const float scale = sum > 0.0f ? 1.0f / sum : 0.0f;
            for (std::uint32_t c = 0; c <= columns_; ++c) out[c] *= scale;
            row_sums_[r] = total;
            total += sum;
        }
        row_sums_[rows_] = total;
        for (float& sum : row_sums_) sum /= total;
    }

private:
    std::uint32_t columns_, rows_;
    std::vector<float> sums_, row_sums_;
};

/// The least of some runs.
double table_seconds(std::uint32_t columns) {
    static std::map<std::uint32_t, double> all;
    double& least = all[columns];
    if (least > 0.0) return least;
    FullTable table(columns);
    const float* rgb = sky(columns).data();
    for (int i = 0; i < 10; ++i) {
        const std::clock_t begin = std::clock();
        table.make(rgb);
        benchmark::DoNotOptimize(table);
        const double seconds = double(std::clock() - begin) / CLOCKS_PER_SEC;
        if (i == 0 || seconds < least) least = seconds;
    }
    return least;
}

struct Case {
    std::uint32_t columns;
    std::uint64_t budget;
    AcdfFilter filter;
    int threads;
};

EnvironmentOptions options_of(const Case& of) {
    EnvironmentOptions options;
    options.goal = Goal::of_budget(of.budget);
    options.target.filter = of.filter;
    return options;
}

void fail(const acdf::builder::Status& status) {
    if (status.ok()) return;
    std::fprintf(stderr, "%s\n", status.message);
    std::exit(1);
}

double best_variance(const Case& of) {
    static std::map<std::tuple<std::uint32_t, std::uint64_t, int>, double> all;
    double& variance = all[{of.columns, of.budget, int(of.filter)}];
    if (variance > 0.0) return variance;
    Environment made;
    fail(environment(pixels_of(of.columns), options_of(of), made));
    return variance = made.accuracy.relative_variance;
}

void frames(benchmark::State& state, const Case& of, const Region& region) {
    EnvironmentRebuilder rebuilder;
    const Pixels pixels = pixels_of(of.columns);
    fail(EnvironmentRebuilder::make(pixels.width, pixels.height, options_of(of), rebuilder));
    Control control;
    control.threads = of.threads;
    fail(rebuilder.rebuild(pixels, control));
    const std::clock_t processor = std::clock();
    const auto clock = std::chrono::steady_clock::now();
    for ([[maybe_unused]] auto _ : state)
        fail(region.width ? rebuilder.update(pixels, region, control) : rebuilder.rebuild(pixels, control));
    const double seconds = of.threads == 1
                               ? double(std::clock() - processor) / CLOCKS_PER_SEC
                               : std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
    state.counters["to_table"] = seconds / double(state.iterations()) / table_seconds(of.columns);
    state.counters["variance"] = rebuilder.relative_variance();
    state.counters["to_best"] = rebuilder.relative_variance() / best_variance(of);
}

void opens(benchmark::State& state, const Case& of) {
    Environment made;
    fail(environment(pixels_of(of.columns), options_of(of), made));
    for ([[maybe_unused]] auto _ : state) {
        acdf::File file;
        if (!acdf::File::from_memory(made.bytes.data(), made.bytes.size(), file).ok()) std::exit(1);
        benchmark::DoNotOptimize(file);
    }
}

void tables(benchmark::State& state, std::uint32_t columns) {
    FullTable table(columns);
    for ([[maybe_unused]] auto _ : state) {
        table.make(sky(columns).data());
        benchmark::DoNotOptimize(table);
    }
}

std::string name_of(const Case& of) {
    return std::to_string(of.columns) + "x" + std::to_string(of.columns / 2) + "/" +
           std::to_string(of.budget >> 10) + "KiB/" + (of.filter == ACDF_FILTER_BILINEAR ? "bilinear" : "nearest") +
           "/threads:" + std::to_string(of.threads);
}

void add(const std::string& name, const Case& of, const Region& region) {
    auto* added = benchmark::RegisterBenchmark(
        (name + "/" + name_of(of)).c_str(), [of, region](benchmark::State& state) { frames(state, of, region); });
    added->Unit(benchmark::kMillisecond);
    if (of.threads != 1) added->UseRealTime();
}

} // namespace

int main(int argc, char** argv) {
    constexpr std::pair<std::uint32_t, std::uint64_t> sizes[] = {
        {512, 4 << 10}, {1024, 16 << 10}, {1024, 64 << 10}, {2048, 16 << 10}, {4096, 16 << 10}, {4096, 64 << 10}};
    for (const auto& [columns, budget] : sizes)
        for (const AcdfFilter filter : {ACDF_FILTER_NEAREST, ACDF_FILTER_BILINEAR})
            for (const int threads : {1, 2}) {
                add("rebuild", {columns, budget, filter, threads}, {});
                if (threads == 1)
                    add("update_64x64", {columns, budget, filter, threads}, {columns / 3, columns / 6, 64, 64});
            }
    for (const std::uint32_t columns : {512u, 1024u, 2048u, 4096u})
        benchmark::RegisterBenchmark(
            ("table/" + std::to_string(columns) + "x" + std::to_string(columns / 2)).c_str(),
            [columns](benchmark::State& state) { tables(state, columns); })
            ->Unit(benchmark::kMillisecond);
    for (const std::uint64_t budget : {std::uint64_t{16} << 10, std::uint64_t{64} << 10}) {
        const Case of{1024, budget, ACDF_FILTER_NEAREST, 1};
        benchmark::RegisterBenchmark(("open/" + std::to_string(budget >> 10) + "KiB").c_str(),
                                     [of](benchmark::State& state) { opens(state, of); })
            ->Unit(benchmark::kMillisecond);
    }
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
