// Time of a shading point, samples and pdfs of local environment files, with runtime tables and without, beside the
// full table of an environment of as many columns, which knows nothing of normals.
//
//   bench_local FILE.acdf...      tables in Markdown
//   bench_local --count point|sample|pdf FILE N [walk]     N calls and nothing else, for callgrind
#include "tests/bench/directions.h"
#include "tests/bench/full_table.h"
#include "tests/bench/turns.h"

#include <acdf/reader.h>
#include <acdf/views.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>

namespace {

using namespace acdf;
using acdf_bench::Candidate;
using acdf_bench::Directions;
using acdf_bench::keep;
using acdf_bench::uniform_directions;

constexpr std::size_t kCalls = std::size_t{1} << 18; // before they repeat
constexpr std::size_t kShared = 16;                  // calls a point, where a point has several

/// What is asked: normals, pairs of numbers, directions anywhere and such as are sampled. Coherent ones go over a
/// sphere, and through the strata of the numbers, in the order of a picture's pixels.
struct Questions {
    Directions normals = uniform_directions(kCalls, 1), anywhere = uniform_directions(kCalls, 2), sampled{kCalls};
    std::vector<std::array<float, 2>> u{kCalls};

    explicit Questions(const LocalEnvironmentView& view, bool coherent = false) {
        std::mt19937_64 random(3);
        for (std::size_t i = 0; i < kCalls; ++i) {
            for (float& value : u[i]) value = static_cast<float>(random() >> 40) * 0x1p-24f;
            if (coherent) {
                constexpr std::size_t side = 512;
                const std::size_t at[2] = {i % side, i / side % side};
                for (int k = 0; k < 2; ++k)
                    u[i][k] = std::min((static_cast<float>(at[k]) + u[i][k]) / side, 1.0f - 0x1p-24f);
                const double phi = 2.0 * ACDF_PI * static_cast<double>(at[0]) / side,
                             z = 2.0 * static_cast<double>(at[1]) / side - 1.0, r = std::sqrt(1.0 - z * z);
                normals[i] = {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
                              static_cast<float>(z)};
            }
            const AcdfDirectionSample s = view.sample(normals[i].data(), u[i][0], u[i][1]);
            sampled[i] = {s.direction[0], s.direction[1], s.direction[2]};
        }
    }
};

/// Calls at a point, which serves `shared` of them.
template <class Ask>
Candidate each(const LocalEnvironmentView& view, const Questions& q, std::size_t shared, const Ask& ask) {
    return {"", [&view, &q, shared, ask](std::size_t first, std::size_t count) {
                for (std::size_t i = first; i < first + count; i += shared) {
                    const AcdfLocalPoint point = view.at(q.normals[i].data());
                    for (std::size_t k = i; k < i + shared; ++k) ask(view, point, k);
                }
            }};
}

/// Samples at a normal that serves once.
Candidate sample_each(const LocalEnvironmentView& view, const Questions& q) {
    return {"", [&](std::size_t first, std::size_t count) {
                for (std::size_t i = first; i < first + count; ++i)
                    keep(view.sample(q.normals[i].data(), q.u[i][0], q.u[i][1]));
            }};
}

/// Pdfs at a normal that serves once.
Candidate pdf_each(const LocalEnvironmentView& view, const Questions& q, const Directions& directions) {
    return {"", [&](std::size_t first, std::size_t count) {
                for (std::size_t i = first; i < first + count; ++i)
                    keep(view.pdf(q.normals[i].data(), directions[i].data()));
            }};
}

struct Compared {
    const acdf_bench::FullTable& full;
    const LocalEnvironmentView &plain, &fast;
    bool evicted = false;
};

/// `ours`: the calls of a view.
template <class Ours, class Full>
void report(const char* what, const Compared& all, const Ours& ours, const Full& full) {
    std::vector<Candidate> rows = {{"",
                                    [&](std::size_t first, std::size_t count) {
                                        for (std::size_t i = first; i < first + count; ++i) full(i);
                                    }},
                                   ours(all.plain),
                                   ours(all.fast)};
    acdf_bench::Turns turns;
    if (all.evicted) turns = {20, 1024, kCalls, true};
    acdf_bench::take_turns(rows, turns);
    std::printf("| %s | %.1f |", what, rows[0].least);
    for (std::size_t i = 1; i < rows.size(); ++i)
        std::printf(" %.1f (%.2f) |", rows[i].least, rows[i].least / rows[0].least);
    std::puts("");
    std::fflush(stdout);
}

bool open(const char* path, bool tables, File& file) {
    LoadOptions options;
    options.tables = tables;
    return File::open(path, file, options).ok() && file.kind() == ACDF_KIND_LOCAL;
}

bool run(const char* path) {
    File tables, none;
    if (!open(path, true, tables) || !open(path, false, none)) return false;
    const LocalEnvironmentView fast = tables.local(), plain = none.local();
    const AcdfEnvironment& env = fast.data().environment;
    const bool latlong = env.parameterization == ACDF_PARAM_LATLONG;
    const std::uint32_t columns = latlong ? env.columns : 1024;
    const acdf_bench::FullTable full(acdf_bench::sky(columns));
    const Questions q(plain);
    std::printf(
        "\nA file of %llu bytes%s, with tables of %llu bytes; full table of %u x %u\n\n| ns a call (of the full "
        "table's) | full table | no tables | tables |\n|---|---|---|---|\n",
        static_cast<unsigned long long>(tables.size()), latlong ? "" : ", octahedral",
        static_cast<unsigned long long>(tables.table_bytes()), columns, columns / 2);
    Compared all = {full, plain, fast};
    const auto nothing = [](const auto&, const AcdfLocalPoint& point, std::size_t) { keep(point); };
    const auto sample = [&q](const auto& view, const AcdfLocalPoint& point, std::size_t k) {
        keep(view.sample(point, q.u[k][0], q.u[k][1]));
    };
    const auto both = [&q](const auto& view, const AcdfLocalPoint& point, std::size_t k) {
        keep(view.sample(point, q.u[k][0], q.u[k][1]));
        keep(view.pdf(point, q.anywhere[k].data()));
    };
    const auto sampled = [&q](const auto& view, const AcdfLocalPoint& point, std::size_t k) {
        keep(view.pdf(point, q.sampled[k].data()));
    };
    const auto full_sample_of = [&full](const Questions& of) {
        return [&](std::size_t i) { keep(full.sample(of.u[i][0], of.u[i][1])); };
    };
    const auto full_sample = full_sample_of(q);
    const auto full_anywhere = [&](std::size_t i) { keep(full.pdf(q.anywhere[i].data())); };
    const auto full_sampled = [&](std::size_t i) { keep(full.pdf(q.sampled[i].data())); };
    const auto full_both = [&](std::size_t i) {
        full_sample(i);
        full_anywhere(i);
    };
    const auto at_points = [&](std::size_t shared, const auto& ask) {
        return [&q, shared, ask](const LocalEnvironmentView& view) { return each(view, q, shared, ask); };
    };
    const auto sample_once = [](const Questions& of) {
        return [&of](const LocalEnvironmentView& view) { return sample_each(view, of); };
    };
    const auto once = [&q](const Directions& directions) {
        return [&](const LocalEnvironmentView& view) { return pdf_each(view, q, directions); };
    };
    report("shading point (full table: a sample)", all, at_points(1, nothing), full_sample);
    report("sample, a normal per call", all, sample_once(q), full_sample);
    report("sample, 16 per shading point", all, at_points(kShared, sample), full_sample);
    report("pdf of a uniform direction, a normal per call", all, once(q.anywhere), full_anywhere);
    report("pdf of a sampled direction, a normal per call", all, once(q.sampled), full_sampled);
    report("pdf, 16 per shading point", all, at_points(kShared, sampled), full_sampled);
    report("shading point, sample, and pdf of another direction (full table: both)", all, at_points(1, both),
           full_both);
    const Questions coherent(plain, true);
    report("sample, coherent normals and numbers", all, sample_once(coherent), full_sample_of(coherent));
    all.evicted = true;
    report("sample, a normal per call, caches evicted", all, sample_once(q), full_sample);
    report("pdf of a uniform direction, a normal per call, caches evicted", all, once(q.anywhere), full_anywhere);
    return true;
}

bool count(char** arguments, const char* how) {
    File file;
    if (!open(arguments[1], std::strcmp(how, "walk") != 0, file)) return false;
    const LocalEnvironmentView view = file.local();
    const Questions q(view);
    const char what = arguments[0][1]; // point, sample, pdf
    const std::size_t calls = std::strtoull(arguments[2], nullptr, 10);
    for (std::size_t i = 0; i < calls; ++i) {
        const std::size_t k = i % kCalls;
        const float* const normal = q.normals[k].data();
        if (what == 'd') keep(view.pdf(normal, q.anywhere[k].data()));
        else if (what == 'r') keep(view.sample(normal, q.u[k][0], q.u[k][1]));
        else keep(view.at(normal));
    }
    return true;
}

} // namespace

int main(int argc, char** argv) {
    if (argc >= 5 && std::strcmp(argv[1], "--count") == 0) return count(argv + 2, argc > 5 ? argv[5] : "") ? 0 : 1;
    for (int i = 1; i < argc; ++i)
        if (!run(argv[i])) {
            std::fprintf(stderr, "%s: no local environment file\n", argv[i]);
            return 1;
        }
}
