#include "build/local_halved.h"

#include "build/local_draft.h"
#include "build/weight_bound.h"
#include "compress/local/halved/fit.h"
#include "compress/visibility/fit.h"

#include <algorithm>
#include <memory>
#include <optional>

namespace acdf::build {
namespace {

using compress::Goal;
using compress::LocalHalvings;
using compress::NormalBins;

constexpr std::uint32_t kCountedAt = 8; // subdivisions of bins by which normals are counted
constexpr std::uint64_t kFixed = 1500;  // bytes of a file beside bins and chunks of the tree, about
constexpr double kBytesOfCell = 3.0;    // of a file, about
/// Of a file with visibility cells: one part in so many is for all that is there without them.
constexpr std::uint64_t kLocalPart = 4;
constexpr std::uint64_t kMostLocal = 400000; // bytes: more tiles are more than columns can tell apart
constexpr std::uint64_t kLeastCells = 1024;  // bytes of a few visibility cells
constexpr std::uint64_t kMetadata = 1024;    // of names and options, most often more than they take

class HalvedLocals {
public:
    HalvedLocals(const compress::Target& target, const Source& source, const LocalOptions& options)
        : target_(target), source_(source), options_(options),
          fitter_(target, bins_of(options, kCountedAt), options.mis) {}

    Local of_budget(std::uint64_t budget, const Progress& progress) {
        const auto build = [&](std::uint64_t bytes) { return of_bytes(bytes, progress); };
        return bounded([&] {
            if (options_.codec == ACDF_CODEC_NONE) return build(budget);
            return compressed_local(budget, build);
        });
    }

    Local of_cells(std::uint64_t cells, const Progress& progress) {
        const double bytes = kBytesOfCell * double(cells);
        const NormalBins bins = bins_for(bytes);
        compress::LocalHalvingsSize size = size_for(bins, bytes);
        size.halvings = std::max<std::uint64_t>(cells, 1) - 1;
        size.bytes = std::uint64_t{1} << 32;
        return bounded([&] { return made(bins, size, progress); });
    }

    Local of_variance(double variance, const Progress& progress) {
        double share = 0.0;
        const auto at = [&](double bytes) -> std::optional<Local> {
            try {
                return of_budget(static_cast<std::uint64_t>(bytes), [&](double, const char*) {
                    if (progress) progress(share, "searching"); // no news, but a chance to cancel
                });
            } catch (const OutOfReach&) {
                return std::nullopt;
            }
        };
        return smallest_of_variance(variance, at, [&](double now) { share = now; });
    }

private:
    template <class Build>
    Local bounded(const Build& build) {
        return within_weight(options_.max_weight, [&](double bound) {
            max_weight_ = bound;
            return build();
        });
    }

    NormalBins bins_for(double bytes) {
        const double of_bin = sizeof(AcdfBin) + (options_.mis ? sizeof(AcdfPartnerRecord) : 0);
        const compress::RowSize rows =
            fitter_.rows_for(std::max(0.0, bytes - double{kFixed}), of_bin, options_.subdivisions);
        code_bits_ = rows.code_bits;
        // Each has a record: where few are stored, these leave half of the file.
        return bins_as_many(options_, rows.subdivisions, static_cast<std::size_t>(0.5 * bytes / of_bin));
    }

    compress::LocalHalvingsSize size_for(const NormalBins& bins, double bytes) {
        compress::LocalHalvingsSize size;
        size.code_bits = code_bits_;
        size.top = options_.tiles > 0 ? options_.tiles - 1 : fitter_.top_for(bytes, bins, code_bits_);
        return size;
    }

    /// Of what of a file is there without visibility cells; where that takes `least`, too.
    std::uint64_t local_bytes(std::uint64_t least) const {
        const SceneVisibility& visibility = options_.visibility;
        if (!visibility.scene) return budget_;
        const std::uint64_t most = budget_ - std::min(budget_, kLeastCells);
        return std::max(std::min(budget_ / kLocalPart, kMostLocal), std::min(least + kSlack, most));
    }

    Local of_bytes(std::uint64_t budget, const Progress& progress) {
        budget_ = budget;
        const NormalBins bins = bins_for(double(local_bytes(0)));
        LocalHalvings nothing;
        nothing.halvings.axes = {-1};
        nothing.shares.assign(bins.normals.size(), 0.0f);
        nothing.roots.assign(bins.normals.size(), ACDF_NO_ROOT);
        if (options_.mis) nothing.records.resize(bins.normals.size(), {1.0f, 0.0f});
        const std::uint64_t least = stored(nothing, bins).size(), bytes = local_bytes(least);
        if (least > bytes) throw OutOfReach(budget, budget - bytes + least);
        const std::uint64_t room = bytes - least + 2 * ACDF_ALIGNMENT; // two chunks of a line each
        compress::LocalHalvingsSize size = size_for(bins, double(room));
        size.bytes = room;
        return made(bins, size, progress);
    }

    compress::Description described(const LocalHalvings& fit, const NormalBins& bins) const {
        compress::Description out = description_of(target_, source_, options_, bins, {});
        out.shares = fit.shares;
        out.chunks = {compress::rows_chunk(fit), compress::local_chunk(static_cast<float>(options_.cosine_share))};
        if (options_.mis) out.chunks.push_back(partner_chunk(options_.mis, fit.records, bins));
        return out;
    }

    std::vector<std::uint8_t> stored(const LocalHalvings& fit, const NormalBins& bins) const {
        return compress::store(fit.halvings, fit.roots, described(fit, bins));
    }

    Local made(const NormalBins& bins, compress::LocalHalvingsSize size, const Progress& progress) {
        const double fitting = options_.visibility.scene ? 0.2 : 0.8; // of the time
        if (max_weight_ > 0.0) size.max_weight = max_weight_;
        const LocalHalvings fit = fitter_.fit(bins, size, [&](double share) {
            if (progress) progress(fitting * share, "fitting");
        });
        const Store store = [&](const compress::Description& description, AcdfCodec codec) {
            return compress::store(fit.halvings, fit.roots, description, codec);
        };
        compress::Description description = described(fit, bins);
        if (options_.visibility.scene) add_visibility(description, store, progress);
        return finish(std::move(description), store, target_, source_, options_, bins);
    }

    /// Adds visibility cells in what the rest leaves of the budget.
    void add_visibility(compress::Description& description, const Store& store, const Progress& progress) {
        const SceneVisibility& visibility = options_.visibility;
        const std::vector<std::uint8_t> bytes = store(description, ACDF_CODEC_NONE);
        const File file = opened(bytes);
        compress::Description bare = description;
        bare.metadata.clear();
        // How many cells there are must not depend on the names of files.
        const std::uint64_t used =
            std::max<std::uint64_t>(store(bare, ACDF_CODEC_NONE).size() + kMetadata, bytes.size());
        const std::uint64_t records = (sizeof(AcdfChunk) + ACDF_ALIGNMENT) * (visibility.portals.empty() ? 1 : 2);
        compress::VisibilitySize size;
        size.beside_cosine = visibility.beside_cosine;
        size.bytes = budget_ > used + records ? budget_ - used - records : 0;
        compress::VisibilityScene scene = visibility.scene;
        if (!visibility.portals.empty())
            scene.portals = std::make_shared<const compress::PortalSet>(
                compress::make_portals(target_, visibility.portals, size.bytes / 8));
        const auto tracing = [&](double share) {
            if (progress) progress(0.2 + 0.7 * share, "tracing visibility");
        };
        for (compress::Chunk& chunk : compress::fit_visibility(file.local().data(), file.description().bin_count,
                                                               scene, visibility.frame, size, tracing))
            description.chunks.push_back(std::move(chunk));
        // A single cell, or a map of portals, may be more than is left.
        const std::uint64_t made = store(description, ACDF_CODEC_NONE).size();
        if (made > budget_) throw OutOfReach(budget_, made + kSlack);
    }

    const compress::Target& target_;
    const Source& source_;
    const LocalOptions& options_;
    compress::LocalHalvingsFitter fitter_;
    std::uint32_t code_bits_ = 7;
    std::uint64_t budget_ = 0; ///< of the file that is made
    double max_weight_ = 0.0;  ///< that a fit is held to; 0: none
};

} // namespace

Local build_halved(const compress::Target& target, const Source& source, const LocalOptions& options,
                   const Progress& progress) {
    HalvedLocals locals(target, source, options);
    switch (options.goal.kind) {
    case Goal::Kind::budget:
        return locals.of_budget(options.goal.budget, progress);
    case Goal::Kind::variance:
        return locals.of_variance(options.goal.variance, progress);
    default:
        return locals.of_cells(options.goal.cells, progress);
    }
}

} // namespace acdf::build
