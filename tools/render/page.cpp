#include "tools/render/page.h"

#include "tools/cli/html.h"
#include "tools/cli/noise.h"
#include "tools/cli/sizes.h"

#include <algorithm>
#include <cstdio>

namespace acdf::tools {
namespace {

constexpr int kZoom = 4; ///< of a part: a picture has 3 x 3 of them, which overlap

constexpr const char* style = R"(
:root{color-scheme:light dark;--page:#f6f7f9;--card:#fff;--ink:#1b1f24;--soft:#59636e;--rule:#d5dae0;--key:#0b62a8;
--keybg:#e8f2fb}
@media (prefers-color-scheme:dark){:root{--page:#11151a;--card:#1a2027;--ink:#e8ecf1;--soft:#a2adb9;--rule:#36404b;
--key:#6fb6f2;--keybg:#152737}}
*{box-sizing:border-box}
body{margin:0 auto;max-width:1240px;padding:20px;background:var(--page);color:var(--ink);
font:16px/1.5 system-ui,-apple-system,"Segoe UI",sans-serif}
h1{font-size:1.8rem;margin:0;overflow-wrap:anywhere}h2{font-size:1.2rem;margin:32px 0 8px}
h3{font-size:.95rem;margin:0 0 6px;overflow-wrap:anywhere}
.soft,figcaption{color:var(--soft);font-size:.88rem}
.advice{background:var(--keybg);border-left:5px solid var(--key);border-radius:6px;padding:10px 18px;margin:16px 0}
.grid{display:grid;grid-template-columns:repeat(auto-fill,minmax(270px,1fr));gap:14px}
figure{margin:0;background:var(--card);border:1px solid var(--rule);border-radius:8px;padding:10px;min-width:0}
.frame{position:relative;overflow:hidden;isolation:isolate}
.frame>*{width:100%;height:auto;display:block;image-rendering:pixelated}
.frame .reference{position:absolute;inset:0;height:100%;background:var(--reference) 0 0/100% 100%;
mix-blend-mode:difference;visibility:hidden}
fieldset{display:inline-flex;gap:6px 14px;align-items:center;flex-wrap:wrap;border:1px solid var(--rule);
border-radius:6px;margin:0 10px 12px 0;padding:6px 12px}
.parts{display:inline-grid;grid-template-columns:repeat(3,18px)}.parts input{margin:1px}
body:has(#difference:checked) .frame .reference{visibility:visible}
body:has(#difference:checked) .frame{filter:brightness(2)}
p{margin:6px 0}code{font-size:.8rem;overflow-wrap:anywhere}
details img{max-width:100%;height:auto}
.scroll{overflow-x:auto;border:1px solid var(--rule);border-radius:8px;background:var(--card)}
table{border-collapse:collapse;width:100%;font-size:.86rem;font-variant-numeric:tabular-nums}
th,td{padding:5px 10px;text-align:right;border-bottom:1px solid var(--rule);white-space:nowrap}
th:first-child,td:first-child{text-align:left}
)";

std::string element(const std::string& open, const std::string& text) {
    return "<" + open + ">" + escaped(text) + "</" + open.substr(0, open.find(' ')) + ">";
}

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

std::string interval(const measure::Interval& i) {
    return number(i.value) + " [" + number(i.low) + ", " + number(i.high) + "]";
}

/// What the checked part shows: all pictures alike.
std::string zoom_style(const PagePictures& pictures) {
    std::string out = ":root{--reference:url(data:image/png;base64," + base64(pictures.reference) + ")}\n";
    for (int part = 0; part < 9; ++part)
        out += "body:has(#part" + std::to_string(part) + ":checked) .frame>*{transform:scale(" +
               std::to_string(kZoom) + ");transform-origin:" + std::to_string(part % 3 * 50) + "% " +
               std::to_string(part / 3 * 50) + "%}\n";
    return out;
}

std::string controls() {
    std::string out = "<fieldset><span>Zoom</span><label><input type=\"radio\" name=\"zoom\" id=\"whole\" checked> "
                      "whole</label><span class=\"parts\">";
    for (int part = 0; part < 9; ++part)
        out += "<input type=\"radio\" name=\"zoom\" id=\"part" + std::to_string(part) + "\" aria-label=\"part " +
               std::to_string(part + 1) + " of 9\">";
    return out +
           "</span></fieldset><fieldset><label><input type=\"checkbox\" id=\"difference\"> difference from the "
           "reference, twice as bright</label></fieldset>\n";
}

std::string frame(const PagePictures& pictures, const std::vector<std::uint8_t>& png, const std::string& name) {
    return element("h3", name) + "<div class=\"frame\">" + html_image(png, pictures.width, pictures.height, name) +
           "<div class=\"reference\"></div></div>";
}

std::string figure_of(const std::vector<std::uint8_t>& png, const std::string& what) {
    if (png.empty()) return "";
    return "<details>" + element("summary", what) + "<img alt=\"" + escaped(what) +
           "\" src=\"data:image/png;base64," + base64(png) + "\"></details>";
}

/// What makes the files of a sampler: "local:1MB --mis cosine" is `acdf local PROBE --budget 1MB --mis cosine`.
std::string commands_of(const SamplerSpec& spec) {
    if (spec.kind == SamplerKind::env || spec.kind == SamplerKind::local) {
        const std::size_t name = spec.text.find_first_of(": "),
                          options = std::min(spec.text.find(' '), spec.text.size());
        std::string out = "acdf " + spec.text.substr(0, name) + " PROBE";
        if (name < options) out += " --budget " + spec.text.substr(name + 1, options - name - 1);
        return "<code>" + escaped(out + spec.text.substr(options)) + (spec.of_scene ? " MESH" : "") + "</code><br>";
    }
    std::string out;
    for (const SamplerSpec& part : spec.parts) out += commands_of(part);
    return out;
}

std::string pictures_html(const RenderRun& run, const PagePictures& pictures) {
    const std::vector<Compared>& samplers = run.passes.front().comparison.samplers;
    std::string out = "<section>\n<h2>Pictures</h2>\n" + controls() + "<div class=\"grid\">\n<figure>" +
                      frame(pictures, pictures.reference, "reference") + "</figure>\n";
    for (std::size_t i = 0; i < samplers.size(); ++i) {
        const SamplerPictures& of = pictures.samplers[i];
        const Compared& one = samplers[i];
        out += "<figure>" + frame(pictures, of.picture, one.spec.text) + "<p class=\"soft\">" +
               commands_of(one.spec) + "</p>" +
               element("figcaption", "noise " + noise_text(one.relative_variance.value, 1) + " at " +
                                         std::to_string(run.options.samples) + " samples") +
               figure_of(of.variance, "relative variance") + figure_of(of.gain, "gain over the first sampler") +
               figure_of(of.above, "share of samples above the horizon") + "</figure>\n";
    }
    return out + "</div>\n</section>\n";
}

std::string table_html(const Comparison& comparison, const ComparisonOptions& o, const std::string& title) {
    std::string out = element("h3", title) +
                      "\n<div class=\"scroll\"><table>\n<thead><tr><th>sampler</th><th>memory</th>"
                      "<th>relative variance</th><th>median</th><th>noise</th>"
                      "<th>gain, equal samples</th>";
    if (o.timing) out += "<th>µs</th><th>gain, equal time</th>";
    out += "<th>bias / s.e.</th></tr></thead>\n<tbody>\n";
    for (const Compared& one : comparison.samplers) {
        const bool sure = one.resolved();
        out += "<tr>" + element("td", one.spec.text) + element("td", to_readable_size(one.bytes)) +
               element("td", number(one.relative_variance.value)) + element("td", number(one.median)) +
               element("td", sure ? noise_text(one.relative_variance.value, 1) : "unsure") +
               element("td", sure ? interval(one.equal_samples) : "unsure");
        if (o.timing)
            out += element("td", number(1e-3 * measure::mean_interval(one.nanoseconds).value)) +
                   element("td", sure ? interval(one.equal_time) : "unsure");
        out += element("td", number(one.bias_standard_errors)) + "</tr>\n";
    }
    return out + "</tbody></table></div>\n";
}

std::string tables_html(const RenderRun& run) {
    std::string out = "<section>\n<h2>Figures</h2>\n";
    for (const RenderPass& pass : run.passes) {
        const std::string numbers =
            pass.numbers == measure::Numbers::sobol ? "Scrambled Sobol' sequence" : "Independent random numbers";
        out += table_html(pass.comparison, run.options, numbers);
        if (pass.in_the_open) out += table_html(*pass.in_the_open, run.options, numbers + ", nothing hidden");
    }
    return out + "<p class=\"soft\">Of an estimate of " + std::to_string(run.options.samples) +
           " samples, mean over pixels. Memory counts the tables made at load. A bias beyond 4 standard errors "
           "(s.e.) is "
           "a "
           "fault of the sampler, or of a file used without its MIS partner.</p>\n</section>\n";
}

std::string advice_html(const RenderRun& run) {
    std::string out = "<section class=\"advice\">\n";
    for (const RenderPass& pass : run.passes)
        for (const std::string& sentence : verdict(pass.comparison, run.options.timing))
            out += element("p", (pass.numbers == measure::Numbers::sobol ? "Sobol': " : "") + sentence) + "\n";
    return out + "</section>\n";
}

} // namespace

std::string render_html(const LoadedScene& scene, const RenderRun& run, const PagePictures& pictures) {
    std::string out = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n" +
                      std::string(closed_page_policy) +
                      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n" +
                      element("title", "acdf render: " + run.scene) + "\n<style>" + style + zoom_style(pictures) +
                      "</style>\n</head>\n<body>\n" + element("h1", run.scene) + "\n" +
                      element("p class=\"soft\"", scene.file.description + ". Light: " + scene.probe.source_name +
                                                      ", " + std::to_string(scene.probe.width) + " x " +
                                                      std::to_string(scene.probe.height) + ". Reference: " +
                                                      (run.options.reference ? "exact, a sum over texels."
                                                                             : "the mean of all pictures.")) +
                      "\n";
    return out + advice_html(run) + pictures_html(run, pictures) + tables_html(run) + "</body>\n</html>\n";
}

} // namespace acdf::tools
