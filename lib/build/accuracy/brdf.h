// How far the stored pdfs of a BRDF are from what it reflects, for views between those that are stored.
#pragma once

#include "compress/brdf/target.h"

#include <acdf/accuracy.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <cstdint>
#include <vector>

namespace acdf::build {

/// Accuracy for one view: p is the stored pdf, f = rho cos(theta_i), both over the directions wi.
struct ViewAccuracy {
    compress::View view;
    double albedo = 0.0; ///< integral of f; 0: all of the rest is 0 but `share_above_horizon`
    /// Variance of one sample of the estimator f/p, over (integral of f)^2. Infinite with a support violation.
    double relative_variance = 0.0;
    double square_error = 0.0;            ///< integral over the hemisphere of (p - f / albedo)^2, sr^-1
    double kl_divergence = 0.0;           ///< integral of (f / albedo) ln(f / (albedo p)), nats
    double max_weight = 0.0;              ///< largest f/p over its mean
    double share_above_horizon = 0.0;     ///< of samples
    double integral = 0.0;                ///< of p over all directions, as summed: 1, but for what the grid misses
    std::uint64_t support_violations = 0; ///< points with f > 0 and p = 0
};

/// With the view that is worst.
struct BrdfAccuracy : builder::BrdfAccuracy {
    compress::View worst_view;
};

/// What p is asked of: the pdf of wi for wo, in sr^-1. Called by several threads at once.
using ViewPdf = std::function<double(const double wo[3], const double wi[3])>;

/// `count` views with cos(theta_o) stratified and uniform in [low, high] and azimuths as random as a hash makes
/// them: not those that are stored. The same for the same arguments.
std::vector<compress::View> random_views(std::uint32_t count, bool isotropic, double low = 0.1, double high = 1.0);

/// Sums over a grid of half-vectors, rows x columns, finer than any fit sees and not aligned with it, and over the
/// same grid the part of samples that falls below the horizon: no samples are taken. The pdf is taken to
/// integrate to 1, and counts as if it did over the grid, too: what the grid misses of a narrow lobe would
/// otherwise be reported as variance or as its absence.
///
/// The defaults are the one grid of all figures that are reported: of those in files, of `acdf brdf`, `measure` and
/// `sweep`.
std::vector<ViewAccuracy> measure_views(const ViewPdf& density, const compress::Reflected& reflected,
                                        const std::vector<compress::View>& views, std::uint32_t columns = 251,
                                        std::uint32_t rows = 601);

/// `alike`: both sides of each view reflect the same, as by all isotropic BRDFs with a mirror
/// symmetry. Sums over files that have it, too, are then over one side.
enum class Sides { any, alike };

/// The same of a BRDF file.
std::vector<ViewAccuracy> measure_views(const File& file, const compress::Reflected& reflected,
                                        const std::vector<compress::View>& views, Sides sides = Sides::any,
                                        std::uint32_t columns = 251, std::uint32_t rows = 601);

/// summary(measure_views(pdf, ...)).relative_variance of several pdfs, which throws alike: what is
/// reflected is looked up once for all of them.
std::vector<double> relative_variances(const std::vector<ViewPdf>& densities, const compress::Reflected& reflected,
                                       const std::vector<compress::View>& views, std::uint32_t columns = 251,
                                       std::uint32_t rows = 601);

/// What views reflect over a grid of measure_views, looked up once: for searches that try many pdfs. Of the
/// first views at most `most_kept` numbers are kept (256 MiB); of others they are looked up each time.
class ReflectedViews {
public:
    ReflectedViews(const compress::Reflected& reflected, const std::vector<compress::View>& views,
                   std::uint32_t columns, std::uint32_t rows, std::size_t most_kept = std::size_t{1} << 25);
    /// That of summary(measure_views(pdf, ...)), which throws alike.
    double relative_variance(const ViewPdf& density) const;

private:
    compress::Reflected reflected_;
    std::vector<compress::View> views_;
    std::uint32_t columns_, rows_;
    std::vector<std::vector<double>> light_; ///< of the first views
};

/// The same of a pdf that integrates to less than 1 because some of its samples are lost: what the integral
/// lacks is variance.
std::vector<ViewAccuracy> with_lost_samples(std::vector<ViewAccuracy> views);

/// Throws std::invalid_argument where no view reflects anything.
BrdfAccuracy summary(const std::vector<ViewAccuracy>& views);

/// Cells of a BRDF file: of all its bins, shared ones counted once.
std::uint64_t brdf_cells(const File& file);

} // namespace acdf::build
