// Products of any local file that was accepted, with a lobe that is the cosine, sampled around the normal.
#pragma once

#include "tests/fuzz/fuzz_random.h"
#include "tests/fuzz/require.h"

#include <acdf/product/product.h>
#include <acdf/visibility/visibility.h>

#include <cmath>

namespace acdf_test {

inline void sample_product(const acdf::VisibleLocalView& view, FuzzRandom& random) {
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
    const acdf::ProductSampler sampler(view.data(), lobe,
                                       {static_cast<int>(1 + random.below(random.below(4) == 0 ? 96 : 12))});
    float normal[3], wo[3];
    random.mostly_unit_vector(0, normal, false);
    random.unit_vector(wo, false);
    const auto point = sampler.at(normal, wo);
    for (int n = 0; n < samples_a_file; ++n) {
        float any[3];
        random.any_vector(any);
        const acdf::ProductSample s = sampler.sample(point, random.any_u(), random.any_u());
        require(s.pdf >= 0.0f && std::isfinite(s.pdf) && std::isfinite(sampler.pdf(point, any)));
        require(sampler.pdf(point, s.direction) == s.pdf || s.pdf == 0.0f);
    }
}

} // namespace acdf_test
