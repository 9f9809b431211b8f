// Compares BrdfBatch with BrdfView, bit for bit, whatever instructions serve.
#pragma once

#include "batch/brdf.h"

#include <acdf/batch/batch.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace acdf_test {

inline const std::vector<acdf::Instructions>& all_instructions() {
    static const std::vector<acdf::Instructions> all = {acdf::Instructions::none, acdf::Instructions::avx2,
                                                        acdf::Instructions::avx512};
    return all;
}

/// Views, random numbers and directions: likely ones, and those that are refused or lie at an end.
class Queries {
public:
    Queries(const acdf::BrdfView& view, std::size_t count) : wo_(3 * count), wi_(3 * count), u_(2 * count) {
        std::mt19937_64 random(5);
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        const double ends[] = {0.0,           1.0,      -1.0,         0.5,      2.0,
                               1.0 - 0x1p-24, 0x1p-149, std::nan(""), infinity, -infinity};
        for (std::size_t i = 0; i < count; ++i) {
            direction(&wo_[3 * i], std::pow(uniform(random), 1.0 + double(i % 3)), 7.0 * uniform(random));
            for (std::size_t k = 0; k < 2; ++k)
                u_[2 * i + k] = i % 13 == 4 * k ? ends[random() % std::size(ends)] : uniform(random);
            if (i % 7 == 3) wo_[3 * i + 2] *= -1.0f;
            if (i % 31 == 5) wo_[3 * i + i % 3] = not_a_direction(random());
            if (i % 37 == 6) direction(&wo_[3 * i], 1.0, 0.0);
            if (i % 41 == 7) direction(&wo_[3 * i], 1e-6, 3.0);
            // Half of wi are sampled, so that they are where pdfs are large.
            const acdf::DirectionSample s = view.sample(wo()[i], u()[i][0], u()[i][1]);
            if (i % 2 == 0 && s.pdf > 0.0f) std::memcpy(&wi_[3 * i], s.direction, sizeof s.direction);
            else direction(&wi_[3 * i], 2.0 * uniform(random) - 1.0, 7.0 * uniform(random));
            if (i % 17 == 8)
                for (std::size_t k = 0; k < 3; ++k) wi_[3 * i + k] = -wo_[3 * i + k];
            if (i % 19 == 3) { // a half-vector in the surface: the last row
                wi_[3 * i] = wo_[3 * i + 1];
                wi_[3 * i + 1] = -wo_[3 * i];
                wi_[3 * i + 2] = -wo_[3 * i + 2];
            }
            if (i % 29 == 9) wi_[3 * i + i % 3] = not_a_direction(random());
        }
    }

    const float (*wo() const)[3] { return reinterpret_cast<const float(*)[3]>(wo_.data()); }
    const float (*wi() const)[3] { return reinterpret_cast<const float(*)[3]>(wi_.data()); }
    const double (*u() const)[2] { return reinterpret_cast<const double(*)[2]>(u_.data()); }

private:
    static constexpr double infinity = std::numeric_limits<double>::infinity();

    static void direction(float* out, double z, double phi) {
        const double r = std::sqrt(1.0 - z * z);
        out[0] = float(r * std::cos(phi));
        out[1] = float(r * std::sin(phi));
        out[2] = float(z);
    }
    static float not_a_direction(std::uint64_t random) {
        const float all[] = {std::nanf(""), 1e30f, -std::numeric_limits<float>::infinity(), 1.01f};
        return all[random % std::size(all)];
    }

    std::vector<float> wo_, wi_;
    std::vector<double> u_;
};

inline void expect_batch_is_the_view(const acdf::BrdfView& view, std::size_t count, acdf::Instructions most) {
    SCOPED_TRACE(std::to_string(count) + " directions, instructions up to " + std::to_string(int(most)));
    acdf::BrdfBatch batch;
    const acdf::Status status = acdf::BrdfBatch::prepare(view, batch, most);
    ASSERT_TRUE(status.ok()) << status.message;
    EXPECT_LE(batch.instructions(), most);
    EXPECT_EQ(batch.bytes() > 0, batch.instructions() != acdf::Instructions::none);

    const Queries asked(view, count);
    // One more than is asked for: that must stay what it is.
    std::vector<acdf::DirectionSample> samples(count + 1, {{7.0f, 7.0f, 7.0f}, 7.0f});
    std::vector<float> pdfs(count + 1, 7.0f);
    batch.sample(asked.wo(), asked.u(), count, samples.data());
    batch.pdf(asked.wo(), asked.wi(), count, pdfs.data());
    for (std::size_t i = 0; i < count; ++i) {
        const acdf::DirectionSample s = view.sample(asked.wo()[i], asked.u()[i][0], asked.u()[i][1]);
        for (int k = 0; k < 3; ++k) ASSERT_EQ(s.direction[k], samples[i].direction[k]) << i;
        ASSERT_EQ(s.pdf, samples[i].pdf) << i;
        ASSERT_EQ(view.pdf(asked.wo()[i], asked.wi()[i]), pdfs[i]) << i;
    }
    EXPECT_EQ(samples[count].pdf, 7.0f);
    EXPECT_EQ(pdfs[count], 7.0f);
}

/// Pdfs of several directions for one view, each 40th of those asked, and several samples.
inline void expect_same_of_a_view(const acdf::BrdfView& view, std::size_t count, acdf::Instructions most) {
    SCOPED_TRACE(std::to_string(count) + " calls of a view, instructions up to " + std::to_string(int(most)));
    const AcdfBrdf& brdf = view.data();
    const Queries asked(view, count);
    for (std::size_t i = 0; i < count; i += 40) {
        AcdfBrdfView of_wo;
        if (!acdf_brdf_view(&brdf, asked.wo()[i], &of_wo)) continue;
        const std::size_t some = std::min(count - i, i % 67);
        std::vector<float> pdfs(some + 1, 7.0f);
        acdf::brdf_pdf_batch(brdf, of_wo, asked.wi() + i, some, pdfs.data(), most);
        for (std::size_t k = 0; k < some; ++k)
            ASSERT_EQ(acdf_brdf_view_pdf(&brdf, &of_wo, asked.wi()[i + k]), pdfs[k]) << i << ' ' << k;
        EXPECT_EQ(pdfs[some], 7.0f);
        std::vector<acdf::DirectionSample> samples(some + 1, acdf::DirectionSample{{7.0f, 7.0f, 7.0f}, 7.0f});
        acdf::brdf_sample_batch(brdf, of_wo, asked.u() + i, some, samples.data(), most);
        for (std::size_t k = 0; k < some; ++k) {
            const acdf::DirectionSample s =
                acdf_brdf_view_sample(&brdf, &of_wo, asked.u()[i + k][0], asked.u()[i + k][1]);
            for (int axis = 0; axis < 3; ++axis)
                ASSERT_EQ(s.direction[axis], samples[k].direction[axis]) << i << ' ' << k;
            ASSERT_EQ(s.pdf, samples[k].pdf) << i << ' ' << k;
        }
        EXPECT_EQ(samples[some].pdf, 7.0f);
    }
}

inline void expect_batch_is_the_view(const acdf::BrdfView& view, std::size_t count) {
    for (const acdf::Instructions most : all_instructions()) {
        expect_batch_is_the_view(view, count, most);
        expect_same_of_a_view(view, count, most);
    }
}

} // namespace acdf_test
