// acdf info: what is inside a file, in a form for people or as JSON.
#include "build/accuracy/cells.h"
#include "build/text/format_names.h"
#include "build/text/partner.h"
#include "measure/samplers/light_samplers.h"
#include "tools/cli/file_input.h"
#include "tools/cli/help.h"
#include "tools/cli/json.h"
#include "tools/cli/messages.h"
#include "tools/cli/options.h"
#include "tools/cli/sizes.h"
#include "tools/commands.h"
#include "visibility/visible_view.h"

#include <acdf/curves/curves.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <map>

namespace acdf::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr char accuracy_prefix[] = "accuracy.";

struct InfoArguments {
    std::vector<std::string> files;
    bool json = false;
};

// ---- what the tree holds -------------------------------------------------------------------------------

struct TreeCounts {
    std::uint64_t curves = 0;
    std::uint64_t cells = 0; // segments that end; one of a shared curve counts once
};

const AcdfNormalRows* rows_of(const File& file) {
    if (file.kind() == ACDF_KIND_BRDF) return file.brdf().data().rows_of_views;
    return file.kind() == ACDF_KIND_LOCAL ? file.local().data().rows_of_normals : nullptr;
}

TreeCounts count_tree(const LoadedFile& loaded) {
    const File& file = loaded.file;
    TreeCounts counts;
    if (file.kind() == ACDF_KIND_INDEXED) {
        counts.cells = loaded.maps.data().halved->count + std::uint64_t{1};
        return counts;
    }
    if (file.kind() == ACDF_KIND_TABLE) {
        for (std::uint32_t bin = 0; bin < file.description().bin_count; ++bin)
            if (file.bin(bin).share > 0.0f)
                build::for_each_table_cell(file, bin, [&](const build::TableCell&) { ++counts.cells; });
        return counts;
    }
    if (!file.has_bins()) {
        counts.cells = file.environment().data().halved->count + 1;
        return counts;
    }
    if (rows_of(file)) {
        counts.cells =
            (file.kind() == ACDF_KIND_BRDF ? file.brdf().data().halved : file.local().environment().data().halved)
                ->count +
            std::uint64_t{1};
        return counts;
    }
    std::uint32_t units;
    const std::uint8_t* tree = acdf_curves_tree(file.get(), &units);
    for (std::uint32_t at = 0; at < units;) {
        AcdfCurve curve;
        const std::size_t next = acdf_curve_decode(tree, at, &curve);
        ++counts.curves;
        for (std::uint32_t i = 0; i < curve.segments; ++i)
            if (acdf_curve_link(&curve, i) == 0) ++counts.cells;
        at = static_cast<std::uint32_t>(next);
    }
    return counts;
}

// ---- parts of the report -------------------------------------------------------------------------------

std::string to_string(Text text) { return text.data ? std::string(text.data, text.size) : std::string(); }

std::string axis_name(const AcdfAxis& axis) {
    const char* name = reinterpret_cast<const char*>(axis.name);
    return std::string(name, strnlen(name, sizeof(axis.name)));
}

// A number of the metadata as a number, anything else as text.
Json metadata_value(const std::string& text) {
    double number = 0.0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc{} || rest != end) return text;
    std::uint64_t integer = 0;
    const auto [integer_rest, integer_error] = std::from_chars(text.data(), end, integer);
    if (integer_error == std::errc{} && integer_rest == end) return integer;
    return number;
}

Json axes_json(const File& file) {
    Json axes = Json::array();
    for (std::uint32_t i = 0; i < file.description().axis_count; ++i) {
        const AcdfAxis& axis = file.axis(i);
        axes.push_back({{"name", axis_name(axis)},
                        {"role", build::role_name(axis.role)},
                        {"measure", build::measure_name(axis.measure)},
                        {"resolution", axis.resolution},
                        {"low", axis.low},
                        {"high", axis.high}});
    }
    return axes;
}

Json chunks_json(const File& file) {
    Json chunks = Json::array();
    const AcdfHeader& header = file.header();
    const auto* table = reinterpret_cast<const AcdfChunk*>(&header + 1);
    for (std::uint32_t i = 0; i < header.chunk_count; ++i)
        chunks.push_back({{"type", build::chunk_name(table[i].type)},
                          {"codec", build::codec_name(table[i].codec)},
                          {"offset", table[i].offset},
                          {"stored", table[i].stored_length},
                          {"raw", table[i].raw_length}});
    return chunks;
}

// Keys "accuracy.NAME" and "source.NAME" as objects, the others as they are.
void add_metadata(const File& file, Json& report) {
    Json source = Json::object(), accuracy = Json::object(), other = Json::object();
    for (std::uint32_t i = 0; i < file.metadata_count(); ++i) {
        Text key_text, value_text;
        file.metadata(i, key_text, value_text);
        const std::string key = to_string(key_text), value = to_string(value_text);
        if (key.rfind("source.", 0) == 0) source[key.substr(7)] = value;
        else if (key.rfind(accuracy_prefix, 0) == 0)
            accuracy[key.substr(sizeof(accuracy_prefix) - 1)] = metadata_value(value);
        else if (key != "tool" && key != "fit.options") other[key] = value;
    }
    report["source"] = source;
    report["tool"] = to_string(file.metadata("tool"));
    report["options"] = to_string(file.metadata("fit.options"));
    report["accuracy"] = accuracy;
    if (!other.empty()) report["metadata"] = other;
}

/// What a local environment has beside its trees.
Json local_json(const File& file) {
    const AcdfVisibleLocal light = visible_view(file).data();
    const AcdfLocal& local = light.local;
    std::uint64_t stored = 0;
    for (std::uint32_t i = 0; i < file.description().bin_count; ++i) stored += file.bin(i).root != ACDF_NO_ROOT;
    Json report;
    report["normals"] = local.subdivisions > 0 ? std::to_string(local.subdivisions)
                                               : std::to_string(local.columns) + "x" + std::to_string(local.rows);
    report["bins_stored"] = stored;
    const AcdfNormalRows* const rows = local.rows_of_normals;
    report["tiles"] = rows ? rows->splits + 1 : 0;
    report["rows"] = rows ? rows->rows : 0;
    report["cosine_share"] = local.cosine_share;
    if (const AcdfVisibility* visibility = light.cells.header)
        report["visibility"] = {{"cells", visibility->split_count + 1},
                                {"rows", visibility->row_count},
                                {"columns", visibility->column_count},
                                {"low", visibility->low},
                                {"high", visibility->high}};
    if (const AcdfPortals* portals = light.portals.header)
        report["portals"] = {{"count", portals->portal_count},
                             {"maps", portals->map_count},
                             {"cells", portals->size},
                             {"pieces", portals->pieces}};
    return report;
}

/// What the maps of an indexed environment have.
Json maps_json(const LoadedFile& loaded) {
    const AcdfIndexed& data = loaded.maps.data();
    std::uint64_t suns = 0;
    for (std::uint32_t i = 0; i < data.top->maps; ++i) suns += data.maps[i].sun_share > 0.0f;
    Json report;
    report["count"] = data.top->maps;
    report["splits"] = data.top->splits;
    report["suns"] = suns;
    Json axes = Json::object();
    const double* at = data.coordinates;
    for (std::uint32_t axis = 0; axis < data.axes; at += data.counts[axis++])
        axes[axis_name(loaded.file.axis(2 + axis))] = std::vector<double>(at, at + data.counts[axis]);
    report["coordinates"] = axes;
    return report;
}

/// What a file is not to be used without.
Json partner_json(const File& file) {
    const AcdfPartner& partner = *file.partner();
    Json report;
    report["kind"] = build::partner_name(static_cast<AcdfPartnerKind>(partner.kind));
    report["heuristic"] = build::heuristic_name(static_cast<AcdfHeuristic>(partner.heuristic));
    report["share"] = partner.share;
    report["recommended_light_share"] = partner.recommended_light_share;
    float least = partner.recommended_light_share, most = least;
    for (std::uint32_t i = 0; i < partner.record_count; ++i) {
        if (file.kind() != ACDF_KIND_TABLE && file.bin(i).root == ACDF_NO_ROOT) continue;
        least = std::min(least, acdf_partner_bin_share(&partner, i));
        most = std::max(most, acdf_partner_bin_share(&partner, i));
    }
    report["least_recommended_light_share"] = least;
    report["largest_recommended_light_share"] = most;
    return report;
}

Json describe(const std::string& path, const LoadedFile& loaded) {
    const File& file = loaded.file;
    const AcdfHeader& header = file.header();
    const AcdfDescription& description = file.description();
    const TreeCounts counts = count_tree(loaded);
    Json report;
    report["file"] = path;
    report["kind"] = build::kind_name(header.kind);
    report["version"] = std::to_string(header.version_major) + "." + std::to_string(header.version_minor);
    report["bytes"] = file.size();
    report["table_bytes"] = file.table_bytes() + loaded.maps.table_bytes();
    report["memory_bytes"] = measure::memory_of(file) + loaded.maps.table_bytes();
    report["bins"] = description.bin_count;
    report["cells"] = counts.cells;
    report["curves"] = counts.curves;
    if (header.kind == ACDF_KIND_LOCAL) report["local"] = local_json(file);
    if (header.kind == ACDF_KIND_INDEXED) report["maps"] = maps_json(loaded);
    if (file.partner()) report["partner"] = partner_json(file);
    report["axes"] = axes_json(file);
    report["fit"] = build::fit_name(description.fit);
    report["filter"] = build::filter_name(description.filter);
    report["parameterization"] = build::parameterization_name(description.parameterization);
    report["channel_weights"] = description.channel_weights;
    report["total"] = description.total;
    report["chunks"] = chunks_json(file);
    add_metadata(file, report);
    return report;
}

// ---- for people ----------------------------------------------------------------------------------------

void line(const char* name, const std::string& value) {
    if (!value.empty()) std::printf("  %-12s %s\n", name, on_one_line(value).c_str());
}

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.6g", value);
    return text;
}

std::string text_of(const Json& value) {
    if (value.is_array()) {
        std::string text;
        for (const Json& each : value) text += (text.empty() ? "(" : ", ") + text_of(each);
        return text + ")";
    }
    return value.is_string()         ? value.get<std::string>()
           : value.is_number_float() ? number(value.get<double>())
                                     : value.dump();
}

std::string target_text(const Json& report) {
    if (report["kind"] == "table") return "a table of numbers; integral " + number(report["total"]);
    const Json& w = report["channel_weights"];
    return number(w[0]) + " r + " + number(w[1]) + " g + " + number(w[2]) + " b, looked up " +
           text_of(report["filter"]) + "; integral " + number(report["total"]);
}

std::string local_text(const Json& local) {
    const std::string bins =
        "--normals " + text_of(local["normals"]) + ", " + text_of(local["bins_stored"]) + " stored; ";
    const std::string shared =
        local["tiles"] == 0 ? "a tree each"
                            : text_of(local["tiles"]) + " tiles shared by " + text_of(local["rows"]) + " rows";
    const std::string visibility = local.contains("visibility")
                                       ? "; " + text_of(local["visibility"]["cells"]) + " visibility cells from " +
                                             text_of(local["visibility"]["low"]) + " to " +
                                             text_of(local["visibility"]["high"])
                                       : "";
    const std::string portals =
        local.contains("portals")
            ? "; " + text_of(local["portals"]["count"]) + " portals, " + text_of(local["portals"]["maps"]) +
                  " maps of " + text_of(local["portals"]["cells"]) + " x " + text_of(local["portals"]["cells"])
            : "";
    return bins + shared + "; cosine share " + number(local["cosine_share"]) + visibility + portals;
}

std::string partner_line(const Json& partner) {
    return text_of(partner["kind"]) + " (" + text_of(partner["heuristic"]) + " heuristic, " +
           number(100.0 * partner["share"].get<double>()) + " % of samples from this file); recommended share " +
           number(partner["recommended_light_share"]) + ", from " +
           number(partner["least_recommended_light_share"]) + " to " +
           number(partner["largest_recommended_light_share"]) + "; not to be used alone";
}

std::string source_text(const Json& source) {
    std::string text;
    for (const auto& [key, value] : source.items()) {
        if (!text.empty()) text += ", ";
        text += key == "name" ? text_of(value) : key + " " + text_of(value);
    }
    return text;
}

void print_table(const char* name, const Json& object) {
    for (const auto& [key, value] : object.items()) {
        std::printf("  %-12s %-28s %s\n", name, on_one_line(key).c_str(), on_one_line(text_of(value)).c_str());
        name = "";
    }
}

void print(const Json& report) {
    const std::uint64_t bytes = report["bytes"];
    std::printf("%s: %s, format %s, %llu bytes (%s)\n", on_one_line(text_of(report["file"])).c_str(),
                text_of(report["kind"]).c_str(), text_of(report["version"]).c_str(),
                static_cast<unsigned long long>(bytes), to_readable_size(bytes).c_str());
    line("target", target_text(report));
    const std::string structure = report["curves"] == 0 ? "" : " in " + text_of(report["curves"]) + " curves";
    line("fit", text_of(report["fit"]) + "; stored: " + text_of(report["cells"]) + " cells" + structure + ", " +
                    text_of(report["bins"]) + (report["bins"] == 1 ? " bin" : " bins"));
    const std::uint64_t tables = report["table_bytes"], memory = report["memory_bytes"];
    if (memory > bytes)
        line("in memory", to_readable_size(memory) + (tables > 0 ? ", of which " + to_readable_size(tables) +
                                                                       " are tables made when it is opened"
                                                                 : ""));
    if (report.contains("local")) line("normals", local_text(report["local"]));
    if (report.contains("maps"))
        line("maps", text_of(report["maps"]["count"]) + ", " + text_of(report["maps"]["suns"]) + " with a sun; " +
                         text_of(report["maps"]["splits"]) + " splits have a code of each");
    if (report.contains("partner")) line("partner", partner_line(report["partner"]));
    line("source", source_text(report["source"]));
    line("made by", text_of(report["tool"]));
    line("options", text_of(report["options"]));
    const char* name = "axes";
    for (const Json& axis : report["axes"]) {
        line(name, text_of(axis["name"]) + " (" + text_of(axis["role"]) + ", " + text_of(axis["measure"]) + "), " +
                       text_of(axis["resolution"]) + " steps from " + number(axis["low"]) + " to " +
                       number(axis["high"]));
        name = "";
    }
    name = "chunks";
    for (const Json& chunk : report["chunks"]) {
        const bool packed = chunk["codec"] != "none";
        line(name, text_of(chunk["type"]) + " at " + text_of(chunk["offset"]) + ", " + text_of(chunk["stored"]) +
                       " bytes" +
                       (packed ? " (" + text_of(chunk["codec"]) + ", " + text_of(chunk["raw"]) + " raw)" : ""));
        name = "";
    }
    print_table("accuracy", report["accuracy"]);
    if (report.contains("metadata")) print_table("metadata", report["metadata"]);
}

// One bad file does not hide what the others hold; it does decide the exit code.
int run(const InfoArguments& options) {
    Json reports = Json::array();
    int exit_code = exit_done;
    for (const std::string& path : options.files) {
        try {
            const LoadedFile loaded = load_file(path);
            reports.push_back(describe(path, loaded));
            if (options.json) continue;
            if (reports.size() > 1) std::printf("\n");
            print(reports.back());
        } catch (const Failure& failure) {
            say(std::string("acdf: ") + failure.what());
            exit_code = exit_failed;
        }
    }
    if (options.json && !reports.empty())
        std::fputs(json_text(options.files.size() == 1 ? reports[0] : reports).c_str(), stdout);
    return exit_code;
}

} // namespace

void add_info(CLI::App& program, int& exit_code) {
    auto options = std::make_shared<InfoArguments>();
    CLI::App* command = program.add_subcommand(
        "info", "Show what is inside: size, cells, axes, source, and the accuracy measured when it was built");
    command->add_option("FILE", options->files, "The .acdf files to describe (- is stdin)")
        ->required()
        ->type_name("");
    add_json(*command, options->json);
    command->footer(help_footer("The accuracy was measured at the build and is stored in the file, so no source is "
                                "needed. `acdf measure` computes it anew. A cell is a part of the sphere where the "
                                "pdf is constant (or linear). A cell that several bins share counts once.",
                                "acdf info sky.acdf\n"
                                "acdf info --json sky.acdf | jq .accuracy.relative_variance\n"
                                "acdf info --json *.acdf | jq -r '.[] | [.file, .bytes, .cells] | @tsv'"));
    command->callback([options, &exit_code] { exit_code = run(*options); });
}

} // namespace acdf::tools
