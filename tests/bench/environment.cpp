// Time of a draw and of a density of environment files, beside samplers of all texels of the same map.
//
//   bench_environment [COLUMNS...]            tables in Markdown; 1024 and 4096 by default
//   bench_environment --files FILE...         a row a file, beside the full tables of 1024 and of 4096 columns
//   bench_environment --write FILE BYTES [octahedral] the file of 1024 x 512 texels, or of 1024 x 1024
//   bench_environment --count draw|pdf FILE N [walk]  N calls and nothing else, for callgrind
#include "tests/bench/directions.h"
#include "tests/bench/full_table.h"
#include "tests/bench/turns.h"

#include "compress/fit/fit.h"
#include "compress/store/store.h"
#include "measure/samplers/alias_table.h"
#include "measure/samplers/hierarchical_warp.h"

#include <acdf/wavefront.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>
#include <thread>

namespace {

using namespace acdf;
using acdf_bench::Candidate;
using acdf_bench::Directions;
using acdf_bench::FullTable;
using acdf_bench::keep;
using acdf_bench::sky;
using acdf_bench::uniform_directions;

constexpr std::size_t kNumbers = std::size_t{1} << 18; // pairs, before they repeat

/// A file in memory, with tables and without.
struct Built {
    std::vector<std::uint8_t> bytes;
    File tables, plain;

    Built(const compress::Target& target, std::uint64_t budget) {
        compress::FitOptions options;
        options.goal.kind = compress::Goal::Kind::budget;
        options.goal.budget = budget - 832; // what is beside the tree
        compress::Description description =
            compress::environment_description(target.columns, target.rows, target.parameterization);
        description.total = compress::integral(target);
        bytes = compress::store(compress::fit(target, options).tree, description);
        open(bytes, tables, plain);
    }
    static bool open(const std::vector<std::uint8_t>& bytes, File& tables, File& plain) {
        LoadOptions walk;
        walk.tables = false;
        return File::from_memory(bytes.data(), bytes.size(), tables).ok() &&
               File::from_memory(bytes.data(), bytes.size(), plain, walk).ok();
    }
};

/// Numbers with 24 bits, as renderers draw them. Coherent ones go through the strata of a grid in its order, as
/// neighbouring pixels do that share a sequence.
std::vector<float> numbers(bool coherent) {
    std::mt19937_64 random(7);
    std::vector<float> u(2 * kNumbers);
    for (float& value : u) value = static_cast<float>(random() >> 40) * 0x1p-24f;
    constexpr std::size_t side = 512;
    if (coherent)
        for (std::size_t i = 0; i < kNumbers; ++i) {
            u[2 * i] = (static_cast<float>(i % side) + u[2 * i]) / side;
            u[2 * i + 1] = (static_cast<float>(i / side) + u[2 * i + 1]) / side;
        }
    for (float& value : u) value = std::min(value, 1.0f - 0x1p-24f);
    return u;
}

Directions drawn_directions(const EnvironmentView& view, const std::vector<float>& u) {
    Directions out(kNumbers);
    for (std::size_t i = 0; i < kNumbers; ++i)
        std::memcpy(out[i].data(), view.sample(u[2 * i], u[2 * i + 1]).direction, sizeof out[i]);
    return out;
}
template <class Sampler>
Candidate draws(const char* name, const Sampler& sampler, const std::vector<float>& u) {
    return {name, [&sampler, &u](std::size_t first, std::size_t count) {
                for (std::size_t i = first; i < first + count; ++i) keep(sampler.sample(u[2 * i], u[2 * i + 1]));
            }};
}
template <class Sampler>
Candidate densities(const char* name, const Sampler& sampler, const Directions& w) {
    return {name, [&sampler, &w](std::size_t first, std::size_t count) {
                for (std::size_t i = first; i < first + count; ++i) keep(sampler.pdf(w[i].data()));
            }};
}

/// The same in waves of 4096.
constexpr std::size_t kWave = 4096;
struct Waves {
    EnvironmentWavefront wavefront;
    std::vector<double> u;
    mutable std::vector<DirectionSample> samples{kWave};
    mutable std::vector<float> pdfs = std::vector<float>(kWave);

    Waves(const EnvironmentView& view, const std::vector<float>& numbers, Instructions most)
        : wavefront(view, most), u(numbers.begin(), numbers.end()) {}
    Candidate draws(const char* name) const {
        return {name, [this](std::size_t first, std::size_t count) {
                    for (std::size_t done = 0; done < count; done += kWave) {
                        wavefront.sample(reinterpret_cast<const double(*)[2]>(&u[2 * (first + done)]),
                                         std::min(kWave, count - done), samples.data());
                        keep(samples[0]);
                    }
                }};
    }
    Candidate densities(const char* name, const Directions& w) const {
        return {name, [this, &w](std::size_t first, std::size_t count) {
                    for (std::size_t done = 0; done < count; done += kWave) {
                        wavefront.pdf(reinterpret_cast<const float(*)[3]>(w[first + done].data()),
                                      std::min(kWave, count - done), pdfs.data());
                        keep(pdfs[0]);
                    }
                }};
    }
};

/// A row of the table: ns of each, and the ratio to the first one.
void report(const std::string& what, std::vector<Candidate> candidates, bool evict) {
    acdf_bench::Turns turns;
    turns.evict = evict;
    if (evict) turns.rounds = 40, turns.calls = 1024;
    acdf_bench::take_turns(candidates, turns);
    std::printf("| %s |", what.c_str());
    for (const Candidate& c : candidates) {
        std::printf(" %.1f", c.least);
        if (&c != &candidates[0]) std::printf(" (%.2f)", c.least / candidates[0].least);
        std::printf(" |");
    }
    std::printf("\n");
    std::fflush(stdout);
}

void run(const compress::Target& target) {
    const Built large(target, 64 << 10), small(target, 4 << 10);
    const FullTable full(target);
    const measure::AliasTable alias(target);
    const measure::HierarchicalWarp warp(target);
    const EnvironmentView fast = large.tables.environment(), walk = large.plain.environment();
    const EnvironmentView fast_small = small.tables.environment();
    std::printf(
        "\n%u x %u texels%s; files of %zu and %zu bytes, with tables of %llu and %llu bytes; full table %llu\n\n",
        target.columns, target.rows, full.octahedral ? " of the octahedral square" : "", large.bytes.size(),
        small.bytes.size(), static_cast<unsigned long long>(large.tables.table_bytes()),
        static_cast<unsigned long long>(small.tables.table_bytes()),
        static_cast<unsigned long long>(full.cdf.bytes()));
    std::printf("| ns a call (of the full table's) | full table | alias table | hierarchical warp | 64 KiB | 4 KiB "
                "| 64 KiB, "
                "no tables | 64 KiB, AVX2 | 64 KiB, AVX-512 |\n|---|---|---|---|---|---|---|---|---|\n");
    const std::vector<float> u = numbers(false), coherent = numbers(true);
    const Directions drawn = drawn_directions(walk, u), uniform = uniform_directions(kNumbers, 9);
    const Waves waves[2][2] = {{{fast, u, Instructions::avx2}, {fast, u, Instructions::avx512}},
                               {{fast, coherent, Instructions::avx2}, {fast, coherent, Instructions::avx512}}};
    const auto all_draws = [&](const std::vector<float>& given) {
        const Waves* const wave = waves[&given == &coherent];
        return std::vector<Candidate>{draws("full", full, given),    draws("alias", alias, given),
                                      draws("warp", warp, given),    draws("64", fast, given),
                                      draws("4", fast_small, given), draws("walk", walk, given),
                                      wave[0].draws("avx2"),         wave[1].draws("avx512")};
    };
    const auto all_densities = [&](const Directions& given) {
        return std::vector<Candidate>{densities("full", full, given),       densities("alias", alias, given),
                                      densities("warp", warp, given),       densities("64", fast, given),
                                      densities("4", fast_small, given),    densities("walk", walk, given),
                                      waves[0][0].densities("avx2", given), waves[0][1].densities("avx512", given)};
    };
    report("draw", all_draws(u), false);
    report("draw, coherent numbers", all_draws(coherent), false);
    report("draw, caches evicted", all_draws(u), true);
    report("density of uniform directions", all_densities(uniform), false);
    report("density of drawn directions", all_densities(drawn), false);
    report("density of uniform directions, caches evicted", all_densities(uniform), true);
}

/// As LoadOptions::parallel: two threads.
void by_two_threads(void*, std::size_t count, void (*task)(void* of, std::size_t i), void* of) {
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t i; (i = next++) < count;) task(of, i);
    };
    std::thread other(work);
    work();
    other.join();
}

/// Milliseconds that runtime tables of a right file take to be made, by one thread and by two, beside what it takes
/// to be opened without them.
std::array<double, 2> making_tables(const std::vector<std::uint8_t>& bytes) {
    LoadOptions options[3]; // without, by one, by two
    options[0].tables = false;
    options[2].parallel.run = by_two_threads;
    double least[3] = {1e9, 1e9, 1e9};
    for (int k = 0; k < 20; ++k)
        for (int i = 0; i < 3; ++i) {
            File file;
            const auto begin = std::chrono::steady_clock::now();
            File::from_memory(bytes.data(), bytes.size(), file, options[i]);
            const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
            least[i] = std::min(least[i], taken.count());
        }
    return {std::max(least[1] - least[0], 0.0), std::max(least[2] - least[0], 0.0)};
}

/// Draws and densities of files, with tables and without, beside full tables.
int of_files(int files, char** paths) {
    const FullTable full[2] = {FullTable(sky(1024)), FullTable(sky(4096))};
    const std::vector<float> u = numbers(false);
    const Directions w = uniform_directions(kNumbers, 9);
    std::printf("| file | bytes | tables | making them, ms (by two threads) | ns a draw | walked "
                "| of the full table's, 1k and 4k | AVX2, AVX-512 | ns a density | walked "
                "| of the full table's, 1k and 4k | AVX2, AVX-512 "
                "|\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int i = 0; i < files; ++i) {
        std::ifstream in(paths[i], std::ios::binary);
        const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
        LoadOptions walk;
        File plain, tables;
        walk.tables = false;
        if (!File::from_memory(bytes.data(), bytes.size(), plain, walk).ok()) return 1;
        if (!File::from_memory(bytes.data(), bytes.size(), tables).ok()) return 1;
        if (plain.kind() != ACDF_KIND_ENVIRONMENT) return 1;
        const EnvironmentView fast = tables.environment(), slow = plain.environment();
        const Waves waves[2] = {{fast, u, Instructions::avx2}, {fast, u, Instructions::avx512}};
        std::vector<Candidate> drawn{draws("1k", full[0], u), draws("4k", full[1], u), draws("tables", fast, u),
                                     draws("walk", slow, u),  waves[0].draws("avx2"),  waves[1].draws("avx512")};
        std::vector<Candidate> told{densities("1k", full[0], w),   densities("4k", full[1], w),
                                    densities("tables", fast, w),  densities("walk", slow, w),
                                    waves[0].densities("avx2", w), waves[1].densities("avx512", w)};
        std::string name = paths[i];
        name.erase(0, name.find_last_of('/') + 1);
        const std::array<double, 2> making = making_tables(bytes);
        std::printf("| %s | %llu | %llu | %.1f (%.1f)", name.c_str(), static_cast<unsigned long long>(plain.size()),
                    static_cast<unsigned long long>(tables.table_bytes()), making[0], making[1]);
        for (auto* const all : {&drawn, &told}) {
            acdf_bench::Turns turns;
            turns.rounds = 20;
            acdf_bench::take_turns(*all, turns);
            const double ns = (*all)[2].least;
            std::printf(" | %.1f | %.1f | %.2f %.2f | %.1f %.1f", ns, (*all)[3].least, ns / (*all)[0].least,
                        ns / (*all)[1].least, (*all)[4].least, (*all)[5].least);
        }
        std::printf(" |\n");
        std::fflush(stdout);
    }
    return 0;
}

int count(const char* what, const char* path, std::size_t calls, bool walk) {
    LoadOptions options;
    options.tables = !walk;
    File file;
    if (!File::open(path, file, options).ok() || file.kind() != ACDF_KIND_ENVIRONMENT) return 1;
    const EnvironmentView view = file.environment();
    const std::vector<float> u = numbers(false);
    const Directions w = uniform_directions(kNumbers, 9);
    if (std::strcmp(what, "draw") == 0) draws(what, view, u).calls(0, calls);
    else densities(what, view, w).calls(0, calls);
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    if (argc >= 3 && std::strcmp(argv[1], "--files") == 0) return of_files(argc - 2, argv + 2);
    if (argc >= 4 && std::strcmp(argv[1], "--write") == 0) {
        const Built built(sky(1024, argc > 4), std::strtoul(argv[3], nullptr, 10));
        std::ofstream(argv[2], std::ios::binary)
            .write(reinterpret_cast<const char*>(built.bytes.data()),
                   static_cast<std::streamsize>(built.bytes.size()));
        return 0;
    }
    if (argc >= 5 && std::strcmp(argv[1], "--count") == 0)
        return count(argv[2], argv[3], std::strtoul(argv[4], nullptr, 10), argc > 5);
    std::vector<std::uint32_t> widths;
    for (int i = 1; i < argc; ++i) widths.push_back(static_cast<std::uint32_t>(std::strtoul(argv[i], nullptr, 10)));
    if (widths.empty()) widths = {1024, 4096};
    for (const std::uint32_t columns : widths)
        for (const bool octahedral : {false, true}) run(sky(columns, octahedral));
}
