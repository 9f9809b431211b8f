// Many samples and pdfs at once, by whatever instructions this processor has, of any file that was accepted:
// those of single calls, to the bit.
#pragma once

#include "tests/fuzz/fuzz_random.h"
#include "tests/fuzz/require.h"
#include "tests/lib/reader/tables/no_pieces.h"

#include <acdf/batch/batch.h>
#include <acdf/product/product.h>

#include <cstring>

namespace acdf_test {

/// What batches take and give.
struct FuzzQueries {
    float first[samples_a_file][3], second[samples_a_file][3], pdfs[samples_a_file];
    double u[samples_a_file][2];
    acdf::DirectionSample samples[samples_a_file];

    /// Each fourth of the first vectors and each second of the others may be no direction; `upper`: where the first
    /// ones lie.
    FuzzQueries(FuzzRandom& random, bool upper) {
        for (int n = 0; n < samples_a_file; ++n) {
            random.mostly_unit_vector(n, first[n], upper);
            if (n % 2 == 0) random.any_vector(second[n]);
            else random.unit_vector(second[n], false);
            for (double& v : u[n]) v = random.any_u();
        }
    }
    /// What batches gave is what single calls give: of number n.
    template <class Sample, class Pdf>
    void require_single(const Sample& sample, const Pdf& pdf) const {
        for (int n = 0; n < samples_a_file; ++n) {
            const acdf::DirectionSample s = sample(n);
            require(std::memcmp(&s, &samples[n], sizeof s) == 0);
            require(pdf(n) == pdfs[n]);
        }
    }
};

/// Of a normal each, and of one shading point.
inline void local_batch_is_the_view(const acdf::LocalEnvironmentView& view, FuzzRandom& random) {
    const auto most = random.below(2) == 0 ? acdf::Instructions::avx2 : acdf::Instructions::avx512;
    const acdf::LocalBatch batch(view, most);
    FuzzQueries asked(random, false);
    batch.sample(asked.first, asked.u, samples_a_file, asked.samples);
    batch.pdf(asked.first, asked.second, samples_a_file, asked.pdfs);
    asked.require_single([&](int n) { return view.sample(asked.first[n], asked.u[n][0], asked.u[n][1]); },
                         [&](int n) { return view.pdf(asked.first[n], asked.second[n]); });
    const AcdfLocalPoint point = view.at(asked.first[random.below(samples_a_file)]);
    batch.sample(point, asked.u, samples_a_file, asked.samples);
    batch.pdf(point, asked.second, samples_a_file, asked.pdfs);
    asked.require_single([&](int n) { return view.sample(point, asked.u[n][0], asked.u[n][1]); },
                         [&](int n) { return view.pdf(point, asked.second[n]); });
}

inline void batch_is_the_view(const acdf::LocalEnvironmentView& view, FuzzRandom& random) {
    local_batch_is_the_view(view, random);
    if (!view.data().tables) return;
    const NoPieces large(view.data());
    local_batch_is_the_view(acdf::LocalEnvironmentView(large.local), random);
}

/// With a lobe that is the cosine, sampled around the normal.
inline void product_at_once_is_the_product(const acdf::LocalEnvironmentView& view, FuzzRandom& random) {
    const auto density = [](const float*, const float* wi) { return wi[2] > 0.0f ? wi[2] / float(ACDF_PI) : 0.0f; };
    const auto draw = [&](const float* wo, double u0, double u1) {
        acdf::ProductSample s;
        double sine, cosine;
        acdf_sincospi(2.0 * acdf_unit_interval(u0) - 1.0, &sine, &cosine);
        const double v = acdf_unit_interval(u1), radius = std::sqrt(v);
        s.direction[0] = static_cast<float>(radius * cosine);
        s.direction[1] = static_cast<float>(radius * sine);
        s.direction[2] = static_cast<float>(std::sqrt(1.0 - v));
        s.pdf = density(wo, s.direction);
        return s;
    };
    const acdf::Lobe lobe([](const float*, const float*) { return 1.0; }, draw, density);
    const acdf::ProductSampler sampler(
        view.data(), lobe,
        {static_cast<int>(1 + random.below(random.below(4) == 0 ? 96 : 12)), acdf_product_vectors()});
    FuzzQueries asked(random, false);
    const auto point = sampler.at(asked.first[0], asked.first[1]);
    acdf::ProductSample at_once[samples_a_file];
    sampler.sample(point, samples_a_file, asked.u, at_once);
    sampler.pdf(point, samples_a_file, asked.second, asked.pdfs);
    for (int n = 0; n < samples_a_file; ++n) {
        const acdf::ProductSample s = sampler.sample(point, asked.u[n][0], asked.u[n][1]);
        require(std::memcmp(&s, &at_once[n], sizeof s) == 0);
        const float pdf = sampler.pdf(point, asked.second[n]);
        require(std::memcmp(&pdf, &asked.pdfs[n], sizeof pdf) == 0);
        require(s.pdf >= 0.0f && std::isfinite(s.pdf) && std::isfinite(sampler.pdf(point, asked.second[n])));
        require(sampler.pdf(point, s.direction) == s.pdf || s.pdf == 0.0f);
    }
}

} // namespace acdf_test
