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

TEST(Product, PdfIsThatOfTheSamplesAtPositions) {
    int sampled = 0;
    for (const NormalsSpec& spec : {visible_normals(), regional_normals(), windowed_normals()}) {
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
                ASSERT_EQ(sampler.pdf(point, s.direction), s.pdf) << i;
            }
        }
    }
    EXPECT_GT(sampled, 30000);
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

// The light's part, over the squares of its grid, in which it is constant; the lobe's part is the lobe's own.
TEST(Product, PdfIntegratesToOne) {
    int cuts = 0;
    each_point(false, [&](const LoadedLocal& loaded, const TestLobe& lobe, const Sampler& sampler,
                          const Sampler::Point& point, const std::string& name, std::mt19937_64&) {
        if (!has_cut(point)) return;
        ++cuts;
        const AcdfLocal light = loaded.light();
        const AcdfVisibleLocal visible = acdf_visible_everywhere(&light);
        const AcdfGrid grid = acdf_environment_grid(&light.environment);
        double sum = 0.0;
        for (std::uint32_t y = 0; y < grid.rows; ++y)
            for (std::uint32_t x = 0; x < grid.columns; ++x) {
                const AcdfRange square[2] = {{x, x + 1}, {y, y + 1}};
                const double middle[2] = {0.5, 0.5};
                const AcdfDirectionSample at = acdf_grid_position(&grid, square, middle, 1.0);
                const float p = acdf_cut_pdf(&visible, &point.light, &point.cut, at.direction);
                sum += double{p} * acdf_grid_solid_angle(&grid, square);
                float wi[3];
                point.frame.to_local(at.direction, wi);
                const double mixture = (1.0 - point.share) * p + point.share * lobe.pdf(point.lobe, wi);
                ASSERT_NEAR(sampler.pdf(point, at.direction), mixture, 1e-6 * mixture) << name;
            }
        ASSERT_NEAR(sum, 1.0, 1e-5) << name;
    });
    EXPECT_GT(cuts, 100);
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
    NormalsSpec spec = small_normals();
    for (auto& bin : spec.bins) bin.share = 0.0f;
    const LoadedLocal loaded(spec.encode());
    const TestLobe lobe{0.1};
    const Sampler sampler(loaded.light(), lobe);
    std::mt19937_64 rng(3);
    for (int i = 0; i < 100; ++i) {
        const acdf::SurfaceFrame frame = acdf::surface_frame(random_normal(rng).v);
        const Sampler::Point point = sampler.at(frame, frame.normal);
        if (!loaded.file.local().stored(frame.normal) && point.light.local.what == ACDF_LOCAL_TREE) continue;
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
            ASSERT_EQ(acdf_product_lobe_pdf(&light, &c_lobe, &c_point, b.direction), b.pdf);
        }
    }
}

} // namespace
