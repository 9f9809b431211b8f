#include "tools/sweep/maps.h"

#include "build/own_terms.h"
#include "measure/samplers/light_samplers.h"
#include "tools/cli/built.h"
#include "tools/cli/json.h"
#include "tools/cli/noise.h"
#include "tools/cli/sizes.h"
#include "tools/sweep/build.h"
#include "tools/sweep/timing.h"

#include <algorithm>
#include <cmath>

namespace acdf::tools {
namespace {

constexpr std::uint64_t kDefaultBudgets[] = {16 << 10, 64 << 10, 256 << 10};
constexpr double kBuilding = 0.9; // of the time, about

/// A row on its way: with what is timed.
struct MadeRow {
    MapRow row;
    std::shared_ptr<const StoredFile> file;
    std::shared_ptr<const IndexedEnvironment> maps; ///< of one file; null: there are several
    std::shared_ptr<const measure::LightSampler> sampler;
};

class Variances {
public:
    void add(double variance) {
        logarithms_ += std::log(variance);
        worst_ = std::max(worst_, variance);
        ++count_;
    }
    void finish(MapRow& row) const {
        row.relative_variance = std::exp(logarithms_ / double(count_));
        row.worst = worst_;
    }

private:
    double logarithms_ = 0.0, worst_ = 0.0;
    std::size_t count_ = 0;
};

/// Half way from the first map to the next of each axis: the most that a sample has to mix.
MixedEnvironment between(const IndexedEnvironment& maps, const std::vector<builder::MapAxis>& axes) {
    double at[ACDF_MOST_INDEXED_AXES] = {};
    for (std::size_t i = 0; i < axes.size(); ++i) at[i] = 0.5 * (axes[i].coordinates[0] + axes[i].coordinates[1]);
    return maps.at(at);
}

MadeRow one_file(const std::vector<builder::IndexedMap>& maps, builder::IndexedOptions options,
                 std::uint64_t budget) {
    options.goal = builder::Goal::of_budget(budget);
    builder::IndexedFile made;
    throw_unless_built(builder::indexed(maps, options, made));
    MadeRow out;
    out.row.bytes = made.bytes.size();
    Variances variances;
    for (const builder::MapAccuracy& each : made.accuracy) variances.add(each.relative_variance);
    variances.finish(out.row);
    out.file = std::make_shared<StoredFile>(std::move(made.bytes));
    IndexedEnvironment stored;
    if (const Status status = IndexedEnvironment::open(out.file->file, stored); !status.ok())
        throw Failure(std::string("cannot read back what was made: ") + status.message);
    out.maps = std::make_shared<const IndexedEnvironment>(std::move(stored));
    out.sampler = measure::sky_sampler(out.file->file, between(*out.maps, options.axes));
    return out;
}

MadeRow file_each(const std::vector<builder::IndexedMap>& maps, const builder::IndexedOptions& one,
                  std::uint64_t budget) {
    builder::EnvironmentOptions options;
    options.target = one.target;
    options.codec = one.codec;
    options.goal = builder::Goal::of_budget(budget / maps.size());
    MadeRow out;
    out.row.together = false;
    Variances variances;
    for (const builder::IndexedMap& map : maps) {
        builder::Environment made;
        throw_unless_built(builder::environment(map.fitted, options, made));
        out.row.bytes += made.bytes.size();
        variances.add(made.accuracy.relative_variance);
        if (!out.file) out.file = std::make_shared<StoredFile>(std::move(made.bytes));
    }
    variances.finish(out.row);
    out.sampler = measure::file_sampler(out.file->file);
    return out;
}

std::string name_of(const MapRow& row) { return row.together ? "one file" : "a file for each map"; }

double median_of(const std::vector<double>& times) { return median_interval(times).value; }

nlohmann::ordered_json known(double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

/// The row of the same size, the other way.
const MapRow* other_way(const MapSweep& sweep, const MapRow& row) {
    for (const MapRow& other : sweep.rows)
        if (other.budget == row.budget && other.together != row.together) return &other;
    return nullptr;
}

} // namespace

void sweep_maps(const std::vector<builder::IndexedMap>& maps, const builder::IndexedOptions& one,
                const SweepOptions& options, const build::Progress& progress, MapSweep& sweep) {
    std::vector<std::uint64_t> budgets = options.budgets;
    if (budgets.empty()) budgets.assign(std::begin(kDefaultBudgets), std::end(kDefaultBudgets));
    std::vector<MadeRow> rows;
    for (std::size_t i = 0; i < 2 * budgets.size(); ++i) {
        const std::uint64_t budget = budgets[i / 2];
        if (progress) progress(kBuilding * double(i) / double(2 * budgets.size()), "building");
        try {
            rows.push_back(i % 2 == 0 ? one_file(maps, one, budget) : file_each(maps, one, budget));
            rows.back().row.budget = budget;
        } catch (const std::runtime_error& error) { // out of reach
            MapRow row;
            row.together = i % 2 == 0;
            sweep.notes.push_back(name_of(row) + " at " + to_readable_size(budget) + ": " + error.what());
        }
    }
    if (std::none_of(rows.begin(), rows.end(), [](const MadeRow& made) { return made.row.together; }))
        throw std::invalid_argument("none of the sizes can be made: " + sweep.notes.front());
    if (options.timing) {
        std::vector<const measure::LightSampler*> samplers;
        for (const MadeRow& made : rows) samplers.push_back(made.sampler.get());
        const std::vector<measure::ShadingPoint> points(options.points);
        std::vector<SweepTimes> times =
            time_samplers(samplers, points, options.rounds, part_of(progress, kBuilding, 1.0 - kBuilding));
        for (std::size_t i = 0; i < rows.size(); ++i) rows[i].row.times = std::move(times[i]);
    }
    for (MadeRow& made : rows) sweep.rows.push_back(std::move(made.row));
}

MapAdvice advise(const MapSweep& sweep) {
    MapAdvice out;
    for (std::size_t i = 0; i < sweep.rows.size() && !out.reached; ++i) {
        if (!sweep.rows[i].together) continue;
        out.row = i;
        out.reached = sweep.rows[i].relative_variance <= sweep.visible.largest_variance();
    }
    const MapRow& best = sweep.rows[out.row];
    const std::uint32_t spp = sweep.visible.spp;
    out.sentence = "One file of " + to_readable_size(best.bytes) + " for " + std::to_string(sweep.maps) +
                   " maps has " + noise_text(best.relative_variance, spp) + " noise at " + std::to_string(spp) +
                   " samples per pixel, " + noise_text(best.worst, spp) + " in the worst map.";
    if (const MapRow* other = other_way(sweep, best))
        out.sentence += " A file for each map, with as many bytes in all, has " +
                        noise_text(other->relative_variance, spp) + " and " + noise_text(other->worst, spp) + ".";
    out.command = "acdf env " + sweep.input + " -o " + sweep.output + ".acdf --budget " + budget_text(best.budget);
    return out;
}

std::string maps_csv(const MapSweep& sweep) {
    std::string out = "file,budget,bytes,relative_variance,worst";
    out += sweep.timed ? ",ns_per_sample,ns_per_pdf\n" : "\n";
    for (const MapRow& row : sweep.rows) {
        char text[200];
        std::snprintf(text, sizeof text, "%s,%llu,%llu,%.9g,%.9g", row.together ? "one" : "each",
                      static_cast<unsigned long long>(row.budget), static_cast<unsigned long long>(row.bytes),
                      row.relative_variance, row.worst);
        out += text;
        if (sweep.timed) {
            std::snprintf(text, sizeof text, ",%.9g,%.9g", median_of(row.times.sample), median_of(row.times.pdf));
            out += text;
        }
        out += "\n";
    }
    return out;
}

std::string maps_json(const MapSweep& sweep) {
    const MapAdvice advice = advise(sweep);
    nlohmann::ordered_json out = {{"kind", "maps"},
                                  {"sources", sweep.sources},
                                  {"maps", sweep.maps},
                                  {"timed", sweep.timed},
                                  {"spp", sweep.visible.spp},
                                  {"threshold", sweep.visible.threshold},
                                  {"recommendation",
                                   {{"row", advice.row},
                                    {"reached", advice.reached},
                                    {"sentence", advice.sentence},
                                    {"command", advice.command}}},
                                  {"notes", sweep.notes},
                                  {"rows", nlohmann::ordered_json::array()}};
    for (const MapRow& row : sweep.rows) {
        nlohmann::ordered_json each = {{"file", row.together ? "one" : "each"},
                                       {"budget", row.budget},
                                       {"bytes", row.bytes},
                                       {"relative_variance", known(row.relative_variance)},
                                       {"worst", known(row.worst)}};
        if (sweep.timed) {
            each["ns_per_sample"] = known(median_of(row.times.sample));
            each["ns_per_pdf"] = known(median_of(row.times.pdf));
        }
        out["rows"].push_back(std::move(each));
    }
    return json_text(out);
}

} // namespace acdf::tools
