// Time of a sample and of a pdf of measured BRDFs: files of ours beside the sampler that the authors of the RGL
// database publish, the full table, a GGX lobe and the cosine. Each call has another view, another direction and
// other random numbers. The time of the RGL sampler is taken in turns with that of what is timed, a millisecond or
// two each: `of_rgl` is the ratio of the two.
#include "build/brdf.h"

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
constexpr std::size_t kTurn = 4096; // calls before the other sampler has its turn: a millisecond or two
// Wavefronts take all queries in a turn, which is about as long: both samplers find the cache as the other one left
// it equally often.
constexpr std::size_t kWave = 4096;
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

using PublishedRgl = measure::RglSamplerOf<float>;
const PublishedRgl* rgl_sampler() {
    static std::unique_ptr<input::Brdf> brdf;
    static std::unique_ptr<PublishedRgl> sampler;
    if (!sampler && std::filesystem::exists(path_of(kRglFile))) {
        brdf = input::open_brdf(path_of(kRglFile));
        sampler = std::make_unique<PublishedRgl>(dynamic_cast<const input::RglBrdf&>(*brdf));
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

/// Queries that are timed in one go.
struct Turn {
    std::size_t first, count;
};

template <class Call>
double timed(const Turn& turn, const Call& call) {
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t i = turn.first; i < turn.first + turn.count; ++i) call(queries()[i]);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A call's, of the middle one of the turns: other programs interrupt some of them.
double median_ns(std::vector<double> seconds, std::size_t calls) {
    const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
    std::nth_element(seconds.begin(), middle, seconds.end());
    return 1e9 * *middle / static_cast<double>(calls);
}

/// Runs `time(turn)`, which returns seconds, on turns of `calls`, and `rgl` on turns of kTurn in between.
template <class Time, class Rgl>
void run_turns(benchmark::State& state, std::size_t calls, const Time& time, const Rgl& rgl) {
    std::vector<double> ours, theirs; // seconds of each turn
    Turn turn{0, calls}, rgl_turn{0, kTurn};
    for (auto _ : state) {
        ours.push_back(time(turn));
        state.SetIterationTime(ours.back());
        if (rgl_sampler()) theirs.push_back(timed(rgl_turn, rgl));
        for (Turn* t : {&turn, &rgl_turn}) t->first = (t->first + t->count) % kQueries;
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(ours.size() * calls));
    state.counters["ns"] = median_ns(ours, calls);
    if (!rgl_sampler()) return;
    state.counters["rgl_ns"] = median_ns(theirs, kTurn);
    state.counters["of_rgl"] = median_ns(ours, calls) / median_ns(theirs, kTurn);
}

const auto rgl_sample = [](const Query& q) { benchmark::DoNotOptimize(rgl_sampler()->sample(Pair(q).wo, q.u)); };
const auto rgl_pdf = [](const Query& q) {
    const Pair d(q);
    benchmark::DoNotOptimize(rgl_sampler()->pdf(d.wo, d.wi));
};

template <class Call>
void run_sample(benchmark::State& state, const Call& call) {
    run_turns(
        state, kTurn, [&](const Turn& turn) { return timed(turn, call); }, rgl_sample);
}
template <class Call>
void run_pdf(benchmark::State& state, const Call& call) {
    run_turns(
        state, kTurn, [&](const Turn& turn) { return timed(turn, call); }, rgl_pdf);
}

/// A source (a file of the test data, or a model) at a size.
struct Case {
    std::string source;
    std::uint64_t bytes;
    std::string label() const { return source + "/" + std::to_string(bytes >> 10) + "KiB"; }
};

const File& file_of(const Case& given) {
    static std::map<std::string, std::unique_ptr<File>> open;
    static std::map<std::string, build::BrdfFile> made;
    const auto [found, missing] = open.try_emplace(given.label());
    if (missing) {
        const std::string path = path_of(given.source);
        const auto brdf = input::open_brdf(std::filesystem::exists(path) ? path : given.source);
        build::BrdfFileOptions options;
        options.fit.goal.kind = compress::Goal::Kind::budget;
        options.fit.goal.budget = given.bytes;
        const auto& bytes = (made[given.label()] = build::build_brdf(*brdf, options)).bytes;
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

/// All queries, in arrays as BrdfWavefront takes them.
struct Wave {
    std::vector<float> wo, wi;
    std::vector<double> u;
    Wave() {
        for (const Query& q : queries()) {
            wo.insert(wo.end(), q.wo, q.wo + 3);
            wi.insert(wi.end(), q.wi, q.wi + 3);
            u.insert(u.end(), q.u, q.u + 2);
        }
    }
    const float (*wo_of(const Turn& turn) const)[3] {
        return reinterpret_cast<const float(*)[3]>(&wo[3 * turn.first]);
    }
    const float (*wi_of(const Turn& turn) const)[3] {
        return reinterpret_cast<const float(*)[3]>(&wi[3 * turn.first]);
    }
    const double (*u_of(const Turn& turn) const)[2] {
        return reinterpret_cast<const double(*)[2]>(&u[2 * turn.first]);
    }
};
const Wave& wave() {
    static const Wave made;
    return made;
}

const std::pair<const char*, Instructions> kInstructions[] = {{"avx2", Instructions::avx2},
                                                              {"avx512", Instructions::avx512}};
BrdfWavefront wavefront_of(const Case& given, Instructions most) {
    BrdfWavefront out;
    BrdfWavefront::prepare(file_of(given).brdf(), out, most);
    return out;
}

/// `call` writes the results of a wave.
template <class Out, class Call, class Rgl>
void run_wavefront(benchmark::State& state, const Call& call, const Rgl& rgl) {
    std::vector<Out> out(kWave);
    const auto time = [&](const Turn& turn) {
        const auto start = std::chrono::steady_clock::now();
        for (std::size_t i = 0; i < turn.count; i += kWave) {
            call(Turn{turn.first + i, kWave}, out.data());
            benchmark::DoNotOptimize(out.data());
            benchmark::ClobberMemory();
        }
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    run_turns(state, kQueries, time, rgl);
}
void wavefront_sample(benchmark::State& state, const Case& given, Instructions most) {
    const BrdfWavefront wavefront = wavefront_of(given, most);
    const auto call = [&](const Turn& turn, DirectionSample* out) {
        wavefront.sample(wave().wo_of(turn), wave().u_of(turn), turn.count, out);
    };
    run_wavefront<DirectionSample>(state, call, rgl_sample);
}
void wavefront_pdf(benchmark::State& state, const Case& given, Instructions most) {
    const BrdfWavefront wavefront = wavefront_of(given, most);
    const auto call = [&](const Turn& turn, float* out) {
        wavefront.pdf(wave().wo_of(turn), wave().wi_of(turn), turn.count, out);
    };
    run_wavefront<float>(state, call, rgl_pdf);
}
void register_wavefronts(const Case& file) {
    for (const auto& [name, most] : kInstructions) {
        const std::string label = file.label() + "/" + name;
        benchmark::RegisterBenchmark(("sample/" + label).c_str(), wavefront_sample, file, most)->UseManualTime();
        benchmark::RegisterBenchmark(("pdf/" + label).c_str(), wavefront_pdf, file, most)->UseManualTime();
    }
}

/// The full table of the first case's source.
const measure::TabulatedBrdf& table(const Case& given) {
    static std::unique_ptr<input::Brdf> brdf;
    static std::unique_ptr<measure::TabulatedBrdf> made;
    if (!made) {
        const std::string path = path_of(given.source);
        brdf = input::open_brdf(std::filesystem::exists(path) ? path : given.source);
        const build::BrdfFileOptions options;
        made = std::make_unique<measure::TabulatedBrdf>(
            build::reflected_light(*brdf, options.channels, options.weights), true, measure::BrdfTableKind::centre);
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
    for (const std::uint64_t bytes : {std::uint64_t{64} << 10, std::uint64_t{128} << 10, std::uint64_t{200} << 10})
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
        register_wavefronts(c);
    }
    register_rivals(cases.front());
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
