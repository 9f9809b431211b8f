// acdf/product/product.h and acdf/product/cut.h on files and lobes of every kind: that the pdf is exactly that
// of the samples, that it integrates to 1, and that nothing is left out.
#include "tests/lib/product/product_points.h"
#include "tests/lib/reader/load.h"

#include <acdf/product/product_c.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <iterator>
#include <new>
#include <vector>

using namespace acdf_test;
using namespace acdf_test::products;

namespace {

// To the bit, with and without slopes in cells, for random numbers of every kind.
TEST(Product, PdfIsExactlyThatOfTheSamples) {
    const double edges[] = {0.0, 1.0, 0.5, 1.0 - 0x1p-24, 1.0 - 0x1p-53, 0x1p-30, 0x1p-1000, NAN, -1.0, 2.0};
    int sampled = 0, all = 0;
    for (const bool tilts : {false, true})
        each_point(tilts, [&](const LoadedLocal&, const TestLobe&, const Sampler& sampler,
                              const Sampler::Point& point, const std::string& name, std::mt19937_64& rng) {
            for (int i = 0; i < 200; ++i) {
                const double u0 = rng() % 8 == 0 ? edges[rng() % 10] : uniform(rng);
                const double u1 = rng() % 8 == 0 ? edges[rng() % 10] : uniform(rng);
                const acdf::ProductSample s = sampler.sample(point, u0, u1);
                ASSERT_TRUE(std::isfinite(s.pdf) && s.pdf >= 0.0f) << name;
                ++all;
                if (s.pdf == 0.0f) continue;
                ++sampled;
                ASSERT_EQ(sampler.pdf(point, s.direction), s.pdf) << name << ", " << u0 << ' ' << u1;
                ASSERT_NEAR(std::hypot(s.direction[0], s.direction[1], s.direction[2]), 1.0, 1e-6) << name;
            }
        });
    EXPECT_GT(sampled, all * 0.98); // the rest: views and light nearly opposite, whose half-vector is lost
}

// Where a part is a bright tile, no row of visibility cells gives it anything.
TEST(Product, PdfIsThatOfTheSamplesAtPositions) {
    int sampled = 0, of_lights = 0;
    for (const LocalSpec& spec : {visibility_local(), regional_local(), windowed_local()}) {
        const LoadedLocal loaded(spec);
        std::mt19937_64 rng(3);
        for (int i = 0; i < 200; ++i) {
            const float position[3] = {static_cast<float>(3.0 * uniform(rng)),
                                       static_cast<float>(3.0 * uniform(rng) - 1.0),
                                       static_cast<float>(1.0 + 3.0 * uniform(rng))};
            const acdf::SurfaceFrame frame = acdf::surface_frame(random_normal(rng).v);
            const Sampler sampler(loaded.light(), TestLobe{widths[i % 3]});
            const Sampler::Point point = sampler.at(position, frame, random_view(rng, frame).v);
            for (int k = 0; k < 100; ++k) {
                const acdf::ProductSample s = sampler.sample(point, uniform(rng), uniform(rng));
                if (s.pdf == 0.0f) continue;
                ++sampled;
                of_lights += s.pdf > 20.0f;
                ASSERT_EQ(sampler.pdf(point, s.direction), s.pdf) << i;
            }
        }
    }
    EXPECT_GT(sampled, 30000);
    EXPECT_GT(of_lights, 0);
}

// A point is made in memory that holds anything: nothing is read of it that was not written.
TEST(Product, PointsAreTheSameInAnyMemory) {
    for (std::uint32_t seed = 0; seed < 16; ++seed) {
        const LoadedLocal loaded(random_light(seed, false));
        std::mt19937_64 rng(seed);
        const TestLobe lobe{widths[seed % 3]};
        const acdf::SurfaceFrame frame = acdf::surface_frame(random_normal(rng).v);
        const Vector wo = random_view(rng, frame);
        for (const Sampler& sampler : {Sampler(loaded.light().environment, lobe), Sampler(loaded.light(), lobe)}) {
            std::vector<acdf::ProductSample> sampled[2]; // and pdfs, without directions
            for (const int byte : {0, 1}) {
                alignas(Sampler::Point) unsigned char memory[sizeof(Sampler::Point)];
                std::memset(memory, byte, sizeof memory);
                const Sampler::Point& point = *new (memory) Sampler::Point(sampler.at(frame, wo.v));
                std::mt19937_64 numbers(7);
                for (int i = 0; i < 100; ++i) {
                    const double u0 = uniform(numbers), u1 = uniform(numbers);
                    sampled[byte].push_back(sampler.sample(point, u0, u1));
                    sampled[byte].push_back({{}, sampler.pdf(point, random_normal(numbers).v)});
                }
            }
            ASSERT_EQ(std::memcmp(sampled[0].data(), sampled[1].data(), 200 * sizeof sampled[0][0]), 0) << seed;
        }
    }
}

constexpr acdf::Instructions each_instructions[] = {acdf::Instructions::none, acdf::Instructions::avx2,
                                                    acdf::Instructions::avx512};

// Whatever the numbers and directions are, and however many; what stands behind the last one stays.
template <class AnySampler>
void expect_single_calls(const AnySampler& sampler, const typename AnySampler::Point& point, std::size_t count,
                         std::mt19937_64& rng) {
    const double edges[] = {0.0, 1.0, 0.5, 1.0 - 0x1p-53, 0x1p-1000, 0x1p-1074, NAN, -1.0, 2.0, HUGE_VAL};
    double u[70][2];
    acdf::ProductSample out[71];
    float directions[70][3], pdfs[71];
    ASSERT_LE(count, 70u);
    for (auto& pair : u)
        for (double& x : pair) x = rng() % 8 == 0 ? edges[rng() % std::size(edges)] : uniform(rng);
    std::memset(out, 0x55, sizeof out);
    std::memset(pdfs, 0x55, sizeof pdfs);
    sampler.sample(point, count, u, out);
    for (std::size_t i = 0; i < count; ++i) {
        const acdf::ProductSample one = sampler.sample(point, u[i][0], u[i][1]);
        ASSERT_EQ(std::memcmp(&out[i], &one, sizeof one), 0)
            << i << " of " << count << ": " << u[i][0] << ' ' << u[i][1];
        const Vector any = random_normal(rng);
        std::memcpy(directions[i], i % 2 ? one.direction : any.v, sizeof any.v);
        if (rng() % 16 == 0) directions[i][rng() % 3] = static_cast<float>(edges[rng() % std::size(edges)]);
    }
    sampler.pdf(point, count, directions, pdfs);
    for (std::size_t i = 0; i < count; ++i) {
        const float one = sampler.pdf(point, directions[i]);
        ASSERT_EQ(std::memcmp(&pdfs[i], &one, sizeof one), 0) << i << " of " << count;
    }
    const unsigned char *behind = reinterpret_cast<const unsigned char*>(&out[count]),
                        *last = reinterpret_cast<const unsigned char*>(&pdfs[count]);
    for (std::size_t k = 0; k < sizeof *out; ++k) ASSERT_EQ(behind[k], 0x55);
    for (std::size_t k = 0; k < sizeof *pdfs; ++k) ASSERT_EQ(last[k], 0x55);
}

TEST(Product, SeveralSamplesAreThoseOfSingleCalls) {
    int together = 0, by_vectors = 0, in_groups = 0, by_fast_vectors = 0;
    for (const acdf::Instructions most : each_instructions)
        for (const bool tilts : {false, true})
            each_point(
                tilts, most, true,
                [&](const LoadedLocal& loaded, const TestLobe&, const Sampler& sampler, const Sampler::Point& point,
                    const std::string& name, std::mt19937_64& rng) {
                    SCOPED_TRACE(name + ", instructions up to " + std::to_string(int(most)));
                    AcdfLocal light = loaded.light();
                    const bool vectors = acdf::product_vectors(most) != nullptr;
                    in_groups += has_groups(point);
                    const bool in_parts = has_cut(point) && point.cut.count > 1;
                    together += in_parts && point.light.mix.count == ACDF_CUT_BATCH_ROWS;
                    by_fast_vectors += has_groups(point) && vectors;
                    by_vectors += vectors && in_parts && acdf_cut_by_vectors(&light, &point.light);
                    for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{16}, rng() % 70})
                        expect_single_calls(sampler, point, count, rng);
                });
    EXPECT_GT(together, 150);
    EXPECT_GT(in_groups, 150);
#if defined(__x86_64__)
    EXPECT_EQ(by_vectors > 50, __builtin_cpu_supports("avx2") != 0);
    EXPECT_EQ(by_fast_vectors > 50, __builtin_cpu_supports("avx2") != 0);
#endif
}

// What no part or row gives anything, and values that are denormal.
TEST(Product, SeveralSamplesOfFaintPartsAreThoseOfSingleCalls) {
    std::mt19937_64 rng(5);
    const TestLobe lobe{0.1};
    for (const acdf::Instructions most : each_instructions)
        for (std::uint32_t seed = 0; seed < 8; ++seed) {
            const LoadedLocal loaded(random_local(seed, false));
            AcdfLocal light = loaded.light();
            acdf::ProductOptions options;
            options.vectors = acdf::product_vectors(most);
            const Sampler sampler(light, lobe, options);
            const acdf::SurfaceFrame frame = acdf::surface_frame(random_normal(rng).v);
            Sampler::Point point = sampler.at(frame, random_view(rng, frame).v);
            const double scales[] = {1.0, 0.0, 0x1p-1074, 0x1p-1060, 0x1p-1000};
            for (int i = 0; i < point.cut.count; ++i) {
                AcdfCutPart& part = point.cut.part[i];
                const double rows = scales[rng() % 5], bright_tiles = scales[rng() % 5];
                for (double& weight : part.weight) weight *= rows;
                for (std::uint32_t k = part.first_light; k < part.end_light; ++k)
                    point.cut.light[k] *= bright_tiles;
                part.bright_tiles = acdf_cut_bright_tiles(&point.cut, part.first_light, part.end_light);
                part.sum = part.bright_tiles + ((part.weight[0] + part.weight[1]) + part.weight[2]);
                part.probability *= scales[rng() % 5];
            }
            acdf_cut_finish(&point.cut);
            SCOPED_TRACE("seed " + std::to_string(seed) + ", instructions up to " + std::to_string(int(most)));
            for (const std::size_t count : {5u, 16u, 61u}) expect_single_calls(sampler, point, count, rng);
        }
}

// The light's part, over the squares of its grid, in which it is constant; the lobe's part is the lobe's own.
TEST(Product, PdfIntegratesToOne) {
    int cuts = 0, groups = 0, open = 0;
    each_point(false, [&](const LoadedLocal& loaded, const TestLobe& lobe, const Sampler& sampler,
                          const Sampler::Point& point, const std::string& name, std::mt19937_64&) {
        if (!has_cut(point) && !has_groups(point)) return;
        cuts += has_cut(point);
        groups += has_groups(point);
        for (const std::uint8_t list : point.fast.open) open += has_groups(point) && list > 0;
        const AcdfLocal light = loaded.light();
        const AcdfGrid grid = acdf_environment_grid(&light.environment);
        double sum = 0.0;
        for (std::uint32_t y = 0; y < grid.rows; ++y)
            for (std::uint32_t x = 0; x < grid.columns; ++x) {
                const AcdfRange square[2] = {{x, x + 1, 0.0}, {y, y + 1, 0.0}};
                const double middle[2] = {0.5, 0.5};
                const AcdfDirectionSample at = acdf_grid_position(&grid, square, middle, 1.0);
                const float p = has_cut(point) ? acdf_cut_pdf(&light, &point.light, &point.cut, at.direction)
                                               : acdf_fast_cut_pdf(&light, &point.light, &point.fast, at.direction);
                sum += double{p} * acdf_grid_solid_angle(&grid, square);
                float wi[3];
                point.frame.to_local(at.direction, wi);
                const double mixture = (1.0 - point.share) * p + point.share * lobe.pdf(point.lobe, wi);
                ASSERT_NEAR(sampler.pdf(point, at.direction), mixture, 1e-6 * mixture) << name;
            }
        ASSERT_NEAR(sum, 1.0, 1e-5) << name;
    });
    EXPECT_GT(cuts, 100);
    EXPECT_GT(groups, 50);
    EXPECT_GT(open, 50);
}

// Wherever the lobe's own sampler samples, whatever the light; nothing is sampled where nothing is reflected.
TEST(Product, NothingIsLeftOut) {
    each_point(true, [&](const LoadedLocal&, const TestLobe& lobe, const Sampler& sampler,
                         const Sampler::Point& point, const std::string& name, std::mt19937_64& rng) {
        for (int i = 0; i < 100; ++i) {
            const acdf::ProductSample s = lobe.sample(point.lobe, uniform(rng), uniform(rng));
            float world[3], wi[3];
            point.frame.to_world(s.direction, world);
            point.frame.to_local(world, wi); // as it was rounded
            ASSERT_GE(sampler.pdf(point, world), 0.0299 * double{lobe.pdf(point.lobe, wi)}) << name;
        }
        const float below[3] = {-point.frame.normal[0], -point.frame.normal[1], -point.frame.normal[2]};
        const Sampler::Point unseen = sampler.at(point.frame, below);
        ASSERT_EQ(sampler.sample(unseen, uniform(rng), uniform(rng)).pdf, 0.0f);
        ASSERT_EQ(sampler.pdf(unseen, point.frame.normal), 0.0f);
        const float bad[][3] = {{NAN, 0.0f, 1.0f}, {0.0f, 0.0f, 2.0f}, {0.0f, 0.0f, 0.0f}};
        for (const auto& d : bad) ASSERT_TRUE(std::isfinite(sampler.pdf(point, d))) << name;
    });
}

// Where no light arrives the lobe's own sampler samples all: its samples count as 0, and the pdf is still
// right.
TEST(Product, HemispheresWithoutLightAreTheLobes) {
    LocalSpec spec = random_local(1, false);
    for (auto& light : spec.bright_tiles) light.share = 1e-30f;
    for (auto& bin : spec.bins) bin.share = 0.0f;
    spec.bright_tiles.clear();
    const LoadedLocal loaded(std::move(spec));
    const TestLobe lobe{0.1};
    const Sampler sampler(loaded.light(), lobe);
    std::mt19937_64 rng(3);
    for (int i = 0; i < 100; ++i) {
        const acdf::SurfaceFrame frame = acdf::surface_frame(random_normal(rng).v);
        const Sampler::Point point = sampler.at(frame, frame.normal);
        if (!loaded.file.local().stored(frame.normal) && point.light.what == ACDF_LOCAL_TREE) continue;
        ASSERT_EQ(point.share, 1.0);
        const acdf::ProductSample s = sampler.sample(point, uniform(rng), uniform(rng));
        float wi[3];
        frame.to_local(s.direction, wi);
        ASSERT_EQ(s.pdf, lobe.pdf(point.lobe, wi));
    }
}

extern "C" {
float c_value(const void* data, const float wo[3], const float wi[3]) {
    const auto* lobe = static_cast<const TestLobe*>(data);
    const TestLobe::Point point{{wo[0], wo[1], wo[2]}};
    return lobe->value(point, wi, lobe->pdf(point, wi));
}
float c_pdf(const void* data, const float wo[3], const float wi[3]) {
    return static_cast<const TestLobe*>(data)->pdf({{wo[0], wo[1], wo[2]}}, wi);
}
AcdfDirectionSample c_sample(const void* data, const float wo[3], double u0, double u1) {
    return static_cast<const TestLobe*>(data)->sample({{wo[0], wo[1], wo[2]}}, u0, u1);
}
}

TEST(Product, InCIsTheSame) {
    for (std::uint32_t seed = 0; seed < 16; ++seed) {
        const LoadedLocal loaded(random_light(seed, false));
        const AcdfLocal light = loaded.light();
        const TestLobe lobe{0.1};
        const AcdfLobe c_lobe{&lobe, c_value, c_sample, c_pdf};
        const Sampler sampler(light, lobe, acdf::ProductOptions{32});
        std::mt19937_64 rng(seed);
        for (int i = 0; i < 50; ++i) {
            const acdf::SurfaceFrame frame = acdf::surface_frame(random_normal(rng).v);
            const Vector wo = random_view(rng, frame);
            float axes[9];
            for (int k = 0; k < 3; ++k) {
                axes[k] = frame.tangent[k];
                axes[3 + k] = frame.bitangent[k];
                axes[6 + k] = frame.normal[k];
            }
            const Sampler::Point point = sampler.at(frame, wo.v);
            AcdfProductPoint c_point;
            acdf_product_lobe_at(&light, &c_lobe, 32, axes, wo.v, &c_point);
            const double u0 = uniform(rng), u1 = uniform(rng);
            const AcdfDirectionSample a = sampler.sample(point, u0, u1),
                                      b = acdf_product_lobe_sample(&light, &c_lobe, &c_point, u0, u1);
            for (int k = 0; k < 3; ++k) ASSERT_EQ(a.direction[k], b.direction[k]);
            ASSERT_EQ(a.pdf, b.pdf);
            const double numbers[3][2] = {{u1, u0}, {u0, u1}, {u0, u0}};
            AcdfDirectionSample several[3];
            acdf_product_lobe_samples(&light, &c_lobe, &c_point, 3, numbers, several);
            ASSERT_EQ(std::memcmp(&several[1], &b, sizeof b), 0);
            ASSERT_EQ(acdf_product_lobe_pdf(&light, &c_lobe, &c_point, b.direction), b.pdf);
            const float directions[2][3] = {{b.direction[0], b.direction[1], b.direction[2]},
                                            {frame.normal[0], frame.normal[1], frame.normal[2]}};
            float pdfs[2];
            acdf_product_lobe_pdfs(&light, &c_lobe, &c_point, 2, directions, pdfs);
            ASSERT_EQ(pdfs[0], b.pdf);
            ASSERT_EQ(pdfs[1], sampler.pdf(point, frame.normal));
        }
    }
}

} // namespace
