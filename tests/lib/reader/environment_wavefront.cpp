// Environments many times at once: the same bits as one by one, on frozen files and random trees.
#include "tests/lib/reader/random.h"

#include <acdf/wavefront.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace acdf_test;

constexpr acdf::Instructions kAll[] = {acdf::Instructions::none, acdf::Instructions::avx2,
                                       acdf::Instructions::avx512};

/// Random numbers and directions: likely ones, those at ends and seams, and such as are refused.
struct Asked {
    std::vector<double> u;
    std::vector<float> w;

    explicit Asked(std::size_t count) : u(2 * count), w(3 * count) {
        std::mt19937_64 random(11);
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        const double infinity = std::numeric_limits<double>::infinity();
        const double ends[] = {0.0,           1.0,      -1.0,         0.5,      2.0,
                               1.0 - 0x1p-53, 0x1p-149, std::nan(""), infinity, -infinity};
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t k = 0; k < 2; ++k)
                u[2 * i + k] = i % 17 == 5 * k ? ends[random() % std::size(ends)] : uniform(random);
            const double z = i % 13 == 2 ? 1.0 - std::exp(-30.0 * uniform(random)) : 2.0 * uniform(random) - 1.0;
            const double phi = i % 7 == 3 ? M_PI_4 * static_cast<double>(random() % 8) : 7.0 * uniform(random);
            const double sine = std::sqrt((1.0 - z) * (1.0 + z));
            w[3 * i] = static_cast<float>(sine * std::cos(phi));
            w[3 * i + 1] = static_cast<float>(sine * std::sin(phi));
            w[3 * i + 2] = static_cast<float>(i % 2 ? z : -z);
            if (i % 29 == 4) w[3 * i + i % 3] = static_cast<float>(ends[random() % std::size(ends)]);
            if (i % 31 == 6) std::memset(&w[3 * i], 0, 3 * sizeof(float));
        }
    }
    const double (*numbers() const)[2] { return reinterpret_cast<const double(*)[2]>(u.data()); }
    const float (*directions() const)[3] { return reinterpret_cast<const float(*)[3]>(w.data()); }
};

void expect_the_view(const acdf::EnvironmentView& view, std::size_t count, acdf::Instructions most) {
    SCOPED_TRACE(std::to_string(count) + " at once, instructions up to " + std::to_string(int(most)));
    const acdf::EnvironmentWavefront wavefront(view, most);
    EXPECT_LE(wavefront.instructions(), most);
    const Asked asked(count);
    // One more than is asked for: that must stay what it is.
    std::vector<acdf::DirectionSample> samples(count + 1, {{7.0f, 7.0f, 7.0f}, 7.0f});
    std::vector<float> pdfs(count + 1, 7.0f);
    wavefront.sample(asked.numbers(), count, samples.data());
    wavefront.pdf(asked.directions(), count, pdfs.data());
    for (std::size_t i = 0; i < count; ++i) {
        const acdf::DirectionSample s = view.sample(asked.u[2 * i], asked.u[2 * i + 1]);
        ASSERT_EQ(std::memcmp(&s, &samples[i], sizeof s), 0) << i;
        const float pdf = view.pdf(&asked.w[3 * i]);
        ASSERT_EQ(std::memcmp(&pdf, &pdfs[i], sizeof pdf), 0) << i;
    }
    EXPECT_EQ(samples[count].pdf, 7.0f);
    EXPECT_EQ(pdfs[count], 7.0f);
}

void expect_the_view(const std::vector<std::uint8_t>& bytes, std::size_t count) {
    acdf::File file;
    ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file).ok());
    if (file.kind() != ACDF_KIND_ENVIRONMENT) return;
    for (const acdf::Instructions most : kAll) expect_the_view(file.environment(), count, most);
}

TEST(EnvironmentWavefront, IsTheViewOnGoldenFiles) {
    for (const auto& entry : std::filesystem::directory_iterator(ACDF_TEST_DIR "/golden/v1.0")) {
        if (entry.path().extension() != ".acdf") continue;
        SCOPED_TRACE(entry.path().filename());
        std::ifstream in(entry.path(), std::ios::binary);
        for (const std::size_t count : {0u, 1u, 31u, 32u, 33u, 2000u})
            expect_the_view({std::istreambuf_iterator<char>(in), {}}, count), in.seekg(0);
        if (HasFatalFailure()) return;
    }
}

TEST(EnvironmentWavefront, IsTheViewOnRandomTrees) {
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
        RandomOptions options = varied_options(seed);
        options.tilts = seed % 10 == 0;
        options.octahedral = seed % 3 == 1;
        SCOPED_TRACE(seed);
        expect_the_view(RandomTree(seed, options).make().encode(), 500);
        if (HasFatalFailure()) return;
    }
}

void expect_vectors(bool octahedral) {
    RandomOptions options;
    options.tilts = false;
    options.octahedral = octahedral;
    const auto bytes = RandomTree(1, options).make().encode();
    acdf::LoadOptions plain;
    plain.tables = false;
    acdf::File file, walked;
    ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file).ok());
    ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), walked, plain).ok());
    ASSERT_GT(file.table_bytes(), 0u);
    EXPECT_EQ(acdf::EnvironmentWavefront(walked.environment()).instructions(), acdf::Instructions::none);
    EXPECT_EQ(acdf::EnvironmentWavefront().instructions(), acdf::Instructions::none);
#if defined(__x86_64__)
    EXPECT_EQ(acdf::EnvironmentWavefront(file.environment()).instructions() != acdf::Instructions::none,
              __builtin_cpu_supports("avx2") != 0);
#endif
}
TEST(EnvironmentWavefront, ServesByVectorsWhatHasTables) {
    expect_vectors(false);
    expect_vectors(true);
}

} // namespace
