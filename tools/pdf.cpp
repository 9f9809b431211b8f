// acdf pdf: pdfs of given directions.
#include "tools/cli/coordinates.h"
#include "tools/cli/directions_csv.h"
#include "tools/cli/file_input.h"
#include "tools/cli/help.h"
#include "tools/cli/normal_option.h"
#include "tools/cli/options.h"
#include "tools/cli/output.h"
#include "tools/cli/table_points.h"
#include "tools/cli/view_option.h"
#include "tools/commands.h"

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>

namespace acdf::tools {
namespace {

struct PdfArguments {
    std::string file;
    std::string directions = "-";
    std::string output = "-";
    std::vector<std::string> at;
    std::vector<float> normal;
    bool normalize = false, csv = false, force = false;
    std::string view;
};

/// The line of a direction (and what stands behind it); `pdf` is a function of a unit vector of floats.
template <class Pdf>
std::string pdf_line(std::vector<double> v, const PdfArguments& options, const Pdf& pdf) {
    if (options.normalize) {
        const double length = std::hypot(v[0], v[1], v[2]);
        for (std::size_t i = 0; i < 3 && length > 0.0 && std::isfinite(length); ++i) v[i] /= length;
    }
    const float direction[3] = {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
    std::string line;
    char text[32];
    for (const double x : v) {
        std::snprintf(text, sizeof(text), "%.9g,", static_cast<double>(static_cast<float>(x)));
        if (options.csv) line += text;
    }
    std::snprintf(text, sizeof(text), "%.9g\n", static_cast<double>(pdf(direction)));
    return line + text;
}

/// The next line without its end; false where there is none. Throws Failure where it is longer than any point: some
/// inputs never end a line.
bool next_line(std::istream& in, std::string& line) {
    constexpr std::size_t longest = 65536;
    line.clear();
    for (int c = in.get(); c != std::istream::traits_type::eof(); c = in.get()) {
        if (c == '\n') return true;
        if (line.size() == longest) throw Failure("is longer than 65536 characters");
        line += static_cast<char>(c);
    }
    return !line.empty();
}

/// Writes `answer(point)` for each point in `in`.
template <class Answer>
void evaluate(std::istream& in, PointParser parser, const PdfArguments& options, Output& output,
              const Answer& answer) {
    const std::string name = options.directions == "-" ? "stdin" : options.directions;
    std::string line;
    for (std::uint64_t number = 1;; ++number) {
        try {
            if (!next_line(in, line)) break;
            if (const auto point = parser.parse(line)) output.write(answer(*point));
        } catch (const Failure& failure) {
            throw Failure(name + ": line " + std::to_string(number) + ": " + failure.what());
        }
    }
    if (in.bad()) throw Failure(name + ": cannot read: " + std::strerror(errno));
}

void evaluate_environment(const File& file, std::istream& in, const PdfArguments& options, Output& output) {
    if (!options.at.empty()) throw Failure(options.file + ": an environment has no bins; leave out --at");
    const EnvironmentView view = file.environment();
    if (options.csv) output.write("x,y,z,pdf\n");
    evaluate(in, PointParser(), options, output, [&](const std::vector<double>& direction) {
        return pdf_line(direction, options, [&](const float d[3]) { return view.pdf(d); });
    });
}

void evaluate_indexed(const LoadedFile& loaded, std::istream& in, const PdfArguments& options, Output& output) {
    const MixedEnvironment view = chosen_environment(options.file, loaded, options.at);
    if (options.csv) output.write("x,y,z,pdf\n");
    evaluate(in, PointParser(), options, output, [&](const std::vector<double>& direction) {
        return pdf_line(direction, options, [&](const float d[3]) { return view.pdf(d); });
    });
}

void evaluate_local(const File& file, std::istream& in, const PdfArguments& options, Output& output) {
    if (!options.at.empty()) throw Failure(options.file + ": a local environment has no --at; give --normal X,Y,Z");
    const LocalEnvironmentView view = file.local();
    if (!options.normal.empty()) {
        const AcdfLocalPoint point = view.at(chosen_normal(options.file, options.normal).data());
        if (options.csv) output.write("x,y,z,pdf\n");
        return evaluate(in, PointParser(), options, output, [&](const std::vector<double>& direction) {
            return pdf_line(direction, options, [&](const float d[3]) { return view.pdf(point, d); });
        });
    }
    if (options.csv) output.write("x,y,z,nx,ny,nz,pdf\n");
    evaluate(in, PointParser({"x", "y", "z", "nx", "ny", "nz"}), options, output,
             [&](const std::vector<double>& both) {
                 const float n[3] = {static_cast<float>(both[3]), static_cast<float>(both[4]),
                                     static_cast<float>(both[5])};
                 return pdf_line(both, options, [&](const float d[3]) { return view.pdf(n, d); });
             });
}

void evaluate_brdf(const File& file, std::istream& in, const PdfArguments& options, Output& output) {
    if (!options.at.empty()) throw Failure(options.file + ": a BRDF has no --at; give --view THETA[,PHI]");
    const BrdfView view = file.brdf();
    const std::array<float, 3> wo = chosen_view(options.file, file, options.view);
    if (options.csv) output.write("x,y,z,pdf\n");
    evaluate(in, PointParser(), options, output, [&](const std::vector<double>& direction) {
        return pdf_line(direction, options, [&](const float d[3]) { return view.pdf(wo.data(), d); });
    });
}

void evaluate_table(const File& file, std::istream& in, const PdfArguments& options, Output& output) {
    if (options.normalize) throw Failure(options.file + ": a table has no directions; leave out --normalize");
    const TableView view = file.table();
    const std::vector<std::uint32_t> bin = chosen_bin(options.file, view, options.at);
    if (options.csv) output.write(point_columns("x", view.sampled_count()) + "pdf\n");
    evaluate(in, PointParser(point_names(view.sampled_count())), options, output,
             [&](const std::vector<double>& x) {
                 return (options.csv ? point_text(x.data(), x.size()) : "") +
                        number_text(view.pdf(bin.data(), x.data())) + "\n";
             });
}

void run(const PdfArguments& options) {
    if (options.file == "-" && options.directions == "-")
        throw CLI::ValidationError("FILE", "the .acdf file and the directions cannot both come from stdin");
    Output output(options.output, options.force, {options.file, options.directions});
    const LoadedFile loaded = load_file(options.file);
    const AcdfKind kind = loaded.file.kind();
    if (kind != ACDF_KIND_LOCAL) refuse_normal(options.file, options.normal);
    if (kind != ACDF_KIND_BRDF) refuse_view(options.file, options.view);
    std::ifstream file;
    if (options.directions != "-") {
        refuse_endless(options.directions);
        file.open(options.directions);
        if (!file || file.peek() == std::ifstream::traits_type::eof()) {
            const int error = errno;
            if (!file.is_open() || error == EISDIR)
                throw Failure(options.directions + ": cannot open: " + std::strerror(error));
        }
    }
    std::istream& in = options.directions == "-" ? std::cin : file;
    if (kind == ACDF_KIND_ENVIRONMENT) evaluate_environment(loaded.file, in, options, output);
    else if (kind == ACDF_KIND_LOCAL) evaluate_local(loaded.file, in, options, output);
    else if (kind == ACDF_KIND_BRDF) evaluate_brdf(loaded.file, in, options, output);
    else if (kind == ACDF_KIND_INDEXED) evaluate_indexed(loaded, in, options, output);
    else if (kind == ACDF_KIND_TABLE) evaluate_table(loaded.file, in, options, output);
    output.commit();
}

} // namespace

void add_pdf(CLI::App& program, int& exit_code) {
    auto options = std::make_shared<PdfArguments>();
    CLI::App* command =
        program.add_subcommand("pdf", "Evaluate the pdf of directions, or points, given on stdin or in a file");
    command->add_option("FILE", options->file, "The .acdf file to evaluate (- is stdin)")
        ->required()
        ->type_name("");
    command
        ->add_option("DIRECTIONS", options->directions,
                     "Text with one direction a line: x y z or x,y,z (- or nothing is stdin). A CSV with a header "
                     "line may have more columns: x, y and z are found by name")
        ->type_name("");
    command
        ->add_flag("--normalize", options->normalize,
                   "Scale directions to unit length first. Without it a direction that is not of unit length has "
                   "pdf 0, as in a renderer, where it shows a mistake")
        ->group("Evaluation");
    add_normal(*command, options->normal, "Evaluation", "; without it each line has one: x y z nx ny nz");
    add_view(*command, options->view, "Evaluation");
    add_bin(*command, options->at, "Evaluation");
    command->add_flag("--csv", options->csv, "Print x,y,z,pdf instead of the pdf alone")->group("Output");
    add_output(*command, options->output, options->force, "The file to write, stdout by default");
    command->footer(
        help_footer("Prints one pdf a line, per steradian, in the order of the directions; 0 where no sample can "
                    "fall. Blank lines and comments after a # are skipped. Of a table: points x0 x1 ... in the "
                    "units of its sampled axes, pdfs per product of these units.",
                    "echo '0 0 1' | acdf pdf sky.acdf\n"
                    "acdf pdf sky.acdf directions.csv --csv -o pdfs.csv\n"
                    "acdf sample local.acdf -n 9 --normal 0,0,1 | acdf pdf local.acdf --normal 0,0,1\n"
                    "acdf sample sky.acdf -n 1000 | acdf pdf sky.acdf"));
    command->callback([options, &exit_code] {
        run(*options);
        exit_code = exit_done;
    });
}

} // namespace acdf::tools
