#include "tools/sweep/page.h"

#include "tools/cli/html.h"
#include "tools/cli/noise.h"
#include "tools/cli/sizes.h"
#include "tools/sweep/advice.h"
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

const char* kind_text(SweepKind kind) {
    return kind == SweepKind::environment  ? "environment map"
           : kind == SweepKind::local      ? "environment map for every normal"
           : kind == SweepKind::visibility ? "environment map for the positions of a scene"
                                           : "BRDF";
}

const char* conditions_text(SweepKind kind) {
    return kind == SweepKind::brdf ? "views" : kind == SweepKind::visibility ? "positions" : "normals";
}

std::string fact(const std::string& name, const std::string& value, const std::string& small) {
    return "<div>" + element("dt", name) + "<dd>" + escaped(value) + "<small>" + escaped(small) +
           "</small></dd></div>\n";
}

std::string facts_html(const Sweep& sweep, const Advice& advice) {
    const SweepRow &best = sweep.rows[advice.recommended.row], &base = sweep.rows[sweep.reference];
    std::string out = "<dl class=\"facts\">\n";
    const std::string file = best.file_bytes > 0 ? "the file's " + to_readable_size(best.file_bytes) +
                                                       " and the tables that are made when it is opened; "
                                                 : "";
    out += fact("Memory", to_readable_size(best.bytes),
                file + short_number(double(base.bytes) / double(best.bytes)) + " times smaller than the " +
                    base.label + ", which takes " + to_readable_size(base.bytes));
    const bool pictures = sweep.kind == SweepKind::environment;
    const std::string where = pictures ? " on a diffuse surface, nothing hidden" : "";
    out += fact("Noise at " + std::to_string(sweep.visible.spp) + " samples per pixel",
                noise_text(best.shaded(), sweep.visible.spp),
                "relative variance of a sample " + short_number(best.shaded()) + where);
    out += fact("Noise at 16, 64, 256 samples", noise_texts(best.shaded()),
                "median over " + std::string(conditions_text(sweep.kind)) + " " +
                    noise_texts(pictures ? best.lit[open_alone].median : best.median));
    const double sobol = pictures ? best.lit[open_alone].sobol : best.sobol;
    if (sobol == sobol)
        out += fact("With a scrambled Sobol' sequence", noise_text(sobol, sweep.visible.spp),
                    "noise at " + std::to_string(sweep.visible.spp) + " samples per pixel" + where);
    if (std::isfinite(base.shaded() / best.shaded()))
        out += fact("At equal samples", noise_ratio_text(base.shaded() / best.shaded()), "the " + base.label);
    if (const Interval time = ratio_interval(best.times.sample, base.times.sample); time.known())
        out += fact("Time a sample", short_number(time.value) + " \xC3\x97",
                    "the time of the " + base.label + "; 95 % confidence " + short_number(time.low) + " to " +
                        short_number(time.high));
    return out + "</dl>\n";
}

std::string advice_html(const Sweep& sweep, const Advice& advice) {
    return "<section class=\"advice\" aria-label=\"Recommendation\">\n<p class=\"lead\" id=\"recommendation\">" +
           escaped(advice.sentence) + "</p>\n" + facts_html(sweep, advice) +
           "<p>This makes that file:</p>\n<pre><code id=\"command\">" + escaped(advice.command) +
           "</code></pre>\n<p class=\"rule\">" + escaped(advice.rule) + "</p>\n</section>\n";
}

Interval only(double value) { return {value, kUnknown, kUnknown}; }

/// In the order of the page. Times come last, so that a page without them just ends earlier.
std::vector<Chart> charts_of(const Sweep& sweep) {
    const std::string base = sweep.rows[sweep.reference].label;
    const char* what = sweep.kind == SweepKind::environment ? "of the light itself"
                       : sweep.kind == SweepKind::local ? "of what a diffuse surface reflects, mean over normals"
                       : sweep.kind == SweepKind::visibility
                           ? "of what the scene reflects, with its occluders, mean over positions"
                           : "of what is reflected to a view, mean over views";
    const bool pictures = sweep.kind == SweepKind::environment;
    std::vector<Chart> out;
    if (pictures)
        out.push_back(
            {"surface", "Noise in pictures",
             "Relative variance of one sample of a diffuse surface, nothing hidden, mean over normals: lower "
             "is better.",
             "relative variance on a surface",
             [](const Sweep&, const SweepRow& r) { return only(r.lit[open_alone].mean); }});
    out.push_back({"variance", pictures ? "Noise of the light itself" : "Noise",
                   std::string("Relative variance of one sample ") + what + ": lower is better.",
                   "relative variance", [](const Sweep&, const SweepRow& r) { return only(r.relative_variance); },
                   pictures ? kUnknown : sweep.visible.largest_variance(),
                   short_number(100.0 * sweep.visible.threshold) + " % noise at " +
                       std::to_string(sweep.visible.spp) + " spp"});
    out.push_back(
        {"weight", "Fireflies",
         "The largest weight f/p that a sample can have, over the mean: it bounds how bright a firefly can be.",
         "largest weight", [](const Sweep&, const SweepRow& r) { return only(r.max_weight); }});
    if (!sweep.timed) return out;
    out.push_back({"sample", "Time of a sample",
                   "Median, and the interval that holds it with 95 % confidence. One thread.", "ns a sample",
                   [](const Sweep&, const SweepRow& r) { return median_interval(r.times.sample); }});
    out.push_back({"equal-time", "Noise at equal time",
                   "Variance times time, in units of one sample of the " + base + ". " +
                       (sweep.kind == SweepKind::environment ? "Of irradiance on a diffuse surface. " : "") +
                       "A sample takes " + short_number(sweep.costs.shadow_ray_ns) +
                       " ns besides its sampling: a shadow ray, a BRDF (--shadow-ray-ns).",
                   "variance at equal time", [](const Sweep& s, const SweepRow& r) {
                       const Interval t = cost_ratio(r, s.rows[s.reference], open_alone, s.costs);
                       return Interval{t.value * r.shaded(), t.low * r.shaded(), t.high * r.shaded()};
                   }});
    out.push_back(
        {"pdf", "Time of a pdf",
         "Multiple importance sampling needs the pdf of each sample; samplers without a pdf are left out.",
         "ns a pdf", [](const Sweep&, const SweepRow& r) { return median_interval(r.times.pdf); }});
    out.push_back({"build", "Time to build a file", "All cores, once; accuracy measured.", "seconds",
                   [](const Sweep&, const SweepRow& r) { return only(r.build_seconds); }});
    return out;
}

std::string legend_html(const Sweep& sweep) {
    std::string out = "<ul class=\"legend\" aria-label=\"Legend\">\n";
    for (const ReportSeries& series : series_of(sweep))
        out += "<li>" + series_mark(series) + element("span", series.label) + "</li>\n";
    return out + "</ul>\n";
}

std::string charts_html(const Sweep& sweep, const Advice& advice) {
    std::string out = "<section>\n<h2>Size, noise and time</h2>\n<p class=\"soft\">Lines are files of acdf; "
                      "letters are the baselines, which renderers use today; the ring is the recommended file. "
                      "Move the pointer to a mark to see its numbers.</p>\n" +
                      legend_html(sweep) + "<div class=\"grid\">\n";
    for (const Chart& chart : charts_of(sweep)) {
        const std::string svg = chart_svg(sweep, chart, advice.recommended.row);
        if (svg.empty()) continue;
        out += "<figure>" + element("h3", chart.title) + element("figcaption", chart.about) + svg + "</figure>\n";
    }
    return out + "</div>\n</section>\n";
}

std::string pictures_html(const Sweep& sweep) {
    if (sweep.pictures.empty()) return "";
    std::string out = "<section>\n<h2>What is stored</h2>\n<p class=\"soft\">Pdf per steradian, on a logarithmic "
                      "scale. Lines are the borders of cells that are large enough to see.</p>\n"
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
    out +=
        "</ul>\n<p class=\"soft\">Each figure is that of the baseline divided by that of the recommended file: "
        "above 1 the file is better. Ratios of times have the interval that holds the median with 95 % confidence; "
        "variances are exact.</p>\n"
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
    if (name == "noise")
        return "<td" + exact + ">" + (std::isfinite(row.shaded()) ? noise_texts(row.shaded()) : "") + "</td>";
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
        const bool noise = name == "noise";
        out += std::string("<th") + (name == "options" ? " class=\"text\"" : "") + ">" +
               escaped(noise ? "noise at 16, 64, 256" : column.heading) + "</th>";
    }
    out += "</tr></thead>\n<tbody>\n";
    for (std::size_t i = 0; i < sweep.rows.size(); ++i) {
        out += "<tr data-row=\"" + std::to_string(i) + "\"" +
               (i == advice.recommended.row ? " class=\"best\"" : "") + ">";
        for (const SweepColumn& column : columns) out += cell_html(column, sweep, sweep.rows[i]);
        out += "</tr>\n";
    }
    return out + "</tbody></table></div>\n</section>\n";
}

std::string method_html(const Sweep& sweep) {
    std::vector<std::string> lines;
    const std::string conditions = std::to_string(sweep.conditions);
    lines.push_back("The relative variance is the variance of one sample of the estimator over its squared mean; "
                    "the mean of n samples has an n-th of it. It is an exact sum over the source, not an estimate: "
                    "it has no noise of its own.");
    if (sweep.kind == SweepKind::environment)
        lines.push_back(
            "On a diffuse surface: the same of the irradiance, light times cosine above the horizon, mean over " +
            conditions +
            " random normals. With an MIS partner: half of the samples are cosine distributed, all weighted by the "
            "balance heuristic. Behind occluders: points of the demo scene, a sphere on a plane beside a wall; "
            "there "
            "variances "
            "are divided by E^2 + (0.1 mean E)^2, E of the point, so that a few nearly black ones do not decide. "
            "Columns named sobol (in sweep.csv) are the variance of an estimate with scrambled Sobol' points times "
            "its number of samples, measured with " +
            std::to_string(sweep.visible.spp) + " samples.");
    else
        lines.push_back(
            std::string("Means are over ") + conditions + " random " + conditions_text(sweep.kind) +
            ", chosen independently of the normals or views that files store. With Sobol' points: the variance of "
            "an estimate with a scrambled Sobol' sequence times its number of samples, measured with " +
            std::to_string(sweep.visible.spp) + " samples.");
    if (sweep.timed)
        lines.push_back("Times: one thread, all samplers in turn within each of many rounds, so that a slower "
                        "moment of the machine affects all of them. Each shading point takes sixteen samples (or "
                        "pdfs), and the work that a sampler does once a point is included; caches are as warm as "
                        "that leaves them. Intervals hold the median "
                        "with 95 % confidence (order statistics); ratios are taken within rounds. Times are those "
                        "of this machine; --no-timing leaves them out.");
    lines.push_back(
        "A sampler is biased if its pdf is 0 in a direction with light: more samples do not remove that error.");
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
                      kind_text(sweep.kind) + "</p>\n<h1><bdi>" + escaped(name) + "</bdi></h1>\n" +
                      element("p class=\"soft\"", sweep.description) + "\n</header>\n<main>\n";
    out += advice_html(sweep, advice) + charts_html(sweep, advice) + pictures_html(sweep) +
           comparisons_html(sweep, advice) + rows_html(sweep, advice) + method_html(sweep);
    return out + "</main>\n<footer>Made by acdf. This page is one file: it loads nothing and runs no "
                 "scripts.</footer>\n</body>\n</html>\n";
}

} // namespace acdf::tools
