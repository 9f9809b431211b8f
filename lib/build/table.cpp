#include "build/table.h"

#include "build/errors.h"
#include "build/table_partner.h"
#include "build/text/partner.h"
#include "compress/sum.h"
#include "compress/tables/fit.h"

#include <acdf/reader.h>
#include <acdf/views.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdio>
#include <set>
#include <stdexcept>

namespace acdf::build {
namespace {

constexpr std::uint64_t max_bins = 1 << 20; // each has a tree of its own

std::string number(double value, const char* format = "%.9g") {
    char text[32];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

/// A variance is searched for in files of up to so many bytes, or of one for each number of the table.
constexpr std::uint64_t kVarianceBytes = 16 << 20;

std::uint64_t bin_count(const std::vector<std::uint32_t>& shape, std::uint32_t indexed) {
    std::uint64_t bins = 1;
    for (std::uint32_t axis = 0; axis < indexed; ++axis) bins *= shape[axis];
    return bins;
}

void check_options(const std::vector<std::uint32_t>& shape, const TableOptions& options) {
    const std::string axes = std::to_string(shape.size()) + (shape.size() == 1 ? " axis" : " axes");
    if (options.indexed >= shape.size())
        throw OptionError("the array has " + axes + ", of which one at least is sampled: index fewer than " +
                          std::to_string(shape.size()));
    if (bin_count(shape, options.indexed) > max_bins)
        throw OptionError("the indexed axes make more than 2^20 bins; index fewer");
    if (!options.names.empty() && options.names.size() != shape.size())
        throw OptionError("the array has " + axes + ", but there are " + std::to_string(options.names.size()) +
                          " names");
    if (!options.ranges.empty() && options.ranges.size() != shape.size())
        throw OptionError("each axis needs a range");
    std::set<std::string> seen;
    for (const std::string& name : options.names) {
        if (name.empty() || name.size() > 15 || name.find('\0') != std::string::npos)
            throw OptionError("the name of an axis has 1 to 15 bytes, none of them zero");
        if (!seen.insert(name).second) throw OptionError("two axes are called '" + name + "'");
    }
}

/// What rules 5015 and 9004 ask of an axis: that no two of its steps have the same coordinates.
void check_range(const compress::AxisDescription& axis) {
    if (!std::isfinite(axis.low) || !std::isfinite(axis.high) || axis.low == axis.high)
        throw OptionError("the range of axis '" + axis.name + "' is empty or not finite");
    AcdfAxis record = {};
    record.resolution = axis.resolution;
    record.low = axis.low;
    record.high = axis.high;
    if (!acdf_table_axis_steps(&record))
        throw OptionError("the range of axis '" + axis.name +
                          "' is too far from 0 for its width, or too "
                          "large or small; choose other units");
}

std::vector<compress::AxisDescription> describe_axes(const std::vector<std::uint32_t>& shape,
                                                     const TableOptions& options) {
    std::vector<compress::AxisDescription> axes;
    for (std::uint32_t i = 0; i < shape.size(); ++i) {
        compress::AxisDescription axis;
        axis.name = options.names.empty() ? "x" + std::to_string(i) : options.names[i];
        axis.role = i < options.indexed ? ACDF_AXIS_INDEXED : ACDF_AXIS_SAMPLED;
        axis.resolution = shape[i];
        axis.low = options.ranges.empty() ? 0.0 : options.ranges[i].first;
        axis.high = options.ranges.empty() ? shape[i] : options.ranges[i].second;
        check_range(axis);
        axes.push_back(axis);
    }
    return axes;
}

/// Volume of the sampled axes in their units.
double volume(const std::vector<compress::AxisDescription>& axes) {
    double volume = 1.0;
    for (const compress::AxisDescription& axis : axes)
        if (axis.role == ACDF_AXIS_SAMPLED) volume *= std::abs(axis.high - axis.low);
    return volume;
}

/// Integral of each bin and, last, their sum, with a volume of 1 a bin.
std::vector<double> integrals(const std::vector<compress::Grid>& bins) {
    std::vector<double> out;
    compress::Sum total;
    for (const compress::Grid& bin : bins) {
        out.push_back(compress::integral(bin));
        total.add(out.back());
    }
    out.push_back(total.value());
    return out;
}

/// A bin with any energy keeps a positive share, however small: share 0 says that there is nothing to sample.
std::vector<float> shares(const std::vector<double>& integrals) {
    std::vector<float> out;
    for (std::size_t i = 0; i + 1 < integrals.size(); ++i)
        out.push_back(integrals[i] > 0.0 ? std::max(static_cast<float>(integrals[i] / integrals.back()), FLT_MIN)
                                         : 0.0f);
    return out;
}

std::string option_text(const TableOptions& options) {
    std::string text = options.indexed > 0 ? "--indexed " + std::to_string(options.indexed) + " " : "";
    const compress::Goal& goal = options.goal;
    if (goal.kind == compress::Goal::Kind::budget) text += "--budget " + std::to_string(goal.budget);
    else if (goal.kind == compress::Goal::Kind::variance) text += "--target-variance " + number(goal.variance);
    else text += "--cells " + std::to_string(options.cells);
    if (options.max_weight > 0.0) text += " --max-weight " + number(options.max_weight);
    if (options.mis) text += " " + partner_text(options.mis);
    if (text.back() == ' ') text.pop_back();
    return text;
}

compress::Metadata metadata(const std::string& name, const std::string& sha256, const TableOptions& options,
                            const TableAccuracy& accuracy) {
    // A fixed width: what accuracy is reached must not change the size that a budget is compared with.
    const auto fixed = [](double value) { return number(std::clamp(value, 0.0, 9.99e99), "%.8e"); };
    compress::Metadata out{{"tool", "acdf " ACDF_VERSION},
                           {"fit.options", option_text(options)},
                           {"source.name", name},
                           {"source.sha256", sha256},
                           {"accuracy.relative_variance", fixed(accuracy.relative_variance)},
                           {"accuracy.relative_variance_median", fixed(accuracy.median)},
                           {"accuracy.relative_variance_worst", fixed(accuracy.worst)},
                           {"accuracy.kl_divergence", fixed(accuracy.kl_divergence)},
                           {"accuracy.max_weight", fixed(accuracy.max_weight)}};
    if (options.mis) {
        out.push_back({"partner.name", options.other_name});
        out.push_back({"partner.sha256", options.other_sha256});
    }
    return out;
}

File open_made(const std::vector<std::uint8_t>& bytes) {
    File file;
    if (const Status status = File::from_memory(bytes.data(), bytes.size(), file); !status.ok())
        throw std::logic_error(std::string("the reader refuses the file just made: ") + status.message);
    return file;
}

/// `shares`: those to recommend, one a bin.
compress::Chunk partner_of(const compress::Partner& partner, const std::vector<float>& shares) {
    std::vector<AcdfPartnerRecord> records;
    double sum = 0.0;
    for (const float share : shares) {
        records.push_back({share, 0.0f});
        sum += static_cast<double>(share);
    }
    return compress::partner_chunk(partner, static_cast<float>(sum / double(shares.size())), records);
}

compress::TableFitOptions goal_of(const TableOptions& options, const compress::Description& description,
                                  std::size_t numbers, const Progress& progress) {
    compress::TableFitOptions out;
    out.goal = options.goal;
    out.goal.cells = static_cast<std::uint32_t>(
        std::min<std::uint64_t>(std::uint64_t{options.cells} * description.shares.size(), 0xFFFFFFFFu));
    out.max_weight = options.max_weight;
    out.most_bytes = std::max<std::uint64_t>(kVarianceBytes, numbers);
    out.progress = [progress](double share) {
        if (progress) progress(0.9 * share, "fitting");
    };
    if (out.goal.kind != compress::Goal::Kind::budget) return out;
    const compress::TableTrees least = compress::whole_cells(description.shares);
    const std::uint64_t bytes = compress::store(least.halvings, least.roots, description).size();
    if (bytes > out.goal.budget)
        throw std::runtime_error("a size of " + std::to_string(out.goal.budget) +
                                 " bytes is out of reach; the smallest possible is " + std::to_string(bytes));
    out.chunk_bytes = compress::halvings_room(description, out.goal.budget);
    return out;
}

/// The bins of the partner. Throws OptionError.
std::vector<compress::Grid> other_grids(const Array& array, const TableOptions& options) {
    if (!options.mis) return {};
    if (options.other->shape != array.shape) throw OptionError("the partner of a table has another shape");
    return table_grids(*options.other, options.indexed);
}

} // namespace

std::vector<compress::Grid> table_grids(const Array& array, std::uint32_t indexed) {
    compress::Grid grid;
    std::size_t size = 1;
    for (std::uint32_t axis = indexed; axis < array.shape.size(); ++axis) {
        grid.shape.push_back(array.shape[axis]);
        grid.measure.emplace_back(array.shape[axis], 1.0 / array.shape[axis]);
        grid.axes.push_back(axis);
        size *= array.shape[axis];
    }
    std::vector<compress::Grid> bins(bin_count(array.shape, indexed), grid);
    for (std::size_t i = 0; i < bins.size(); ++i) bins[i].values = array.values.data() + i * size;
    return bins;
}

Table build_table(const Array& array, const std::string& source_name, const std::string& source_sha256,
                  const TableOptions& options, const Progress& progress) {
    check_options(array.shape, options);
    compress::Description description;
    description.kind = ACDF_KIND_TABLE;
    description.parameterization = ACDF_PARAM_TABLE;
    description.axes = describe_axes(array.shape, options);
    const std::vector<compress::Grid> bins = table_grids(array, options.indexed);
    const std::vector<compress::Grid> others = other_grids(array, options);
    const std::vector<double> energy = integrals(bins);
    if (!(energy.back() > 0.0)) throw NoEnergy("all its numbers are 0, so there is nothing to sample");
    Table out;
    out.total = description.total = energy.back() * array.scale * volume(description.axes);
    if (!(out.total >= DBL_MIN && out.total <= DBL_MAX))
        throw std::invalid_argument("its integral over the ranges is not a number that a double holds; scale it");
    description.shares = shares(energy);
    std::fill(description.channel_weights, description.channel_weights + 3, 0.0);
    description.channel_weights[0] = 1.0; // a table has one channel

    description.metadata = metadata(source_name, source_sha256, options, {});
    if (options.mis) description.chunks = {partner_of(options.mis, std::vector<float>(bins.size(), 0.5f))};
    const TablePartner beside(bins, others, options.mis);
    const compress::TableTrees trees =
        compress::fit_table(beside.bins(), goal_of(options, description, array.values.size(), progress));
    const std::vector<std::uint8_t> bytes = compress::store(trees.halvings, trees.roots, description);
    const File file = open_made(bytes);
    out.accuracy = summary(options.mis ? measure_bins_beside(file, bins, others) : measure_bins(file, bins));
    out.accuracy.combined = static_cast<bool>(options.mis);
    if (options.mis) description.chunks = {partner_of(options.mis, recommended_light_shares(file, bins, others))};
    description.metadata = metadata(source_name, source_sha256, options, out.accuracy);
    out.bytes = compress::store(trees.halvings, trees.roots, description, options.codec);
    if (progress) progress(1.0, "measuring");
    return out;
}

} // namespace acdf::build
