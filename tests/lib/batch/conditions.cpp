// Batches of local environments and of BRDFs give the bits of single calls, with each set of instructions, for
// normals or views that serve one call each, or several.
#include "tests/lib/batch/batches.h"
#include "tests/lib/reader/brdf_loaded.h"
#include "tests/lib/reader/golden_files.h"
#include "tests/lib/reader/local_loaded.h"

#include <acdf/batch/batch.h>
#include <acdf/curves/curves.h>

#include <algorithm>

namespace batch_test {
namespace {

/// Normals or views: any, and those on the borders of bins.
std::vector<Vector> conditions(std::size_t count, bool above) {
    std::vector<Vector> out = directions(count, 7);
    std::mt19937_64 random(8);
    for (Vector& v : out) {
        if (random() % 8 == 0)
            for (float& x : v) x = static_cast<float>(static_cast<int>(random() % 9) - 4);
        if (above && random() % 16 != 0) v[2] = std::fabs(v[2]);
    }
    return out;
}

template <class View>
void expect_same(const View& view, bool above, std::size_t each, std::size_t count) {
    const std::vector<Vector> at = conditions(count / each + 1, above), given = directions(count, 2);
    const std::vector<Pair> u = numbers(count, 1);
    Results single(count), batch(count), single_pdfs(count), batch_pdfs(count), pdfs_of_samples(count),
        again(count);
    for (std::size_t i = 0; i < count; ++i) {
        const acdf::DirectionSample one = view.sample(at[i / each].data(), u[i][0], u[i][1]);
        single.set(i, one.direction, one.pdf);
        single_pdfs.pdfs()[i] = view.pdf(at[i / each].data(), given[i].data());
        pdfs_of_samples.pdfs()[i] = view.pdf(at[i / each].data(), one.direction);
    }
    acdf::sample_batch(view, array_of(at), each, array_of(u), count, batch.directions(), batch.pdfs());
    EXPECT_TRUE(single == batch) << count << " samples, of " << each;
    acdf::pdf_batch(view, array_of(at), each, array_of(given), count, batch_pdfs.pdfs());
    EXPECT_TRUE(single_pdfs == batch_pdfs) << count << " pdfs, of " << each;
    acdf::pdf_batch(view, array_of(at), each, single.directions(), count, again.pdfs());
    EXPECT_TRUE(pdfs_of_samples == again) << count << " pdfs of samples, of " << each;
}

template <class View>
void expect_same(const View& view, bool above) {
    with_each_target([&] {
        for (const std::size_t each : {std::size_t{1}, std::size_t{5}, std::size_t{200}})
            expect_same(view, above, each, 1500);
    });
}

void expect_same(const acdf::File& file) {
    if (file.kind() == ACDF_KIND_LOCAL) expect_same(file.local(), false);
    if (file.kind() == ACDF_KIND_BRDF) expect_same(file.brdf(), true);
}

TEST(ConditionBatch, GivesTheBitsOfSingleCallsOfGoldenFiles) {
    acdf_test::each_golden_file([](const std::vector<std::uint8_t>& bytes) {
        for (const bool tables : {true, false}) {
            acdf::LoadOptions options;
            options.tables = tables;
            acdf::File file;
            ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves(options)).ok());
            expect_same(file);
        }
    });
}

TEST(ConditionBatch, GivesTheBitsOfSingleCallsOfRandomNormals) {
    for (std::uint32_t seed = 0; seed < 24 && !testing::Test::HasFailure(); ++seed) {
        SCOPED_TRACE(seed);
        acdf_test::NormalsSpec spec = acdf_test::random_normals(seed);
        if (seed % 4 == 1) spec.cosine_share = 0.25f;
        if (seed % 4 == 2) {
            spec.subdivisions = 9;
            while (spec.bins.size() < 4 * 9 * 9 + 2) spec.bins.push_back(spec.bins[spec.bins.size() / 2]);
        }
        expect_same(acdf_test::LoadedLocal(spec).file);
    }
}

TEST(ConditionBatch, GivesTheBitsOfSingleCallsOfRandomBrdfs) {
    for (std::uint32_t seed = 0; seed < 24 && !testing::Test::HasFailure(); ++seed) {
        SCOPED_TRACE(seed);
        expect_same(acdf_test::Loaded(acdf_test::random_brdf(seed).encode()).file);
    }
}

TEST(ConditionBatch, TakesAnyNumberOfCalls) {
    const acdf_test::LoadedLocal local(acdf_test::random_normals(2));
    const acdf_test::Loaded brdf(acdf_test::random_brdf(2).encode());
    with_each_target([&] {
        for (const std::size_t count : lengths())
            for (const std::size_t each : {std::size_t{1}, std::size_t{3}, std::max<std::size_t>(count, 1)}) {
                expect_same(local.view(), false, each, count);
                expect_same(brdf.view(), true, each, count);
            }
    });
}

} // namespace
} // namespace batch_test
