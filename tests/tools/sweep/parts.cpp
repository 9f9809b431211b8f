// What a sweep recommends and writes, on made-up rows and on a tiny probe.
#include "build/environment.h"
#include "build/own_terms.h"
#include "tests/inputs/nearest_lookup.h"
#include "tests/inputs/synthetic.h"
#include "tools/sweep/advice.h"
#include "tools/sweep/page.h"
#include "tools/sweep/page_chart.h"
#include "tools/sweep/renderers.h"
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
    out.file = fit;
    out.command = "brdf";
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
    sweep.kind = SweepKind::brdf;
    sweep.source = "nickel.binary";
    sweep.input = "nickel.binary";
    sweep.output = "nickel";
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
    EXPECT_EQ(advice.command, "acdf brdf nickel.binary --budget 65536 -o nickel.acdf");
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

SweepRow light_row(const char* system, const char* file, std::uint64_t bytes, Given needs, bool needs_mis,
                   double alone, double mis) {
    SweepRow out = row(system, file, bytes, 0.1, {100, 100, 100, 100, 100, 100});
    out.command = needs == Given::nothing ? "env" : "local";
    out.needs = needs;
    out.needs_mis = needs_mis;
    out.file_bytes = out.ours() ? bytes / 2 : 0;
    out.times.pdf = out.times.sample;
    for (std::size_t c = 0; c < kCases; ++c) {
        out.noise[light_alone][c] = {needs_mis ? HUGE_VAL : alone, needs_mis ? HUGE_VAL : 0.25 * alone};
        out.noise[with_mis][c] = {mis, 0.25 * mis};
    }
    return out;
}

/// Files of all kinds, as probes have them.
Sweep made_up_probe() {
    Sweep sweep;
    sweep.source = "probe.exr";
    sweep.input = "probe.exr";
    sweep.output = "probe";
    sweep.conditions = 8;
    sweep.rows = {light_row("acdf", "env", 16384, Given::nothing, false, 4.0, 2.0),
                  light_row("acdf", "env", 65536, Given::nothing, false, 3.9, 1.9),
                  light_row("acdf", "env-mis", 16384, Given::nothing, true, 0.0, 1.5),
                  light_row("acdf", "local", 65536, Given::normal, false, 0.8, 0.7),
                  light_row("acdf", "local", 1048576, Given::normal, false, 0.5, 0.6),
                  light_row("acdf", "local-mis", 65536, Given::normal, true, 0.0, 0.405),
                  light_row("acdf", "local-mis", 1048576, Given::normal, true, 0.0, 0.4),
                  light_row("full_cdf", "", 8000000, Given::nothing, false, 3.8, 1.85),
                  light_row("tiles", "", 8000000, Given::normal, false, 0.6, 0.3)};
    sweep.reference = 7;
    sweep.costs = {500.0, 20.0};
    return sweep;
}

TEST(SweepAdvice, EachKindOfRendererHasAFile) {
    Sweep sweep = made_up_probe();
    const auto rows = [&] {
        std::map<std::string, std::size_t> out;
        for (const RendererAdvice& one : advise_renderers(sweep)) out[to_string(one.renderer)] = one.row;
        return out;
    };
    using Rows = std::map<std::string, std::size_t>;
    // Of a kind the smallest within 5 % of the least noise: sqrt(4 / 3.9) is 1.01, sqrt(0.8 / 0.5) is 1.26.
    EXPECT_EQ(rows(), (Rows{{"alone", 0}, {"mis", 2}, {"alone_normal", 4}, {"mis_normal", 5}}));
    sweep.rows[6].times.sample.assign(6, 1500.0); // slow: then it does not set what is good enough
    for (Noise& noise : sweep.rows[6].noise[with_mis]) noise.exact = 0.3;
    EXPECT_EQ(rows()["mis_normal"], 5u);
    sweep.costs.shadow_ray_ns = 1e6; // then the time of a sample does not matter
    EXPECT_EQ(rows()["mis_normal"], 6u);
    sweep = made_up_probe();
    for (Noise& noise : sweep.rows[3].noise[light_alone]) noise.exact = 0.001; // cannot be seen
    for (Noise& noise : sweep.rows[4].noise[light_alone]) noise.exact = 0.0001;
    EXPECT_EQ(rows()["alone_normal"], 3u);
    sweep.numbers = measure::Numbers::sobol;
    for (Noise& noise : sweep.rows[0].noise[light_alone]) noise.sobol = 2.0;
    EXPECT_EQ(rows()["alone"], 1u);
}

TEST(SweepAdvice, PositionsCountOnAMesh) {
    Sweep sweep = made_up_probe();
    sweep.rows.push_back(light_row("acdf", "visibility", 4194304, Given::position, false, 0.2, 0.2));
    EXPECT_EQ(advise_renderers(sweep).size(), 4u);
    sweep.on_mesh = true;
    const std::vector<RendererAdvice> advice = advise_renderers(sweep);
    ASSERT_EQ(advice.size(), 6u);
    EXPECT_EQ(to_string(advice[5].renderer), "mis_position");
    EXPECT_EQ(advice[4].row, 9u);
    EXPECT_EQ(advice[5].row, 9u);
    EXPECT_EQ(advice[3].row, 5u); // who hands over the normal alone cannot use it
    // What is not hidden does not count there.
    sweep.rows[9].noise[with_mis][diffuse_open].exact = sweep.rows[9].noise[with_mis][glossy_open].exact = 100.0;
    EXPECT_EQ(advise_renderers(sweep)[5].row, 9u);
    sweep.rows[9].noise[with_mis][diffuse_hidden].exact = 100.0;
    EXPECT_EQ(advise_renderers(sweep)[5].row, 5u);
}

TEST(SweepAdvice, SaysWhatRenderersGet) {
    const Sweep sweep = made_up_probe();
    const RendererAdvice advice = advise_renderers(sweep)[3];
    EXPECT_EQ(advice.command, "acdf local probe.exr --budget 65536 -o probe.local.acdf");
    EXPECT_DOUBLE_EQ(advice.variance, 0.405);
    ASSERT_TRUE(advice.other && advice.baseline);
    EXPECT_EQ(advice.other->row, 4u);
    EXPECT_NEAR(advice.other->variance.value, 0.6 / 0.405, 1e-12); // all take the same time
    EXPECT_EQ(advice.baseline->row, 8u);
    EXPECT_NEAR(advice.over_reference.value, 1.85 / 0.405, 1e-12);
    EXPECT_EQ(advice.sentence,
              "local-mis, 32 KiB (64 KiB in memory): 8 % noise at 64 samples; after the same time 2.14 times less "
              "noise than the full_cdf, 1.16 times more noise than tiles, 1.22 times less noise than local of "
              "512 KiB.");
    const std::string html = sweep_html(sweep);
    for (const char* part :
         {"data-renderer=\"alone\"", "data-renderer=\"mis_normal\"", "acdf local probe.exr --budget 65536"})
        EXPECT_NE(html.find(part), std::string::npos) << part;
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
    std::map<std::string, const char*> charts = {
        {"weight", "max_weight"}, {"sample", "ns_per_sample"}, {"pdf", "ns_per_pdf"}, {"build", "build_seconds"}};
    if (sweep.kind == SweepKind::brdf) {
        charts["variance"] = "relative_variance";
        charts["equal-time"] = "equal_time_variance";
    } else {
        charts["alone"] = sweep.timed ? "equal_time_alone" : "alone";
        charts["mis"] = sweep.timed ? "equal_time_mis" : "mis";
    }
    for (const auto& [chart, name] : charts) {
        std::size_t expected = 0;
        const std::size_t at = column(name);
        for (std::size_t r = 1; r < csv.size(); ++r) expected += at < csv[r].size() && !csv[r][at].empty();
        const auto points = points_of(html, chart);
        EXPECT_EQ(points.size(), expected) << chart;
        for (auto point : points) {
            const auto& line = csv[std::size_t(std::stoul(point["row"])) + 1];
            EXPECT_EQ(point["system"], line[column("system")]);
            EXPECT_EQ(point["file"], line[column("file")]);
            EXPECT_EQ(point["bytes"], line[column("bytes")]);
            EXPECT_EQ(point["variance"], line[column("relative_variance")]);
            EXPECT_EQ(point["value"], line[at]) << chart;
        }
    }
}

TEST(SweepOutputs, CsvJsonAndPageHoldTheSameNumbers) {
    expect_consistent(made_up_probe());
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
    sweep.input = shell_word(hostile);
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
    options.files = {"env", "env-cdf"};
    options.timing = false;
    options.points = 6;
    options.seeds = 4;
    return options;
}

TEST(SweepRows, OfATinyProbeAreWhatTheFilesHave) {
    const compress::Target target = acdf_test::noise_target(64, 32, 7);
    Sweep sweep = sweep_probe(builder::target_of(target, acdf::test::nearest_lookup()), {}, nullptr, quick());
    sweep.source = sweep.input = "tiny.exr", sweep.output = "tiny";
    std::map<std::string, int> systems, files;
    for (const SweepRow& r : sweep.rows) {
        ++systems[r.system];
        ++files[r.file];
        EXPECT_GT(r.bytes, 0u);
        for (const auto& estimator : r.noise)
            for (const Noise& noise : estimator) {
                EXPECT_GE(noise.exact, 0.0) << r.label;
                EXPECT_EQ(std::isinf(noise.sobol), std::isinf(noise.exact)) << r.label;
            }
        EXPECT_EQ(std::isinf(r.noise[light_alone][diffuse_open].exact), r.needs_mis) << r.label;
        if (r.file == "env") {
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
    EXPECT_EQ(files["env"], 2);
    EXPECT_GE(files["env-cdf"], 1);
    for (const char* baseline : {"full_cdf", "alias_table", "hierarchical_warp", "mis_compensation", "tiling_512"})
        EXPECT_GE(systems[baseline], 1) << baseline;
    EXPECT_EQ(sweep.rows[sweep.reference].system, "full_cdf");
    EXPECT_EQ(sweep.rows[sweep.reference].relative_variance, 0.0);
    EXPECT_EQ(sweep.pictures.size(), 3u);
    expect_consistent(sweep);
}

TEST(SweepRows, WhatIsOutOfReachIsNoted) {
    const compress::Target target = acdf_test::noise_target(64, 32, 7);
    SweepOptions options = quick();
    options.budgets = {100, 2500};
    options.files = {"env"};
    options.pictures = false;
    const builder::Target fitted = builder::target_of(target, acdf::test::nearest_lookup());
    const Sweep sweep = sweep_probe(fitted, {}, nullptr, options);
    ASSERT_EQ(sweep.notes.size(), 1u);
    EXPECT_NE(sweep.notes[0].find("100 bytes"), std::string::npos) << sweep.notes[0];
    options.budgets = {100};
    EXPECT_THROW(sweep_probe(fitted, {}, nullptr, options), std::invalid_argument);
}

} // namespace
} // namespace acdf::tools
