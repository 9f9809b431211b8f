// Time of a sample and of a pdf of measured BRDFs: files of ours beside the sampler that the authors of the RGL
// database publish, the full table, an alias table and a hierarchical warp of tabulated slices, and a GGX lobe.
// Each call has another view, another direction and other random numbers.
//
//   bench_brdf [KIB...]                            tables in Markdown; 64 and 128 by default
//   bench_brdf --write FILE KIB                    a file of the first BRDF
//   bench_brdf --count sample|pdf FILE N [walk]    N calls and nothing else, for callgrind
#include "tests/bench/brdf_baselines.h"
#include "tests/bench/turns.h"

#include "build/brdf.h"
#include "input/brdf/rgl.h"
#include "measure/samplers/brdf_samplers.h"
#include "measure/samplers/brdf_table.h"
#include "measure/samplers/rgl_sampler.h"

#include <acdf/curves/curves.h>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <vector>

namespace {

using namespace acdf;
using acdf_bench::Candidate;
using acdf_bench::keep;

// So many before views and random numbers repeat. With a few thousand the processor learns the branches of each.
constexpr std::size_t kQueries = 1 << 16;
constexpr std::size_t kBatch = 4096;
constexpr double kPi = 3.14159265358979323846;

const char* const kRglFile = "cc_ibiza_sunset_rgb.bsdf";
std::string path_of(const std::string& name) { return std::string(ACDF_TEST_DATA) + "/brdfs/" + name; }

/// cos(theta_o) uniform in [0.1, 1]; wi reflected by the RGL sampler or, without its data, a GGX lobe: where light
/// comes from is where pdfs are asked for.
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

std::unique_ptr<input::Brdf> open_source(const std::string& name) {
    const std::string path = path_of(name);
    return input::open_brdf(std::filesystem::exists(path) ? path : name);
}

/// A file in memory, with tables and without.
struct Built {
    std::vector<std::uint8_t> bytes;
    File tables, plain;

    Built(const input::Brdf& brdf, std::uint64_t budget) {
        build::BrdfFileOptions options;
        options.fit.goal.kind = compress::Goal::Kind::budget;
        options.fit.goal.budget = budget;
        bytes = build::build_brdf(brdf, options).bytes;
        LoadOptions walk;
        walk.tables = false;
        File::from_memory(bytes.data(), bytes.size(), tables, acdf::with_curves());
        File::from_memory(bytes.data(), bytes.size(), plain, acdf::with_curves(walk));
    }
};

/// What takes floats, or doubles, one call at a time.
template <class Call>
std::function<void(std::size_t, std::size_t)> each(const Call& call) {
    return [call](std::size_t first, std::size_t count) {
        for (std::size_t i = first; i < first + count; ++i) keep(call(queries()[i % kQueries]));
    };
}
/// A sample and a pdf of one sampler.
struct Sampler {
    std::string name;
    std::function<void(std::size_t, std::size_t)> sample, pdf;
};
template <class S>
Sampler in_doubles(const char* name, const S& sampler) {
    return {name, each([&sampler](const Query& q) { return sampler.sample(Pair(q).wo, q.u); }),
            each([&sampler](const Query& q) {
                const Pair d(q);
                return sampler.pdf(d.wo, d.wi);
            })};
}
template <class S>
Sampler in_floats(const char* name, const S& sampler) {
    return {name, each([&sampler](const Query& q) { return sampler.sample(q.wo, q.u); }),
            each([&sampler](const Query& q) { return sampler.pdf(q.wo, q.wi); })};
}
Sampler of_view(const std::string& name, const BrdfView& view) {
    return {name, each([view](const Query& q) { return view.sample(q.wo, q.u[0], q.u[1]); }),
            each([view](const Query& q) { return view.pdf(q.wo, q.wi); })};
}

std::vector<double> times(const std::vector<Sampler>& samplers, bool of_pdfs, bool evict) {
    std::vector<Candidate> candidates;
    for (const Sampler& s : samplers) candidates.push_back({s.name, of_pdfs ? s.pdf : s.sample});
    acdf_bench::Turns turns;
    turns.calls = evict ? 1024 : kBatch;
    turns.period = kQueries;
    turns.rounds = evict ? 40 : 200;
    turns.evict = evict;
    acdf_bench::take_turns(candidates, turns);
    std::vector<double> out;
    for (const Candidate& c : candidates) out.push_back(c.least);
    return out;
}

/// A row a sampler: ns and the ratio to the first one.
void report(const std::vector<Sampler>& samplers) {
    std::printf("| | ns a sample | of %s | ns a pdf | of it | a sample, caches evicted | of it | a pdf, caches "
                "evicted | of it |\n|---|---|---|---|---|---|---|---|---|\n",
                samplers[0].name.c_str());
    const std::vector<double> sample = times(samplers, false, false), pdf = times(samplers, true, false),
                              cold = times(samplers, false, true), cold_pdf = times(samplers, true, true);
    for (std::size_t i = 0; i < samplers.size(); ++i)
        std::printf("| %s | %.0f | %.2f | %.0f | %.2f | %.0f | %.2f | %.0f | %.2f |\n", samplers[i].name.c_str(),
                    sample[i], sample[i] / sample[0], pdf[i], pdf[i] / pdf[0], cold[i], cold[i] / cold[0],
                    cold_pdf[i], cold_pdf[i] / cold_pdf[0]);
    std::fflush(stdout);
}

void run(const std::string& source, const std::vector<std::uint64_t>& sizes) {
    const auto brdf = open_source(source);
    const build::BrdfFileOptions options;
    const auto reflected = build::reflected_light(*brdf, options.channels, options.weights);
    const measure::TabulatedBrdf table(reflected, true, measure::BrdfTableKind::centre);
    const acdf_bench::AliasSlices alias(reflected);
    const acdf_bench::WarpSlices warp(reflected);
    const measure::GgxSampler ggx(0.3);
    std::vector<Sampler> samplers;
    if (rgl_sampler()) samplers.push_back(in_doubles("RGL sampler", *rgl_sampler()));
    samplers.push_back(in_doubles("full table", table));
    samplers.push_back(in_floats("alias table", alias));
    samplers.push_back(in_floats("hierarchical warp", warp));
    samplers.push_back(in_doubles("GGX lobe", ggx));
    std::vector<std::unique_ptr<Built>> built;
    for (const std::uint64_t kib : sizes) {
        built.push_back(std::make_unique<Built>(*brdf, kib << 10));
        const std::string size = std::to_string(kib) + " KiB";
        samplers.push_back(of_view(size, built.back()->tables.brdf()));
        samplers.push_back(of_view(size + ", no tables", built.back()->plain.brdf()));
        std::printf("\n%s, %s: tables of %llu bytes\n", source.c_str(), size.c_str(),
                    static_cast<unsigned long long>(built.back()->tables.table_bytes()));
    }
    std::printf("\n");
    report(samplers);
}

std::vector<std::string> sources() {
    std::vector<std::string> out;
    for (const char* name : {kRglFile, "nickel.binary"})
        if (std::filesystem::exists(path_of(name))) out.push_back(name);
    if (out.empty()) out.push_back("ggx:alpha=0.2"); // and there is no sampler of the RGL database to compare with
    return out;
}

int count(const char* what, const char* path, std::size_t calls, bool walk) {
    LoadOptions options;
    options.tables = !walk;
    File file;
    if (!File::open(path, file, acdf::with_curves(options)).ok() || file.kind() != ACDF_KIND_BRDF) return 1;
    const Sampler sampler = of_view("", file.brdf());
    queries();
    (std::strcmp(what, "sample") == 0 ? sampler.sample : sampler.pdf)(0, calls);
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    if (argc == 4 && std::strcmp(argv[1], "--write") == 0) {
        const Built built(*open_source(sources()[0]), std::strtoull(argv[3], nullptr, 10) << 10);
        std::ofstream(argv[2], std::ios::binary)
            .write(reinterpret_cast<const char*>(built.bytes.data()),
                   static_cast<std::streamsize>(built.bytes.size()));
        return 0;
    }
    if (argc >= 5 && std::strcmp(argv[1], "--count") == 0)
        return count(argv[2], argv[3], std::strtoul(argv[4], nullptr, 10), argc > 5);
    std::vector<std::uint64_t> sizes;
    for (int i = 1; i < argc; ++i) sizes.push_back(std::strtoull(argv[i], nullptr, 10));
    if (sizes.empty()) sizes = {64, 128};
    for (const std::string& source : sources()) run(source, sizes);
}
