// What a sweep recommends and writes, on made-up rows and on a tiny probe.
#include "build/environment.h"
#include "build/own_terms.h"
#include "measure/samplers/full_cdf.h"
#include "tests/inputs/nearest_lookup.h"
#include "tests/inputs/synthetic.h"
#include "tools/sweep/advice.h"
#include "tools/sweep/page.h"
#include "tools/sweep/page_chart.h"
#include "tools/sweep/sweep.h"
#include "tools/sweep/text.h"
#include "tools/sweep/timing.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>

namespace acdf::tools {
namespace {

SweepRow row(const char* system, const char* fit, std::uint64_t bytes, double variance,
             std::vector<double> sample = {}) {
    SweepRow out;
    out.system = system;
    out.fit = fit;
    out.label = *fit ? fit : system;
    out.options = *fit ? "--budget " + std::to_string(bytes) : "";
    out.bytes = bytes;
    out.relative_variance = variance;
    out.times.sample = std::move(sample);
    return out;
}

/// Two fits, and baselines of which one wins at equal time, one loses, one is even and one is biased.
Sweep made_up() {
    Sweep sweep;
    sweep.kind = SweepKind::local;
    sweep.source = "probe.exr";
    sweep.command = "acdf local probe.exr";
    sweep.output = "probe.local.acdf";
    sweep.conditions = 8;
    sweep.rows = {row("acdf", "variance", 4096, 0.1, {100, 100, 100, 100, 100, 100}),
                  row("acdf", "variance", 65536, 0.006, {100, 110, 90, 100, 100, 105}),
                  row("acdf", "variance", 262144, 0.001, {100, 100, 100, 100, 100, 100}),
                  row("acdf", "cdf", 131072, 0.005, {80, 80, 80, 80, 80, 80}),
                  row("full_cdf", "", 8000000, 2.0, {200, 220, 180, 200, 200, 210}),
                  row("fast", "", 9000000, 0.012, {20, 22, 18, 20, 20, 21}),
                  row("even", "", 0, 0.006, {90, 120, 90, 110, 95, 108}),
                  row("hole", "", 500, HUGE_VAL, {1, 1, 1, 1, 1, 1})};
    sweep.reference = 4;
    sweep.costs.shadow_ray_ns = 0.0;
    return sweep;
}

TEST(SweepAdvice, TheSmallestFileWhoseNoiseCannotBeSeen) {
    const Sweep sweep = made_up();
    const VisibleNoise v; // 1 % at 64 samples: at most 0.0064
    EXPECT_DOUBLE_EQ(v.largest_variance(), 0.0064);
    EXPECT_EQ(recommended_row(sweep.rows, v).row, 1u);
    EXPECT_TRUE(recommended_row(sweep.rows, v).reached);
    EXPECT_EQ(recommended_row(sweep.rows, {32, 0.01}).row, 2u);   // 0.0032
    EXPECT_EQ(recommended_row(sweep.rows, {56, 0.01}).row, 3u);   // 0.0056: the other fit is smaller
    EXPECT_EQ(recommended_row(sweep.rows, {2000, 0.01}).row, 0u); // 0.2
    const Recommended none = recommended_row(sweep.rows, {1, 0.01});
    EXPECT_EQ(none.row, 2u); // the least noisy
    EXPECT_FALSE(none.reached);
}

TEST(SweepAdvice, GoesBySobolPointsWhereAsked) {
    Sweep sweep = made_up();
    sweep.rows[0].sobol = 0.004;
    sweep.rows[1].sobol = 0.001;
    EXPECT_EQ(advise(sweep).recommended.row, 1u);
    sweep.numbers = measure::Numbers::sobol;
    const Advice advice = advise(sweep);
    EXPECT_EQ(advice.recommended.row, 0u);
    EXPECT_EQ(advice.sentence, "4 KiB reaches a relative variance of 0.004, 0.79 % noise at 64 samples per pixel "
                               "from a scrambled Sobol' sequence; beyond it you gain nothing visible.");
    EXPECT_NE(advice.rule.find("Sobol'"), std::string::npos) << advice.rule;
    EXPECT_NE(sweep_html(sweep).find("With a scrambled Sobol&#39; sequence"), std::string::npos);
}

TEST(SweepAdvice, SaysSoInWords) {
    Sweep sweep = made_up();
    Advice advice = advise(sweep);
    EXPECT_EQ(advice.sentence, "64 KiB reaches a relative variance of 0.006, 0.97 % noise at 64 samples per pixel; "
                               "beyond it you gain nothing visible.");
    EXPECT_EQ(advice.command, "acdf local probe.exr --budget 65536 -o probe.local.acdf");
    EXPECT_NE(advice.rule.find("0.0064"), std::string::npos) << advice.rule;
    sweep.visible.spp = 1;
    advice = advise(sweep);
    EXPECT_EQ(advice.sentence.rfind("No size tried gets below 1 % noise at 1 sample per pixel", 0), 0u)
        << advice.sentence;
    sweep = made_up();
    sweep.rows.erase(sweep.rows.begin() + 2, sweep.rows.begin() + 4);
    sweep.reference = 2;
    EXPECT_EQ(advise(sweep).sentence.rfind("64 KiB is enough", 0), 0u) << advise(sweep).sentence;
}

/// Three files of an environment: what the light itself says is wrong for pictures.
Sweep made_up_pictures() {
    Sweep sweep;
    sweep.kind = SweepKind::environment;
    sweep.source = "probe.exr";
    sweep.command = "acdf env probe.exr";
    sweep.output = "probe.acdf";
    sweep.conditions = 8;
    const auto add = [&](SweepRow one, std::array<double, kSituations> lit) {
        for (std::size_t i = 0; i < kSituations; ++i)
            one.lit[i] = {lit[i], 0.5 * lit[i], 2.0 * lit[i], 0.25 * lit[i]};
        one.times.pdf = one.times.sample;
        sweep.rows.push_back(std::move(one));
    };
    add(row("acdf", "variance", 4096, 0.1, {100, 100, 100, 100, 100, 100}), {4.0, 2.0, 6.0, 3.0});
    add(row("acdf", "variance", 65536, 0.004, {100, 110, 90, 100, 100, 105}), {3.8, 1.9, 5.9, 2.95});
    add(row("acdf", "variance", 262144, 0.0, {100, 100, 100, 100, 100, 100}), {3.75, 1.85, 5.85, 2.9});
    add(row("full_cdf", "", 8000000, 0.0, {200, 220, 180, 200, 200, 210}), {3.75, 1.85, 5.85, 2.9});
    add(row("mis_compensation", "", 8000000, HUGE_VAL, {200, 220, 180, 200, 200, 210}),
        {HUGE_VAL, 0.5, HUGE_VAL, 2.0});
    sweep.reference = 3;
    sweep.costs = {500.0, 20.0};
    return sweep;
}

TEST(SweepAdvice, PicturesDecideNotTheLightItself) {
    Sweep sweep = made_up_pictures();
    const auto recommended = [&] { return recommended_row(sweep.rows, sweep.visible, sweep.costs, sweep.numbers); };
    EXPECT_EQ(recommended().row, 0u); // sqrt(4 / 3.75) is 1.03
    EXPECT_FALSE(recommended().reached);
    sweep.rows[0].lit[hidden_partner].mean = 3.3; // sqrt(3.3 / 2.9) is 1.07, in one situation
    EXPECT_EQ(recommended().row, 1u);
    sweep.rows[1].lit[open_partner].mean = 2.2;
    EXPECT_EQ(recommended().row, 2u);
    sweep.numbers = measure::Numbers::sobol; // where they are given, those
    EXPECT_EQ(recommended().row, 0u);
    sweep = made_up_pictures();
    sweep.rows[1].times.sample.assign(6, 10.0); // faster by 15 % of all that a sample costs
    EXPECT_EQ(recommended().row, 1u);
    sweep.costs.shadow_ray_ns = 1e5; // then it does not matter
    EXPECT_EQ(recommended().row, 0u);
    sweep = made_up_pictures();
    for (Lit& lit : sweep.rows[2].lit) lit.mean = 0.006;
    EXPECT_EQ(recommended().row, 2u);
    EXPECT_TRUE(recommended().reached);
}

TEST(SweepAdvice, SaysWhatPicturesHave) {
    const Sweep sweep = made_up_pictures();
    const Advice advice = advise(sweep);
    EXPECT_EQ(
        advice.sentence,
        "4 KiB is enough: a diffuse surface has 25 % noise with it at 64 samples per pixel, and 24 % with the "
        "full_cdf; no other size or fit tried lowers it by more than 5 %.");
    ASSERT_EQ(advice.situations.size(), std::size_t{kSituations});
    EXPECT_EQ(advice.situations[open_alone].best_baseline, 3u);
    EXPECT_EQ(advice.situations[open_partner].best_baseline, 4u);
    const double cost = (0.5 * (200 + 200 + 20) + 500) / (0.5 * (100 + 100 + 20) + 500);
    EXPECT_NEAR(advice.situations[open_partner].over_best_baseline.value, 0.5 / 2.0 * cost, 1e-9);
    const std::string all = advice.situations[open_alone].sentence + advice.situations[open_partner].sentence;
    for (const char* part :
         {"50 %, 25 %, 12 % noise at 16, 64, 256 independent samples (median point: 35 %, 18 %, 8.8 %)",
          "12 % at 64 samples of a scrambled Sobol' sequence", "times less noise than the full_cdf",
          "times more noise than the best baseline, the mis_compensation"})
        EXPECT_NE(all.find(part), std::string::npos) << part << "\n" << all;
    const std::string html = sweep_html(sweep);
    EXPECT_EQ(html.find("1/"), std::string::npos);
    EXPECT_NE(html.find("times smaller than the full_cdf"), std::string::npos);
    EXPECT_EQ(noise_ratio_text(4.0), "2 times less noise than");
    EXPECT_EQ(noise_ratio_text(1.0 / 9.0), "3 times more noise than");
    EXPECT_EQ(noise_ratio_text(1.004), "the same noise as");
}

TEST(SweepAdvice, NamesTheBaselinesThatWin) {
    const Sweep sweep = made_up();
    const Advice advice = advise(sweep);
    std::map<std::string, Verdict> verdicts;
    for (const BaselineComparison& c : advice.comparisons) verdicts[sweep.rows[c.row].system] = c.verdict;
    EXPECT_EQ(verdicts["full_cdf"], Verdict::ours);
    EXPECT_EQ(verdicts["fast"], Verdict::baseline);
    EXPECT_EQ(verdicts["even"], Verdict::even);
    EXPECT_EQ(verdicts["hole"], Verdict::ours); // biased, however fast
    const BaselineComparison& fast = advice.comparisons[1];
    EXPECT_NEAR(fast.variance, 2.0, 1e-12);
    EXPECT_NEAR(fast.time.value, 0.2, 1e-12); // in each round a fifth
    EXPECT_NEAR(fast.equal_time.value, 0.4, 1e-12);
    std::string all;
    for (const std::string& finding : advice.findings) all += finding + "\n";
    EXPECT_NE(all.find("At equal time a baseline wins: fast 0.4 (0.4 to 0.4) with 137 times the memory."),
              std::string::npos)
        << all;
    EXPECT_NE(all.find("Too close to call at equal time: even"), std::string::npos) << all;
    EXPECT_NE(all.find("Hole is biased if used alone"), std::string::npos) << all;
    EXPECT_NE(all.find("At equal samples no baseline is less noisy"), std::string::npos) << all;
}

/// Lines of a CSV of which no field holds a line break; fields unquoted.
std::vector<std::vector<std::string>> parse_csv(const std::string& text) {
    std::vector<std::vector<std::string>> out(1, std::vector<std::string>(1));
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted && c == '"' && text[i + 1] == '"') out.back().back() += text[++i];
        else if (c == '"') quoted = !quoted;
        else if (!quoted && c == ',') out.back().emplace_back();
        else if (!quoted && c == '\n') out.emplace_back(1);
        else out.back().back() += c;
    }
    out.pop_back();
    return out;
}

/// Of all points of a chart: the attributes of its groups.
std::vector<std::map<std::string, std::string>> points_of(const std::string& html, const std::string& chart) {
    std::vector<std::map<std::string, std::string>> out;
    const std::string group = "<g class=\"point ", attribute = " data-";
    for (std::size_t begin = html.find(group); begin != std::string::npos; begin = html.find(group, begin + 1)) {
        const std::string text = html.substr(begin, html.find('>', begin) - begin);
        std::map<std::string, std::string> one;
        for (std::size_t at = text.find(attribute); at != std::string::npos; at = text.find(attribute, at + 1)) {
            const std::size_t name = at + attribute.size(), value = text.find("=\"", name);
            one[text.substr(name, value - name)] = text.substr(value + 2, text.find('"', value + 2) - value - 2);
        }
        if (one["chart"] == chart) out.push_back(one);
    }
    return out;
}

void expect_consistent(const Sweep& sweep) {
    const auto csv = parse_csv(sweep_csv(sweep));
    const auto json = nlohmann::json::parse(sweep_json(sweep));
    const std::string html = sweep_html(sweep);
    ASSERT_EQ(csv.size(), sweep.rows.size() + 1);
    ASSERT_EQ(json["rows"].size(), sweep.rows.size());
    for (std::size_t r = 0; r < sweep.rows.size(); ++r) {
        ASSERT_EQ(csv[r + 1].size(), csv[0].size());
        for (std::size_t c = 0; c < csv[0].size(); ++c) {
            const auto& value = json["rows"][r][csv[0][c]];
            const std::string& field = csv[r + 1][c];
            if (value.is_string()) EXPECT_EQ(value.get<std::string>(), field);
            else if (value.is_null()) EXPECT_TRUE(field.empty() || field == "inf" || field == "-inf") << field;
            else EXPECT_EQ(value.get<double>(), std::strtod(field.c_str(), nullptr)) << csv[0][c];
        }
    }
    const auto column = [&](const char* name) {
        return std::size_t(std::find(csv[0].begin(), csv[0].end(), name) - csv[0].begin());
    };
    std::map<std::string, const char*> charts = {{"variance", "relative_variance"},     {"weight", "max_weight"},
                                                 {"sample", "ns_per_sample"},           {"pdf", "ns_per_pdf"},
                                                 {"equal-time", "equal_time_variance"}, {"build", "build_seconds"}};
    if (sweep.kind == SweepKind::environment) charts["surface"] = "irradiance_variance";
    for (const auto& [chart, name] : charts) {
        std::size_t expected = 0;
        const std::size_t at = column(name);
        for (std::size_t r = 1; r < csv.size(); ++r) expected += at < csv[r].size() && !csv[r][at].empty();
        const auto points = points_of(html, chart);
        EXPECT_EQ(points.size(), expected) << chart;
        for (auto point : points) {
            const auto& line = csv[std::size_t(std::stoul(point["row"])) + 1];
            EXPECT_EQ(point["system"], line[column("system")]);
            EXPECT_EQ(point["fit"], line[column("fit")]);
            EXPECT_EQ(point["bytes"], line[column("bytes")]);
            EXPECT_EQ(point["variance"], line[column("relative_variance")]);
            EXPECT_EQ(point["value"], line[at]) << chart;
        }
    }
}

TEST(SweepOutputs, CsvJsonAndPageHoldTheSameNumbers) {
    expect_consistent(made_up_pictures());
    Sweep sweep = made_up();
    expect_consistent(sweep);
    sweep.timed = false;
    expect_consistent(sweep);
    EXPECT_EQ(sweep_csv(sweep).find("ns_per"), std::string::npos);
    EXPECT_EQ(sweep_html(sweep).find("chart-sample"), std::string::npos);
}

TEST(SweepOutputs, NamesAreTextWhateverTheyHold) {
    Sweep sweep = made_up();
    const std::string hostile = "<script>alert(1)</script>\"><img src=x onerror='y'>&amp;\x01`.exr";
    sweep.source = hostile;
    sweep.command = "acdf local " + shell_word(hostile);
    sweep.output = hostile;
    sweep.description = hostile;
    sweep.notes = {hostile};
    sweep.rows[0].label = hostile;
    sweep.rows[4].system = hostile;
    const std::string html = sweep_html(sweep);
    EXPECT_EQ(html.find("<script"), std::string::npos);
    EXPECT_EQ(html.find("<img src=x"), std::string::npos);
    EXPECT_EQ(html.find('\x01'), std::string::npos);
    EXPECT_NE(html.find("&lt;script&gt;alert(1)&lt;/script&gt;&quot;&gt;&lt;img"), std::string::npos);
    const auto csv = parse_csv(sweep_csv(sweep));
    ASSERT_EQ(csv.size(), sweep.rows.size() + 1);
    EXPECT_EQ(csv[1][2], hostile);
    EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
    EXPECT_EQ(shell_word("plain-1.0_x.exr"), "plain-1.0_x.exr");
    EXPECT_EQ(shell_word("$(rm)"), "'$(rm)'");
}

TEST(SweepOutputs, ThePageLoadsNothing) {
    const std::string html = sweep_html(made_up());
    for (const char* what : {"http:", "https:", "src=\"/", "url(", "@import", "<link", "<script"})
        EXPECT_EQ(html.find(what), std::string::npos) << what;
    EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
}

SweepOptions quick() {
    SweepOptions options;
    options.budgets = {1500, 2500};
    options.timing = false;
    options.normals = 4;
    options.points = 6;
    options.seeds = 4;
    return options;
}

TEST(SweepRows, OfATinyProbeAreWhatTheFilesHave) {
    const compress::Target target = acdf_test::noise_target(64, 32, 7);
    Sweep sweep = sweep_environment(builder::target_of(target, acdf::test::nearest_lookup()), {}, quick());
    sweep.source = "tiny.exr", sweep.command = "acdf env tiny.exr", sweep.output = "tiny.acdf";
    std::map<std::string, int> systems, fits;
    for (const SweepRow& r : sweep.rows) {
        ++systems[r.system];
        ++fits[r.fit];
        EXPECT_GT(r.bytes, 0u);
        EXPECT_GE(r.relative_variance, 0.0) << r.label;
        for (const Lit& lit : r.lit) {
            EXPECT_GE(lit.mean, 0.0) << r.label;
            EXPECT_LE(lit.median, lit.worst) << r.label;
            EXPECT_EQ(std::isinf(lit.sobol), std::isinf(lit.mean)) << r.label;
        }
        EXPECT_GE(r.lit[open_alone].mean, r.system == "full_cdf" ? 0.5 : 0.0) << r.label; // half is sampled in vain
        if (r.fit == "variance") {
            build::EnvironmentOptions options;
            options.fit.goal.kind = compress::Goal::Kind::budget;
            options.fit.goal.budget = r.options == "--budget 1500" ? 1500 : 2500;
            const build::Environment file = build_environment(target, {}, options);
            EXPECT_EQ(r.file_bytes, file.bytes.size());
            File opened;
            ASSERT_TRUE(File::from_memory(file.bytes.data(), file.bytes.size(), opened).ok());
            EXPECT_EQ(r.bytes, opened.size() + opened.table_bytes());
            EXPECT_EQ(r.relative_variance, file.accuracy.relative_variance);
        }
    }
    EXPECT_EQ(fits["variance"], 2);
    EXPECT_GE(fits["cdf"], 1);
    for (const char* baseline :
         {"full_cdf", "alias_table", "hierarchical_warp", "downsampled_cdf", "mis_compensation"})
        EXPECT_GE(systems[baseline], 1) << baseline;
    EXPECT_EQ(sweep.rows[sweep.reference].system, "full_cdf");
    EXPECT_EQ(sweep.rows[sweep.reference].relative_variance, 0.0);
    EXPECT_GE(sweep.pictures.size(), 3u);
    expect_consistent(sweep);
}

TEST(SweepRows, GoalsOutOfReachAreNoted) {
    const compress::Target target = acdf_test::noise_target(64, 32, 7);
    SweepOptions options = quick();
    options.budgets = {100, 2500};
    options.fits = {"variance"};
    options.pictures = false;
    const Sweep sweep = sweep_environment(builder::target_of(target, acdf::test::nearest_lookup()), {}, options);
    ASSERT_EQ(sweep.notes.size(), 1u);
    EXPECT_NE(sweep.notes[0].find("100 bytes"), std::string::npos) << sweep.notes[0];
    options.budgets = {100};
    EXPECT_THROW(sweep_environment(builder::target_of(target, acdf::test::nearest_lookup()), {}, options),
                 std::invalid_argument);
}

} // namespace
} // namespace acdf::tools
