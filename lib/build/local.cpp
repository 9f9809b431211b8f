#include "build/local.h"

#include "build/errors.h"
#include "build/lit_bins.h"
#include "build/local_draft.h"
#include "build/local_halved.h"
#include "build/local_size.h"
#include "build/local_whole.h"
#include "build/text/options.h"
#include "build/text/partner.h"
#include "build/weight_bound.h"
#include "compress/local/fit.h"
#include "compress/visibility/portal_sides.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <stdexcept>

namespace acdf::build {
namespace {

using compress::Goal;
using compress::NormalBins;

/// Everything of a file but its accuracy.
struct LocalDraft {
    compress::EncodedTree tree;
    compress::Description description;
};

Local finish(const LocalDraft& draft, const compress::Target& target, const Source& source,
             const LocalOptions& options, const NormalBins& bins) {
    const Store store = [&](const compress::Description& description, AcdfCodec codec) {
        return compress::store(draft.tree, description, codec);
    };
    return finish(draft.description, store, target, source, options, bins);
}

/// The first four fifths of the work.
compress::Progress fitting(const Progress& progress) {
    return [&progress](double share) {
        if (progress) progress(0.8 * share, "fitting");
    };
}

LocalDraft shared_draft(const compress::LocalFit& fit, const compress::Target& target, const Source& source,
                        const LocalOptions& options, const NormalBins& bins) {
    LocalDraft draft{fit.tree, description_of(target, source, options, bins, {})};
    draft.description.shares = fit.shares;
    draft.description.chunks = compress::shared_chunks(fit.shared);
    draft.description.chunks.push_back(
        compress::local_chunk(static_cast<float>(options.cosine_share), fit.bright_tiles));
    if (options.mis) draft.description.chunks.push_back(partner_chunk(options.mis, fit.records, bins));
    return draft;
}

/// The bytes of a file, before compression.
struct Budget {
    std::uint64_t whole; ///< for a tree of the environment alone
    std::uint64_t local; ///< for that, and all else
};

Budget budget_of(std::uint64_t all, compress::WholeTree tree) {
    return {tree == compress::WholeTree::own ? std::min(whole_tree_bytes(all), all) : 0, all};
}

std::uint64_t bytes_of(const LocalDraft& draft) { return compress::store(draft.tree, draft.description).size(); }

/// Whether an error names the least size that would do: finding it takes a fit.
enum class Least { told, unheard };

/// Of a file that has bins, but nothing in them: known before anything is fitted.
std::uint64_t bytes_of_bins(const compress::Target& target, const Source& source, const LocalOptions& options,
                            const NormalBins& bins) {
    compress::LocalFit nothing;
    nothing.shares.assign(bins.normals.size(), 0.0f);
    nothing.tree.roots.assign(bins.normals.size(), ACDF_NO_ROOT);
    if (options.mis) nothing.records.resize(bins.normals.size(), {1.0f, 0.0f});
    return bytes_of(shared_draft(nothing, target, source, options, bins));
}

/// Of a file that has these bins, two tiles, and as little in them as can be; but for a tree of the environment.
std::uint64_t least_bytes(const compress::Target& target, const Source& source, const LocalOptions& options,
                          LitBins& bins, compress::LocalSize size) {
    size.tiles = 2;
    size.whole_bytes = 0;
    compress::LocalFitter fitter(target, bins.bins(), bins.light(), size, {}, options.mis);
    return bytes_of(shared_draft(fitter.outlined(64), target, source, options, bins.bins())) + kSlack;
}

/// The file in which all but a tree of the environment alone has `others` bytes.
std::uint64_t whole_of(std::uint64_t others, compress::WholeTree tree) {
    return tree == compress::WholeTree::own ? file_of_others(others) : others;
}

/// What one try leaves to the next.
struct Tried {
    explicit Tried(const compress::Target& target) : alone(target) {}

    LastBins bins;
    AloneTree alone;
};

/// build(bytes). Where that is out of reach, the least that the error names was made once, by `attempt`.
template <class Build, class Attempt>
Local within_reach(std::uint64_t bytes, const Build& build, const Attempt& attempt) {
    try {
        return build(bytes);
    } catch (const OutOfReach& first) {
        std::uint64_t least = first.least;
        for (int tries = 0; tries < 4; ++tries) {
            try {
                attempt(least);
                break;
            } catch (const OutOfReach& again) {
                least = std::max(again.least, least + kSlack);
            }
        }
        throw OutOfReach(bytes, least);
    }
}

/// At most `all` bytes before compression, and nearly as many.
Local build_plain(const compress::Target& target, const Source& source, const LocalOptions& options,
                  std::uint64_t all, WholeChoice choice, double max_weight, Tried& tried, Least least,
                  const Progress& progress) {
    const compress::WholeTree tree = choice.tree;
    const Budget budgets = budget_of(all, tree);
    const std::uint64_t budget = budgets.local, others = budget - budgets.whole;
    LitBins& lit = bins_for(options, double(others), target, tried.bins);
    const NormalBins& bins = lit.bins();
    compress::LocalSize size = size_for(options, bins, double(others));
    size.whole = tree;
    size.whole_worth = choice.worth;
    size.whole_bytes = budgets.whole;
    if (max_weight > 0.0) size.max_weight = max_weight;
    if (const std::uint64_t bytes = bytes_of_bins(target, source, options, bins); bytes > others)
        throw OutOfReach(
            all, whole_of(least == Least::unheard ? bytes : least_bytes(target, source, options, lit, size), tree));
    std::optional<compress::LocalFitter> fitter; // of so many tiles
    for (int tries = 0;; ++tries) {
        if (!fitter) fitter.emplace(target, bins, lit.light(), size, fitting(progress), options.mis);
        compress::LocalFit fit = fitter->outlined(size.inside_bytes);
        LocalDraft draft = shared_draft(fit, target, source, options, bins);
        const std::uint64_t bytes = bytes_of(draft);
        // What bright tiles and packing take is known now; once is enough but where tiles or curves run out.
        const bool fits = bytes <= budget, full = bytes >= budget - budget / 50;
        const bool checked = tree == compress::WholeTree::of_tiles;
        if (fits && checked && !tried.alone.is_matched(fit.tree, all))
            return build_plain(target, source, options, all, next_choice(choice), max_weight, tried, least,
                               progress);
        if (fits && (full || tries > 0)) {
            fitter->fill(fit);
            draft = shared_draft(fit, target, source, options, bins);
            return finish(std::move(draft), target, source, options, bins);
        }
        const auto miss = static_cast<std::int64_t>(budget) - static_cast<std::int64_t>(bytes);
        const std::int64_t next = static_cast<std::int64_t>(size.inside_bytes) + miss - 192;
        if (next < 64 || tries == 6) {
            if (size.tiles <= 2) throw OutOfReach(all, whole_of(bytes - std::min(bytes, budgets.whole), tree));
            size.tiles = size.tiles * 3 / 4;
            fitter.reset();
            size.inside_bytes = size_for(options, bins, double(others)).inside_bytes;
            tries = 0;
            continue;
        }
        size.inside_bytes = static_cast<std::uint64_t>(next);
    }
}

Local build_in_budget(const compress::Target& target, const Source& source, const LocalOptions& options,
                      std::uint64_t budget, Tried& tried, Least least, const Progress& progress) {
    if (options.codec != ACDF_CODEC_NONE) least = Least::told; // by which it goes on
    return within_weight(options.max_weight, [&](double max_weight) {
        const auto build_with = [&](std::uint64_t bytes, const Progress& told) {
            return build_plain(target, source, options, bytes, first_choice(options), max_weight, tried, least,
                               told);
        };
        const auto build = [&](std::uint64_t bytes) { return build_with(bytes, progress); };
        if (options.codec == ACDF_CODEC_NONE)
            return within_reach(budget, build, [&](std::uint64_t bytes) { return build_with(bytes, {}); });
        return compressed_local(budget, build);
    });
}

/// Cells in tiles as asked for, and a tree of the environment that suits them.
compress::LocalFit fit_cells(const compress::Target& target, const Source& source, const LocalOptions& options,
                             LitBins& lit, AloneTree& alone, compress::LocalSize size, const Progress& progress) {
    const auto bytes = [&](const compress::LocalFit& fit) {
        return bytes_of(shared_draft(fit, target, source, options, lit.bins()));
    };
    size.whole_bytes = 0;
    for (WholeChoice choice = first_choice(options);; choice = next_choice(choice)) {
        size.whole = choice.tree;
        size.whole_worth = choice.worth;
        compress::LocalFitter fitter(target, lit.bins(), lit.light(), size, fitting(progress), options.mis);
        compress::LocalFit fit = fitter.outlined(size.inside_bytes);
        if (size.whole == compress::WholeTree::own) {
            fitter.refit_whole(whole_tree_bytes(file_of_others(bytes(fit))));
            fit = fitter.outlined(size.inside_bytes);
        } else if (!alone.is_matched(fit.tree, bytes(fit))) {
            continue;
        }
        fitter.fill(fit);
        return fit;
    }
}

/// The smallest file whose measured variance is low enough.
Local build_to_variance(const compress::Target& target, const Source& source, const LocalOptions& options,
                        Tried& tried, const Progress& progress) {
    double share = 0.0; // steps of the search are of about the same size
    const auto at = [&](double bytes) -> std::optional<Local> {
        const auto searching = [&](double, const char*) { // no news, but a chance to cancel
            if (progress) progress(share, "searching");
        };
        try {
            return build_in_budget(target, source, options, static_cast<std::uint64_t>(bytes), tried,
                                   Least::unheard, searching);
        } catch (const OutOfReach&) {
            return std::nullopt; // bins alone may take more
        }
    };
    return smallest_of_variance(options.goal.variance, at, [&](double now) { share = now; });
}

Local build_separate(const compress::Target& target, const Source& source, const LocalOptions& options,
                     const Progress& progress) {
    const NormalBins bins = bins_of(options, options.subdivisions > 0 ? options.subdivisions : 6);
    LocalDraft draft{{}, description_of(target, source, options, bins, {})};
    draft.description.chunks = {compress::local_chunk(static_cast<float>(options.cosine_share), {})};
    compress::FitOptions fit = options.fit;
    fit.file_size = [&](const compress::EncodedTree& tree) {
        return std::uint64_t{compress::store(tree, draft.description, options.codec).size()};
    };
    fit.progress = [&](double share) {
        if (progress) progress(0.9 * share, "fitting");
    };
    draft.description.shares.assign(bins.normals.size(), 0.0f);
    compress::SeparateFit fitted = compress::fit_local_separate(target, bins, options.bin_target, fit);
    draft.tree = std::move(fitted.tree);
    draft.description.shares = std::move(fitted.shares);
    return finish(std::move(draft), target, source, options, bins);
}

} // namespace

namespace {

std::string shape_text(compress::LocalShape shape) {
    return shape == compress::LocalShape::small ? "--shape small " : "--shape halvings ";
}

} // namespace

std::string option_text(const std::string& reading, const LocalOptions& o) {
    std::string text = reading + target_text(o.target) + codec_text(o.codec);
    if (o.subdivisions > 0) text += "--normals " + std::to_string(o.subdivisions) + " ";
    if (o.columns > 0) text += "--normals " + std::to_string(o.columns) + "x" + std::to_string(o.rows) + " ";
    if (!o.scene_text.empty()) text += o.scene_text + " ";
    else if (!o.scene.empty()) text += "--scene ";
    text += partner_text(o.mis);
    if (o.visibility.scene && o.scene_text.find("--visibility") == std::string::npos) text += "--visibility ";
    if (o.cosine_share > 0.0) text += "--cosine-share " + option_number(o.cosine_share) + " ";
    if (o.sharing) {
        if (o.shape_from == ShapeFrom::request) text += shape_text(o.shape);
        if (o.max_weight > 0.0) text += "--max-weight " + option_number(o.max_weight) + " ";
        if (o.tiles > 0) text += "--tiles " + std::to_string(o.tiles) + " ";
        return text + goal_text(o.goal);
    }
    text += "--no-sharing " + fit_text(o.fit.fit);
    if (o.bin_target == compress::BinTarget::centre) text += "--bin-target centre ";
    if (o.fit.order) text += "--order " + std::string(to_string(*o.fit.order)) + " ";
    text += "--knots " + std::to_string(o.fit.column_segments) + "x" + std::to_string(o.fit.row_segments);
    return o.fit.epsilon > 0.0 ? text + " --eps " + option_number(o.fit.epsilon) : text;
}

namespace {

Local build_to_goal(const compress::Target& target, const Source& source, const LocalOptions& options,
                    const Progress& progress) {
    if (!options.sharing) return build_separate(target, source, options, progress);
    if (options.shape == compress::LocalShape::halvings) return build_halved(target, source, options, progress);
    Tried tried(target);
    switch (options.goal.kind) {
    case Goal::Kind::budget:
        return build_in_budget(target, source, options, options.goal.budget, tried, Least::told, progress);
    case Goal::Kind::variance:
        return build_to_variance(target, source, options, tried, progress);
    default: {
        const double bytes = kBytesOfCell * options.goal.cells;
        LitBins& lit = bins_for(options, bytes_around(bytes), target, tried.bins);
        compress::LocalSize size = size_around(options, lit.bins(), bytes);
        return within_weight(options.max_weight, [&](double max_weight) {
            if (max_weight > 0.0) size.max_weight = max_weight;
            const NormalBins& bins = lit.bins();
            const compress::LocalFit fit = fit_cells(target, source, options, lit, tried.alone, size, progress);
            return finish(shared_draft(fit, target, source, options, bins), target, source, options, bins);
        });
    }
    }
}

} // namespace

Local build_local(const compress::Target& target, const Source& source, const LocalOptions& options,
                  const Progress& progress) {
    if (!compress::has_energy(target)) throw NoEnergy("a target without energy");
    if (options.visibility.portals.empty()) return build_to_goal(target, source, options, progress);
    LocalOptions facing = options; // checked first: building takes long
    facing.visibility.portals =
        compress::facing_light(target, options.visibility.portals, options.visibility.scene);
    return build_to_goal(target, source, facing, progress);
}

} // namespace acdf::build
