#include "tools/measure/brdf.h"

#include "tools/cli/json.h"
#include "tools/cli/messages.h"
#include "tools/cli/source_check.h"

#include "build/accuracy/brdf.h"
#include "build/brdf.h"
#include "input/brdf/brdf.h"
#include "measure/samplers/brdf_samplers.h"
#include "measure/samplers/brdf_table.h"
#include "tools/cli/noise.h"
#include "tools/cli/sizes.h"
#include "tools/commands.h"
#include "tools/measure/memory.h"

#include <nlohmann/json.hpp>

#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

namespace acdf::tools {
namespace {

/// What the file is compared with, on the same views.
struct Baselines {
    double table_mean = 0.0, table_centre = 0.0; ///< infinite where it has no support for some of the light
    std::size_t table_bytes = 0;
    double ggx_alpha = 0.0, ggx = 0.0, cosine = 0.0;
};

Baselines baselines(const compress::Reflected& reflected, const input::Brdf& brdf,
                    const std::vector<compress::View>& views) {
    const measure::TabulatedBrdf mean(reflected, brdf.isotropic, measure::BrdfTableKind::mean),
        centre(reflected, brdf.isotropic, measure::BrdfTableKind::centre);
    Baselines out;
    out.table_bytes = mean.bytes();
    out.ggx_alpha = measure::best_ggx(reflected, views).alpha;
    const measure::GgxSampler ggx(out.ggx_alpha);
    const std::vector<build::ViewPdf> pdfs = {
        [&](const double wo[3], const double wi[3]) { return mean.pdf(wo, wi); },
        [&](const double wo[3], const double wi[3]) { return centre.pdf(wo, wi); },
        [&](const double wo[3], const double wi[3]) { return ggx.pdf(wo, wi); }, measure::CosineSampler::pdf};
    const std::vector<double> variances = build::relative_variances(pdfs, reflected, views);
    out.table_mean = variances[0];
    out.table_centre = variances[1];
    out.ggx = variances[2];
    out.cosine = variances[3];
    return out;
}

double degrees(const compress::View& view) { return std::acos(view.cosine()) * (180.0 / ACDF_PI); }

nlohmann::ordered_json report(const std::string& path, const File& file, const std::string& source,
                              const build::BrdfAccuracy& a, const Baselines& r) {
    return {{"file", path},
            {"source", source},
            {"relative_variance", a.relative_variance}, // JSON has no infinity: null with a support violation
            {"noise_percent", noise_json(a.relative_variance)},
            {"relative_variance_median", a.median},
            {"relative_variance_worst", a.worst},
            {"worst_theta_o", degrees(a.worst_view)},
            {"relative_variance_full_cdf", r.table_mean},
            {"relative_variance_full_cdf_centre", r.table_centre},
            {"full_cdf_bytes", r.table_bytes},
            {"relative_variance_ggx", r.ggx},
            {"ggx_alpha", r.ggx_alpha},
            {"relative_variance_cosine", r.cosine},
            {"rms_pdf_error", a.rms_pdf_error},
            {"kl_divergence", a.kl_divergence},
            {"max_weight", a.max_weight},
            {"share_above_horizon", a.share_above_horizon},
            {"support_violations", a.support_violations},
            {"views", a.views},
            {"bytes", file.size()},
            {"memory_bytes", measure::memory_of(file)},
            {"cells", a.cells},
            {"bins", file.description().bin_count},
            {"total", file.description().total}};
}

void print_text(const std::string& path, const File& file, const std::string& source, const build::BrdfAccuracy& a,
                const Baselines& r) {
    std::printf("%s against %s, %u random views\n", printable(path).c_str(), printable(source).c_str(), a.views);
    std::printf(
        "  relative variance      %.6g   of one sample, mean over views; the mean of n samples has 1/n of it\n",
        a.relative_variance);
    std::printf("    noise                %s   at 16, 64, 256 samples under uniform light\n",
                noise_texts(a.relative_variance).c_str());
    std::printf("    median over views    %.6g\n", a.median);
    std::printf("    worst view           %.6g   at theta_o = %.1f degrees\n", a.worst, degrees(a.worst_view));
    std::printf("    full table           %.6g   of %s, each bin made for all of its views\n", r.table_mean,
                to_readable_size(r.table_bytes).c_str());
    std::printf("      for bins' centres  %.6g   the same table as published: biased between the centres where "
                "this is infinite\n",
                r.table_centre);
    std::printf("    best GGX lobe        %.6g   alpha = %.3g\n", r.ggx, r.ggx_alpha);
    std::printf("    cosine               %.6g\n", r.cosine);
    std::printf("  largest weight         %.6g   f/p over its mean\n", a.max_weight);
    std::printf("  RMS error of the pdf   %.6g   sr^-1\n", a.rms_pdf_error);
    std::printf("  KL divergence          %.6g   nats\n", a.kl_divergence);
    std::printf("  samples above horizon  %.6g\n", a.share_above_horizon);
    std::printf("  support violations     %" PRIu64 "\n", a.support_violations);
    std::printf("  bins, cells            %" PRIu32 ", %" PRIu64 "\n", file.description().bin_count, a.cells);
    print_bytes(file);
}

} // namespace

void measure_brdf(const std::string& path, const File& file, const std::string& source, std::uint32_t view_count,
                  bool json, bool quiet) {
    const std::unique_ptr<input::Brdf> brdf = input::open_brdf(source);
    if (!quiet) note_another(path, file, source, brdf->sha256);
    const AcdfDescription& d = file.description();
    const compress::Reflected reflected =
        build::reflected_light(*brdf, static_cast<AcdfChannels>(d.channels),
                               {d.channel_weights[0], d.channel_weights[1], d.channel_weights[2]});
    const std::vector<compress::View> views = build::random_views(view_count, brdf->isotropic);
    try {
        build::BrdfAccuracy accuracy =
            build::summary(build::measure_views(file, reflected, views, build::sides(*brdf)));
        accuracy.cells = build::brdf_cells(file);
        const Baselines r = baselines(reflected, *brdf, views);
        if (json) std::fputs(json_text(report(path, file, source, accuracy, r)).c_str(), stdout);
        else print_text(path, file, source, accuracy, r);
        require_support(path, file, source, brdf->sha256, accuracy.support_violations);
    } catch (const std::invalid_argument& error) {
        throw Failure(source + ": " + error.what());
    }
}

} // namespace acdf::tools
