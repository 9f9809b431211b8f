// Environments many times at once: the same bits as one by one, on frozen files and random trees.
#include "tests/lib/reader/random.h"
#include "tests/lib/reader/tables/grouped.h"

#include <acdf/wavefront.h>

#include <gtest/gtest.h>

#include <algorithm>
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

/// Random numbers and directions: likely ones, those at ends, borders and seams, and such as are refused. Arrays
/// begin wherever elements may.
struct Asked {
    std::vector<double> all_u;
    std::vector<float> all_w;
    double* const u;
    float* const w;

    explicit Asked(std::size_t count)
        : all_u(2 * count + 1), all_w(3 * count + 1), u(all_u.data() + 1), w(all_w.data() + 1) {
        std::mt19937_64 random(11);
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        const double infinity = std::numeric_limits<double>::infinity();
        const double ends[] = {0.0,           1.0,      -1.0,         0.5,      2.0,      1.0 - 0x1p-24,
                               1.0 - 0x1p-53, 0x1p-149, std::nan(""), infinity, -infinity};
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t k = 0; k < 2; ++k)
                u[2 * i + k] = i % 17 == 5 * k ? ends[random() % std::size(ends)]
                               : i % 11 == 4   ? static_cast<double>(random() % 65536) / (i % 2 ? 65535.0 : 65536.0)
                                               : uniform(random);
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
    const double (*numbers() const)[2] { return reinterpret_cast<const double(*)[2]>(u); }
    const float (*directions() const)[3] { return reinterpret_cast<const float(*)[3]>(w); }
};

void expect_the_view(const acdf::EnvironmentView& view, std::size_t count, acdf::Instructions most) {
    SCOPED_TRACE(std::to_string(count) + " at once, instructions up to " + std::to_string(int(most)));
    const acdf::EnvironmentWavefront wavefront(view, most);
    EXPECT_LE(wavefront.instructions(), most);
    const Asked asked(count);
    // One more than is asked for: that must stay what it is. Samples begin where no vector does.
    std::vector<float> drawn(4 * (count + 1) + 1, 7.0f), pdfs(count + 1, 7.0f);
    auto* const samples = reinterpret_cast<acdf::DirectionSample*>(drawn.data() + 1);
    wavefront.sample(asked.numbers(), count, samples);
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

Grouped grouped(const acdf::File& file, bool least) {
    return Grouped(file.environment().data(), file.tree_units(), 8 * file.size() + (1u << 20), least);
}

/// By groups, and by as large ones as there may be. Returns by how many of these.
int expect_the_view_by_groups(const std::vector<std::uint8_t>& bytes, std::size_t count) {
    int with_groups = 0;
    acdf::File file;
    EXPECT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file).ok());
    for (const bool least : {false, true}) {
        if (file.kind() != ACDF_KIND_ENVIRONMENT) break;
        const Grouped groups = grouped(file, least);
        if (!groups.data.groups) continue;
        ++with_groups;
        for (const acdf::Instructions most : kAll) expect_the_view(acdf::EnvironmentView(groups.data), count, most);
    }
    return with_groups;
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
        const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
        for (const std::size_t count : {0u, 1u, 31u, 32u, 33u, 2000u}) {
            expect_the_view(bytes, count);
            expect_the_view_by_groups(bytes, count);
        }
        if (HasFatalFailure()) return;
    }
}

TEST(EnvironmentWavefront, IsTheViewOnRandomTrees) {
    int with_groups = 0;
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
        RandomOptions options = varied_options(seed);
        options.tilts = seed % 10 == 0;
        options.octahedral = seed % 3 == 1;
        SCOPED_TRACE(seed);
        const std::vector<std::uint8_t> bytes = RandomTree(seed, options).make().encode();
        expect_the_view(bytes, 500);
        with_groups += expect_the_view_by_groups(bytes, 500);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(with_groups, 50);
}

// Groups of several blocks of cells, and of one.
TEST(EnvironmentWavefront, IsTheViewByGroupsOfAnySize) {
    for (const bool octahedral : {false, true}) {
        RandomOptions options;
        options.columns = 1024;
        options.rows = 256;
        options.depth = 7;
        options.end = 0.1;
        options.tilts = false;
        options.octahedral = octahedral;
        const std::vector<std::uint8_t> bytes = RandomTree(4, options).make().encode();
        acdf::File file;
        ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file).ok());
        const Grouped large = grouped(file, true);
        const AcdfGroups* const groups = large.data.groups;
        ASSERT_NE(groups, nullptr);
        std::uint32_t most = 0, least = ~0u;
        for (std::uint32_t cells = 0, i = 0; cells < groups->count; ++i) {
            const std::uint32_t count = acdf_group_at(groups, i, 0u)->count;
            cells += count;
            most = std::max(most, count);
            least = std::min(least, count);
        }
        EXPECT_GT(most, 2u * ACDF_BLOCK_CELLS);
        EXPECT_EQ(least, 1u);
        EXPECT_EQ(expect_the_view_by_groups(bytes, 20000), 2);
    }
}

bool has_vectors(const acdf::EnvironmentView& view) {
    return acdf::EnvironmentWavefront(view).instructions() != acdf::Instructions::none;
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
    EXPECT_FALSE(has_vectors(walked.environment()));
    EXPECT_EQ(acdf::EnvironmentWavefront().instructions(), acdf::Instructions::none);
#if defined(__x86_64__)
    const bool avx2 = __builtin_cpu_supports("avx2") != 0;
    EXPECT_EQ(has_vectors(file.environment()), avx2);
    EXPECT_EQ(has_vectors(acdf::EnvironmentView(grouped(file, false).data)), avx2);
#endif
}
TEST(EnvironmentWavefront, ServesByVectorsWhatHasTables) {
    expect_vectors(false);
    expect_vectors(true);
}

} // namespace
