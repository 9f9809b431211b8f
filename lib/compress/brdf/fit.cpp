#include "compress/brdf/fit.h"

#include "compress/brdf/fit_separate.h"
#include "compress/brdf/halved.h"
#include "compress/brdf/views.h"
#include "compress/halvings/row_size.h"
#include "compress/no_energy.h"

#include <acdf/layout.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace acdf::compress {
namespace {

constexpr std::uint32_t kLeastCells = 16;
constexpr std::size_t kMostNodes = 64, kViews = 96;
constexpr double kBytesPerView = 130.0, kBytesPerTurnedView = 16.0; // times views; isotropic, anisotropic
constexpr std::uint32_t kRowCodeBits = 8;

/// A file without rows, to ask for its size.
BrdfFit hollow(std::uint32_t thetas, std::uint32_t azimuths) {
    BrdfFit out;
    out.nodes.assign(thetas, 0.0f);
    out.phi_views = azimuths;
    out.rows.halvings.axes = {-1};
    out.rows.code_bits = kRowCodeBits;
    out.rows.rows.resize(out.bins());
    out.shares.resize(out.bins());
    return out;
}

/// Stored views.
struct Plan {
    std::uint32_t thetas = 0, azimuths = 1;
};

/// Another view is worth about as much as cells for its bytes where there are so many bytes for each view.
Plan plan(const BrdfOptions& options, std::uint64_t budget) {
    const bool isotropic = options.symmetry.isotropic;
    const double bins = std::sqrt(double(budget) / (isotropic ? kBytesPerView : kBytesPerTurnedView));
    Plan out;
    out.azimuths = options.phi_views ? options.phi_views : isotropic ? 1 : bins < 90.0 ? 8 : 16;
    out.thetas = options.theta_views;
    if (out.thetas == 0)
        out.thetas =
            std::clamp(static_cast<std::uint32_t>(std::lround(bins / out.azimuths)), isotropic ? 10u : 4u, 64u);
    return out;
}

class BrdfSearch {
public:
    BrdfSearch(const Reflected& reflected, const BrdfOptions& options)
        : reflected_(reflected), options_(options),
          grid_(HalfGrid::halved(options.symmetry.isotropic && !options.symmetry.mirrored ? 512 : 256,
                                 options.symmetry.isotropic ? 512 : 256, options.symmetry.mirrored)),
          order_(choose_nodes(reflected, options.symmetry, kMostNodes)) {}

    BrdfFit within(std::uint64_t budget) const {
        const Plan p = plan(options_, budget);
        const std::uint64_t none = row_bytes(0, 0, kRowCodeBits),
                            others = options_.file_size(hollow(p.thetas, p.azimuths)) - none,
                            least =
                                others + row_bytes(kLeastCells, std::size_t{p.thetas} * p.azimuths * kLeastCells,
                                                   kRowCodeBits);
        if (budget >= least) return one(p, {budget - others, 0});
        throw std::runtime_error("no file of " + std::to_string(budget) + " bytes can hold it; the smallest has " +
                                 std::to_string(least) + " bytes");
    }

    /// Looks at the stored views and some between them, and fits.
    BrdfFit one(const Plan& p, const HalvedBrdfSize& size) const {
        std::vector<double> x(order_.begin(),
                              order_.begin() + std::min<std::ptrdiff_t>(p.thetas, std::ptrdiff_t(order_.size())));
        std::sort(x.begin(), x.end());
        const bool isotropic = options_.symmetry.isotropic;
        const std::size_t parts = isotropic ? std::clamp<std::size_t>(kViews / x.size(), 2, 8) : 2,
                          turns = isotropic ? 1 : p.azimuths * std::max(2u, 24 / p.azimuths);
        BrdfViews views = look_at(reflected_, grid_, subdivided(x, parts), azimuths(turns));
        const HorizonSquares horizon = look_at_horizon(reflected_, views);
        if (std::none_of(views.targets.begin(), views.targets.end(),
                         [](const ViewTarget& t) { return t.albedo > 0.0; }))
            throw NoEnergy("it reflects nothing to any view looked at, so there is nothing to sample");
        if (options_.progress) options_.progress(0.6);
        StoredViews stored;
        for (std::size_t i = 0; i < x.size(); ++i) stored.x.push_back(i * parts);
        for (std::size_t k = 0; k < p.azimuths; ++k) stored.phi.push_back(k * turns / p.azimuths);
        const ViewMixtures mixtures(views, stored);
        HalvedBrdf fit = fit_halved_brdf(views, horizon, mixtures, size, options_.max_weight);
        return described(views, mixtures, std::move(fit));
    }

    /// The smallest file for a variance, to about a tenth.
    BrdfFit reaching(double variance) const {
        std::uint64_t high = 8192, low = 0;
        BrdfFit fit = within(high);
        for (; fit.relative_variance > variance; fit = within(high)) {
            if (high >= (std::uint64_t{4} << 20)) {
                char text[96];
                std::snprintf(text, sizeof text, "a relative variance of %.3g is out of reach; 4 MiB have %.3g",
                              variance, fit.relative_variance);
                throw std::runtime_error(text);
            }
            low = high;
            high *= 2;
        }
        for (int step = 0; step < 3 && low > 0; ++step) {
            const std::uint64_t middle = (low + high) / 2;
            BrdfFit tried = within(middle);
            if (tried.relative_variance > variance) low = middle;
            else high = middle, fit = std::move(tried);
        }
        return fit;
    }

private:
    BrdfFit described(const BrdfViews& views, const ViewMixtures& mixtures, HalvedBrdf fit) const {
        const StoredViews& stored = mixtures.stored();
        BrdfFit out;
        out.mirrored = options_.symmetry.mirrored;
        out.phi_views = static_cast<std::uint32_t>(stored.phi.size());
        for (const std::size_t i : stored.x) out.nodes.push_back(static_cast<float>(views.x[i]));
        out.total = mixtures.total();
        for (const double a : mixtures.albedos())
            out.shares.push_back(static_cast<float>(std::max(a / out.total, kLeastShare)));
        out.rows = std::move(fit.rows);
        out.relative_variance = fit.relative_variance;
        return out;
    }

    const Reflected& reflected_;
    const BrdfOptions& options_;
    HalfGrid grid_;
    std::vector<double> order_; ///< of x: see choose_nodes
};

} // namespace

BrdfFit fit_brdf(const Reflected& reflected, const BrdfOptions& given) {
    BrdfOptions options = given;
    if (options.phi_views > 1) options.symmetry = {false, false};
    if (options.symmetry.isotropic) options.phi_views = 1;
    else options.symmetry.mirrored = false;
    if (options.fit != ACDF_FIT_VARIANCE) return fit_separate(reflected, options);
    const BrdfSearch search(reflected, options);
    switch (options.goal.kind) {
    case Goal::Kind::variance:
        return search.reaching(options.goal.variance);
    case Goal::Kind::budget:
        return search.within(options.goal.budget);
    default: {
        const bool isotropic = options.symmetry.isotropic;
        const Plan p = {options.theta_views ? options.theta_views
                        : isotropic         ? 32u
                                            : 12u,
                        options.phi_views ? options.phi_views
                        : isotropic       ? 1u
                                          : 16u};
        return search.one(p, {0, std::min(options.goal.cells, ACDF_MOST_HALVINGS)});
    }
    }
}

} // namespace acdf::compress
