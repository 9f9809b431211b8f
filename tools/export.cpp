// acdf export: samples and pdfs of an environment, of several maps, of a local environment or a BRDF for shaders:
// functions in their languages, and tables.
#include "shader/texts.h"
#include "tools/cli/choice.h"
#include "tools/cli/coordinates.h"
#include "tools/cli/file_input.h"
#include "tools/cli/help.h"
#include "tools/cli/json.h"
#include "tools/cli/options.h"
#include "tools/cli/output.h"
#include "tools/commands.h"

#include <acdf/shader/tables.h>

#include <nlohmann/json.hpp>

#include <cstdio>
#include <filesystem>
#include <optional>

namespace acdf::tools {
namespace {

enum class Target { c, glsl, hlsl, wgsl, json };

struct ExportArguments {
    std::string file;
    Target target = Target::c;
    std::string output = "-", tables;
    bool force = false;
};

constexpr int texture_width = 2048; // of the texture that head.txt of GLSL reads

/// A line of eight words a row.
std::string rows_of_words(const ShaderTables& tables, const char* format, const char* indent) {
    std::string text;
    char word[24];
    for (std::size_t i = 0; i < tables.size(); ++i) {
        std::snprintf(word, sizeof word, format, static_cast<unsigned>(tables.words()[i]));
        text += i % 8 == 0 ? indent : " ";
        text += word;
        if (i + 1 < tables.size()) text += i % 8 == 7 ? ",\n" : ",";
    }
    return text + "\n";
}

std::string c_text(const ShaderTables& tables, bool with_words) {
    const std::string text = shader_walk_c;
    if (!with_words) return text;
    return text + "\n#if !defined(ACDF_TABLES_H) && !defined(__OPENCL_VERSION__)\n#define ACDF_TABLES_H\n" +
           "static const uint32_t acdf_tables[" + std::to_string(tables.size()) + "] = {\n" +
           rows_of_words(tables, "0x%08Xu", "    ") + "};\n#endif\n";
}

/// Those of several maps, in the order of acdf_sky.
std::vector<std::string> sky_axes(const File& file) {
    return file.kind() == ACDF_KIND_INDEXED ? indexed_axes(file) : std::vector<std::string>();
}

/// What a program needs to make a buffer or a texture of the tables, and to check that they are the file's.
std::string description(const ExportArguments& options, const LoadedFile& loaded, const ShaderTables& tables) {
    const std::size_t rows = (tables.size() + texture_width - 1) / texture_width;
    nlohmann::ordered_json json = {{"what", "tables for the functions of acdf export"},
                                   {"version", ACDF_VERSION},
                                   {"element", "uint32, little-endian"},
                                   {"words", tables.size()},
                                   {"texture", {{"format", "r32ui"}, {"width", texture_width}, {"height", rows}}}};
    json["resolution"] = {loaded.file.axis(0).resolution, loaded.file.axis(1).resolution};
    json["total"] = loaded.file.description().total;
    for (const std::string& axis : sky_axes(loaded.file)) json["axes"].push_back(axis);
    if (loaded.file.kind() == ACDF_KIND_ENVIRONMENT)
        json["recommended_light_share"] = loaded.file.environment().recommended_light_share();
    json["requires_mis"] = loaded.file.partner() != nullptr;
    const std::string head = json.dump(2);
    if (!options.tables.empty()) return head + "\n";
    return head.substr(0, head.size() - 2) + ",\n  \"tables\": [\n" + rows_of_words(tables, "%u", "    ") +
           "  ]\n}\n";
}

std::string text_of(const ExportArguments& options, const LoadedFile& loaded, const ShaderTables& tables) {
    switch (options.target) {
    case Target::c:
        return c_text(tables, options.tables.empty());
    case Target::glsl:
        return shader_walk_glsl;
    case Target::hlsl:
        return shader_walk_hlsl;
    case Target::wgsl:
        return shader_walk_wgsl;
    case Target::json:
        break;
    }
    return description(options, loaded, tables);
}

ShaderTables make_tables(const ExportArguments& options, const LoadedFile& loaded) {
    ShaderTables tables;
    if (const Status status = ShaderTables::make(loaded.file, tables); !status.ok())
        throw Failure(options.file + ": " + status.message);
    return tables;
}

bool one_file(const std::string& a, const std::string& b) {
    std::error_code ignored; // then empty
    const std::filesystem::path path = std::filesystem::weakly_canonical(a, ignored);
    return a == b || (!path.empty() && path == std::filesystem::weakly_canonical(b, ignored));
}

void run(const ExportArguments& options) {
    if (options.output == "-" && options.tables == "-")
        throw CLI::ValidationError("--tables", "stdout takes one of the two; name a file with -o or --tables");
    if (!options.tables.empty() && options.tables != "-" && one_file(options.tables, options.output))
        throw Failure(options.tables + ": is named for both, the text and the tables; name two files");
    Output output(options.output, options.force, {options.file});
    std::optional<Output> words;
    if (!options.tables.empty())
        words.emplace(options.tables, options.force, std::vector<std::string>{options.file});
    const LoadedFile loaded = load_file(options.file);
    const ShaderTables tables = make_tables(options, loaded);
    output.write(text_of(options, loaded, tables));
    if (words) {
        words->write(tables.words(), 4 * tables.size());
        words->commit();
    }
    output.commit();
}

} // namespace

void add_export(CLI::App& program, int& exit_code) {
    constexpr Named<Target> targets[] = {{"c", Target::c},
                                         {"glsl", Target::glsl},
                                         {"hlsl", Target::hlsl},
                                         {"wgsl", Target::wgsl},
                                         {"json", Target::json}};
    auto options = std::make_shared<ExportArguments>();
    CLI::App* command = program.add_subcommand("export", "Write an environment (also of several maps), a local "
                                                         "environment or a BRDF for shaders: functions that "
                                                         "sample and evaluate, and tables");
    command
        ->add_option("FILE", options->file,
                     "The .acdf file of an environment, a local environment or a BRDF (- is stdin)")
        ->required()
        ->type_name("");
    add_choice(*command, "--target", options->target, targets,
               "The language of the functions: glsl (WebGL 2, OpenGL, Vulkan), wgsl (WebGPU), hlsl (and Slang) "
               "or c (C99, C++, CUDA, HIP, OpenCL C). json: no functions, but a description of the tables, for a "
               "program that loads them")
        ->required()
        ->option_text("NAME (required)")
        ->group("Output");
    command
        ->add_option(
            "--tables", options->tables,
            "The file for the tables: 32-bit words, little-endian, for a buffer or a texture. Without it c "
            "and json hold them as text, and the others do without: their functions are the same for all "
            "files")
        ->type_name("FILE")
        ->group("Output");
    add_output(*command, options->output, options->force, "The text to write, stdout by default");
    command->footer(help_footer(
        "Samples and pdfs are the reader's, from 32-bit words and floats alone: the tables take some 60 bytes a "
        "cell. docs/shaders.md says how to bind the tables, and how nearly results agree.",
        "acdf export sky.acdf --target glsl -o sky.glsl --tables sky.bin\n"
        "acdf export sky.acdf --target wgsl --tables sky.bin > sky.wgsl\n"
        "acdf export sky.acdf --target c -o sky.h               # functions and tables in one header\n"
        "acdf export nickel.acdf --target glsl --tables nickel.bin > lobe.glsl   # also serves local files\n"
        "acdf export sky.acdf --target json --tables sky.bin    # how large the texture is"));
    command->callback([options, &exit_code] {
        run(*options);
        exit_code = exit_done;
    });
}

} // namespace acdf::tools
