// Time of a shading point, a draw and a density of local environment files, with runtime tables and without.
//
//   bench_local FILE.acdf...      a table in Markdown; local files of lat-long probes
#include "tests/bench/turns.h"

#include <acdf/reader.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <random>

namespace {

using namespace acdf;
using acdf_bench::Candidate;
using acdf_bench::keep;

constexpr std::size_t kCalls = std::size_t{1} << 18; // before they repeat
constexpr std::size_t kShared = 16;                  // calls a point, where a point has several

using Directions = std::vector<std::array<float, 3>>;
Directions uniform_directions(unsigned seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    Directions out(kCalls);
    for (auto& d : out) {
        const double z = 2.0 * uniform(random) - 1.0, phi = 2.0 * ACDF_PI * uniform(random),
                     r = std::sqrt(1.0 - z * z);
        d = {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)), static_cast<float>(z)};
    }
    return out;
}

/// What is asked: normals, pairs of numbers, directions anywhere and such as are drawn.
struct Questions {
    Directions normals = uniform_directions(1), anywhere = uniform_directions(2), drawn{kCalls};
    std::vector<std::array<float, 2>> u{kCalls};

    explicit Questions(const LocalEnvironmentView& view) {
        std::mt19937_64 random(3);
        for (std::size_t i = 0; i < kCalls; ++i) {
            for (float& value : u[i]) value = static_cast<float>(random() >> 40) * 0x1p-24f;
            const AcdfDirectionSample s = view.sample(normals[i].data(), u[i][0], u[i][1]);
            drawn[i] = {s.direction[0], s.direction[1], s.direction[2]};
        }
    }
};

template <class Ask>
Candidate each(const LocalEnvironmentView& view, const Questions& q, std::size_t shared, const Ask& ask) {
    return {"", [&view, &q, shared, ask](std::size_t first, std::size_t count) {
                for (std::size_t i = first; i < first + count; i += shared) {
                    const AcdfLocalPoint point = view.at(q.normals[i].data());
                    for (std::size_t k = i; k < i + shared; ++k) ask(view, point, k);
                }
            }};
}

template <class Ask>
void report(const char* what, const LocalEnvironmentView& plain, const LocalEnvironmentView& fast,
            const Questions& q, std::size_t shared, const Ask& ask) {
    std::vector<Candidate> both = {each(plain, q, shared, ask), each(fast, q, shared, ask)};
    acdf_bench::take_turns(both, {});
    std::printf("| %s | %.1f | %.1f (%.2f) |\n", what, both[0].least, both[1].least, both[1].least / both[0].least);
    std::fflush(stdout);
}

bool run(const char* path) {
    LoadOptions walk;
    walk.tables = false;
    File tables, none;
    if (!File::open(path, tables).ok() || !File::open(path, none, walk).ok() || tables.kind() != ACDF_KIND_LOCAL)
        return false;
    const LocalEnvironmentView fast = tables.local(), plain = none.local();
    const Questions q(plain);
    std::printf("\nA file of %llu bytes, with tables of %llu bytes\n\n| ns a call | walked | with tables "
                "|\n|---|---|---|\n",
                static_cast<unsigned long long>(tables.size()),
                static_cast<unsigned long long>(tables.table_bytes()));
    const auto nothing = [](const auto&, const AcdfLocalPoint& point, std::size_t) { keep(point); };
    const auto draw = [&q](const auto& view, const AcdfLocalPoint& point, std::size_t k) {
        keep(view.sample(point, q.u[k][0], q.u[k][1]));
    };
    const auto anywhere = [&q](const auto& view, const AcdfLocalPoint& point, std::size_t k) {
        keep(view.pdf(point, q.anywhere[k].data()));
    };
    const auto drawn = [&q](const auto& view, const AcdfLocalPoint& point, std::size_t k) {
        keep(view.pdf(point, q.drawn[k].data()));
    };
    report("shading point", plain, fast, q, 1, nothing);
    report("shading point and draw", plain, fast, q, 1, draw);
    report("one of 16 draws at a point", plain, fast, q, kShared, draw);
    report("shading point and density of a uniform direction", plain, fast, q, 1, anywhere);
    report("shading point and density of a drawn direction", plain, fast, q, 1, drawn);
    report("one of 16 densities at a point", plain, fast, q, kShared, drawn);
    return true;
}

} // namespace

int main(int argc, char** argv) {
    for (int i = 1; i < argc; ++i)
        if (!run(argv[i])) {
            std::fprintf(stderr, "%s: no local environment file\n", argv[i]);
            return 1;
        }
}
