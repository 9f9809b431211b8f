#include "tools/measure/table.h"
#include "tools/cli/json.h"
#include "tools/cli/messages.h"
#include "tools/cli/source_check.h"

#include "build/table.h"
#include "build/table_partner.h"
#include "input/npy.h"
#include "input/sha256.h"
#include "tools/cli/noise.h"
#include "tools/commands.h"
#include "tools/measure/memory.h"

#include <CLI/Error.hpp>
#include <nlohmann/json.hpp>

#include <cinttypes>
#include <cstdio>

namespace acdf::tools {
namespace {

/// Index on each indexed axis, last one fastest.
std::vector<std::uint32_t> index_of(const File& file, std::uint32_t bin) {
    std::vector<std::uint32_t> index(file.table().indexed_count());
    for (std::size_t axis = index.size(); axis-- > 0;) {
        const std::uint32_t length = file.axis(static_cast<std::uint32_t>(axis)).resolution;
        index[axis] = bin % length;
        bin /= length;
    }
    return index;
}

std::string joined(const std::vector<std::uint32_t>& numbers, const char* separator) {
    std::string text;
    for (const std::uint32_t number : numbers) text += (text.empty() ? "" : separator) + std::to_string(number);
    return text;
}

nlohmann::ordered_json report(const std::string& path, const File& file, const std::string& source,
                              const build::TableAccuracy& a) {
    nlohmann::ordered_json out{
        {"file", path},
        {"source", source},
        {"relative_variance", a.relative_variance}, // JSON has no infinity: null with a support violation
        {"noise_percent", noise_json(a.relative_variance)},
        {"relative_variance_median", a.median},
        {"relative_variance_worst", a.worst},
        {"worst_bin", index_of(file, a.worst_bin)},
        {"rms_pdf_error", known_json(!a.combined, a.rms_pdf_error)},
        {"kl_divergence", known_json(!a.combined, a.kl_divergence)},
        {"max_weight", a.max_weight},
        {"support_violations", a.support_violations},
        {"bytes", file.size()},
        {"memory_bytes", measure::memory_of(file)},
        {"cells", a.cells},
        {"bins", file.description().bin_count},
        {"bins_with_energy", a.lit_bins},
        {"total", file.description().total}};
    if (a.combined) out["combined"] = true; // of the file and its partner
    return out;
}

void print_text(const std::string& path, const File& file, const std::string& source,
                const build::TableAccuracy& a) {
    std::printf("%s against %s\n", printable(path).c_str(), printable(source).c_str());
    std::printf("  relative variance      %.6g   %s\n", a.relative_variance,
                a.combined ? "a sample, with its MIS partner: not to be used alone"
                           : "of one sample; the mean of n samples has 1/n of it");
    std::printf("    noise                %s   at 16, 64, 256 samples\n", noise_texts(a.relative_variance).c_str());
    if (file.description().bin_count > 1) {
        std::printf("    median over bins     %.6g\n", a.median);
        std::printf("    worst bin            %.6g   --at %s\n", a.worst,
                    joined(index_of(file, a.worst_bin), ",").c_str());
    }
    std::printf("  largest weight         %.6g   f/p over its mean\n", a.max_weight);
    if (!a.combined) {
        std::printf("  RMS error of the pdf   %.6g   where a uniform pdf is 1\n", a.rms_pdf_error);
        std::printf("  KL divergence          %.6g   nats\n", a.kl_divergence);
    }
    std::printf("  support violations     %" PRIu64 "\n", a.support_violations);
    std::printf("  bins                   %" PRIu32 "   of %" PRIu32 " have energy\n", a.lit_bins,
                file.description().bin_count);
    std::printf("  cells                  %" PRIu64 "\n", a.cells);
    print_bytes(file);
}

/// The table at `source`, which has the shape of the file.
input::NpyArray read_source(const std::string& path, const File& file, const std::string& source) {
    input::NpyOptions options;
    options.bad_values = input::BadValuePolicy::zero; // as the file was made, or `acdf table` had refused them
    input::NpyArray array = input::read_npy(source, options);
    std::vector<std::uint32_t> shape;
    for (std::uint32_t axis = 0; axis < file.description().axis_count; ++axis)
        shape.push_back(file.axis(axis).resolution);
    if (shape != array.shape)
        throw Failure(source + ": its shape is " + joined(array.shape, "x") + ", but " + path + " was made from " +
                      joined(shape, "x") + "; measure against the array it was made from");
    return array;
}

} // namespace

void measure_table(const std::string& path, const File& file, const std::string& source, const std::string& other,
                   bool json, bool quiet) {
    if (file.partner() && other.empty())
        throw Failure(path + ": it was made to be combined with another table; name it (--mis OTHER.npy)");
    if (!file.partner() && !other.empty())
        throw CLI::ValidationError("--mis", "is for tables with an MIS partner, which " + path + " is not");
    const input::NpyArray array = read_source(path, file, source);
    const std::string sha256 = input::file_sha256(source);
    if (!quiet) note_another(path, file, source, sha256);
    const std::vector<compress::Grid> bins = build::table_grids(array, file.table().indexed_count());
    try {
        build::TableAccuracy accuracy;
        if (file.partner()) {
            const input::NpyArray beside = read_source(path, file, other);
            if (!quiet) note_another(path, file, other, input::file_sha256(other), "partner.sha256");
            accuracy = build::summary(
                build::measure_bins_beside(file, bins, build::table_grids(beside, file.table().indexed_count())));
            accuracy.combined = true;
        } else accuracy = build::summary(build::measure_bins(file, bins));
        if (json) std::fputs(json_text(report(path, file, source, accuracy)).c_str(), stdout);
        else print_text(path, file, source, accuracy);
        require_support(path, file, source, sha256, accuracy.support_violations);
    } catch (const std::invalid_argument& error) {
        throw Failure(source + ": " + error.what());
    }
}

} // namespace acdf::tools
