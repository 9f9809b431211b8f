// What the sweeps of all kinds are put together from.
#pragma once

#include "measure/map_lookup.h"
#include "measure/samplers/light_sampler.h"
#include "tools/plot/colour.h"
#include "tools/sweep/sweep.h"

#include <acdf/reader.h>
#include <acdf/views.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace acdf::tools {

/// A file in memory.
struct StoredFile {
    explicit StoredFile(std::vector<std::uint8_t> made);

    std::vector<std::uint8_t> bytes;
    File file;
};

/// A row on its way: with what samples its samples.
struct Candidate {
    SweepRow row;
    std::shared_ptr<const measure::LightSampler> sampler;
    std::shared_ptr<const StoredFile> file; ///< of acdf
    std::shared_ptr<const void> tables;     ///< what the sampler refers to
};

/// With the file's sampler and size.
Candidate file_candidate(std::vector<std::uint8_t> bytes);
/// With the sampler's size.
Candidate baseline_candidate(std::string system, std::string label,
                             std::shared_ptr<const measure::LightSampler> sampler);

/// One file to be made: a kind at a size.
struct Step {
    std::string file;
    std::uint64_t budget = 0;
};

/// What the advice goes by.
void take_options(Sweep& sweep, const SweepOptions& options);

/// What estimates find in a direction; `target` (compress::of_texels) is referred to.
measure::MapLight map_light(const compress::Target& target, const SweepOptions& options);

/// Fills `candidates` with what `make` builds for each step, timed. Steps whose goal is out of reach
/// (std::runtime_error) become notes, files that equal the one before them in kind and size are left out. Throws
/// std::invalid_argument where nothing could be made.
void build_all(Sweep& sweep, std::vector<Candidate>& candidates, const std::vector<Step>& steps,
               const std::function<Candidate(const Step&)>& make, const build::Progress& progress);

/// Times candidates where that is asked for, and turns them into rows.
void finish_rows(Sweep& sweep, std::vector<Candidate> candidates, const std::vector<measure::ShadingPoint>& points,
                 const SweepOptions& options, const build::Progress& progress);

/// "--knots 64x32".
std::string knots_text(std::uint32_t columns, std::uint32_t rows);
/// As --budget reads it, exactly: "64KiB", "1MB", "1234".
std::string budget_text(std::uint64_t bytes);

/// Cells that a budget pays for in curves of their own, about 4.4 bytes each beside what any file takes.
std::uint32_t cells_in(std::uint64_t budget);

/// What is pictured: the last of each kind.
std::vector<std::size_t> largest_of_each_kind(const std::vector<Candidate>& candidates);

constexpr int kPictureWidth = 640;

/// Adds a picture in the colours of sweep.range; `opacity` (of knots, of a horizon) may be empty.
void add_picture(Sweep& sweep, const PdfImage& image, const std::vector<float>& knots,
                 const std::vector<float>& horizon, std::string title, std::string description);
/// The colours of sweep.range from low to high.
void add_colour_bar(Sweep& sweep);

/// What is under a picture of a file.
std::string picture_title(const SweepRow& row);

/// The part [begin, begin + width] of a progress; valid as long as that is.
build::Progress part_of(const build::Progress& progress, double begin, double width);

} // namespace acdf::tools
