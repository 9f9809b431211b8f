#include "build/local_draft.h"

#include "build/compressed_budget.h"
#include "build/text/options.h"

#include <acdf/curves/curves.h>

#include <algorithm>
#include <cmath>

namespace acdf::build {
namespace {

constexpr std::uint32_t kTestNormals = 256;

Local measured(std::vector<std::uint8_t> bytes, const compress::Target& target, const LocalOptions& options) {
    Local out = {std::move(bytes), {}, 0};
    const std::vector<Normal> normals = test_normals(options.scene, kTestNormals);
    out.accuracy = summary(measure_normals(opened(out.bytes), target, normals));
    out.normals = static_cast<std::uint32_t>(normals.size());
    return out;
}

float mean_share(const std::vector<AcdfPartnerRecord>& records, const compress::NormalBins& bins) {
    double sum = 0.0;
    for (std::size_t b = 0; b < records.size(); ++b)
        sum += bins.weight[b] * static_cast<double>(records[b].recommended_light_share);
    return static_cast<float>(std::clamp(sum, 1e-3, 1.0)); // weights add up to 1
}

} // namespace

OutOfReach::OutOfReach(std::uint64_t budget, std::uint64_t least_bytes)
    : std::runtime_error("a size of " + std::to_string(budget) +
                         " bytes is out of reach; the smallest possible is about " + std::to_string(least_bytes)),
      least(least_bytes) {}

compress::Description description_of(const compress::Target& target, const Source& source, const LocalOptions& o,
                                     const compress::NormalBins& bins, const LocalAccuracy& accuracy) {
    compress::Description d =
        compress::environment_description(target.columns, target.rows, target.parameterization);
    d.kind = ACDF_KIND_LOCAL;
    d.fit = o.sharing ? ACDF_FIT_VARIANCE : o.fit.fit;
    d.filter = o.target.filter;
    d.channels = o.target.channels;
    const double weights[3] = {o.target.weights.r, o.target.weights.g, o.target.weights.b};
    std::copy(std::begin(weights), std::end(weights), d.channel_weights);
    d.total = target.total;
    if (bins.subdivisions > 0) {
        const auto count = static_cast<std::uint32_t>(bins.normals.size());
        d.axes.push_back({"normal", ACDF_AXIS_INDEXED, ACDF_MEASURE_LINEAR, count, 0.0, double(count)});
    } else {
        d.axes.push_back({"normal theta", ACDF_AXIS_INDEXED, ACDF_MEASURE_LINEAR, bins.rows, 0.0, ACDF_PI});
        d.axes.push_back({"normal phi", ACDF_AXIS_INDEXED, ACDF_MEASURE_LINEAR, bins.columns, ACDF_PI, -ACDF_PI});
    }
    d.metadata = {{"tool", "acdf " ACDF_VERSION},
                  {"fit.options", option_text(source.reading, o)},
                  {"source.name", source.name},
                  {"source.sha256", source.sha256},
                  {"source.projection", source.projection},
                  {"accuracy.relative_variance", accuracy_text(accuracy.relative_variance)},
                  {"accuracy.relative_variance_full_cdf", accuracy_text(accuracy.relative_variance_full_cdf)},
                  {"accuracy.share_above_horizon", accuracy_text(accuracy.share_above_horizon)}};
    return d;
}

compress::Chunk partner_chunk(const compress::Partner& partner, const std::vector<AcdfPartnerRecord>& records,
                              const compress::NormalBins& bins) {
    return compress::partner_chunk(partner, mean_share(records, bins), records);
}

File opened(const std::vector<std::uint8_t>& bytes) {
    File file;
    if (const Status status = File::from_memory(bytes.data(), bytes.size(), file, with_curves()); !status.ok())
        throw std::logic_error(std::string("the reader refuses the file just made: ") + status.message);
    return file;
}

Local finish(compress::Description description, const Store& store, const compress::Target& target,
             const Source& source, const LocalOptions& options, const compress::NormalBins& bins) {
    Local out = measured(store(description, ACDF_CODEC_NONE), target, options);
    description.metadata = description_of(target, source, options, bins, out.accuracy).metadata; // of the same size
    out.bytes = store(description, options.codec);
    return out;
}

Local compressed_local(std::uint64_t budget, const std::function<Local(std::uint64_t bytes)>& build) {
    try {
        return fill_compressed(budget, build);
    } catch (const OutOfReach& plain) { // compressed, the least may be small enough
        Local made = build(plain.least);
        if (made.bytes.size() > budget) throw OutOfReach(budget, made.bytes.size() + kSlack);
        return made;
    }
}

Local smallest_of_variance(double variance, const std::function<std::optional<Local>(double bytes)>& at,
                           const std::function<void(double share)>& progress) {
    const auto reaches = [&](const std::optional<Local>& made) {
        return made && made->accuracy.relative_variance <= variance;
    };
    constexpr double smallest = 256.0, largest = 64.0 * 1048576.0;
    double low = 16384.0, high = 65536.0;
    std::optional<Local> best = at(high);
    for (std::size_t bytes = 0; !reaches(best);) {
        const bool grown = !best || best->bytes.size() > bytes; // else nothing is left to store
        if (high >= largest || !grown)
            throw std::runtime_error("a relative variance of " + option_number(variance) + " is out of reach; " +
                                     (grown ? "64 MiB" : std::to_string(bytes) + " bytes") + " have " +
                                     (best ? option_number(best->accuracy.relative_variance) : "no room"));
        bytes = best ? best->bytes.size() : 0;
        low = high;
        high = std::min(4.0 * high, largest);
        best = at(high);
    }
    for (; low < 65536.0 && low >= smallest; low /= 4.0) { // not the first size that was tried is too small
        std::optional<Local> less = at(low);
        if (!reaches(less)) break;
        high = low;
        best = std::move(less);
    }
    for (int step = 0; step < 7; ++step) {
        progress(0.3 + 0.1 * step);
        const double middle = std::sqrt(low * high);
        if (std::optional<Local> candidate = at(middle); reaches(candidate)) {
            high = middle;
            best = std::move(candidate);
        } else {
            low = middle;
        }
    }
    return std::move(*best);
}

} // namespace acdf::build
