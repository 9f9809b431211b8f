// Local environments many times at once, of a normal each or at one point: the same bits as one by one, with each
// set of instructions, on frozen and random files of both grids, with and without runtime tables.
#include "tests/inputs/sanitized.h"
#include "tests/lib/reader/golden_files.h"
#include "tests/lib/reader/local_fast_random.h"
#include "tests/lib/reader/local_loaded.h"
#include "tests/lib/reader/local_random.h"
#include "tests/lib/reader/tables/no_pieces.h"

#include <acdf/batch/batch.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace acdf_test;

/// Normals, numbers and directions: likely ones, and such as are on edges or refused.
struct Queries {
    std::vector<float> normals, directions;
    std::vector<double> u;

    explicit Queries(std::size_t count) : normals(3 * count), directions(3 * count), u(2 * count) {
        std::mt19937_64 random(5);
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        const double infinity = std::numeric_limits<double>::infinity();
        const double ends[] = {0.0, 1.0, -0.0, 1.0 - 0x1p-53, 0x1p-149, std::nan(""), infinity, -infinity};
        const auto direction = [&](float* out) {
            const double z = 2.0 * uniform(random) - 1.0, phi = 6.3 * uniform(random), r = std::sqrt(1.0 - z * z);
            out[0] = static_cast<float>(r * std::cos(phi));
            out[1] = static_cast<float>(r * std::sin(phi));
            out[2] = static_cast<float>(z);
        };
        for (std::size_t i = 0; i < count; ++i) {
            direction(&normals[3 * i]);
            direction(&directions[3 * i]);
            for (std::size_t k = 0; k < 2; ++k)
                u[2 * i + k] = i % 19 == 7 * k ? 1.5 * double(i % 2) : uniform(random);
            if (i % 11 == 3) std::memcpy(&normals[3 * i], edge_normal(random).data(), 3 * sizeof(float));
            if (i % 23 == 4) normals[3 * i] = std::nanf("");
            if (i % 13 == 5) directions[3 * i + i % 3] *= 3.0f;
            if (i % 17 == 6) u[2 * i + i % 2] = ends[random() % std::size(ends)];
            if (i % 29 == 8) normals[3 * i + i % 3] = static_cast<float>(ends[random() % std::size(ends)]);
            if (i % 31 == 9) directions[3 * i + i % 3] = static_cast<float>(ends[random() % std::size(ends)]);
        }
    }
};

constexpr acdf::Instructions kEach[] = {acdf::Instructions::none, acdf::Instructions::avx2,
                                        acdf::Instructions::avx512};

void expect_one_point(const acdf::LocalEnvironmentView& view, const acdf::LocalBatch& batch,
                      const AcdfLocalPoint& point, const double (*u)[2], const float (*directions)[3],
                      std::size_t count) {
    std::vector<acdf::DirectionSample> samples(count + 1, {{7.0f, 7.0f, 7.0f}, 7.0f});
    std::vector<float> pdfs(count + 1, 7.0f);
    batch.sample(point, u, count, samples.data());
    batch.pdf(point, directions, count, pdfs.data());
    for (std::size_t i = 0; i < count; ++i) {
        const acdf::DirectionSample s = view.sample(point, u[i][0], u[i][1]);
        ASSERT_EQ(std::memcmp(&s, &samples[i], sizeof s), 0) << i;
        const float pdf = view.pdf(point, directions[i]);
        ASSERT_EQ(std::memcmp(&pdf, &pdfs[i], sizeof pdf), 0) << i;
    }
    EXPECT_EQ(samples[count].pdf, 7.0f);
    EXPECT_EQ(pdfs[count], 7.0f);
}

void expect_the_local_view(const acdf::LocalEnvironmentView& view, std::size_t count, acdf::Instructions most) {
    SCOPED_TRACE(std::to_string(count) + " at once, instructions up to " + std::to_string(int(most)));
    const acdf::LocalBatch batch(view, most);
    EXPECT_LE(batch.instructions(), most);
    const Queries asked(count);
    const auto* normals = reinterpret_cast<const float(*)[3]>(asked.normals.data());
    const auto* directions = reinterpret_cast<const float(*)[3]>(asked.directions.data());
    const auto* u = reinterpret_cast<const double(*)[2]>(asked.u.data());
    // One more than is asked for: that must stay what it is.
    std::vector<acdf::DirectionSample> samples(count + 1, {{7.0f, 7.0f, 7.0f}, 7.0f});
    std::vector<float> pdfs(count + 1, 7.0f);
    batch.sample(normals, u, count, samples.data());
    batch.pdf(normals, directions, count, pdfs.data());
    for (std::size_t i = 0; i < count; ++i) {
        const acdf::DirectionSample s = view.sample(normals[i], u[i][0], u[i][1]);
        ASSERT_EQ(std::memcmp(&s, &samples[i], sizeof s), 0) << i;
        const float pdf = view.pdf(normals[i], directions[i]),
                    at_a_point = view.pdf(view.at(normals[i]), directions[i]);
        ASSERT_EQ(std::memcmp(&pdf, &pdfs[i], sizeof pdf), 0) << i;
        ASSERT_EQ(std::memcmp(&pdf, &at_a_point, sizeof pdf), 0) << i;
    }
    EXPECT_EQ(samples[count].pdf, 7.0f);
    EXPECT_EQ(pdfs[count], 7.0f);
    for (std::size_t i = 0; i < count; i += 40)
        for (const std::size_t at_a_point : {i % 67, i % 131}) // one block, and several
            expect_one_point(view, batch, view.at(normals[i]), u + i, directions + i,
                             std::min(count - i, at_a_point));
}

void expect_the_local_view(const acdf::LocalEnvironmentView& view, std::size_t count) {
    for (const acdf::Instructions most : kEach) expect_the_local_view(view, count, most);
}

void expect_all(const acdf::File& file) {
    const acdf::LocalEnvironmentView view = file.local();
    const std::size_t many = acdf_test::kSanitized ? 150 : 700; // several blocks
    for (const std::size_t count :
         {std::size_t{0}, std::size_t{1}, std::size_t{5}, std::size_t{7}, std::size_t{64}, many})
        expect_the_local_view(view, count);
    if (!view.data().tables) return;
    const NoPieces large(view.data());
    expect_the_local_view(acdf::LocalEnvironmentView(large.local), many);
}

/// So many of some files are served by vectors.
void expect_vectors(int files) {
#if defined(__x86_64__)
    EXPECT_EQ(files > 5, __builtin_cpu_supports("avx2") != 0);
#endif
    (void)files;
}

TEST(LocalBatch, IsTheViewOnGoldenFiles) {
    int files = 0;
    each_golden_file([&](const Bytes& bytes) {
        acdf::File file;
        ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file).ok());
        if (file.kind() != ACDF_KIND_LOCAL) return;
        ++files;
        expect_all(file);
    });
    EXPECT_GE(files, 3);
}

TEST(LocalBatch, IsTheViewOnRandomFiles) {
    int with_tables = 0, by_vectors = 0;
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        RandomOptions options = varied_local_options(seed);
        options.octahedral = seed % 5 == 4;
        SCOPED_TRACE(seed);
        LocalSpec spec = RandomLocal(seed, options).make();
        if (seed % 4 > 0) spec.cosine_share = 0.0f; // vectors serve no others
        const LoadedLocal loaded(spec);
        with_tables += loaded.light().tables != nullptr;
        by_vectors += acdf::LocalBatch(loaded.file.local()).instructions() != acdf::Instructions::none;
        expect_all(loaded.file);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(with_tables, 15);
    expect_vectors(by_vectors);
}

TEST(LocalBatch, IsTheViewOnRandomFilesOfTheFastShape) {
    int by_vectors = 0;
    for (std::uint32_t seed = 0; seed < 30; ++seed) {
        SCOPED_TRACE(seed);
        LocalSpec spec = random_fast(seed);
        if (seed % 4 > 0) spec.cosine_share = 0.0f; // vectors serve no others
        const LoadedLocal loaded(spec);
        by_vectors += acdf::LocalBatch(loaded.file.local()).instructions() != acdf::Instructions::none;
        expect_all(loaded.file);
        if (HasFatalFailure()) return;
    }
    expect_vectors(by_vectors);
}

} // namespace
