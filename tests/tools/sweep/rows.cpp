// Rows of sweeps of local and BRDF files.
#include "build/own_terms.h"
#include "input/brdf/brdf.h"
#include "tests/inputs/nearest_lookup.h"
#include "tests/inputs/synthetic.h"
#include "tools/sweep/sweep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

namespace acdf::tools {
namespace {

SweepOptions small_sweep() {
    SweepOptions options;
    options.budgets = {16384};
    options.fits = {"variance"};
    options.timing = false;
    options.pictures = false;
    options.normals = 4;
    options.views = 2;
    options.seeds = 4;
    return options;
}

TEST(SweepRows, LocalFilesBesideTheirBaselines) {
    const compress::Target target = acdf_test::noise_target(64, 32, 7);
    SweepOptions options = small_sweep();
    const Sweep sweep = sweep_local(builder::target_of(target, acdf::test::nearest_lookup()), {}, options);
    std::map<std::string, const SweepRow*> by;
    for (const SweepRow& r : sweep.rows) by[r.system] = &r;
    ASSERT_EQ(by.size(), 8u);
    EXPECT_LT(by["acdf"]->relative_variance, 0.2 * by["full_cdf"]->relative_variance);
    EXPECT_NEAR(by["resampling_32"]->relative_variance, by["full_cdf"]->relative_variance / 32.0, 1e-12);
    EXPECT_LT(by["cdf_cosine"]->relative_variance, by["full_cdf"]->relative_variance);
    for (const SweepRow& r : sweep.rows) {
        EXPECT_LE(r.relative_variance, r.worst) << r.label;
        EXPECT_LE(r.median, r.worst) << r.label;
        const bool own_numbers = r.system == "resampling_32";
        EXPECT_EQ(r.sobol == r.sobol, !own_numbers) << r.label;
    }
    EXPECT_LT(by["full_cdf"]->sobol, 0.8 * by["full_cdf"]->relative_variance);
    EXPECT_LT(by["acdf"]->sobol, by["full_cdf"]->sobol);
}

// A set of a single point is uniform: then sampled variances are those of the sums.
TEST(SweepRows, SobolOfOneSampleIsThatOfTheSums) {
    SweepOptions options = small_sweep();
    options.visible.spp = 1;
    options.seeds = 2000;
    const compress::Target target = acdf_test::noise_target(64, 32, 7);
    for (const SweepRow& r :
         sweep_local(builder::target_of(target, acdf::test::nearest_lookup()), {}, options).rows)
        if (r.relative_variance > 0.1 && r.system != "resampling_32") {
            EXPECT_NEAR(r.sobol, r.relative_variance, 0.1 * r.relative_variance) << r.label;
        }
}

TEST(SweepRows, OfABrdf) {
    const auto brdf = input::open_brdf("ggx:alpha=0.3");
    SweepOptions options = small_sweep();
    options.visible.spp = 1; // uniform numbers, as above; samples that are lost below the surface count
    options.seeds = 3000;
    const Sweep sweep = sweep_brdf(*brdf, options);
    std::map<std::string, const SweepRow*> by;
    for (const SweepRow& r : sweep.rows) by[r.system] = &r;
    EXPECT_EQ(sweep.rows[sweep.reference].system, "full_table");
    EXPECT_LT(by["acdf"]->relative_variance, by["cosine"]->relative_variance);
    EXPECT_LT(by["full_table"]->relative_variance, by["cosine"]->relative_variance);
    EXPECT_GT(by["full_table"]->bytes, 60000000u);
    for (const SweepRow& r : sweep.rows) {
        EXPECT_LE(r.median, r.worst) << r.label;
        EXPECT_EQ(r.sobol == r.sobol, std::isfinite(r.relative_variance)) << r.label; // not where it is biased
        if (r.sobol == r.sobol) { // the file is measured over more views than two
            EXPECT_NEAR(r.sobol, r.relative_variance, (r.ours() ? 0.5 : 0.15) * r.relative_variance) << r.label;
        }
    }
}

} // namespace
} // namespace acdf::tools
