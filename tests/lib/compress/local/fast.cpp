// The fast shape of local environment maps: what fits of it must do. Its pdf is tested with that of other maps.
#include "build/accuracy/local.h"
#include "tests/inputs/local_maps.h"
#include "tests/inputs/sanitized.h"

#include <gtest/gtest.h>

#include <tbb/global_control.h>

using namespace acdf_test;

namespace {

using namespace acdf::compress;

LocalFileOptions shaped(LocalShape shape, std::uint32_t tiles, std::uint64_t bytes) {
    LocalFileOptions options;
    options.size = {tiles, bytes};
    options.size.shape = shape;
    return options;
}

TEST(FastShape, TheSameBytesForAnyNumberOfThreads) {
    const Target target = suns_target(128, 64);
    std::vector<std::uint8_t> first;
    for (const std::size_t threads : {1u, 2u, 7u}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const auto bytes = local_bytes(target, octahedral_bins(3), shaped(LocalShape::fast, 120, 6000));
        if (first.empty()) first = bytes;
        EXPECT_EQ(bytes, first) << threads;
    }
}

double variance(const Target& target, LocalShape shape, std::uint32_t tiles, std::uint64_t bytes) {
    const LocalMap map(target, octahedral_bins(5), shaped(shape, tiles, bytes));
    const auto accuracy =
        acdf::build::summary(acdf::build::measure_normals(map.file, target, acdf::build::random_normals(64)));
    EXPECT_EQ(accuracy.support_violations, 0u);
    return accuracy.relative_variance;
}

/// With as many tiles, and what is in them as fine as it can be, rounding to steps is what differs.
TEST(FastShape, IsNearlyAsAccurateAsTheSmallOne) {
    ACDF_NOT_SANITIZED();
    for (const Target& target : {suns_target(256, 128), octahedral(suns_target(128, 128))}) {
        const double small = variance(target, LocalShape::small, 300, 30000);
        const double fast = variance(target, LocalShape::fast, 300, 60000);
        EXPECT_LT(fast, 2.0 * small);
    }
}

TEST(FastShape, ATreeServesNormalsWhoseBinsAreNotStored) {
    NormalBins bins = octahedral_bins(4);
    weigh(bins, {{{0.1f, 0.2f, 0.9f}, 1.0}});
    const Target target = suns_target(128, 64);
    const LocalMap map(target, bins, shaped(LocalShape::fast, 60, 3000));
    EXPECT_GT(map.file.tree_units(), 100u);
    const auto accuracy =
        acdf::build::summary(acdf::build::measure_normals(map.file, target, {{0.0f, 0.0f, -1.0f}}));
    EXPECT_LT(accuracy.relative_variance, 1.2 * accuracy.relative_variance_full_cdf);
}

TEST(FastShape, RefusesAPartnerAndBoundsOnWeights) {
    LocalSize size;
    size.shape = LocalShape::fast;
    const Target target = suns_target(32, 16);
    EXPECT_THROW(fit_local(target, octahedral_bins(2), size, {}, {ACDF_PARTNER_COSINE}), std::invalid_argument);
    size.max_weight = 10.0;
    EXPECT_THROW(fit_local(target, octahedral_bins(2), size), std::invalid_argument);
}

} // namespace
