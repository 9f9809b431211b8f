// acdf scanline: how many knots one row of a probe needs.
#include "measure/scanline.h"
#include "build/text/format_names.h"
#include "tools/cli/help.h"
#include "tools/cli/json.h"
#include "tools/cli/messages.h"
#include "tools/cli/options.h"
#include "tools/cli/probe_options.h"
#include "tools/cli/probe_source.h"
#include "tools/commands.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <memory>

namespace acdf::tools {
namespace {

using Json = nlohmann::ordered_json;
using measure::KnotGain;
using measure::Scanline;

constexpr AcdfFit kAdaptive[] = {ACDF_FIT_CDF, ACDF_FIT_PDF};

struct ScanlineArguments {
    std::string probe, row = "auto-peaky";
    input::ProbeOptions reading;
    bool json = false, csv = false, quiet = false;
};

/// One number of segments, all fits.
struct Point {
    std::uint32_t segments = 0;
    double uniform = 0.0; ///< error
    std::vector<KnotGain> adaptive;
};

struct Study {
    std::uint32_t row = 0, rows = 0, columns = 0;
    double theta_degrees = 0.0, contrast = 0.0;
    std::vector<Point> points;

    /// Of an adaptive fit, over the points, ascending.
    std::vector<double> factors(std::size_t fit) const {
        std::vector<double> out;
        for (const Point& point : points) out.push_back(point.adaptive[fit].factor());
        std::sort(out.begin(), out.end());
        return out;
    }
};

/// Empty where the text is a row, as CLI11 asks it of checks.
std::string row_problem(const std::string& text) {
    const bool number = !text.empty() && text.size() < 10 && text.find_first_not_of("0123456789") == text.npos;
    return number || text == "auto-smooth" || text == "auto-peaky" ? ""
                                                                   : "neither a row nor auto-smooth or auto-peaky";
}

std::uint32_t chosen_row(const std::string& text, const compress::Target& target) {
    if (text == "auto-smooth") return choose_row(target, measure::RowChoice::smooth);
    if (text == "auto-peaky") return choose_row(target, measure::RowChoice::peaky);
    const unsigned long row = std::stoul(text);
    if (row >= target.rows)
        throw CLI::ValidationError("--row", "the probe has rows 0 to " + std::to_string(target.rows - 1));
    return static_cast<std::uint32_t>(row);
}

Study study(const compress::Target& target, std::uint32_t row) {
    const Scanline scanline(target, row);
    Study out{row, target.rows, target.columns, 180.0 * (row + 0.5) / target.rows, scanline.contrast(), {}};
    for (std::uint32_t segments = 4; segments <= std::max(4u, target.columns / 4); segments *= 2) {
        Point point{segments, scanline.rms_error(scanline.fit(ACDF_FIT_UNIFORM, segments)), {}};
        for (const AcdfFit fit : kAdaptive) point.adaptive.push_back(knot_gain(scanline, fit, segments));
        out.points.push_back(std::move(point));
    }
    return out;
}

void print_table(const std::string& path, const Study& s) {
    std::printf("%s: row %u of %u, %.1f degrees from the pole, %u texels, contrast %.3g\n", printable(path).c_str(),
                s.row, s.rows, s.theta_degrees, s.columns, s.contrast);
    std::printf(
        "RMS error of the PDF over the row, mean 1; in brackets how many times as many knots equally spaced "
        "ones are for the same error\n");
    std::printf("  %8s  %9s", "segments", "uniform");
    for (const AcdfFit fit : kAdaptive) std::printf("  %18s", build::fit_name(fit).c_str());
    std::printf("\n");
    for (const Point& point : s.points) {
        std::printf("  %8u  %9.4g", point.segments, point.uniform);
        for (const KnotGain& gain : point.adaptive) std::printf("  %9.4g (%5.1fx)", gain.rms_error, gain.factor());
        std::printf("\n");
    }
    for (std::size_t fit = 0; fit < std::size(kAdaptive); ++fit) {
        const std::vector<double> factors = s.factors(fit);
        std::printf("%s: %.1f times fewer knots in the middle of %zu sizes, %.1f at most\n",
                    build::fit_name(kAdaptive[fit]).c_str(), factors[factors.size() / 2], factors.size(),
                    factors.back());
    }
}

void print_csv(const Study& s) {
    std::printf("segments,uniform_rms");
    for (const AcdfFit fit : kAdaptive) {
        const std::string name = build::fit_name(fit);
        std::printf(",%s_segments,%s_rms,%s_uniform_segments,%s_factor", name.c_str(), name.c_str(), name.c_str(),
                    name.c_str());
    }
    std::printf("\n");
    for (const Point& point : s.points) {
        std::printf("%u,%.9g", point.segments, point.uniform);
        for (const KnotGain& gain : point.adaptive)
            std::printf(",%u,%.9g,%u,%.9g", gain.segments, gain.rms_error, gain.uniform_segments, gain.factor());
        std::printf("\n");
    }
}

Json to_json(const std::string& path, const Study& s) {
    Json report = {{"file", path},
                   {"row", s.row},
                   {"rows", s.rows},
                   {"columns", s.columns},
                   {"theta_degrees", s.theta_degrees},
                   {"contrast", s.contrast}};
    Json points = Json::array();
    for (const Point& point : s.points) {
        Json entry = {{"segments", point.segments}, {"uniform", {{"rms_error", point.uniform}}}};
        for (std::size_t fit = 0; fit < std::size(kAdaptive); ++fit) {
            const KnotGain& gain = point.adaptive[fit];
            entry[build::fit_name(kAdaptive[fit])] = {{"segments", gain.segments},
                                                      {"rms_error", gain.rms_error},
                                                      {"uniform_segments", gain.uniform_segments},
                                                      {"factor", gain.factor()}};
        }
        points.push_back(std::move(entry));
    }
    report["points"] = std::move(points);
    for (std::size_t fit = 0; fit < std::size(kAdaptive); ++fit) {
        const std::vector<double> factors = s.factors(fit);
        report["factor"][build::fit_name(kAdaptive[fit])] = {{"median", factors[factors.size() / 2]},
                                                             {"largest", factors.back()}};
    }
    return report;
}

void run(const ScanlineArguments& options) {
    const input::Probe probe = load_probe(options.probe, options.reading, options.quiet || options.json);
    const builder::Target held = probe_texels(options.probe, probe);
    const compress::Target& target = builder::grid_of(held);
    const Study made = study(target, chosen_row(options.row, target));
    if (options.json) std::fputs(json_text(to_json(options.probe, made)).c_str(), stdout);
    else if (options.csv) print_csv(made);
    else print_table(options.probe, made);
}

} // namespace

void add_scanline(CLI::App& program, int& exit_code) {
    auto options = std::make_shared<ScanlineArguments>();
    CLI::App* command = program.add_subcommand(
        "scanline", "Show on one row of a probe how many knots each fit needs, adaptive against equally spaced");
    command->add_option("PROBE", options->probe, "The probe")->required()->type_name("");
    command
        ->add_option("--row", options->row,
                     "Which row of the probe as a lat-long map, from 0 at the top; auto-smooth and auto-peaky take "
                     "that of least and most contrast between 45 and 135 degrees")
        ->check(CLI::Validator(row_problem, ""))
        ->option_text("N|auto-smooth|auto-peaky [auto-peaky]");
    add_projection(*command, options->reading.projection);
    add_faces(*command, options->reading.faces);
    add_repairs(*command, options->reading);
    add_json(*command, options->json);
    command->add_flag("--csv", options->csv, "The table as CSV")->excludes("--json");
    add_quiet(*command, options->quiet);
    command->footer(help_footer(
        "The study of Lawrence et al. 2005, Fig. 6. The fits approximate the pdf of the row over its columns. The "
        "error is that of the stored pdf, as a share of the mean pdf. With S segments a curve has S + 1 knots. The "
        "fit `pdf` is linear on each segment and stores a slope too.",
        "acdf scanline sky.exr --row auto-smooth\n"
        "acdf scanline grace_probe.hdr --projection angular --row 300\n"
        "acdf scanline sky.exr --json | jq .factor.cdf.median\n"
        "acdf scanline sky.exr --csv > knots.csv"));
    command->callback([options, &exit_code] {
        run(*options);
        exit_code = exit_done;
    });
}

} // namespace acdf::tools
