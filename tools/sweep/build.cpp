#include "tools/sweep/build.h"

#include "build/own_terms.h"
#include "measure/samplers/light_samplers.h"
#include "tools/cli/sizes.h"
#include "tools/commands.h"
#include "tools/plot/image.h"
#include "tools/plot/knots.h"
#include "tools/plot/local.h"
#include "tools/sweep/advice.h"
#include "tools/sweep/timing.h"

#include <acdf/curves/curves.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

namespace acdf::tools {

const char* to_string(SweepKind kind) { return kind == SweepKind::probe ? "probe" : "brdf"; }

StoredFile::StoredFile(std::vector<std::uint8_t> made) : bytes(std::move(made)) {
    if (const Status status = File::from_memory(bytes.data(), bytes.size(), file, with_curves()); !status.ok())
        throw std::logic_error(std::string("the reader refuses the file just made: ") + status.message);
}

Candidate file_candidate(std::vector<std::uint8_t> bytes) {
    Candidate out;
    out.file = std::make_shared<StoredFile>(std::move(bytes));
    out.sampler = measure::file_sampler(out.file->file);
    return out;
}

Candidate baseline_candidate(std::string system, std::string label,
                             std::shared_ptr<const measure::LightSampler> sampler) {
    Candidate out;
    out.row.system = std::move(system);
    out.row.label = std::move(label);
    out.row.bytes = sampler->bytes();
    out.sampler = std::move(sampler);
    return out;
}

void take_options(Sweep& sweep, const SweepOptions& options) {
    sweep.visible = options.visible;
    sweep.timed = options.timing;
    sweep.costs.shadow_ray_ns = options.shadow_ray_ns;
    sweep.numbers = options.numbers;
    sweep.heuristic = options.heuristic;
}

measure::MapLight map_light(const compress::Target& target, const SweepOptions& options) {
    if (options.texels.empty()) return measure::MapLight(target);
    return {builder::grid_of(options.texels), options.target.filter, options.target.wrap == builder::Wrap::repeat};
}

void build_all(Sweep& sweep, std::vector<Candidate>& candidates, const std::vector<Step>& steps,
               const std::function<Candidate(const Step&)>& make, const build::Progress& progress) {
    std::string last_failure;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (progress) progress(static_cast<double>(i) / static_cast<double>(steps.size()), "building");
        const auto start = std::chrono::steady_clock::now();
        Candidate made;
        try {
            made = make(steps[i]);
        } catch (const std::runtime_error& error) {
            last_failure = steps[i].file + " at " + to_readable_size(steps[i].budget) + ": " + error.what();
            sweep.notes.push_back(last_failure);
            continue;
        }
        made.row.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        made.row.system = "acdf";
        made.row.file = steps[i].file;
        made.row.bytes = made.sampler->bytes();
        made.row.file_bytes = made.file->bytes.size();
        const bool again = !candidates.empty() && candidates.back().row.file == made.row.file &&
                           candidates.back().row.file_bytes == made.row.file_bytes;
        if (!again) candidates.push_back(std::move(made));
    }
    if (candidates.empty()) throw std::invalid_argument("none of the sizes can be made: " + last_failure);
}

void finish_rows(Sweep& sweep, std::vector<Candidate> candidates, const std::vector<measure::ShadingPoint>& points,
                 const SweepOptions& options, const build::Progress& progress) {
    if (options.timing) {
        std::vector<const measure::LightSampler*> samplers;
        for (const Candidate& candidate : candidates) samplers.push_back(candidate.sampler.get());
        const auto partner = measure::cosine_sampler();
        samplers.push_back(partner.get());
        std::vector<SweepTimes> times = time_samplers(samplers, points, options.rounds, progress);
        sweep.costs.cosine_ns =
            median_interval(times.back().sample).value + median_interval(times.back().pdf).value;
        for (std::size_t i = 0; i < candidates.size(); ++i) candidates[i].row.times = std::move(times[i]);
    }
    for (Candidate& candidate : candidates) sweep.rows.push_back(std::move(candidate.row));
}

std::string knots_text(std::uint32_t columns, std::uint32_t rows) {
    return "--knots " + std::to_string(columns) + "x" + std::to_string(rows);
}

std::string budget_text(std::uint64_t bytes) {
    struct Unit {
        std::uint64_t bytes;
        const char* name;
    };
    for (const Unit unit : {Unit{1u << 20, "MiB"}, Unit{1000000, "MB"}, Unit{1024, "KiB"}, Unit{1000, "kB"}})
        if (bytes > 0 && bytes % unit.bytes == 0) return std::to_string(bytes / unit.bytes) + unit.name;
    return std::to_string(bytes);
}

std::uint32_t cells_in(std::uint64_t budget) {
    return static_cast<std::uint32_t>(std::max(4.0, (static_cast<double>(budget) - 900.0) / 4.4));
}

std::vector<std::size_t> largest_of_each_kind(const std::vector<Candidate>& candidates) {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < candidates.size() && candidates[i].row.ours(); ++i)
        if (i + 1 == candidates.size() || candidates[i + 1].row.file != candidates[i].row.file) out.push_back(i);
    return out;
}

void add_picture(Sweep& sweep, const PdfImage& image, const std::vector<float>& knots,
                 const std::vector<float>& horizon, std::string title, std::string description) {
    images::Picture picture = false_colour(image, sweep.range);
    if (!knots.empty()) draw_knots(picture, knots);
    if (!horizon.empty()) draw_horizon(picture, horizon);
    sweep.pictures.push_back({std::move(title), std::move(description), image.map.width, image.map.height,
                              encode_png(picture, {"acdf", "pdf in false colour"})});
}

void add_colour_bar(Sweep& sweep) {
    constexpr int width = 256;
    PdfImage ramp{{build::Layout::latlong, width, 1}, {}};
    const double decades = std::log(sweep.range.high / sweep.range.low);
    for (int x = 0; x < width; ++x)
        ramp.pdf.push_back(static_cast<float>(sweep.range.low * std::exp(decades * (x + 0.5) / width)));
    sweep.colour_bar = encode_png(false_colour(ramp, sweep.range), {"acdf", "colours"});
}

std::string picture_title(const SweepRow& row) { return row.label + ", " + size_text(row); }

build::Progress part_of(const build::Progress& progress, double begin, double width) {
    return [&progress, begin, width](double share, const char* what) {
        if (progress) progress(begin + width * share, what);
    };
}

} // namespace acdf::tools
