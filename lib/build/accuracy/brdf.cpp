#include "build/accuracy/brdf.h"

#include "build/accuracy/cells.h"
#include "compress/no_energy.h"
#include "compress/parallel.h"
#include "compress/sum.h"

#include <acdf/sample.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>

namespace acdf::build {
namespace {

/// A fraction in [0, 1) that looks random (the finalizer of MurmurHash3).
double hashed(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x85EBCA6Bu;
    x ^= x >> 13;
    x *= 0xC2B2AE35u;
    x ^= x >> 16;
    return x * 0x1p-32;
}

/// What the relative variance of a view is made from.
class VarianceSums {
public:
    /// `number`: how many there are of this kind, `measure` of them all.
    void add(double f, double p, double measure, double cosine, std::uint32_t number = 1) {
        if (cosine <= 0.0) {
            below_.add(p * measure);
            return;
        }
        above_.add(p * measure);
        albedo_.add(f * measure);
        if (!(f > 0.0)) return;
        if (p > 0.0) second_.add(f * f / p * measure);
        else violations_ += number;
    }
    ViewAccuracy result() const {
        ViewAccuracy out;
        const double e = albedo_.value();
        out.albedo = e;
        // Of what was summed: the sum is off by a thousandth, and no share is more than 1.
        out.integral = above_.value() + below_.value();
        out.share_above_horizon = out.integral > 0.0 ? above_.value() / out.integral : 0.0;
        out.support_violations = violations_;
        if (!(e > 0.0)) return out;
        out.relative_variance = violations_ > 0 ? std::numeric_limits<double>::infinity()
                                                : std::max(0.0, second_.value() * out.integral / (e * e) - 1.0);
        return out;
    }

private:
    compress::PlainerSum albedo_, above_, below_, second_;
    std::uint64_t violations_ = 0;
};

/// All sums of one view.
class ViewSums {
public:
    void add(double f, double p, double measure, double cosine, std::uint32_t number = 1) {
        variance_.add(f, p, measure, cosine, number);
        if (cosine <= 0.0) return;
        square_p_.add(p * p * measure);
        cross_.add(p * f * measure);
        square_f_.add(f * f * measure);
        if (!(f > 0.0) || !(p > 0.0)) return;
        log_.add(f * std::log(f / p) * measure);
        largest_ = std::max(largest_, f / p);
    }
    ViewAccuracy result() const {
        ViewAccuracy out = variance_.result();
        const double e = out.albedo;
        if (!(e > 0.0)) return out;
        out.square_error = square_p_.value() - 2.0 * cross_.value() / e + square_f_.value() / (e * e);
        out.kl_divergence = log_.value() / e - std::log(e / out.integral);
        out.max_weight = largest_ / e;
        return out;
    }

private:
    VarianceSums variance_;
    compress::PlainerSum square_p_, cross_, square_f_, log_;
    double largest_ = 0.0;
};

/// A direction as the reader takes it.
void rounded(const double direction[3], float out[3]) {
    const float given[3] = {float(direction[0]), float(direction[1]), float(direction[2])};
    acdf_as_given(given, out);
}

/// Half-vectors around the view's azimuth, the first `visited` of each row of `columns`; theta_h in steps of its
/// square root. Calls visit(wi, measure) for each, row by row.
template <typename Visit>
void for_some_half_vectors(const compress::View& view, const double wo[3], std::uint32_t columns,
                           std::uint32_t visited, std::uint32_t rows, const Visit& visit) {
    std::vector<std::array<double, 2>> azimuth;
    for (std::uint32_t c = 0; c < visited; ++c) {
        const double phi = view.phi + 2.0 * ACDF_PI * (c + 0.5) / columns;
        azimuth.push_back({std::cos(phi), std::sin(phi)});
    }
    const auto theta = [&](double r) { return 0.5 * ACDF_PI * (r / rows) * (r / rows); };
    for (std::uint32_t r = 0; r < rows; ++r) {
        const double sine = std::sin(theta(r + 0.5)), hz = std::cos(theta(r + 0.5));
        const double low = std::sin(0.5 * theta(r)), high = std::sin(0.5 * theta(r + 1.0));
        const double measure = 2.0 * (high * high - low * low) * 2.0 * ACDF_PI / columns;
        for (std::uint32_t c = 0; c < visited; ++c) {
            const double h[3] = {sine * azimuth[c][0], sine * azimuth[c][1], hz};
            const double dot = wo[0] * h[0] + wo[1] * h[1] + wo[2] * h[2];
            const double wi[3] = {2.0 * dot * h[0] - wo[0], 2.0 * dot * h[1] - wo[1], 2.0 * dot * h[2] - wo[2]};
            // Nearly opposite to wo, which is below the surface, rounding wi decides on the half-vector.
            visit(wi, std::abs(dot) < 2e-3 ? 0.0 : measure * 4.0 * std::abs(dot));
        }
    }
}

template <typename Visit>
void for_each_half_vector(const compress::View& view, const double wo[3], std::uint32_t columns, std::uint32_t rows,
                          const Visit& visit) {
    for_some_half_vectors(view, wo, columns, columns, rows, visit);
}

double light_above(const compress::Reflected& reflected, const double wo[3], const double wi[3]) {
    return wi[2] > 0.0 ? reflected(wo, wi) : 0.0;
}

} // namespace

std::vector<compress::View> random_views(std::uint32_t count, bool isotropic, double low, double high) {
    std::vector<compress::View> out;
    for (std::uint32_t i = 0; i < count; ++i) {
        compress::View view;
        const double cosine = low + (high - low) * (i + hashed(2 * i + 1)) / count;
        view.x = std::sqrt(1.0 - cosine);
        view.phi = isotropic ? 0.0 : ACDF_PI * (2.0 * hashed(2 * i + 2) - 1.0);
        out.push_back(view);
    }
    return out;
}

std::vector<ViewAccuracy> measure_views(const ViewPdf& density, const compress::Reflected& reflected,
                                        const std::vector<compress::View>& views, std::uint32_t columns,
                                        std::uint32_t rows) {
    std::vector<ViewAccuracy> out(views.size());
    compress::parallel_for(std::size_t{0}, views.size(), [&](std::size_t v) {
        double wo[3];
        views[v].direction(wo);
        ViewSums sums;
        for_each_half_vector(views[v], wo, columns, rows, [&](const double wi[3], double measure) {
            sums.add(light_above(reflected, wo, wi), density(wo, wi), measure, wi[2]);
        });
        out[v] = sums.result();
        out[v].view = views[v];
    });
    return out;
}

std::vector<double> relative_variances(const std::vector<ViewPdf>& densities, const compress::Reflected& reflected,
                                       const std::vector<compress::View>& views, std::uint32_t columns,
                                       std::uint32_t rows) {
    std::vector<std::vector<ViewAccuracy>> measured(densities.size(), std::vector<ViewAccuracy>(views.size()));
    compress::parallel_for(std::size_t{0}, views.size(), [&](std::size_t v) {
        double wo[3];
        views[v].direction(wo);
        std::vector<VarianceSums> sums(densities.size());
        for_each_half_vector(views[v], wo, columns, rows, [&](const double wi[3], double measure) {
            const double f = light_above(reflected, wo, wi);
            for (std::size_t d = 0; d < densities.size(); ++d) sums[d].add(f, densities[d](wo, wi), measure, wi[2]);
        });
        for (std::size_t d = 0; d < densities.size(); ++d) measured[d][v] = sums[d].result();
    });
    std::vector<double> out;
    for (const std::vector<ViewAccuracy>& of_pdf : measured) out.push_back(summary(of_pdf).relative_variance);
    return out;
}

std::vector<ViewAccuracy> measure_views(const File& file, const compress::Reflected& reflected,
                                        const std::vector<compress::View>& views, Sides sides,
                                        std::uint32_t columns, std::uint32_t rows) {
    const AcdfBrdf brdf = file.brdf().data();
    const bool both = acdf_brdf_mirrored(&brdf) && brdf.views->phi_count == 1; // sides of views have the same pdfs
    // The last one visited is its own mirror image where columns are odd.
    const std::uint32_t visited = sides == Sides::alike && both ? (columns + 1) / 2 : columns;
    const auto images = [&](std::uint32_t c) { return visited == columns || 2 * c + 1 == columns ? 1u : 2u; };
    std::vector<ViewAccuracy> out(views.size());
    compress::parallel_for(std::size_t{0}, views.size(), [&](std::size_t v) {
        double wo[3];
        views[v].direction(wo);
        float o[3], i[3];
        rounded(wo, o);
        AcdfBrdfView view; // looked up once
        const bool seen = acdf_brdf_view(&brdf, o, &view) != 0;
        ViewSums sums;
        std::uint32_t column = 0;
        for_some_half_vectors(views[v], wo, columns, visited, rows, [&](const double wi[3], double measure) {
            rounded(wi, i);
            const double p = seen ? double{acdf_brdf_view_pdf(&brdf, &view, i)} : 0.0;
            sums.add(light_above(reflected, wo, wi), p, images(column) * measure, wi[2], images(column));
            column = column + 1 < visited ? column + 1 : 0;
        });
        out[v] = sums.result();
        out[v].view = views[v];
    });
    return out;
}

ReflectedViews::ReflectedViews(const compress::Reflected& reflected, const std::vector<compress::View>& views,
                               std::uint32_t columns, std::uint32_t rows, std::size_t most_kept)
    : reflected_(reflected), views_(views), columns_(columns), rows_(rows),
      light_(std::min(views.size(), most_kept / (std::size_t{columns} * rows))) {
    compress::parallel_for(std::size_t{0}, light_.size(), [&](std::size_t v) {
        double wo[3];
        views[v].direction(wo);
        light_[v].reserve(std::size_t{columns} * rows);
        for_each_half_vector(views[v], wo, columns, rows, [&](const double wi[3], double) {
            light_[v].push_back(light_above(reflected, wo, wi));
        });
    });
}

double ReflectedViews::relative_variance(const ViewPdf& density) const {
    std::vector<ViewAccuracy> out(views_.size());
    compress::parallel_for(std::size_t{0}, views_.size(), [&](std::size_t v) {
        double wo[3];
        views_[v].direction(wo);
        VarianceSums sums;
        const double* light = v < light_.size() ? light_[v].data() : nullptr;
        for_each_half_vector(views_[v], wo, columns_, rows_, [&](const double wi[3], double measure) {
            const double f = light ? *light++ : light_above(reflected_, wo, wi);
            sums.add(f, density(wo, wi), measure, wi[2]);
        });
        out[v] = sums.result();
    });
    return summary(out).relative_variance;
}

std::vector<ViewAccuracy> with_lost_samples(std::vector<ViewAccuracy> views) {
    for (ViewAccuracy& view : views)
        if (view.integral > 0.0 && view.integral < 1.0)
            view.relative_variance = (1.0 + view.relative_variance) / view.integral - 1.0;
    return views;
}

BrdfAccuracy summary(const std::vector<ViewAccuracy>& views) {
    BrdfAccuracy out;
    compress::Sum variance, square_error, kl, above;
    std::vector<double> sorted;
    for (const ViewAccuracy& v : views) {
        if (!(v.albedo > 0.0)) continue;
        ++out.views;
        variance.add(v.relative_variance);
        square_error.add(v.square_error);
        kl.add(v.kl_divergence);
        above.add(v.share_above_horizon);
        sorted.push_back(v.relative_variance);
        if (sorted.size() == 1 || v.relative_variance > out.worst) {
            out.worst = v.relative_variance;
            out.worst_view = v.view;
        }
        out.max_weight = std::max(out.max_weight, v.max_weight);
        out.support_violations += v.support_violations;
    }
    if (sorted.empty()) throw compress::NoEnergy("it reflects nothing to any of the views");
    const double count = out.views;
    std::sort(sorted.begin(), sorted.end());
    out.median = 0.5 * (sorted[(sorted.size() - 1) / 2] + sorted[sorted.size() / 2]);
    out.relative_variance =
        out.support_violations > 0 ? std::numeric_limits<double>::infinity() : variance.value() / count;
    out.rms_pdf_error = std::sqrt(std::max(0.0, square_error.value()) / (2.0 * ACDF_PI * count));
    out.kl_divergence = kl.value() / count;
    out.share_above_horizon = above.value() / count;
    return out;
}

std::uint64_t brdf_cells(const File& file) {
    if (const AcdfHalvedTree* halved = file.brdf().data().halved) return halved->count + std::uint64_t{1};
    std::uint64_t cells = 0;
    for (std::uint32_t b = 0; b < file.description().bin_count; ++b)
        for_each_cell(file, file.bin(b).root, [&](const Cell&) { ++cells; });
    return cells;
}

} // namespace acdf::build
