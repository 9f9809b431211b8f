#include "compress/brdf/fit_separate.h"

#include "compress/fit/fit.h"
#include "compress/no_energy.h"
#include "compress/parallel.h"

#include <acdf/sample.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace acdf::compress {
namespace {

constexpr std::uint32_t kRowAxis = 1, kColumnAxis = 0; // of the file
constexpr std::uint32_t kThetaViews = 32, kPhiViews = 16;

/// What a bin of views covers.
struct BinRange {
    View low, high;
    View node;
};

std::vector<BinRange> bin_ranges(std::uint32_t thetas, std::uint32_t azimuths) {
    std::vector<double> x;
    for (std::uint32_t i = 0; i < thetas; ++i)
        x.push_back(std::sqrt(1.0 - std::cos(0.5 * ACDF_PI * (i + 0.5) / thetas)));
    std::vector<BinRange> out;
    for (std::uint32_t i = 0; i < thetas; ++i)
        for (std::uint32_t k = 0; k < azimuths; ++k) {
            BinRange bin;
            bin.node.x = x[i];
            bin.low.x = i > 0 ? 0.5 * (x[i - 1] + x[i]) : 0.0;
            bin.high.x = i + 1 < thetas ? 0.5 * (x[i] + x[i + 1]) : 1.0;
            if (azimuths > 1) {
                const double step = 2.0 * ACDF_PI / azimuths;
                bin.node.phi = -ACDF_PI + step * k;
                bin.low.phi = bin.node.phi - 0.5 * step;
                bin.high.phi = bin.node.phi + 0.5 * step;
            }
            out.push_back(bin);
        }
    return out;
}

/// Views spread over a bin.
std::vector<View> views_in(const BinRange& bin, bool isotropic) {
    const std::uint32_t count = isotropic ? 5 : 2, azimuths = isotropic ? 1 : 2;
    std::vector<View> out;
    for (std::uint32_t i = 0; i < count; ++i)
        for (std::uint32_t k = 0; k < azimuths; ++k) {
            View view;
            view.x = std::min(bin.low.x + (bin.high.x - bin.low.x) * (i + 0.5) / count, std::sqrt(1.0 - 1e-3));
            view.phi = isotropic ? 0.0 : bin.low.phi + (bin.high.phi - bin.low.phi) * (k + 0.5) / azimuths;
            out.push_back(view);
        }
    return out;
}

/// Root of the mean square of the views of a bin (docs/method.md): right for all of them, support included.
Target bin_target(const Reflected& reflected, const HalfGrid& grid, const BinRange& bin, bool isotropic,
                  double& albedo) {
    Target out;
    out.columns = grid.columns();
    out.rows = grid.rows();
    out.column_measure = grid.column_measure;
    out.row_measure = grid.row_measure;
    out.column_axis = kColumnAxis;
    out.row_axis = kRowAxis;
    std::vector<double> square(grid.size(), 0.0);
    const std::vector<View> views = views_in(bin, isotropic);
    albedo = 0.0;
    for (const View& view : views) {
        const ViewTarget target = view_target(reflected, grid, view);
        for (std::size_t i = 0; i < square.size(); ++i) square[i] += target.square[i];
        albedo += target.albedo / static_cast<double>(views.size());
    }
    const std::vector<std::uint8_t> visible = visible_squares(grid, bin.low, bin.high);
    for (std::size_t i = 0; i < square.size(); ++i) {
        const double mean = std::sqrt(square[i] / static_cast<double>(views.size()));
        out.values.push_back(static_cast<float>(visible[i] ? std::max(mean, 1e-2 * kPrior) : mean));
    }
    out.total = integral(out);
    return out;
}

/// From steps of the grid to positions of the file.
void place_knots(Cascade& cascade, const HalfGrid& grid) {
    for (Curve& curve : cascade.curves)
        for (std::uint32_t& knot : curve.knots)
            knot = (curve.axis == kRowAxis ? grid.row_knots : grid.column_knots)[knot];
}

Cascade fit_each(const std::vector<Target>& targets, const HalfGrid& grid, const BrdfOptions& options) {
    FitOptions fit;
    fit.fit = options.fit;
    fit.row_segments = options.theta_segments;
    fit.column_segments = options.phi_segments;
    fit.epsilon = options.epsilon;
    std::vector<Cascade> bins(targets.size());
    parallel_for(std::size_t{0}, bins.size(), [&](std::size_t b) { bins[b] = fit_regional(targets[b], fit); });
    Cascade out;
    for (const Cascade& bin : bins) append(bin, out);
    place_knots(out, grid);
    return out;
}

} // namespace

BrdfFit fit_separate(const Reflected& reflected, const BrdfOptions& options) {
    const bool isotropic = options.symmetry.isotropic;
    const std::uint32_t thetas = options.theta_views ? options.theta_views : kThetaViews;
    const std::uint32_t azimuths = isotropic ? 1 : options.phi_views ? options.phi_views : kPhiViews;
    const HalfGrid grid(isotropic ? 256 : 128, isotropic ? 540 : 180, options.symmetry.mirrored);
    const std::vector<BinRange> ranges = bin_ranges(thetas, azimuths);
    std::vector<Target> targets(ranges.size());
    std::vector<double> albedo(ranges.size());
    parallel_for(std::size_t{0}, ranges.size(),
                 [&](std::size_t b) { targets[b] = bin_target(reflected, grid, ranges[b], isotropic, albedo[b]); });
    BrdfFit out;
    out.mirrored = options.symmetry.mirrored;
    out.phi_views = azimuths;
    for (std::size_t b = 0; b < ranges.size(); b += azimuths)
        out.nodes.push_back(static_cast<float>(ranges[b].node.x));
    out.total = std::accumulate(albedo.begin(), albedo.end(), 0.0);
    if (!(out.total > 0.0))
        throw NoEnergy("it reflects nothing to any view looked at, so there is nothing to sample");
    for (const double a : albedo) out.shares.push_back(static_cast<float>(std::max(a / out.total, kLeastShare)));
    out.tree = encode_tree(fit_each(targets, grid, options));
    return out;
}

} // namespace acdf::compress
