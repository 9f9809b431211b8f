// Rows of sweeps of probes and BRDFs.
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
    options.timing = false;
    options.pictures = false;
    options.points = 6;
    options.views = 2;
    options.seeds = 4;
    return options;
}

TEST(SweepRows, FilesOfAllKindsBesideBaselines) {
    const compress::Target target = acdf_test::noise_target(64, 32, 7);
    const Sweep sweep =
        sweep_probe(builder::target_of(target, acdf::test::nearest_lookup()), {}, nullptr, small_sweep());
    std::map<std::string, const SweepRow*> by;
    for (const SweepRow& r : sweep.rows) by[r.ours() ? r.file : r.system] = &r;
    const auto noise = [&](const char* name, Estimator estimator) {
        return by.at(name)->noise[estimator][diffuse_open].exact;
    };
    EXPECT_LT(noise("local", light_alone), 0.2 * noise("full_cdf", light_alone));
    EXPECT_LT(noise("full_cdf", with_mis), noise("full_cdf", light_alone));
    EXPECT_LT(noise("local-mis", with_mis), noise("local", with_mis));
    EXPECT_LT(noise("env-mis", with_mis), noise("env", with_mis));
    for (const char* name : {"env-mis", "local-mis"}) {
        EXPECT_TRUE(by.at(name)->needs_mis) << name;
        EXPECT_TRUE(std::isinf(noise(name, light_alone))) << name;
    }
    const Noise& full = by.at("full_cdf")->noise[light_alone][diffuse_open];
    EXPECT_LT(full.sobol, 0.8 * full.exact);
}

TEST(SweepRows, OfABrdf) {
    const auto brdf = input::open_brdf("ggx:alpha=0.3");
    SweepOptions options = small_sweep();
    options.files = {"variance"};
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
