#include "tools/sweep/baselines.h"

#include "compress/sum.h"
#include "measure/samplers/light_samplers.h"
#include "measure/samplers/local_baselines.h"
#include "measure/samplers/point_samplers.h"
#include "measure/samplers/tiling.h"
#include "tools/sweep/surface.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace acdf::tools {
namespace {

using compress::Target;
using measure::LightSampler;
using measure::PointSampler;
using measure::ShadingPoint;

/// Accuracy of a pdf on the light itself, as in build::measure_environment.
struct LightAccuracy {
    double relative_variance = 0.0, max_weight = 0.0, rms = 0.0;
};
LightAccuracy light_accuracy(const Target& target, const std::vector<float>& peaks, const std::vector<float>& pdf) {
    compress::Sum second, error;
    double peak = 0.0;
    bool violated = false;
    const double flux = compress::integral(target);
    for (std::uint32_t r = 0; r < target.rows; ++r)
        for (std::uint32_t c = 0; c < target.columns; ++c) {
            const std::size_t i = std::size_t{r} * target.columns + c;
            const double f = target.values[i], p = pdf[i];
            const double measure = target.row_measure[r] * target.column_measure[c];
            if (f > 0.0 && !(p > 0.0)) {
                violated = true;
            } else if (f > 0.0) {
                second.add(f * f / p * measure);
                peak = std::max(peak, (peaks.empty() ? f : double{peaks[i]}) / p);
            }
            error.add((p - f / flux) * (p - f / flux) * measure);
        }
    LightAccuracy out;
    const double mean_square = target.mean_square > 0.0 ? target.mean_square : flux * flux;
    out.relative_variance = second.value() / mean_square - 1.0;
    // Pdfs and CDFs are floats: a variance as small as their rounding is reported as 0.
    if (out.relative_variance < 1e-9) out.relative_variance = 0.0;
    out.max_weight = peak / std::sqrt(mean_square);
    if (violated) out.relative_variance = out.max_weight = HUGE_VAL;
    out.rms = std::sqrt(error.value() / (4.0 * ACDF_PI));
    return out;
}

/// Half of the samples from a sampler of light, half from the cosine, each weighted by both pdfs with the balance
/// heuristic, one sample (Veach and Guibas, SIGGRAPH 1995).
struct HalfCosine {
    std::shared_ptr<const LightSampler> light, cosine;
    std::uint64_t bytes() const { return light->bytes(); }
    explicit HalfCosine(std::shared_ptr<const LightSampler> l)
        : light(std::move(l)), cosine(measure::cosine_sampler()) {}
};

class HalfCosinePoint final : public PointSampler {
public:
    explicit HalfCosinePoint(const HalfCosine& both)
        : light_(both.light->point_sampler()), cosine_(both.cosine->point_sampler()) {}
    void move_to(const ShadingPoint& point) override {
        light_->move_to(point);
        cosine_->move_to(point);
    }
    AcdfDirectionSample sample(double u0, double u1) const override {
        AcdfDirectionSample out = u0 < 0.5 ? light_->sample(2.0 * u0, u1) : cosine_->sample(2.0 * u0 - 1.0, u1);
        out.pdf = pdf(out.direction);
        return out;
    }
    float pdf(const float wi[3]) const override { return 0.5f * light_->pdf(wi) + 0.5f * cosine_->pdf(wi); }

private:
    std::unique_ptr<PointSampler> light_, cosine_;
};

std::shared_ptr<const LightSampler> half_cosine(std::shared_ptr<const LightSampler> light) {
    return std::make_shared<measure::MovedToPoints<HalfCosine, HalfCosinePoint>>(std::move(light));
}

/// Its numbers come from a generator of its own: it needs three a candidate. What it returns as pdf is one over the
/// weight, of no use but for timing.
class ResamplingPoint final : public PointSampler {
public:
    explicit ResamplingPoint(const measure::Resampling& resampling) : resampling_(resampling) {}
    void move_to(const ShadingPoint& point) override { point_ = point; }
    AcdfDirectionSample sample(double, double) const override {
        const auto kept =
            resampling_.sample(point_.n, [&] { return static_cast<double>(random_() >> 11) * 0x1p-53; });
        AcdfDirectionSample out{};
        std::copy_n(kept.direction, 3, out.direction);
        out.pdf = kept.weight > 0.0 ? static_cast<float>(1.0 / kept.weight) : 0.0f;
        return out;
    }
    float pdf(const float*) const override { return 0.0f; }

private:
    const measure::Resampling& resampling_;
    ShadingPoint point_;
    mutable std::mt19937_64 random_{1};
};

} // namespace

std::vector<Candidate> environment_baselines(const Target& target, const std::vector<float>& peaks,
                                             const SweepOptions& options) {
    std::vector<Candidate> out;
    out.push_back(baseline_candidate("full_cdf", "full-resolution CDF", measure::full_cdf_sampler(target)));
    out.push_back(baseline_candidate("alias_table", "alias table", measure::alias_sampler(target)));
    out.push_back(
        baseline_candidate("hierarchical_warp", "hierarchical warp", measure::hierarchical_sampler(target)));
    out.push_back(baseline_candidate("mis_compensation", "compensated CDF, for MIS only",
                                     measure::compensated_sampler(target)));
    for (std::uint64_t budget : budgets_of(SweepKind::environment, options)) {
        const double side = std::sqrt(static_cast<double>(budget) / 8.0 / 2.0); // eight bytes a cell, 2:1
        const auto rows = static_cast<std::uint32_t>(std::lround(side));
        if (rows < 2 || rows >= target.rows || 2 * rows >= target.columns) continue;
        out.push_back(baseline_candidate(
            "downsampled_cdf", "CDF downsampled to " + std::to_string(2 * rows) + " x " + std::to_string(rows),
            measure::downsampled_cdf_sampler(target, 2 * rows, rows)));
    }
    for (Candidate& candidate : out) {
        const LightAccuracy accuracy = light_accuracy(target, peaks, texel_pdfs(target, *candidate.sampler));
        candidate.row.relative_variance = accuracy.relative_variance;
        candidate.row.max_weight = accuracy.max_weight;
        candidate.row.rms = accuracy.rms;
    }
    return out;
}

std::vector<Candidate> local_baselines(const Target& target, const std::vector<build::Normal>& normals) {
    constexpr std::uint32_t candidates = 32;
    const measure::LocalFullCdf full(target);
    std::vector<Candidate> out;
    const auto add = [&](const char* system, const std::string& label, std::shared_ptr<const LightSampler> sampler,
                         const Lit& variance) {
        out.push_back(baseline_candidate(system, label, std::move(sampler)));
        out.back().row.relative_variance = variance.mean;
        out.back().row.worst = variance.worst;
        out.back().row.median = variance.median;
    };
    const auto each = [&](const auto& sampler) {
        return over_normals(normals, [&sampler](const float n[3]) { return sampler.relative_variance(n); });
    };
    const auto in_partner = [&](const LightSampler& sampler) {
        return summary(point_variances(target, texel_pdfs(target, sampler), in_the_open(normals)), Scale::own)
            .partner;
    };
    const Lit of_full = each(full);
    const std::shared_ptr<const LightSampler> cdf = measure::full_cdf_sampler(target);
    add("full_cdf", "full-resolution CDF", cdf, of_full);
    add("cdf_cosine", "CDF and cosine, balance heuristic", half_cosine(cdf), in_partner(*cdf));
    const std::shared_ptr<const LightSampler> compensated = measure::compensated_sampler(target);
    add("mis_compensation", "CDF and cosine, MIS compensation", half_cosine(compensated), in_partner(*compensated));
    for (std::uint32_t columns : {32u, 64u}) {
        if (columns > target.columns || columns / 2 > target.rows) continue;
        const std::string tiles = std::to_string(columns * columns / 2);
        add(("tiling_" + tiles).c_str(), tiles + " tiles weighted on the fly",
            measure::tiling_sampler(target, columns, columns / 2),
            each(measure::TilingOnTheFly(target, columns, columns / 2)));
    }
    add("resampling_32", "resampling of 32 candidates",
        std::make_shared<measure::MovedToPoints<measure::Resampling, ResamplingPoint>>(target, candidates),
        {of_full.mean / candidates, of_full.median / candidates, of_full.worst / candidates});
    out.back().has_pdf = false;
    add("cosine", "cosine hemisphere", measure::cosine_sampler(), each(measure::CosineHemisphere(target)));
    return out;
}

} // namespace acdf::tools
