// Time of a sample and of a pdf of measured BRDFs: files of ours beside the sampler that the authors of the RGL
// database publish, the full table, a GGX lobe and the cosine. Each call has another view, another direction and
// other random numbers. The time of the RGL sampler on the same random numbers is taken in turns with that of what
// is timed, a few microseconds apart: `of_rgl` is the ratio of the two.
#include "brdf.h"

#include "input/rgl_brdf.h"
#include "measure/brdf_samplers.h"
#include "measure/brdf_table.h"
#include "measure/rgl_sampler.h"

#include <acdf/wavefront.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <random>
#include <vector>

namespace {

using namespace acdf;

// So many before views and random numbers repeat. With a few thousand the processor learns the branches of each.
constexpr std::size_t kQueries = 1 << 16;
constexpr std::size_t kTurn = 4096; // calls before the other sampler has its turn: a small wave
constexpr double kPi = 3.14159265358979323846;

const char* const kRglFile = "cc_ibiza_sunset_rgb.bsdf";
std::string path_of(const std::string& name) { return std::string(ACDF_TEST_DATA) + "/brdfs/" + name; }

/// cos(theta_o) uniform in [0.1, 1]; wi reflected by the RGL sampler or, without its data, a GGX lobe: where light
/// comes from is where densities are asked for.
struct Query {
    double u[2];
    float wo[3], wi[3];
};
struct Pair {
    explicit Pair(const Query& q) : wo{q.wo[0], q.wo[1], q.wo[2]}, wi{q.wi[0], q.wi[1], q.wi[2]} {}
    double wo[3], wi[3]; // as the samplers that compute in double take them
};

void direction(double cosine, double phi, double out[3]) {
    const double sine = std::sqrt(1.0 - cosine * cosine);
    out[0] = sine * std::cos(phi);
    out[1] = sine * std::sin(phi);
    out[2] = cosine;
}

const measure::RglSampler* rgl_sampler() {
    static std::unique_ptr<input::Brdf> brdf;
    static std::unique_ptr<measure::RglSampler> sampler;
    if (!sampler && std::filesystem::exists(path_of(kRglFile))) {
        brdf = input::open_brdf(path_of(kRglFile));
        sampler = std::make_unique<measure::RglSampler>(dynamic_cast<const input::RglBrdf&>(*brdf));
    }
    return sampler.get();
}

const std::vector<Query>& queries() {
    static const std::vector<Query> made = [] {
        std::mt19937_64 random(1);
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        std::vector<Query> out(kQueries);
        const measure::GgxSampler ggx(0.3);
        for (Query& q : out) {
            const double cosine = 0.1 + 0.9 * uniform(random), phi = 2.0 * kPi * uniform(random);
            double wo[3];
            direction(cosine, phi, wo);
            const double u[2] = {uniform(random), uniform(random)};
            const measure::BrdfSample s = rgl_sampler() ? rgl_sampler()->sample(wo, u) : ggx.sample(wo, u);
            for (int k = 0; k < 3; ++k) {
                q.wo[k] = static_cast<float>(wo[k]);
                q.wi[k] = s.pdf > 0.0 ? static_cast<float>(s.wi[k]) : q.wo[k];
            }
            q.u[0] = uniform(random);
            q.u[1] = uniform(random);
        }
        return out;
    }();
    return made;
}

/// Seconds that `call` takes for the queries first .. first + kTurn - 1.
template <class Call>
double timed(std::size_t first, const Call& call) {
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t i = first; i < first + kTurn; ++i) call(queries()[i]);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A call's, of the middle one of the turns: other programs interrupt some of them.
double median_ns(std::vector<double> seconds) {
    const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
    std::nth_element(seconds.begin(), middle, seconds.end());
    return 1e9 * *middle / static_cast<double>(kTurn);
}

/// Runs `turn(first query)`, which returns its seconds, and `rgl` (may be null) in turns.
template <class Turn, class Rgl>
void run_turns(benchmark::State& state, const Turn& turn, const Rgl& rgl) {
    std::vector<double> ours, theirs; // seconds of each turn
    std::size_t first = 0;
    for (auto _ : state) {
        ours.push_back(turn(first));
        state.SetIterationTime(ours.back());
        if (rgl_sampler()) theirs.push_back(timed(first, rgl));
        first = (first + kTurn) % kQueries;
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(ours.size() * kTurn));
    state.counters["ns"] = median_ns(ours);
    if (!rgl_sampler()) return;
    state.counters["rgl_ns"] = median_ns(theirs);
    state.counters["of_rgl"] = median_ns(ours) / median_ns(theirs);
}

const auto rgl_sample = [](const Query& q) { benchmark::DoNotOptimize(rgl_sampler()->sample(Pair(q).wo, q.u)); };
const auto rgl_pdf = [](const Query& q) {
    const Pair d(q);
    benchmark::DoNotOptimize(rgl_sampler()->pdf(d.wo, d.wi));
};

template <class Call>
void run_sample(benchmark::State& state, const Call& call) {
    run_turns(
        state, [&](std::size_t first) { return timed(first, call); }, rgl_sample);
}
template <class Call>
void run_pdf(benchmark::State& state, const Call& call) {
    run_turns(
        state, [&](std::size_t first) { return timed(first, call); }, rgl_pdf);
}

/// A source (a file of the test data, or a model) at a size.
struct Case {
    std::string source;
    std::uint64_t bytes;
    std::string label() const { return source + "/" + std::to_string(bytes >> 10) + "KiB"; }
};

const File& file_of(const Case& given) {
    static std::map<std::string, std::unique_ptr<File>> open;
    static std::map<std::string, tools::BrdfFile> made;
    const auto [found, missing] = open.try_emplace(given.label());
    if (missing) {
        const std::string path = path_of(given.source);
        const auto brdf = input::open_brdf(std::filesystem::exists(path) ? path : given.source);
        tools::BrdfFileOptions options;
        options.fit.goal.kind = compress::Goal::Kind::budget;
        options.fit.goal.budget = given.bytes;
        const auto& bytes = (made[given.label()] = tools::build_brdf(*brdf, options)).bytes;
        found->second = std::make_unique<File>();
        File::from_memory(bytes.data(), bytes.size(), *found->second);
    }
    return *found->second;
}

void sample(benchmark::State& state, const Case& given) {
    const BrdfView view = file_of(given).brdf();
    run_sample(state, [&](const Query& q) { benchmark::DoNotOptimize(view.sample(q.wo, q.u[0], q.u[1])); });
}
void pdf(benchmark::State& state, const Case& given) {
    const BrdfView view = file_of(given).brdf();
    run_pdf(state, [&](const Query& q) { benchmark::DoNotOptimize(view.pdf(q.wo, q.wi)); });
}

/// A wave's arrays, as BrdfWavefront takes them.
struct Wave {
    float wo[kTurn][3], wi[kTurn][3];
    double u[kTurn][2];
    explicit Wave(std::size_t first) {
        for (std::size_t i = 0; i < kTurn; ++i) {
            const Query& q = queries()[first + i];
            for (std::size_t k = 0; k < 3; ++k) wo[i][k] = q.wo[k], wi[i][k] = q.wi[k];
            for (std::size_t k = 0; k < 2; ++k) u[i][k] = q.u[k];
        }
    }
};
const std::pair<const char*, Instructions> kInstructions[] = {{"avx2", Instructions::avx2},
                                                              {"avx512", Instructions::avx512}};
BrdfWavefront wavefront_of(const Case& given, Instructions most) {
    BrdfWavefront out;
    BrdfWavefront::prepare(file_of(given).brdf(), out, most);
    return out;
}

template <class Call>
double timed_wave(std::size_t first, const Call& call) {
    const Wave wave(first);
    const auto start = std::chrono::steady_clock::now();
    call(wave);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void wavefront_sample(benchmark::State& state, const Case& given, Instructions most) {
    const BrdfWavefront wavefront = wavefront_of(given, most);
    const auto call = [&](const Wave& wave) {
        DirectionSample out[kTurn];
        wavefront.sample(wave.wo, wave.u, kTurn, out);
        benchmark::DoNotOptimize(out);
    };
    run_turns(
        state, [&](std::size_t first) { return timed_wave(first, call); }, rgl_sample);
}
void wavefront_pdf(benchmark::State& state, const Case& given, Instructions most) {
    const BrdfWavefront wavefront = wavefront_of(given, most);
    const auto call = [&](const Wave& wave) {
        float out[kTurn];
        wavefront.pdf(wave.wo, wave.wi, kTurn, out);
        benchmark::DoNotOptimize(out);
    };
    run_turns(
        state, [&](std::size_t first) { return timed_wave(first, call); }, rgl_pdf);
}

/// The full table of the first case's source.
const measure::TabulatedBrdf& table(const Case& given) {
    static std::unique_ptr<input::Brdf> brdf;
    static std::unique_ptr<measure::TabulatedBrdf> made;
    if (!made) {
        const std::string path = path_of(given.source);
        brdf = input::open_brdf(std::filesystem::exists(path) ? path : given.source);
        const tools::BrdfFileOptions options;
        made = std::make_unique<measure::TabulatedBrdf>(
            tools::reflected_light(*brdf, options.channels, options.weights), true, measure::BrdfTableKind::centre);
    }
    return *made;
}

void register_rivals(const Case& first) {
    using benchmark::DoNotOptimize;
    using benchmark::RegisterBenchmark;
    using State = benchmark::State;
    std::vector<benchmark::internal::Benchmark*> all;
    all.push_back(RegisterBenchmark("sample/ggx", [](State& state) {
        const measure::GgxSampler ggx(0.3);
        run_sample(state, [&](const Query& q) { DoNotOptimize(ggx.sample(Pair(q).wo, q.u)); });
    }));
    all.push_back(RegisterBenchmark("pdf/ggx", [](State& state) {
        const measure::GgxSampler ggx(0.3);
        run_pdf(state, [&](const Query& q) {
            const Pair d(q);
            DoNotOptimize(ggx.pdf(d.wo, d.wi));
        });
    }));
    all.push_back(RegisterBenchmark("sample/cosine", [](State& state) {
        run_sample(state, [](const Query& q) { DoNotOptimize(measure::CosineSampler::sample(Pair(q).wo, q.u)); });
    }));
    all.push_back(RegisterBenchmark("sample/full_table", [first](State& state) {
        const auto& full = table(first);
        run_sample(state, [&](const Query& q) { DoNotOptimize(full.sample(Pair(q).wo, q.u)); });
    }));
    all.push_back(RegisterBenchmark("pdf/full_table", [first](State& state) {
        const auto& full = table(first);
        run_pdf(state, [&](const Query& q) {
            const Pair d(q);
            DoNotOptimize(full.pdf(d.wo, d.wi));
        });
    }));
    for (auto* benchmark : all) benchmark->UseManualTime();
}

} // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    std::vector<Case> cases;
    for (const std::uint64_t bytes : {std::uint64_t{64} << 10, std::uint64_t{200} << 10})
        for (const char* name :
             {kRglFile, "satin_rosaline_rgb.bsdf", "nickel.binary", "blue-metallic-paint.binary"})
            if (std::filesystem::exists(path_of(name))) cases.push_back({name, bytes});
            else std::printf("%s is not there\n", path_of(name).c_str());
    if (cases.empty()) {
        std::printf("a model takes their place, and there is no sampler of the RGL database to compare with\n");
        cases.push_back({"ggx:alpha=0.2", 64 << 10});
    }
    for (const Case& c : cases) {
        benchmark::RegisterBenchmark(("sample/" + c.label()).c_str(), sample, c)->UseManualTime();
        benchmark::RegisterBenchmark(("pdf/" + c.label()).c_str(), pdf, c)->UseManualTime();
        for (const auto& [name, most] : kInstructions)
            benchmark::RegisterBenchmark(("sample/" + c.label() + "/" + name).c_str(), wavefront_sample, c, most)
                ->UseManualTime();
        for (const auto& [name, most] : kInstructions)
            benchmark::RegisterBenchmark(("pdf/" + c.label() + "/" + name).c_str(), wavefront_pdf, c, most)
                ->UseManualTime();
    }
    register_rivals(cases.front());
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
