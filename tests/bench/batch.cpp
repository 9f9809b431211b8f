// Time of a call in batches beside the loop over single calls, with each set of instructions.
//
//   bench_batch FILE...     environments, local files and BRDFs; a table in Markdown for each
#include "tests/bench/directions.h"
#include "tests/bench/turns.h"

#include <acdf/batch/batch.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <hwy/targets.h>

#include <cmath>
#include <cstdio>
#include <cstring>

namespace {

using acdf_bench::Candidate;
using acdf_bench::Directions;

constexpr std::size_t kNumbers = std::size_t{1} << 17; // pairs, before they repeat

using Vectors = float (*)[3];
Vectors from(const Directions& vectors, std::size_t i) {
    return reinterpret_cast<Vectors>(const_cast<float*>(vectors[i].data()));
}

/// What calls are given, and what they give.
struct Calls {
    std::vector<double> u = std::vector<double>(2 * kNumbers);
    Directions at = acdf_bench::uniform_directions(kNumbers, 3),
               given = acdf_bench::uniform_directions(kNumbers, 9), directions = Directions(kNumbers);
    std::vector<float> pdfs = std::vector<float>(kNumbers);

    Calls() {
        std::mt19937_64 random(7);
        for (double& x : u) x = static_cast<double>(random() >> 40) * 0x1p-24;
    }
    const double (*numbers(std::size_t i) const)[2] { return reinterpret_cast<const double(*)[2]>(&u[2 * i]); }
    void put(std::size_t i, const acdf::DirectionSample& sample) {
        std::memcpy(directions[i].data(), sample.direction, sizeof sample.direction);
        pdfs[i] = sample.pdf;
    }
};

/// A row: single calls, then batches with each set of instructions, and how many times faster they are.
template <class Single, class Batch>
void report(const char* what, const Single& single, const Batch& batch, bool evict = false) {
    std::vector<Candidate> candidates = {{"single calls", single}};
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
        candidates.push_back({hwy::TargetName(target), [target, &batch](std::size_t first, std::size_t count) {
                                  hwy::SetSupportedTargetsForTest(target);
                                  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
                                  batch(first, count);
                                  hwy::SetSupportedTargetsForTest(0);
                              }});
    acdf_bench::Turns turns;
    turns.period = kNumbers;
    turns.evict = evict;
    if (evict) turns.rounds = 40, turns.calls = 1024;
    acdf_bench::take_turns(candidates, turns);
    std::printf("| %s |", what);
    for (const Candidate& c : candidates) {
        std::printf(" %.1f", c.least);
        if (&c != &candidates[0]) std::printf(" (%.2f)", candidates[0].least / c.least);
        std::printf(" |");
    }
    std::printf("\n");
    std::fflush(stdout);
}

void run(const acdf::EnvironmentView& view, Calls& calls) {
    const auto sample = [&](std::size_t first, std::size_t count) {
        for (std::size_t i = first; i < first + count; ++i)
            calls.put(i, view.sample(calls.u[2 * i], calls.u[2 * i + 1]));
    };
    const auto samples = [&](std::size_t first, std::size_t count) {
        acdf::sample_batch(view, calls.numbers(first), count, from(calls.directions, first), &calls.pdfs[first]);
    };
    const auto pdf = [&](const Directions& w) {
        return [&](std::size_t first, std::size_t count) {
            for (std::size_t i = first; i < first + count; ++i) calls.pdfs[i] = view.pdf(w[i].data());
        };
    };
    const auto pdfs = [&](const Directions& w) {
        return [&](std::size_t first, std::size_t count) {
            acdf::pdf_batch(view, from(w, first), count, &calls.pdfs[first]);
        };
    };
    report("sample", sample, samples);
    report("sample, caches evicted", sample, samples, true);
    report("pdf of uniform directions", pdf(calls.given), pdfs(calls.given));
    report("pdf of sampled directions", pdf(calls.directions), pdfs(calls.directions));
    report("pdf of uniform directions, caches evicted", pdf(calls.given), pdfs(calls.given), true);
}

// A normal or view of several calls is looked up once, by both.
AcdfLocalPoint look_up(const acdf::LocalEnvironmentView& view, const float normal[3]) { return view.at(normal); }
acdf::DirectionSample sample_at(const acdf::LocalEnvironmentView& view, const AcdfLocalPoint& at,
                                const double u[2]) {
    return view.sample(at, u[0], u[1]);
}
float pdf_at(const acdf::LocalEnvironmentView& view, const AcdfLocalPoint& at, const float w[3]) {
    return view.pdf(at, w);
}
AcdfBrdfView look_up(const acdf::BrdfView& view, const float wo[3]) {
    AcdfBrdfView out;
    acdf_brdf_view(&view.data(), wo, &out);
    return out;
}
acdf::DirectionSample sample_at(const acdf::BrdfView& view, const AcdfBrdfView& at, const double u[2]) {
    return acdf_brdf_view_sample(&view.data(), &at, u[0], u[1]);
}
float pdf_at(const acdf::BrdfView& view, const AcdfBrdfView& at, const float wi[3]) {
    return acdf_brdf_view_pdf(&view.data(), &at, wi);
}

template <class View>
void run(const View& view, std::size_t each, Calls& calls) {
    const auto sample = [&, each](std::size_t first, std::size_t count) {
        for (std::size_t j = first; j < first + count; j += each) {
            if (each == 1) {
                calls.put(j, view.sample(calls.at[j].data(), calls.u[2 * j], calls.u[2 * j + 1]));
                continue;
            }
            const auto at = look_up(view, calls.at[j / each].data());
            for (std::size_t i = j; i < j + each; ++i) calls.put(i, sample_at(view, at, &calls.u[2 * i]));
        }
    };
    const auto samples = [&, each](std::size_t first, std::size_t count) {
        acdf::sample_batch(view, from(calls.at, first / each), each, calls.numbers(first), count,
                           from(calls.directions, first), &calls.pdfs[first]);
    };
    const auto pdf = [&, each](std::size_t first, std::size_t count) {
        for (std::size_t j = first; j < first + count; j += each) {
            if (each == 1) {
                calls.pdfs[j] = view.pdf(calls.at[j].data(), calls.given[j].data());
                continue;
            }
            const auto at = look_up(view, calls.at[j / each].data());
            for (std::size_t i = j; i < j + each; ++i) calls.pdfs[i] = pdf_at(view, at, calls.given[i].data());
        }
    };
    const auto pdfs = [&, each](std::size_t first, std::size_t count) {
        acdf::pdf_batch(view, from(calls.at, first / each), each, from(calls.given, first), count,
                        &calls.pdfs[first]);
    };
    const std::string of = each == 1 ? ", of its own" : ", " + std::to_string(each) + " at a time of one";
    report(("sample" + of).c_str(), sample, samples);
    report(("pdf" + of).c_str(), pdf, pdfs);
    if (each == 1) report(("sample" + of + ", caches evicted").c_str(), sample, samples, true);
}

} // namespace

int main(int argc, char** argv) {
    for (int k = 1; k < argc; ++k) {
        acdf::File file;
        if (!acdf::File::open(argv[k], file).ok()) return std::fprintf(stderr, "%s: no file\n", argv[k]), 1;
        const char* name = std::strrchr(argv[k], '/');
        const char* kind = file.kind() == ACDF_KIND_LOCAL  ? ", of normals"
                           : file.kind() == ACDF_KIND_BRDF ? ", of views"
                                                           : "";
        std::printf("\n| ns a call (times faster): %s%s | single calls |", name ? name + 1 : argv[k], kind);
        for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
            std::printf(" %s |", hwy::TargetName(target));
        std::printf("\n|---|---|");
        for (std::size_t i = 0; i < hwy::SupportedAndGeneratedTargets().size(); ++i) std::printf("---|");
        std::printf("\n");
        Calls calls;
        if (file.kind() == ACDF_KIND_ENVIRONMENT) run(file.environment(), calls);
        if (file.kind() == ACDF_KIND_BRDF)
            for (Directions* vectors : {&calls.at, &calls.given})
                for (auto& v : *vectors) v[2] = std::fabs(v[2]);
        for (const std::size_t each : {1, 16}) {
            if (file.kind() == ACDF_KIND_LOCAL) run(file.local(), each, calls);
            if (file.kind() == ACDF_KIND_BRDF) run(file.brdf(), each, calls);
        }
    }
    return 0;
}
