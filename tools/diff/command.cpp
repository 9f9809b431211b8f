// acdf diff: whether two files are the same, byte by byte or in what is sampled from them.
#include "tools/cli/file_input.h"
#include "tools/cli/help.h"
#include "tools/cli/json.h"
#include "tools/cli/messages.h"
#include "tools/cli/number_range.h"
#include "tools/cli/options.h"
#include "tools/cli/sizes.h"
#include "tools/commands.h"
#include "tools/diff/distance.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace acdf::tools {
namespace {

struct DiffArguments {
    std::string a, b;
    double tolerance = 0.0;
    std::uint32_t samples = 0;
    bool by_distance = false, json = false, quiet = false;
};

using Metadata = std::map<std::string, std::string>;

Metadata metadata_of(const File& file) {
    Metadata out;
    for (std::uint32_t i = 0; i < file.metadata_count(); ++i) {
        Text key, value;
        file.metadata(i, key, value);
        out[std::string(key.data, key.size)] = std::string(value.data, value.size);
    }
    return out;
}

/// Descriptions of two files where they differ: by key, what each has (empty: nothing).
std::map<std::string, std::pair<std::string, std::string>> told_differently(const File& a, const File& b) {
    std::map<std::string, std::pair<std::string, std::string>> all;
    for (auto& [key, value] : metadata_of(a)) all[key].first = value;
    for (auto& [key, value] : metadata_of(b)) all[key].second = value;
    for (auto i = all.begin(); i != all.end();)
        i = i->second.first == i->second.second ? all.erase(i) : std::next(i);
    return all;
}

struct Found {
    bool same_bytes = false, same = false;
    std::size_t first_difference = 0;
    std::string why_not; ///< compared by what is sampled
    std::optional<Distance> distance;
};

Found compare(const DiffArguments& options, const LoadedFile& a, const LoadedFile& b) {
    Found found;
    const auto at = std::mismatch(a.bytes.begin(), a.bytes.end(), b.bytes.begin(), b.bytes.end());
    found.same_bytes = found.same = at.first == a.bytes.end() && at.second == b.bytes.end();
    if (found.same_bytes) return found;
    found.first_difference = static_cast<std::size_t>(at.first - a.bytes.begin());
    found.why_not = why_not_compared(a.file, b.file);
    if (!found.why_not.empty()) return found;
    found.distance = distance(a.file, b.file, options.samples);
    found.same = options.by_distance && found.distance->worst <= options.tolerance &&
                 found.distance->total <= options.tolerance;
    return found;
}

nlohmann::ordered_json report(const DiffArguments& options, const LoadedFile& a, const LoadedFile& b,
                              const Found& found) {
    nlohmann::ordered_json out{{"files", {options.a, options.b}},
                               {"same", found.same},
                               {"same_bytes", found.same_bytes},
                               {"bytes", {a.bytes.size(), b.bytes.size()}}};
    out["first_difference"] =
        found.same_bytes ? nlohmann::ordered_json() : nlohmann::ordered_json(found.first_difference);
    out["metadata"] = nlohmann::ordered_json::object();
    for (const auto& [key, values] : told_differently(a.file, b.file))
        out["metadata"][key] = {values.first, values.second};
    out["tolerance"] = known_json(options.by_distance, options.tolerance);
    const Distance d = found.distance.value_or(Distance{});
    const bool known = found.same_bytes || found.distance;
    out["distance"] = known_json(known, d.worst);
    out["mean_distance"] = known_json(known, d.mean);
    out["conditions"] = d.conditions;
    out["largest_ratio"] = known_json(known && std::isfinite(d.largest_ratio), d.largest_ratio);
    out["total_difference"] = known_json(known, d.total);
    return out;
}

std::string per_cent(double share) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g %%", 100.0 * share);
    return text;
}

std::string text_of(const Distance& d) {
    char ratio[64] = "the pdf of one is 0 where the other samples";
    if (std::isfinite(d.largest_ratio))
        std::snprintf(ratio, sizeof ratio, "pdfs differ by up to a factor of %.4g", d.largest_ratio);
    return per_cent(d.worst) + " of the samples fall elsewhere" +
           (d.conditions > 1 ? " in the worst of " + std::to_string(d.conditions) + " conditions, " +
                                   per_cent(d.mean) + " in the mean"
                             : "") +
           "; " + ratio + "; integrals differ by " + per_cent(d.total);
}

void print(const LoadedFile& a, const LoadedFile& b, const Found& found) {
    if (found.same_bytes) return put("the same bytes\n");
    put("bytes: differ from byte " + std::to_string(found.first_difference) + " on (" +
        to_readable_size(a.bytes.size()) + " and " + to_readable_size(b.bytes.size()) + ")\n");
    for (const auto& [key, values] : told_differently(a.file, b.file))
        put(key + ": " + (values.first.empty() ? "-" : on_one_line(values.first)) + " and " +
            (values.second.empty() ? "-" : on_one_line(values.second)) + "\n");
    put("sampled: " + (found.distance ? text_of(*found.distance) : found.why_not) + "\n");
}

int run(const DiffArguments& options) {
    if (options.a == "-" && options.b == "-") throw CLI::ValidationError("A, B", "only one of them is stdin");
    const LoadedFile a = load_file(options.a), b = load_file(options.b);
    const Found found = compare(options, a, b);
    if (options.json) std::fputs(json_text(report(options, a, b, found)).c_str(), stdout);
    else if (!options.quiet) print(a, b, found);
    return found.same ? exit_done : exit_differ;
}

} // namespace

void add_diff(CLI::App& program, int& exit_code) {
    auto options = std::make_shared<DiffArguments>();
    CLI::App& command = *program.add_subcommand("diff", "Compare two files: their bytes, and what they sample");
    command.add_option("A", options->a, "An .acdf file (- is stdin)")->required()->type_name("")->group("Input");
    command.add_option("B", options->b, "Another one")->required()->type_name("")->group("Input");
    command
        .add_option_function<double>(
            "--tolerance",
            [options](double tolerance) {
                options->tolerance = tolerance;
                options->by_distance = true;
            },
            "Count files as the same whose bytes differ, if at most this share of the samples falls elsewhere, for "
            "each "
            "normal, view or bin, and integrals differ by no more: 0 of files that differ in compression or names "
            "alone. "
            "Without it the bytes decide")
        ->check(number_range(0.0, 1.0))
        ->option_text("SHARE")
        ->group("Comparison");
    command.add_option("--samples", options->samples, "Samples of either file for each normal, view or bin")
        ->check(CLI::Range(1u, 1u << 28))
        ->option_text("N [2048; of environments 65536]")
        ->group("Comparison");
    add_json(command, options->json);
    add_quiet(command, options->quiet);
    command.footer(help_footer("The share of samples that fall elsewhere is the total variation distance of both "
                               "pdfs, from 0 to 1. Local files are compared for 64 normals, BRDFs for 32 views, "
                               "tables for up to 64 bins; files that store visibility cells by their bytes alone.",
                               "acdf diff before.acdf after.acdf\n"
                               "acdf diff sky.acdf sky.zlib.acdf --tolerance 0\n"
                               "acdf diff old.acdf new.acdf --tolerance 0.01 --quiet && echo as good as the same",
                               "3 they differ"));
    command.callback([options, &exit_code] { exit_code = run(*options); });
}

} // namespace acdf::tools
