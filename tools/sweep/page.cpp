#include "tools/sweep/page.h"

#include "tools/cli/html.h"
#include "tools/cli/noise.h"
#include "tools/cli/sizes.h"
#include "tools/sweep/advice.h"
#include "tools/sweep/cost.h"
#include "tools/sweep/page_chart.h"
#include "tools/sweep/page_style.h"
#include "tools/sweep/text.h"

#include <algorithm>
#include <cmath>

namespace acdf::tools {
namespace {

std::string element(const std::string& open, const std::string& text) {
    return "<" + open + ">" + escaped(text) + "</" + open.substr(0, open.find(' ')) + ">";
}

std::string interval_html(const Interval& i) {
    if (!i.known()) return "";
    return short_number(i.value) + " <small>" + short_number(i.low) + " to " + short_number(i.high) + "</small>";
}

/// Text between backticks becomes code.
std::string prose(const std::string& text) {
    std::string out;
    bool code = false;
    for (const char c : escaped(text)) {
        if (c != '`') out += c;
        else out += (code = !code) ? "<code>" : "</code>";
    }
    return out + (code ? "</code>" : "");
}

std::string fact(const std::string& name, const std::string& value, const std::string& small) {
    return "<div>" + element("dt", name) + "<dd>" + escaped(value) + "<small>" + escaped(small) +
           "</small></dd></div>\n";
}

std::string brdf_facts(const Sweep& sweep, const Advice& advice) {
    const SweepRow &best = sweep.rows[advice.recommended.row], &base = sweep.rows[sweep.reference];
    std::string out = "<dl class=\"facts\">\n";
    out += fact(
        "Memory", to_readable_size(best.bytes),
        "the file's " + to_readable_size(best.file_bytes) + " and the tables that are made when it is opened; " +
            short_number(double(base.bytes) / double(best.bytes)) + " times smaller than the " + base.label);
    out += fact("Noise at 16, 64, 256 samples", noise_texts(best.relative_variance),
                "median over views " + noise_texts(best.median));
    if (best.sobol == best.sobol)
        out += fact("With a scrambled Sobol' sequence", noise_text(best.sobol, sweep.visible.spp),
                    "noise at " + std::to_string(sweep.visible.spp) + " samples per pixel");
    if (const Interval time = ratio_interval(best.times.sample, base.times.sample); time.known())
        out += fact("Time a sample", short_number(time.value) + " \xC3\x97",
                    "the time of the " + base.label + "; 95 % confidence " + short_number(time.low) + " to " +
                        short_number(time.high));
    return out + "</dl>\n";
}

std::string brdf_advice(const Sweep& sweep, const Advice& advice) {
    return "<p class=\"lead\" id=\"recommendation\">" + escaped(advice.sentence) + "</p>\n" +
           brdf_facts(sweep, advice) + "<p>This makes that file:</p>\n<pre><code id=\"command\">" +
           escaped(advice.command) + "</code></pre>\n";
}

/// "yes" or "no" to whether it combines samples by MIS, and what it hands over.
std::string renderer_cells(const RendererKind& renderer) {
    constexpr const char* given[] = {"no", "yes", "yes, and the position"};
    return element("td", renderer.mis ? "yes" : "no") +
           element("td class=\"text\"", given[static_cast<std::size_t>(renderer.given)]);
}

/// Noise of a row in each case that counts, beside the reference's.
std::string case_cells(const Sweep& sweep, const RendererAdvice& one) {
    std::string out;
    for (std::size_t c = 0; c < kCases; ++c) {
        const Estimator e = one.renderer.estimator();
        const auto noise = [&](std::size_t row) {
            const Noise& n = sweep.rows[row].noise[e][c];
            const double v = sweep.numbers == measure::Numbers::sobol ? n.sobol : n.exact;
            return noise_text(v, sweep.visible.spp);
        };
        out += "<td>" + noise(one.row) + " <small>" + noise(sweep.reference) + "</small></td>";
    }
    return out;
}

/// A line a kind of renderer.
std::string renderers_table(const Sweep& sweep, const Advice& advice) {
    std::string out =
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Renderers\"><table id=\"renderers\">\n"
        "<thead><tr><th>MIS?</th><th class=\"text\">normal handed to lights?</th><th class=\"text\">make</th>"
        "<th>memory</th><th>diffuse, open</th><th>diffuse, hidden</th><th>glossy, open</th><th>glossy, hidden</th>"
        "</tr></thead>\n<tbody>\n";
    for (const RendererAdvice& one : advice.renderers) {
        const SweepRow& row = sweep.rows[one.row];
        out += "<tr data-renderer=\"" + to_string(one.renderer) + "\">" + renderer_cells(one.renderer) +
               "<td class=\"text\"><code>" + escaped(row.label) + "</code>, " + to_readable_size(row.file_bytes) +
               "</td>" + element("td", to_readable_size(row.bytes)) + case_cells(sweep, one) + "</tr>\n";
    }
    return out + "</tbody></table></div>\n<p class=\"soft\">Noise at " + std::to_string(sweep.visible.spp) +
           " samples; in small type that of the " + escaped(sweep.rows[sweep.reference].label) +
           " beside it.</p>\n";
}

std::string probe_advice(const Sweep& sweep, const Advice& advice) {
    std::string out =
        "<p class=\"lead\">Two questions decide: does your renderer combine samples of the light and of "
        "the BSDF by MIS, and does it hand the surface normal to its lights?</p>\n" +
        renderers_table(sweep, advice);
    for (const RendererAdvice& one : advice.renderers)
        out += "<h3>" + escaped(renderer_text(one.renderer)) + "</h3>\n" + element("p", one.sentence) +
               "\n<pre><code>" + escaped(one.command) + "</code></pre>\n";
    return out;
}

std::string advice_html(const Sweep& sweep, const Advice& advice) {
    return "<section class=\"advice\" aria-label=\"Recommendation\">\n" +
           (sweep.kind == SweepKind::probe ? probe_advice(sweep, advice) : brdf_advice(sweep, advice)) +
           "<p class=\"rule\">" + escaped(advice.rule) + "</p>\n</section>\n";
}

Interval only(double value) { return {value, kUnknown, kUnknown}; }

/// Variance at equal time, or at equal samples where nothing was timed.
template <Estimator E>
Interval compared(const Sweep& sweep, const SweepRow& row) {
    const bool probe = sweep.kind == SweepKind::probe;
    const double variance = probe ? case_mean(sweep, row, E) : row.relative_variance;
    if (!sweep.timed || std::isinf(variance)) return only(variance);
    const Interval t = cost_ratio(row, sweep.rows[sweep.reference], E, sweep.costs);
    return {t.value * variance, t.low * variance, t.high * variance};
}

Chart equal_time_chart(const Sweep& sweep, const char* id, const char* title, const char* what,
                       Interval (*value)(const Sweep&, const SweepRow&)) {
    std::string about = std::string("Relative variance ") + what + ": lower is better.";
    if (sweep.timed)
        about += " Times the time of a sample, in units of the " + sweep.rows[sweep.reference].label + "'s, with " +
                 short_number(sweep.costs.shadow_ray_ns) + " ns beside its sampling (--shadow-ray-ns).";
    return {id, title, about, sweep.timed ? "variance at equal time" : "relative variance", value};
}

void add_probe_charts(const Sweep& sweep, std::vector<Chart>& out) {
    out.push_back(equal_time_chart(sweep, "mis", "Noise with MIS",
                                   "of one sample of the light and one of the BSDF, mean over cases",
                                   compared<with_mis>));
    out.push_back(equal_time_chart(sweep, "alone", "Noise with samples of the light alone",
                                   "of one sample, mean over cases", compared<light_alone>));
}

void add_brdf_charts(const Sweep& sweep, std::vector<Chart>& out) {
    out.push_back({"variance", "Noise", "Relative variance of one sample, mean over views: lower is better.",
                   "relative variance", [](const Sweep&, const SweepRow& r) { return only(r.relative_variance); },
                   sweep.visible.largest_variance(),
                   short_number(100.0 * sweep.visible.threshold) + " % noise at " +
                       std::to_string(sweep.visible.spp) + " spp"});
    if (sweep.timed)
        out.push_back(equal_time_chart(sweep, "equal-time", "Noise at equal time", "of one sample, mean over views",
                                       compared<light_alone>));
}

/// In the order of the page. Times come last, so that a page without them just ends earlier.
std::vector<Chart> charts_of(const Sweep& sweep) {
    std::vector<Chart> out;
    if (sweep.kind == SweepKind::probe) add_probe_charts(sweep, out);
    else add_brdf_charts(sweep, out);
    out.push_back(
        {"weight", "Fireflies",
         "The largest weight f/p that a sample can have, over the mean: it bounds how bright a firefly can be.",
         "largest weight", [](const Sweep&, const SweepRow& r) { return only(r.max_weight); }});
    if (!sweep.timed) return out;
    out.push_back({"sample", "Time of a sample",
                   "Median, and the interval that holds it with 95 % confidence. One thread.", "ns a sample",
                   [](const Sweep&, const SweepRow& r) { return median_interval(r.times.sample); }});
    out.push_back({"pdf", "Time of a pdf", "MIS evaluates one for each sample.", "ns a pdf",
                   [](const Sweep&, const SweepRow& r) { return median_interval(r.times.pdf); }});
    out.push_back({"build", "Time to build a file", "All cores, once; accuracy measured.", "seconds",
                   [](const Sweep&, const SweepRow& r) { return only(r.build_seconds); }});
    return out;
}

std::vector<std::size_t> recommended_rows(const Sweep& sweep, const Advice& advice) {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < sweep.rows.size(); ++i)
        if (advice.recommends(i)) out.push_back(i);
    return out;
}

std::string legend_html(const Sweep& sweep) {
    std::string out = "<ul class=\"legend\" aria-label=\"Legend\">\n";
    for (const ReportSeries& series : series_of(sweep))
        out += "<li>" + series_mark(series) + element("span", series.label) + "</li>\n";
    return out + "</ul>\n";
}

std::string charts_html(const Sweep& sweep, const Advice& advice) {
    std::string out =
        "<section>\n<h2>Size, noise and time</h2>\n<p class=\"soft\">Lines are files of acdf; letters "
        "are what renderers use without it; rings mark recommended files. Point at anything for "
        "its numbers.</p>\n" +
        legend_html(sweep) + "<div class=\"grid\">\n";
    for (const Chart& chart : charts_of(sweep)) {
        const std::string svg = chart_svg(sweep, chart, recommended_rows(sweep, advice));
        if (svg.empty()) continue;
        out += "<figure>" + element("h3", chart.title) + element("figcaption", chart.about) + svg + "</figure>\n";
    }
    return out + "</div>\n</section>\n";
}

std::string pictures_html(const Sweep& sweep) {
    if (sweep.pictures.empty()) return "";
    std::string out =
        "<section>\n<h2>What is stored</h2>\n<p class=\"soft\">The pdf per steradian, on a logarithmic "
        "scale; lines are the borders of cells, where those are large enough to see.</p>\n"
        "<div class=\"grid pictures\">\n";
    for (const SweepPicture& picture : sweep.pictures)
        out += "<figure>" + element("h3", picture.title) +
               html_image(picture.png, picture.width, picture.height, picture.title + ". " + picture.description) +
               "</figure>\n";
    out += "</div>\n<p class=\"scale\"><span>" + escaped(short_number(sweep.range.low)) + "</span>" +
           html_image(sweep.colour_bar, 256, 1, "Colours from violet over green to red") + "<span>" +
           escaped(short_number(sweep.range.high)) + " per steradian</span></p>\n";
    return out + "</section>\n";
}

std::string verdict_html(Verdict verdict) {
    switch (verdict) {
    case Verdict::ours:
        return "<span class=\"won\">the file</span>";
    case Verdict::baseline:
        return "<span class=\"lost\">the baseline</span>";
    case Verdict::even:
        return "too close to call";
    default:
        return "";
    }
}

std::string comparisons_html(const Sweep& sweep, const Advice& advice) {
    std::string out = "<section>\n<h2>Compared with what renderers use today</h2>\n<ul class=\"say\">\n";
    for (const std::string& finding : advice.findings) out += "<li>" + prose(finding) + "</li>\n";
    out += "</ul>\n";
    if (advice.comparisons.empty()) return out + "</section>\n";
    out +=
        "<p class=\"soft\">Each baseline over the recommended file: more than 1 speaks for the file. Ratios "
        "of "
        "times have the interval that holds the median with 95 % confidence; variances are exact.</p>\n"
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Baselines\"><table id=\"baselines\">\n"
        "<thead><tr><th>baseline</th><th>memory</th><th>variance</th>";
    if (sweep.timed) out += "<th>time a sample</th><th>variance at equal time</th><th class=\"text\">better</th>";
    out += "</tr></thead>\n<tbody>\n";
    for (const BaselineComparison& c : advice.comparisons) {
        const SweepRow& row = sweep.rows[c.row];
        out += "<tr>" + element("td class=\"left\"", row.label) + element("td", short_number(c.bytes)) +
               element("td", short_number(c.variance));
        if (sweep.timed)
            out += "<td>" + interval_html(c.time) + "</td><td>" + interval_html(c.equal_time) +
                   "</td><td class=\"text\">" + verdict_html(c.verdict) + "</td>";
        out += "</tr>\n";
    }
    return out + "</tbody></table></div>\n</section>\n";
}

std::string cell_html(const SweepColumn& column, const Sweep& sweep, const SweepRow& row) {
    const SweepValue value = column.value(sweep, row);
    const std::string exact = " data-exact=\"" + escaped(exact_text(value)) + "\"";
    const std::string name = column.name;
    if (name == "label") return "<td class=\"left\"" + exact + ">" + escaped(row.label) + "</td>";
    if (name == "options") return "<td class=\"text\"" + exact + "><code>" + escaped(row.options) + "</code></td>";
    if (name == "bytes" || (name == "file_bytes" && row.ours()))
        return "<td" + exact + ">" + escaped(to_readable_size(std::get<std::uint64_t>(value))) + "</td>";
    if (name == "alone" || name == "mis") {
        const double variance = std::get<double>(value);
        return "<td" + exact + ">" + (std::isinf(variance) ? "biased" : noise_texts(variance)) + "</td>";
    }
    if (const auto* count = std::get_if<std::uint64_t>(&value))
        return "<td" + exact + ">" + std::to_string(*count) + "</td>";
    const double number = std::get<double>(value);
    return "<td" + exact + ">" + (number == number ? short_number(number) : "") + "</td>";
}

/// Columns that are empty in all rows are left out.
std::vector<SweepColumn> shown_columns(const Sweep& sweep) {
    std::vector<SweepColumn> out;
    for (const SweepColumn& column : columns_of(sweep))
        if (column.heading && std::any_of(sweep.rows.begin(), sweep.rows.end(), [&](const SweepRow& row) {
                return !exact_text(column.value(sweep, row)).empty();
            }))
            out.push_back(column);
    return out;
}

std::string rows_html(const Sweep& sweep, const Advice& advice) {
    const std::vector<SweepColumn> columns = shown_columns(sweep);
    std::string out =
        "<section>\n<h2>All rows</h2>\n<p class=\"soft\">The same, with all digits, is in sweep.csv and "
        "sweep.json.</p>\n<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"All "
        "rows\"><table id=\"rows\">\n<thead><tr>";
    for (const SweepColumn& column : columns) {
        const std::string name = column.name;
        const bool noise = name == "alone" || name == "mis";
        out += std::string("<th") + (name == "options" ? " class=\"text\"" : "") + ">" +
               escaped(std::string(noise ? "noise at 16, 64, 256, " : "") + column.heading) + "</th>";
    }
    out += "</tr></thead>\n<tbody>\n";
    for (std::size_t i = 0; i < sweep.rows.size(); ++i) {
        out += "<tr data-row=\"" + std::to_string(i) + "\"" + (advice.recommends(i) ? " class=\"best\"" : "") + ">";
        for (const SweepColumn& column : columns) out += cell_html(column, sweep, sweep.rows[i]);
        out += "</tr>\n";
    }
    return out + "</tbody></table></div>\n</section>\n";
}

std::string method_html(const Sweep& sweep) {
    std::vector<std::string> lines;
    const std::string conditions = std::to_string(sweep.conditions);
    lines.push_back(
        "Relative variance is that of one sample of the estimator over its squared mean; n samples have it "
        "over n. It is summed over the whole source, not estimated: it has no noise of its own.");
    if (sweep.kind == SweepKind::probe)
        lines.push_back(
            "The estimate is that of a path tracer's vertex: samples of the light alone, or one of the light and "
            "one of "
            "the BSDF with the " +
            std::string(sweep.heuristic == ACDF_HEURISTIC_POWER ? "power" : "balance") +
            " heuristic. The surface is white and diffuse, or a white GGX lobe of alpha 0.2 seen at 45 degrees. "
            "Means are over " +
            conditions +
            (sweep.on_mesh ? " points of the mesh."
                           : " random normals; the wall that hides half of a sky "
                             "stands in a random direction.") +
            " Noise is that of a picture: the mean of variances over points, over the square of what they reflect "
            "on average. "
            "Columns named sobol are variance times samples with scrambled Sobol' points, at " +
            std::to_string(sweep.visible.spp) + " samples, by sampling them.");
    else
        lines.push_back(
            "Means are over " + conditions +
            " random views, none chosen for what a file stores. With Sobol' points: variance times samples "
            "with a scrambled Sobol' sequence, at " +
            std::to_string(sweep.visible.spp) + " samples, by sampling them.");
    if (sweep.timed)
        lines.push_back(
            "Times: one thread, all samplers in turn within each of many rounds, so that what slows the "
            "machine slows all; sixteen samples (or pdfs) at each shading point, what a sampler does "
            "once a point included; tables are as warm as that leaves them. Intervals hold the median "
            "with 95 % confidence (order statistics); ratios are taken within rounds. They are of this "
            "machine; --no-timing leaves them out.");
    lines.push_back("A sampler is called biased where there is light but no pdf: no number of samples mends "
                    "that.");
    for (const std::string& note : sweep.notes) lines.push_back(note);
    std::string out = "<section>\n<h2>How this was measured</h2>\n<ul class=\"say soft\">\n";
    for (const std::string& text : lines) out += element("li", text) + "\n";
    return out + "</ul>\n</section>\n";
}

} // namespace

std::string sweep_html(const Sweep& sweep) {
    const Advice advice = advise(sweep);
    const std::string name = sweep.source.substr(sweep.source.find_last_of('/') + 1);
    std::string out = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n" +
                      std::string(closed_page_policy) +
                      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n" +
                      element("title", "acdf sweep: " + name) + "\n<style>" + report_style +
                      "</style>\n</head>\n<body>\n<header>\n<p class=\"kicker\">acdf sweep, " +
                      (sweep.kind == SweepKind::probe ? "environment map" : "BRDF") + "</p>\n<h1><bdi>" +
                      escaped(name) + "</bdi></h1>\n" + element("p class=\"soft\"", sweep.description) +
                      "\n</header>\n<main>\n";
    out += advice_html(sweep, advice) + charts_html(sweep, advice) + pictures_html(sweep) +
           comparisons_html(sweep, advice) + rows_html(sweep, advice) + method_html(sweep);
    return out + "</main>\n<footer>Made by acdf. This page is one file: it loads nothing and runs no "
                 "scripts.</footer>\n</body>\n</html>\n";
}

} // namespace acdf::tools
