// How many cells lie below the curves of a tree: counted while the file is checked, where its tree lies in
// preorder, by a traversal of the tree elsewhere, and here one by one.
#include "tests/extremes/targets.h"
#include "tests/lib/compress/checks.h"
#include "tests/lib/reader/golden_files.h"
#include "tests/lib/reader/random.h"

#include "compress/store/store.h"
#include "reader/check/check.h"
#include "reader/memory.h"
#include "reader/tables/tree_survey.h"

#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using namespace acdf_test;
using acdf::TreeSurvey;

/// A file of an environment, and the survey that its check makes of its tree.
class Checked {
public:
    explicit Checked(const std::vector<std::uint8_t>& bytes) {
        acdf::LoadOptions options;
        options.tables = false;
        EXPECT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file_, options).ok());
        acdf::Parts parts;
        parts.survey = &survey_;
        acdf::check(bytes.data(), bytes.size(), options.limits, nullptr, nullptr, parts);
        acdf::give_block({}, parts.inflated);
    }

    AcdfEnvironment environment() const { return file_.environment().data(); }
    std::uint32_t units() const { return file_.tree_units(); }
    const TreeSurvey& survey() const { return survey_; }

private:
    acdf::File file_;
    TreeSurvey survey_;
};

/// Expects that surveys agree with what lies below the curve at `at`, and below those below it. Returns how many
/// cells there are.
std::uint64_t expect_cells(const AcdfEnvironment& environment, std::uint32_t at,
                           const std::vector<const TreeSurvey*>& surveys) {
    const AcdfCurve curve = acdf_curve_at(environment.tree, at);
    std::uint64_t cells = 0;
    for (std::uint32_t i = 0; i < curve.segments; ++i) {
        const std::uint32_t link = curve.links ? acdf_curve_link(&curve, i) : 0;
        cells += link == 0 ? 1 : expect_cells(environment, at + link, surveys);
    }
    for (const TreeSurvey* survey : surveys)
        EXPECT_EQ(std::min<std::uint64_t>(survey->cells(at, curve.header), TreeSurvey::kMany),
                  std::min<std::uint64_t>(cells, TreeSurvey::kMany))
            << "curve at " << at;
    return cells;
}

struct Made {
    int by_check = 0, by_walk = 0;
};

/// Of an environment file without an error.
void compare(const std::vector<std::uint8_t>& bytes, Made& made) {
    const Checked checked(bytes);
    const AcdfEnvironment environment = checked.environment();
    if (!environment.tree) return; // halvings
    const TreeSurvey walked(environment, checked.units());
    std::vector<const TreeSurvey*> surveys;
    if (walked.done()) surveys.push_back(&walked);
    if (checked.survey().done()) {
        ASSERT_TRUE(walked.done()) << "the check surveyed what the walk did not";
        surveys.push_back(&checked.survey());
        EXPECT_EQ(checked.survey().most_steps(), walked.most_steps());
    }
    if (surveys.empty()) return;
    const std::uint64_t cells = expect_cells(environment, environment.root, surveys);
    for (const TreeSurvey* survey : surveys) EXPECT_EQ(survey->cells(), cells);
    made.by_check += checked.survey().done();
    ++made.by_walk;
}

TEST(TreeSurvey, OfGoldenFiles) {
    Made made;
    each_golden_file([&](const std::vector<std::uint8_t>& bytes) {
        acdf::File file;
        ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file).ok());
        if (file.kind() == ACDF_KIND_ENVIRONMENT) compare(bytes, made);
    });
    EXPECT_GT(made.by_check, 5);
    EXPECT_GT(made.by_walk, made.by_check) << "some share curves";
}

// Shared curves, curves in any order, tilts, every width of every array.
TEST(TreeSurvey, OfRandomTrees) {
    Made made;
    for (std::uint32_t seed = 0; seed < 400; ++seed) {
        RandomOptions options = varied_options(seed);
        options.tilts = seed % 10 == 0;
        options.octahedral = seed % 7 < 3;
        SCOPED_TRACE(seed);
        compare(RandomTree(seed, options).make().encode(), made);
    }
    EXPECT_GT(made.by_check, 20);
    EXPECT_GT(made.by_walk, made.by_check) << "trees in another order are walked";
}

class TreeSurveyOf : public testing::TestWithParam<NamedTarget> {};

TEST_P(TreeSurveyOf, EveryFit) {
    for (const NamedFit& fit : all_fits(9, 7, 60)) {
        SCOPED_TRACE(fit.name);
        const acdf::compress::Target& target = GetParam().target;
        auto description =
            acdf::compress::environment_description(target.columns, target.rows, target.parameterization);
        description.fit = fit.options.fit;
        description.total = acdf::compress::integral(target);
        Made made;
        compare(acdf::compress::store(acdf::compress::fit(target, fit.options).tree, description), made);
        EXPECT_EQ(made.by_check, made.by_walk) << "trees as they are written lie in preorder";
    }
}
INSTANTIATE_TEST_SUITE_P(Probes, TreeSurveyOf, testing::ValuesIn(extreme_targets()),
                         [](const auto& info) { return info.param.name; });
INSTANTIATE_TEST_SUITE_P(Octahedral, TreeSurveyOf, testing::ValuesIn(octahedral_extremes()),
                         [](const auto& info) { return info.param.name; });

} // namespace
