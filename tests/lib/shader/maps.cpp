// Skies between maps for shaders beside the reader's: a sample has the pdf that is told for its direction, and both
// are the reader's but for the rounding of floats and directions next to a border.
#include "tests/lib/indexed/indexed_builder.h"
#include "tests/lib/reader/golden_files.h"
#include "tests/lib/shader/walked_file.h"

#include <acdf/indexed/views.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace {

using namespace acdf_test;

struct SkyCounts {
    int samples = 0, other_cells = 0, other_pdfs = 0;
};

/// Of the pdf, or of that in the middle of the cone, where it falls steeply.
bool sky_pdfs_agree(const acdf::MixedEnvironment& sky, float a, float b) {
    const double steep = 2e-5 * sky.sun_share() * (sky.data().cone.reach > 0.0 ? sky.data().cone.peak : 0.0);
    return std::fabs(double{a} - double{b}) <= 2e-5 * std::max(double{a}, double{b}) + steep;
}

void compare_skies(const WalkedFile& file, const acdf::MixedEnvironment& sky, const double at[3],
                   std::mt19937& random, SkyCounts& counts) {
    const std::uint32_t* words = file.tables.words();
    const AcdfShaderSky shader = acdf_sky_at(words, float(at[0]), float(at[1]), float(at[2]));
    EXPECT_NEAR(double{shader.total}, sky.total(), 1e-5 * sky.total());
    EXPECT_NEAR(double{shader.sun}, sky.sun_share(), 1e-5);
    for (int n = 0; n < 400; ++n) {
        const auto n0 = std::uint32_t(random()), n1 = std::uint32_t(random());
        const AcdfWalkSample s = acdf_sky_sample(words, shader, n0, n1);
        const acdf::DirectionSample told = sky.sample(n0 * 0x1p-32, n1 * 0x1p-32);
        const float d[3] = {s.x, s.y, s.z};
        ASSERT_NEAR(std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), 1.0, 2e-6);
        ASSERT_GT(s.pdf, 0.0f);
        ASSERT_EQ(acdf_sky_pdf(words, shader, s.x, s.y, s.z), s.pdf) << n0 << ' ' << n1;
        ++counts.samples;
        counts.other_cells += !(std::hypot(double{d[0] - told.direction[0]}, double{d[1] - told.direction[1]},
                                           double{d[2] - told.direction[2]}) < 2e-5);
        counts.other_pdfs += !sky_pdfs_agree(sky, s.pdf, sky.pdf(d));
        const double z = 1.0 - double(random()) * 0x1p-31, phi = double(random()) * 0x1p-32 * 2.0 * ACDF_PI;
        const float any[3] = {float(std::sqrt(1.0 - z * z) * std::cos(phi)),
                              float(std::sqrt(1.0 - z * z) * std::sin(phi)), float(z)};
        counts.other_pdfs +=
            !sky_pdfs_agree(sky, acdf_sky_pdf(words, shader, any[0], any[1], any[2]), sky.pdf(any));
    }
}

void compare_all_skies(const WalkedFile& file) {
    ASSERT_TRUE(file.status.ok()) << file.status.message;
    acdf::IndexedEnvironment maps;
    ASSERT_TRUE(acdf::IndexedEnvironment::open(file.file, maps).ok());
    const AcdfIndexed& data = maps.data();
    std::mt19937 random(5);
    SkyCounts counts;
    for (int place = 0; place < 40; ++place) {
        double at[3] = {};
        const double* of_axis = data.coordinates;
        for (std::uint32_t axis = 0; axis < data.axes; of_axis += data.counts[axis++]) {
            const double low = of_axis[0], wide = of_axis[data.counts[axis] - 1] - low;
            // At maps, beyond them, and between.
            at[axis] = place < 4 ? of_axis[random() % data.counts[axis]]
                                 : double(float(low + wide * (double(random()) * 0x1p-32 * 1.2 - 0.1)));
        }
        compare_skies(file, maps.at(at), at, random, counts);
        if (testing::Test::HasFatalFailure()) return;
    }
    EXPECT_LT(counts.other_cells, 1e-3 * counts.samples);
    EXPECT_LT(counts.other_pdfs, 1e-3 * counts.samples);
}

TEST(ShaderMaps, SampleAsTheReaderDoes) {
    int maps = 0;
    each_golden_file([&](const std::vector<std::uint8_t>& bytes) {
        const WalkedFile file(bytes);
        if (file.file.kind() != ACDF_KIND_INDEXED) return;
        ++maps;
        compare_all_skies(file);
    });
    EXPECT_EQ(maps, 2);
}

/// Three axes mix eight maps.
TEST(ShaderMaps, MixEightMaps) {
    IndexedSpec spec;
    spec.axes = {{"a", 1, 0, 2, 0.0, 1.0}, {"b", 1, 0, 2, -5.0, 5.0}, {"c", 1, 0, 3, 1.0, 9.0}};
    spec.coordinates = {{0.0, 1.0}, {-5.0, 5.0}, {1.0, 3.0, 9.0}};
    spec.maps.clear();
    for (std::uint32_t i = 0; i < 12; ++i) {
        const float share = i < 4 ? 0.125f : 0.0625f, sign = i % 2 ? 0.6f : -0.6f;
        spec.maps.push_back(
            {share, i % 5 ? 0.25f : 0.0f, 0.1f + 0.02f * float(i), {sign, 0.0f, 0.8f}, {17 * i + 9, 250 - 20 * i}});
        if (i == 6) spec.maps.back() = {share, 0.0f, 0.0f, {0.0f, 0.0f, 0.0f}, {40, 90}};
    }
    for (const bool octahedral : {false, true}) {
        spec.octahedral = octahedral;
        compare_all_skies(WalkedFile(spec.encode()));
    }
}

TEST(ShaderMaps, ThatAreNoneHaveNoSky) {
    each_golden_file([&](const std::vector<std::uint8_t>& bytes) {
        const WalkedFile file(bytes);
        if (!file.status.ok() || file.file.kind() == ACDF_KIND_INDEXED) return;
        const AcdfShaderSky sky = acdf_sky_at(file.tables.words(), 1.0f, 2.0f, 3.0f);
        EXPECT_EQ(acdf_sky_sample(file.tables.words(), sky, 1, 2).pdf, 0.0f);
        EXPECT_EQ(acdf_sky_pdf(file.tables.words(), sky, 0.0f, 0.0f, 1.0f), 0.0f);
    });
}

/// Maps are no environment: whoever forgets coordinates gets nothing.
TEST(ShaderMaps, HaveNothingWithoutCoordinates) {
    const WalkedFile file(IndexedSpec().encode());
    ASSERT_TRUE(file.status.ok());
    const std::uint32_t* words = file.tables.words();
    EXPECT_EQ(acdf_walk_sample(words, acdf_point_anywhere(words), 1, 2).pdf, 0.0f);
    EXPECT_EQ(acdf_walk_pdf(words, acdf_point_at(words, 0.0f, 0.0f, 1.0f), 0.0f, 0.0f, 1.0f), 0.0f);
}

} // namespace
