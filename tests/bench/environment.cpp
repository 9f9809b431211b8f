// Time of a sample and of a pdf of environment files beside samplers of all texels of the same map, and time to
// build them.
//
//   bench_environment [COLUMNS...]              tables in Markdown; 1024 and 4096 by default
//   bench_environment --build                   CPU time to build files, one thread
//   bench_environment --count sample|pdf FILE N N calls and nothing else, for callgrind
#include "tests/bench/directions.h"
#include "tests/bench/full_table.h"
#include "tests/bench/turns.h"

#include "compress/halvings/fit.h"
#include "compress/store/store.h"
#include "compress/threads.h"
#include "measure/samplers/alias_table.h"
#include "measure/samplers/hierarchical_warp.h"

#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <random>

namespace {

using namespace acdf;
using acdf_bench::Candidate;
using acdf_bench::Directions;
using acdf_bench::FullTable;
using acdf_bench::keep;
using acdf_bench::sky;
using acdf_bench::uniform_directions;

constexpr std::size_t kNumbers = std::size_t{1} << 18; // pairs, before they repeat

/// A file in memory, opened with a lookup grid and without.
struct Built {
    std::vector<std::uint8_t> bytes;
    File with_lookup, without;

    Built(const compress::Target& target, std::uint64_t budget) {
        compress::Description description =
            compress::environment_description(target.columns, target.rows, target.parameterization);
        description.total = target.total;
        compress::HalvingsOptions options;
        options.goal.kind = compress::Goal::Kind::budget;
        options.chunk_bytes = compress::halvings_room(description, budget);
        bytes = compress::store(compress::fit_halvings(target, options), description);
        LoadOptions plain;
        plain.tables = false;
        File::from_memory(bytes.data(), bytes.size(), with_lookup, acdf::with_curves());
        File::from_memory(bytes.data(), bytes.size(), without, acdf::with_curves(plain));
    }
};

/// Numbers with 24 bits, as renderers sample them. Coherent ones go through the strata of a grid in its order, as
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

Directions sampled_directions(const EnvironmentView& view, const std::vector<float>& u) {
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

/// Milliseconds that a right file takes to be opened.
double milliseconds_to_open(const std::vector<std::uint8_t>& bytes) {
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 20; ++k) {
        File file;
        const double begin = acdf_bench::thread_seconds();
        File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves());
        least = std::min(least, 1e3 * (acdf_bench::thread_seconds() - begin));
    }
    return least;
}

void run(const compress::Target& target) {
    const Built large(target, 64 << 10), small(target, 16 << 10);
    const FullTable full(target);
    const measure::AliasTable alias(target);
    const measure::HierarchicalWarp warp(target);
    const EnvironmentView at_64 = large.with_lookup.environment(), at_16 = small.with_lookup.environment(),
                          plain = large.without.environment();
    std::printf("\n%u x %u texels%s; full table of %llu bytes\n", target.columns, target.rows,
                full.octahedral ? " of the octahedral square" : "",
                static_cast<unsigned long long>(full.cdf.bytes()));
    for (const Built* built : {&large, &small})
        std::printf("- a file of %zu bytes takes %llu more in memory, and %.2f ms to open\n", built->bytes.size(),
                    static_cast<unsigned long long>(built->with_lookup.table_bytes()),
                    milliseconds_to_open(built->bytes));
    std::printf(
        "\n| ns a call (of the full table's) | full table | alias table | hierarchical warp | 64 KiB | 16 KiB "
        "| 64 KiB, no lookup grid |\n|---|---|---|---|---|---|---|\n");
    const std::vector<float> u = numbers(false), coherent = numbers(true);
    const Directions sampled = sampled_directions(plain, u), uniform = uniform_directions(kNumbers, 9);
    const auto samples = [&](const std::vector<float>& given) {
        return std::vector<Candidate>{draws("full", full, given), draws("alias", alias, given),
                                      draws("warp", warp, given), draws("64", at_64, given),
                                      draws("16", at_16, given),  draws("plain", plain, given)};
    };
    const auto pdfs = [&](const Directions& given) {
        return std::vector<Candidate>{densities("full", full, given), densities("alias", alias, given),
                                      densities("warp", warp, given), densities("64", at_64, given),
                                      densities("16", at_16, given),  densities("plain", plain, given)};
    };
    report("sample", samples(u), false);
    report("sample, coherent numbers", samples(coherent), false);
    report("sample, caches evicted", samples(u), true);
    report("pdf of uniform directions", pdfs(uniform), false);
    report("pdf of sampled directions", pdfs(sampled), false);
    report("pdf of uniform directions, caches evicted", pdfs(uniform), true);
}

/// CPU milliseconds that building takes, one thread, without decoding: target, fit, bytes.
void building(std::uint32_t columns, AcdfFilter filter) {
    const compress::Target source = sky(columns);
    std::vector<float> rgb;
    for (const float value : source.values) rgb.insert(rgb.end(), 3, value);
    compress::TargetOptions options;
    options.filter = filter;
    std::printf("| %u x %u, %s |", columns, columns / 2, filter == ACDF_FILTER_BILINEAR ? "bilinear" : "nearest");
    for (const std::uint64_t budget : {4u << 10, 16u << 10, 64u << 10}) {
        double least[3] = {1e9, 1e9, 1e9};
        compress::with_threads(1, [&] {
            for (int k = 0; k < 5; ++k) {
                const double begin = acdf_bench::thread_seconds();
                const compress::Target target =
                    compress::environment_target(rgb.data(), columns, columns / 2, options);
                const double made = acdf_bench::thread_seconds();
                const Built built(target, budget);
                const double end = acdf_bench::thread_seconds();
                least[0] = std::min(least[0], 1e3 * (end - begin));
                least[1] = std::min(least[1], 1e3 * (made - begin));
            }
        });
        std::printf(" %.1f (%.1f) |", least[0], least[1]);
    }
    std::printf("\n");
    std::fflush(stdout);
}

int count(const char* what, const char* path, std::size_t calls) {
    File file;
    if (!File::open(path, file, acdf::with_curves()).ok() || file.kind() != ACDF_KIND_ENVIRONMENT) return 1;
    const EnvironmentView view = file.environment();
    const std::vector<float> u = numbers(false);
    const Directions w = uniform_directions(kNumbers, 9);
    if (std::strcmp(what, "sample") == 0) draws(what, view, u).calls(0, calls);
    else densities(what, view, w).calls(0, calls);
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    if (argc >= 2 && std::strcmp(argv[1], "--build") == 0) {
        std::printf("| CPU ms (of which the target) | 4 KiB | 16 KiB | 64 KiB |\n|---|---|---|---|\n");
        for (const std::uint32_t columns : {512u, 1024u, 2048u, 4096u})
            for (const AcdfFilter filter : {ACDF_FILTER_NEAREST, ACDF_FILTER_BILINEAR}) building(columns, filter);
        return 0;
    }
    if (argc >= 5 && std::strcmp(argv[1], "--count") == 0)
        return count(argv[2], argv[3], std::strtoul(argv[4], nullptr, 10));
    std::vector<std::uint32_t> widths;
    for (int i = 1; i < argc; ++i) widths.push_back(static_cast<std::uint32_t>(std::strtoul(argv[i], nullptr, 10)));
    if (widths.empty()) widths = {1024, 4096};
    for (const std::uint32_t columns : widths)
        for (const bool octahedral : {false, true}) run(sky(columns, octahedral));
}
