// Batches of environments give the bits of single calls, with each set of instructions.
#include "tests/lib/batch/batches.h"
#include "tests/lib/reader/environment_pair.h"
#include "tests/lib/reader/golden_files.h"
#include "tests/lib/reader/random_halvings.h"

#include <acdf/batch/batch.h>
#include <acdf/curves/curves.h>

namespace batch_test {
namespace {

void expect_same_samples(const acdf::EnvironmentView& view, const std::vector<Pair>& u) {
    Results single(u.size()), batch(u.size());
    for (std::size_t i = 0; i < u.size(); ++i) {
        const acdf::DirectionSample one = view.sample(u[i][0], u[i][1]);
        single.set(i, one.direction, one.pdf);
    }
    acdf::sample_batch(view, array_of(u), u.size(), batch.directions(), batch.pdfs());
    EXPECT_TRUE(single == batch) << u.size();
}

void expect_same_pdfs(const acdf::EnvironmentView& view, const std::vector<Vector>& w) {
    Results single(w.size()), batch(w.size());
    for (std::size_t i = 0; i < w.size(); ++i) single.pdfs()[i] = view.pdf(w[i].data());
    acdf::pdf_batch(view, array_of(w), w.size(), batch.pdfs());
    EXPECT_TRUE(single == batch) << w.size();
}

/// Directions of samples, and on borders of the grid, or beside them by what rounding may do.
std::vector<Vector> near_borders(const acdf::EnvironmentView& view, std::size_t count) {
    const AcdfGrid grid = acdf_environment_grid(&view.data());
    std::mt19937_64 random(3);
    std::vector<Vector> out(count);
    for (std::size_t i = 0; i < count; ++i) {
        const int axis = static_cast<int>(i % 2);
        const double off =
            (acdf_test::uniform(random) - 0.5) * std::exp2(-18.0 - 12.0 * acdf_test::uniform(random));
        const auto step = static_cast<std::uint32_t>(random() % (axis == 0 ? grid.columns : grid.rows));
        acdf_test::direction_at_border(grid, axis, step, i % 3 == 0 ? 0.0 : off, acdf_test::uniform(random),
                                       out[i].data());
        if (i % 5 == 0) {
            const auto sample = view.sample(acdf_test::uniform(random), acdf_test::uniform(random));
            std::memcpy(out[i].data(), sample.direction, sizeof(Vector));
        }
    }
    return out;
}

void expect_same(const acdf::EnvironmentView& view, std::size_t count) {
    expect_same_samples(view, numbers(count, 1));
    expect_same_pdfs(view, directions(count, 2));
    expect_same_pdfs(view, near_borders(view, count));
}

TEST(EnvironmentBatch, GivesTheBitsOfSingleCallsOfGoldenFiles) {
    acdf_test::each_golden_file([](const std::vector<std::uint8_t>& bytes) {
        for (const bool tables : {true, false}) {
            acdf::LoadOptions options;
            options.tables = tables;
            acdf::File file;
            ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves(options)).ok());
            if (file.kind() == ACDF_KIND_ENVIRONMENT)
                with_each_target([&] { expect_same(file.environment(), 3000); });
        }
    });
}

// Deep trees and narrow cells, of no probability, too, on both grids.
TEST(EnvironmentBatch, GivesTheBitsOfSingleCallsOfRandomTrees) {
    for (std::uint32_t seed = 0; seed < 24; ++seed) {
        SCOPED_TRACE(seed);
        acdf_test::RandomOptions options = acdf_test::varied_options(seed, 65536);
        options.octahedral = seed % 2 == 1;
        options.depth = 4 + static_cast<int>(seed % 7);
        const acdf_test::EnvironmentPair pair(acdf_test::RandomHalvings(seed, options).make().encode());
        with_each_target([&] {
            expect_same(pair.view(), 2000);
            expect_same(pair.plain.environment(), 500);
        });
        if (testing::Test::HasFailure()) return;
    }
}

TEST(EnvironmentBatch, TakesAnyNumberOfCalls) {
    for (const bool octahedral : {false, true}) {
        acdf_test::RandomOptions options;
        options.octahedral = octahedral;
        const acdf_test::EnvironmentPair pair(acdf_test::RandomHalvings(5, options).make().encode());
        with_each_target([&] {
            for (const std::size_t count : lengths()) expect_same(pair.view(), count);
        });
    }
}

} // namespace
} // namespace batch_test
