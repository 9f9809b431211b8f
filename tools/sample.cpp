// acdf sample: directions sampled from a file, as CSV.
#include "measure/sequences.h"
#include "tools/cli/choice.h"
#include "tools/cli/coordinates.h"
#include "tools/cli/file_input.h"
#include "tools/cli/help.h"
#include "tools/cli/messages.h"
#include "tools/cli/normal_option.h"
#include "tools/cli/options.h"
#include "tools/cli/output.h"
#include "tools/cli/progress.h"
#include "tools/cli/table_points.h"
#include "tools/cli/view_option.h"
#include "tools/commands.h"

#include <algorithm>
#include <cstdio>
#include <memory>

namespace acdf::tools {
namespace {

struct SampleArguments {
    std::string file;
    std::uint64_t count = 0;
    std::optional<std::uint64_t> seed;
    measure::SequenceKind sequence = measure::SequenceKind::random;
    std::vector<std::string> at;
    std::vector<float> normal;
    std::string output = "-";
    bool force = false, quiet = false;
    std::string view;
};

constexpr std::uint64_t max_count = std::uint64_t{1} << 32; // of the Sobol' sequence; 300 GB of text
constexpr std::size_t kTogether = 4096;                     // are sampled at once

// 9 and 17 significant digits give back exactly the float and the double that they print.
std::string csv_line(const double u[2], const DirectionSample& s) {
    char text[160];
    std::snprintf(text, sizeof(text), "%.17g,%.17g,%.9g,%.9g,%.9g,%.9g\n", u[0], u[1],
                  static_cast<double>(s.direction[0]), static_cast<double>(s.direction[1]),
                  static_cast<double>(s.direction[2]), static_cast<double>(s.pdf));
    return text;
}

/// Calls `write(count)` until as many samples are written as are asked for.
template <class Write>
void write_samples(const SampleArguments& options, const Write& write) {
    ProgressBar bar(options.quiet);
    const build::Progress progress = bar.callback();
    for (std::uint64_t done = 0; done < options.count; done += kTogether) {
        progress(static_cast<double>(done) / static_cast<double>(options.count), "sampling");
        write(static_cast<std::size_t>(std::min<std::uint64_t>(options.count - done, kTogether)));
    }
}

/// Writes numbers of the sequence, and the directions that `sample(numbers, count, samples)` makes of them.
template <class Draw>
void write_directions(const SampleArguments& options, Output& output, const Draw& draw) {
    measure::Sequence sequence(options.sequence, options.count, options.seed);
    const auto u = std::make_unique<double[][2]>(kTogether);
    const auto samples = std::make_unique<DirectionSample[]>(kTogether);
    output.write("u0,u1,x,y,z,pdf\n");
    write_samples(options, [&](std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            const std::array<double, 2> next = sequence.next();
            u[i][0] = next[0], u[i][1] = next[1];
        }
        draw(u.get(), count, samples.get());
        for (std::size_t i = 0; i < count; ++i) output.write(csv_line(u[i], samples[i]));
    });
}

using Numbers = const double (*)[2];

void sample_environment(const File& file, const SampleArguments& options, Output& output) {
    if (!options.at.empty()) throw Failure(options.file + ": an environment has no bins; leave out --at");
    const EnvironmentView view = file.environment();
    write_directions(options, output, [&](Numbers u, std::size_t count, DirectionSample* samples) {
        for (std::size_t i = 0; i < count; ++i) samples[i] = view.sample(u[i][0], u[i][1]);
    });
}

void sample_indexed(const LoadedFile& loaded, const SampleArguments& options, Output& output) {
    const MixedEnvironment view = chosen_environment(options.file, loaded, options.at);
    write_directions(options, output, [&](Numbers u, std::size_t count, DirectionSample* samples) {
        for (std::size_t i = 0; i < count; ++i) samples[i] = view.sample(u[i][0], u[i][1]);
    });
}

void sample_local(const File& file, const SampleArguments& options, Output& output) {
    if (!options.at.empty()) throw Failure(options.file + ": a local environment has no --at; give --normal X,Y,Z");
    const AcdfLocalPoint point = file.local().at(chosen_normal(options.file, options.normal).data());
    if (point.what == ACDF_LOCAL_NOTHING)
        throw Failure(options.file +
                      ": no light reaches this normal, so there is nothing to sample; choose another");
    const LocalEnvironmentView view = file.local();
    write_directions(options, output, [&](Numbers u, std::size_t count, DirectionSample* samples) {
        for (std::size_t i = 0; i < count; ++i) samples[i] = view.sample(point, u[i][0], u[i][1]);
    });
}

void sample_brdf(const File& file, const SampleArguments& options, Output& output) {
    if (!options.at.empty()) throw Failure(options.file + ": a BRDF has no --at; give --view THETA[,PHI]");
    const std::array<float, 3> wo = chosen_view(options.file, file, options.view);
    const BrdfView view = file.brdf();
    if (!(view.albedo(wo.data()) > 0.0))
        throw Failure(options.file + ": nothing is reflected to this view, so there is nothing to sample");
    write_directions(options, output, [&](Numbers u, std::size_t count, DirectionSample* samples) {
        for (std::size_t i = 0; i < count; ++i) samples[i] = view.sample(wo.data(), u[i][0], u[i][1]);
    });
}

void sample_table(const File& file, const SampleArguments& options, Output& output) {
    const TableView view = file.table();
    const std::uint32_t n = view.sampled_count();
    if (options.sequence != measure::SequenceKind::random && n != 2)
        throw Failure(options.file + ": has " + std::to_string(n) + (n == 1 ? " sampled axis" : " sampled axes") +
                      ", not 2; use --sequence random");
    const std::vector<std::uint32_t> bin = chosen_bin(options.file, view, options.at);
    if (!(view.share(bin.data()) > 0.0))
        throw Failure(options.file +
                      ": this bin is empty, so there is nothing to sample; choose another with --at");
    measure::Sequence sequence(options.sequence, options.count, options.seed);
    output.write(point_columns("u", n) + point_columns("x", n) + "pdf\n");
    write_samples(options, [&](std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            double u[ACDF_MAX_AXES], x[ACDF_MAX_AXES];
            sequence.next(u, n);
            const double pdf = view.sample(bin.data(), u, x);
            output.write(point_text(u, n) + point_text(x, n) + number_text(pdf) + "\n");
        }
    });
}

void run(const SampleArguments& options) {
    Output output(options.output, options.force, {options.file});
    const LoadedFile loaded = load_file(options.file);
    const AcdfKind kind = loaded.file.kind();
    if (loaded.file.partner() && !options.quiet)
        say(options.file +
            ": is made for an MIS partner (--mis) and not to be used alone: its samples leave out light");
    if (kind != ACDF_KIND_LOCAL) refuse_normal(options.file, options.normal);
    if (kind != ACDF_KIND_BRDF) refuse_view(options.file, options.view);
    if (kind == ACDF_KIND_ENVIRONMENT) sample_environment(loaded.file, options, output);
    else if (kind == ACDF_KIND_LOCAL) sample_local(loaded.file, options, output);
    else if (kind == ACDF_KIND_BRDF) sample_brdf(loaded.file, options, output);
    else if (kind == ACDF_KIND_INDEXED) sample_indexed(loaded, options, output);
    else if (kind == ACDF_KIND_TABLE) sample_table(loaded.file, options, output);
    output.commit();
}

} // namespace

void add_sample(CLI::App& program, int& exit_code) {
    constexpr Named<measure::SequenceKind> sequences[] = {{"random", measure::SequenceKind::random},
                                                          {"stratified", measure::SequenceKind::stratified},
                                                          {"sobol", measure::SequenceKind::sobol}};
    auto options = std::make_shared<SampleArguments>();
    CLI::App* command = program.add_subcommand(
        "sample", "Sample directions, or points of a table: CSV of random numbers, direction and pdf");
    command->add_option("FILE", options->file, "The .acdf file to sample (- is stdin)")->required()->type_name("");
    command->add_option("-n,--count", options->count, "How many directions to sample")
        ->required()
        ->option_text("N (required)")
        ->check(CLI::Range(std::uint64_t{1}, max_count))
        ->group("Sampling");
    add_choice(*command, "--sequence", options->sequence, sequences,
               "Where the random numbers come from: random (independent), stratified (one in each of N boxes of "
               "equal area: less noise, needs N in advance) or sobol (least noise; any first part of it is "
               "well spread too)")
        ->option_text("NAME [random]")
        ->group("Sampling");
    command
        ->add_option(
            "--seed", options->seed,
            "Other random numbers, for independent runs; the same seed gives the same bytes on any machine. "
            "Without one sobol is the plain sequence")
        ->option_text("S [0]")
        ->group("Sampling");
    add_normal(*command, options->normal, "Sampling");
    add_view(*command, options->view, "Sampling");
    add_bin(*command, options->at, "Sampling");
    add_output(*command, options->output, options->force, "The CSV file to write, stdout by default");
    add_quiet(*command, options->quiet);
    command->footer(help_footer(
        "Columns: u0,u1 (the random numbers used, 17 digits), x,y,z (a unit direction, "
        "right-handed, z up) and pdf (per "
        "steradian). Floats carry 9 digits: read back, they are the same floats. To "
        "estimate an integral of g, average "
        "g(x,y,z)/pdf. Of a table: u0,u1,...,x0,x1,...,pdf, a number each for every sampled axis in its "
        "units, all with 17 digits.",
        "acdf sample sky.acdf -n 1000 > directions.csv\n"
        "acdf sample sky.acdf -n 4096 --sequence sobol -o directions.csv\n"
        "acdf sample local.acdf -n 1000 --normal 0,0.6,0.8 > directions.csv\n"
        "acdf sample sky.acdf -n 1000 | acdf pdf sky.acdf      # the same pdfs"));
    command->callback([options, &exit_code] {
        run(*options);
        exit_code = exit_done;
    });
}

} // namespace acdf::tools
