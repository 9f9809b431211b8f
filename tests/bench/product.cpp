// Time of what acdf/product/product.h does, beside that of one sample of each strategy with the pdf of the
// other, which is what multiple importance sampling pays a sample: bench_product LOCAL.acdf BRDF.acdf
//
// Processor time of the thread, the least of some turns in which all take part. Each call has another normal,
// another view and other random numbers; those of a turn are those of the one before, where nothing else is said.
#include "measure/samplers/ggx_lobe.h"

#include <acdf/product/product.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace acdf;

constexpr std::size_t kPoints = 256, kDraws = 16;

double now() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e9 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec);
}

struct ShadingPoint {
    SurfaceFrame frame;
    float wo[3];
    double u[kDraws][2];
};

std::vector<ShadingPoint> shading_points() {
    std::mt19937_64 random(1);
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    const auto direction = [&](double low, float out[3]) {
        const double z = low + (1.0 - low) * uniform(), phi = 2.0 * uniform() - 1.0, r = std::sqrt(1.0 - z * z);
        double s, c;
        acdf_sincospi(phi, &s, &c);
        out[0] = static_cast<float>(r * c);
        out[1] = static_cast<float>(r * s);
        out[2] = static_cast<float>(z);
    };
    std::vector<ShadingPoint> out(kPoints);
    for (ShadingPoint& point_ : out) {
        float n[3], wo[3];
        direction(-1.0, n);
        direction(0.1, wo);
        point_.frame = surface_frame(n);
        point_.frame.to_world(wo, point_.wo);
        for (auto& u : point_.u)
            for (double& x : u) x = uniform();
    }
    return out;
}

volatile float sink;

/// A number that no turn had before: what guesses branches learns the others.
double other_number() {
    static std::uint64_t state = 1;
    state = state * 6364136223846793005u + 1442695040888963407u; // Knuth's, of MMIX
    return static_cast<double>(state >> 11) * 0x1p-53;
}

struct Timed {
    std::string name;
    std::function<void()> run;
    double calls;
    double best = 1e30;
};

template <class AnyLobe>
void add(const AcdfLocal& light, const AnyLobe& lobe, const std::string& name, const std::vector<ShadingPoint>& all,
         std::vector<Timed>& out) {
    using Sampler = ProductSampler<AnyLobe>;
    for (const int parts : {1, 8, 16, 32, 64, 96}) {
        const Sampler sampler(light, lobe, ProductOptions{parts});
        out.push_back({name + ", `at`, " + std::to_string(parts) + (parts == 1 ? " sub-region" : " sub-regions"),
                       [=, &all] {
                           for (const ShadingPoint& point_ : all)
                               sink = static_cast<float>(sampler.at(point_.frame, point_.wo).share);
                       },
                       double{kPoints}});
    }
    const Sampler sampler(light, lobe, ProductOptions{64});
    std::vector<typename Sampler::Point> points;
    for (const ShadingPoint& point_ : all) points.push_back(sampler.at(point_.frame, point_.wo));
    out.push_back({name + ", `sample`, 64 sub-regions",
                   [=, &all] {
                       for (std::size_t i = 0; i < kPoints; ++i)
                           for (const auto& u : all[i].u) sink = sampler.sample(points[i], u[0], u[1]).pdf;
                   },
                   double{kPoints * kDraws}});
    out.push_back({name + ", `sample`, 64 sub-regions, other random numbers each turn",
                   [=] {
                       for (const auto& point : points)
                           for (std::size_t k = 0; k < kDraws; ++k) {
                               const double u0 = other_number(), u1 = other_number();
                               sink = sampler.sample(point, u0, u1).pdf;
                           }
                   },
                   double{kPoints * kDraws}});
    out.push_back({name + ", `at` of 64 sub-regions and 16 samples, per sample",
                   [=, &all] {
                       for (const ShadingPoint& point_ : all) {
                           const auto point = sampler.at(point_.frame, point_.wo);
                           for (const auto& u : point_.u) sink = sampler.sample(point, u[0], u[1]).pdf;
                       }
                   },
                   double{kPoints * kDraws}});
    std::vector<typename AnyLobe::Point> views(kPoints);
    std::vector<AcdfLocalPoint> normals(kPoints);
    for (std::size_t i = 0; i < kPoints; ++i) {
        float wo[3];
        all[i].frame.to_local(all[i].wo, wo);
        (void)lobe.at(wo, views[i]);
        acdf_local_at(&light, all[i].frame.normal, &normals[i]);
    }
    out.push_back({name + ", MIS: a sample of each strategy and the other's pdf, mean of both",
                   [=, &all] {
                       for (std::size_t i = 0; i < kPoints; ++i)
                           for (std::size_t k = 0; k < kDraws; ++k) {
                               const double* u = all[i].u[k];
                               float d[3];
                               if (k % 2) {
                                   const ProductSample s = acdf_local_sample_at(&light, &normals[i], u[0], u[1]);
                                   all[i].frame.to_local(s.direction, d);
                                   sink = s.pdf + lobe.pdf(views[i], d);
                               } else {
                                   const ProductSample s = lobe.sample(views[i], u[0], u[1]);
                                   all[i].frame.to_world(s.direction, d);
                                   sink = s.pdf + acdf_local_pdf_at(&light, &normals[i], d);
                               }
                           }
                   },
                   double{kPoints * kDraws}});
}

} // namespace

int main(int argc, char** argv) {
    File light, brdf;
    if (argc != 3 || !File::open(argv[1], light).ok() || !File::open(argv[2], brdf).ok() ||
        light.kind() != ACDF_KIND_LOCAL || brdf.kind() != ACDF_KIND_BRDF) {
        std::fprintf(stderr, "usage: bench_product LOCAL.acdf BRDF.acdf\n");
        return 1;
    }
    const std::vector<ShadingPoint> all = shading_points();
    std::vector<Timed> timed;
    add(light.local().data(), measure::GgxLobe(0.3), "GGX lobe", all, timed);
    add(light.local().data(), BrdfLobe(brdf.brdf().data()), "BRDF file", all, timed);
    for (int turn = 0; turn < 40; ++turn)
        for (Timed& one : timed) {
            one.run(); // what another one left in the caches is not timed
            const double begin = now();
            one.run();
            one.best = std::min(one.best, (now() - begin) / one.calls);
        }
    std::printf("| what | ns |\n|---|---|\n");
    for (const Timed& one : timed) std::printf("| %s | %.0f |\n", one.name.c_str(), one.best);
}
