// acdf table: an array of numbers of any number of axes to an .acdf file.
#include "build/builder/sources.h"
#include "input/file_name.h"
#include "input/npy.h"
#include "input/sha256.h"
#include "tools/cli/built.h"
#include "tools/cli/choice.h"
#include "tools/cli/file_input.h"
#include "tools/cli/goal_options.h"
#include "tools/cli/help.h"
#include "tools/cli/json.h"
#include "tools/cli/messages.h"
#include "tools/cli/mis_options.h"
#include "tools/cli/number_range.h"
#include "tools/cli/options.h"
#include "tools/cli/output.h"
#include "tools/cli/output_names.h"
#include "tools/cli/progress.h"
#include "tools/cli/sizes.h"
#include "tools/commands.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <charconv>
#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <sstream>

namespace acdf::tools {
namespace {

struct TableArguments {
    std::string array, other, output;
    std::vector<std::string> ranges;
    std::string budget, names;
    input::NpyOptions input;
    builder::TableOptions table;
    const CLI::App* command = nullptr;
    int threads = 0;
    bool json = false, quiet = false, force = false;

    bool given(const char* option) const { return command->get_option(option)->count() > 0; }
};

/// A number that fills all of `text`.
template <class Number>
bool parse_number(const std::string& text, Number& value) {
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    return error == std::errc{} && rest == end;
}

/// "theta,phi": a name an axis, none of them empty.
std::vector<std::string> names_of(const std::string& text) {
    std::vector<std::string> names;
    std::istringstream rest(text + ',');
    for (std::string name; std::getline(rest, name, ',');) {
        if (name.empty()) throw CLI::ValidationError("--names", "needs a value between all commas");
        names.push_back(name);
    }
    return names;
}

/// The axis that `text` names or counts. Axes without names are x0, x1, ...
std::uint32_t axis_of(const std::string& text, const std::vector<std::string>& names, std::size_t axes) {
    for (std::uint32_t i = 0; i < names.size(); ++i)
        if (names[i] == text) return i;
    const bool by_default = names.empty() && text.rfind('x', 0) == 0;
    std::uint32_t axis = 0;
    if (!parse_number(by_default ? text.substr(1) : text, axis) || axis >= axes)
        throw CLI::ValidationError("--range", "'" + text + "' is none of the " + std::to_string(axes) + " axes");
    return axis;
}

/// "theta=0:3.14" or "1=0:3.14", for each axis that has one.
void set_ranges(TableArguments& options, const std::vector<std::uint32_t>& shape) {
    if (options.ranges.empty()) return;
    for (const std::uint32_t length : shape) options.table.ranges.emplace_back(0.0, length);
    std::set<std::uint32_t> seen;
    for (const std::string& text : options.ranges) {
        const std::size_t equals = text.rfind('='),
                          colon = text.find(':', equals == std::string::npos ? 0 : equals);
        double low = 0.0, high = 0.0;
        if (equals == std::string::npos || colon == std::string::npos ||
            !parse_number(text.substr(equals + 1, colon - equals - 1), low) ||
            !parse_number(text.substr(colon + 1), high))
            throw CLI::ValidationError("--range", "'" + text + "' is not of the form AXIS=LOW:HIGH");
        const std::uint32_t axis = axis_of(text.substr(0, equals), options.table.names, shape.size());
        if (!seen.insert(axis).second)
            throw CLI::ValidationError("--range",
                                       "'" + text + "' is the second one for axis " + std::to_string(axis));
        options.table.ranges[axis] = {low, high};
    }
}

/// What a user should know of the array.
std::vector<std::string> remarks(const input::NpyArray& array) {
    const input::BadValues& bad = array.bad;
    if (bad.count() == 0) return {};
    return {std::to_string(bad.nan) + " NaN, " + std::to_string(bad.infinite) + " infinite and " +
            std::to_string(bad.negative) + " negative numbers set to 0, the first at [" +
            input::index_text(array.shape, bad.first) + "]"};
}

nlohmann::ordered_json report(const TableArguments& options, const input::NpyArray& array, std::size_t bins,
                              const builder::Table& result) {
    const builder::TableAccuracy& a = result.accuracy;
    const input::BadValues& bad = array.bad;
    nlohmann::ordered_json out{
        {"file", options.output},
        {"source", options.array},
        {"shape", array.shape},
        {"indexed", options.table.indexed},
        {"bad_values", {{"nan", bad.nan}, {"infinite", bad.infinite}, {"negative", bad.negative}}},
        {"bytes", result.bytes.size()},
        {"bins", bins},
        {"bins_with_energy", a.lit_bins},
        {"cells", a.cells},
        {"total", result.total},
        {"relative_variance", a.relative_variance},
        {"relative_variance_median", a.median},
        {"relative_variance_worst", a.worst},
        {"kl_divergence", known_json(!a.combined, a.kl_divergence)},
        {"max_weight", a.max_weight},
        {"support_violations", a.support_violations}};
    if (a.combined) out["combined"] = true; // of the file and its partner
    out["notes"] = remarks(array);
    return out;
}

/// The table that is the partner, as `table` refers to it.
input::NpyArray read_other(TableArguments& options) {
    for (const char* option : {"--shares", "--heuristic"})
        if (options.other.empty() && options.given(option))
            throw CLI::ValidationError(option, "is for files with an MIS partner (--mis)");
    if (options.other.empty()) return {};
    for (const char* option : {"--max-weight", "--target-variance"})
        if (options.given(option))
            throw CLI::ValidationError(option, "is for files without an MIS partner (--mis)");
    input::NpyArray other = input::read_npy(options.other, options.input);
    options.table.mis.kind = ACDF_PARTNER_TABLE;
    options.table.other = {other.values.data(), builder::Number::float32, other.shape, {}};
    options.table.other_source.name = input::file_name(options.other);
    options.table.other_source.sha256 = input::file_sha256(options.other);
    return other;
}

builder::Table build(TableArguments& options, const input::NpyArray& array) {
    options.table.source.name = input::file_name(options.array);
    options.table.source.sha256 = input::file_sha256(options.array);
    ProgressBar bar(options.quiet);
    builder::Table result;
    require_built(options.array, builder::table(array, array.bad, options.table, result, told(bar.callback())));
    return result;
}

void run(TableArguments& options) {
    read_goal(*options.command, options.budget, options.table.goal);
    if (options.given("--names")) options.table.names = names_of(options.names);
    const auto limit = limit_threads(options.threads);
    Output output(options.output, options.force, {options.array, options.other}); // refuses early, before the work
    const input::NpyArray array = input::read_npy(options.array, options.input);
    if (!options.quiet)
        for (const std::string& text : remarks(array)) say(options.array + ": " + text);
    const input::NpyArray other = read_other(options);
    if (!options.other.empty() && other.shape != array.shape)
        throw Failure(options.other + ": its shape is not that of " + options.array);
    set_ranges(options, array.shape);
    const builder::Table result = build(options, array);
    output.write(result.bytes.data(), result.bytes.size());
    output.commit(check_reads_back);

    std::size_t bins = 1;
    for (std::uint32_t axis = 0; axis < options.table.indexed; ++axis) bins *= array.shape[axis];
    std::FILE* out = options.output == "-" ? stderr : stdout;
    const builder::TableAccuracy& a = result.accuracy;
    if (options.json) std::fputs(json_text(report(options, array, bins, result)).c_str(), out);
    else if (!options.quiet && bins == 1)
        std::fprintf(out, "%s: %s, %" PRIu64 " cells, %srelative variance %.4g%s\n",
                     printable(options.output).c_str(), to_readable_size(result.bytes.size()).c_str(), a.cells,
                     a.combined ? "with its MIS partner " : "", a.relative_variance,
                     a.combined ? " a sample; not to be used alone" : "");
    else if (!options.quiet)
        std::fprintf(out, "%s: %s, %zu bins, %" PRIu64 " cells, %srelative variance %.4g (mean; worst %.4g)%s\n",
                     printable(options.output).c_str(), to_readable_size(result.bytes.size()).c_str(), bins,
                     a.cells, a.combined ? "with its MIS partner " : "", a.relative_variance, a.worst,
                     a.combined ? "; not to be used alone" : "");
}

void add_axis_options(CLI::App& command, TableArguments& options) {
    command
        .add_option("--indexed", options.table.indexed,
                    "How many of the first axes are chosen by the caller (a view direction, a pixel) instead of "
                    "sampled: each combination of their indices is a bin with a pdf of its own")
        ->check(CLI::Range(0u, 5u))
        ->option_text("K [0]")
        ->group("Axes");
    command.add_option("--names", options.names, "Names of all axes in order, for `acdf info` and --range")
        ->type_name("")
        ->option_text("A,B,... [x0,x1,...]")
        ->group("Axes");
    command
        .add_option("--range", options.ranges,
                    "The coordinates at both ends of an axis, by its name or number: samples and pdfs are in these "
                    "units (--range theta=0:3.14159). May be repeated")
        ->option_text("AXIS=LOW:HIGH [0 to length]")
        ->group("Axes");
    constexpr Named<input::BadValuePolicy> policies[] = {{"error", input::BadValuePolicy::refuse},
                                                         {"zero", input::BadValuePolicy::zero}};
    add_choice(command, "--bad-values", options.input.bad_values, policies,
               "What to do about NaN, infinities and negative numbers: error (refuse, and say how many and where) "
               "or zero (nothing is sampled there)")
        ->option_text("NAME [error]")
        ->group("Input");
}

void add_size_options(CLI::App& command, TableArguments& options) {
    add_goal(command, options.table.goal.cells, options.budget, options.table.goal.variance,
             {"Cells a bin, on average, instead of a size: a bin that is harder gets more of them", "N",
              "SIZE [64KiB; of more than 256 bins 256 bytes a bin]", ", as mean over the bins"});
    add_max_weight(command, options.table.max_weight, ". In every bin");
}

void add_mis_options(CLI::App& command, TableArguments& options) {
    command
        .add_option("--mis", options.other,
                    "Another table of the same shape, which your renderer also samples, weighting both by multiple "
                    "importance sampling: within each bin its numbers are its pdf. The file's pdf is 0 where that "
                    "table alone is enough: never use such a file alone")
        ->type_name("")
        ->option_text("OTHER.npy")
        ->group("MIS partner");
    add_weighing(command, options.table.mis);
}

} // namespace

void add_table(CLI::App& program, int& exit_code) {
    auto options = std::make_shared<TableArguments>();
    CLI::App& command = *program.add_subcommand(
        "table", "Compress a table of any number of axes: points by the numbers stored there");
    options->command = &command;
    command
        .add_option("ARRAY", options->array,
                    "The table: an .npy file (numpy.save) of float32 or float64, 1 to 6 axes, no number negative")
        ->required()
        ->type_name("")
        ->group("Input");
    add_axis_options(command, *options);
    add_size_options(command, *options);
    add_mis_options(command, *options);
    add_output(command, options->output, options->force,
               "The .acdf file to write, or a folder for it; without it NAME.acdf beside the array");
    add_codec(command, options->table.codec);
    add_threads(command, options->threads);
    add_json(command, options->json);
    add_quiet(command, options->quiet);
    command.footer(
        help_footer("Each number is the value of a function that is constant on its box of the grid. The pdf is "
                    "per product of the units of the sampled axes. A float64 table is fitted as float32, scaled by "
                    "a power of two where it would not fit; the integral stays exact.",
                    "acdf table histogram.npy -o histogram.acdf\n"
                    "acdf table field.npy -o field.acdf --indexed 2 --names s,t,u,v --range u=-1:1 --range v=-1:1\n"
                    "acdf table volume.npy -o volume.acdf --budget 256KiB --json"));
    command.callback([options, &exit_code] {
        options->output = output_names({options->array}, options->output, ".acdf")[0];
        run(*options);
        exit_code = exit_done;
    });
}

} // namespace acdf::tools
