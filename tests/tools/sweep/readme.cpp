// The files that README.md advises, in a path tracer's estimate on real probes.
#include "tests/tools/sweep/advised.h"
#include "tools/sweep/files.h"
#include "tools/sweep/renderers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace acdf::tools {
namespace {

/// A row of the table: who asks, and what is advised.
struct Advised {
    RendererKind renderer;
    const FileKind* file = nullptr;
};

std::vector<Advised> advised_rows(const char* page) {
    std::vector<Advised> out;
    for (const std::vector<std::string>& cells : test::table_of(page, "Does it combine")) {
        if (cells[0] != "yes" && cells[0] != "no") continue;
        Advised one{{cells[0] == "yes", cells[1] == "yes" ? Given::normal : Given::nothing}};
        for (const FileKind& kind : file_kinds()) {
            const std::string command = std::string("acdf ") + kind.command + " PROBE";
            if (test::code_in(cells[2]) == command + (*kind.options ? " " : "") + kind.options) one.file = &kind;
        }
        out.push_back(one);
    }
    return out;
}

/// Files of one size, on a smaller probe: default sizes are for maps of 1024 x 512.
Sweep sweep_of(const std::string& probe, int columns, std::vector<std::string> files, std::uint64_t budget) {
    const input::Probe small = test::reduced_probe(probe, columns);
    builder::Pixels pixels;
    pixels.data = small.rgb.data();
    pixels.width = static_cast<std::uint32_t>(small.width);
    pixels.height = static_cast<std::uint32_t>(small.height);
    builder::Target target;
    EXPECT_TRUE(builder::Target::from(pixels, {}, target).ok());
    SweepOptions options;
    options.files = std::move(files);
    options.budgets = {budget};
    options.timing = options.pictures = false;
    options.points = 16;
    options.seeds = 2;
    return sweep_probe(target, {}, nullptr, options);
}

/// Of each row of the table, on how many probes the advised file has the least noise of all kinds of the same size.
std::map<std::string, int> wins(const std::vector<Advised>& rows) {
    std::map<std::string, int> out;
    for (const std::string& probe : test::six_probes) {
        const Sweep small = sweep_of(probe, 256, {"env", "env-mis"}, builder::DefaultBudget::environment);
        const Sweep large =
            sweep_of(probe, 128, {"env", "env-mis", "local", "local-mis"}, builder::DefaultBudget::local / 16);
        for (const Advised& row : rows) {
            const Sweep& sweep = row.renderer.given == Given::nothing ? small : large;
            std::string best;
            double least = HUGE_VAL, of_advised = HUGE_VAL;
            for (const SweepRow& each : sweep.rows) {
                if (!each.ours() || each.needs > row.renderer.given) continue;
                const double noise = case_mean(sweep, each, row.renderer.estimator()); // infinite where biased
                if (each.file == row.file->name) of_advised = noise;
                if (noise < least) {
                    least = noise;
                    best = each.file;
                }
            }
            EXPECT_TRUE(std::isfinite(of_advised)) << probe << ", " << to_string(row.renderer);
            out[to_string(row.renderer)] += best == row.file->name;
        }
    }
    return out;
}

TEST(ReadmeAdvice, HasTheLeastNoiseOnRealProbes) {
    const std::vector<Advised> rows = advised_rows("README.md");
    ASSERT_EQ(rows.size(), 4u);
    for (const Advised& row : rows) ASSERT_TRUE(row.file) << to_string(row.renderer) << " gets no known command";
    if (!test::probes_are_there()) GTEST_SKIP() << "six probes are absent; set ACDF_TEST_DATA";
    const std::map<std::string, int> won = wins(rows);
    EXPECT_EQ(won.size(), 4u);
    for (const auto& [renderer, count] : won) EXPECT_GE(count, 5) << renderer;
}

TEST(ReadmeAdvice, IsThatOfTheGuide) {
    const std::vector<Advised> readme = advised_rows("README.md"), guide = advised_rows("docs/guide.md");
    ASSERT_EQ(readme.size(), guide.size());
    for (std::size_t i = 0; i < readme.size(); ++i) {
        EXPECT_EQ(to_string(readme[i].renderer), to_string(guide[i].renderer));
        EXPECT_EQ(readme[i].file, guide[i].file);
    }
}

} // namespace
} // namespace acdf::tools
