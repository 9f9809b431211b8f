#include "tools/sweep/estimator.h"

#include "build/accuracy/combination.h"
#include "build/accuracy/local.h"
#include "build/accuracy/texel_cosines.h"
#include "compress/boxes.h"
#include "compress/parallel.h"
#include "measure/random.h"
#include "measure/samplers/light_samplers.h"
#include "measure/surface_frame.h"
#include "tools/sweep/pixel_samples.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace acdf::tools {
namespace {

using measure::PointSampler;
using measure::ShadingPoint;
using Direction = std::array<float, 3>;

constexpr std::size_t kSurfaces = 2; ///< diffuse, glossy

/// The direction of the middle of a texel.
Direction texel_middle(const compress::Target& target, std::uint32_t row, std::uint32_t column) {
    const compress::Box texel{{row, column}, {row + 1, column + 1}};
    const std::array<double, 3> middle = compress::centre(target, texel);
    return {static_cast<float>(middle[0]), static_cast<float>(middle[1]), static_cast<float>(middle[2])};
}

double cosine_of(const ShadingPoint& point, const float wi[3]) {
    return double{point.n[0]} * wi[0] + double{point.n[1]} * wi[1] + double{point.n[2]} * wi[2];
}

/// Smith's masking of a GGX lobe.
double visible_share(double cosine) {
    constexpr double a2 = kGlossyAlpha * kGlossyAlpha;
    return 2.0 * cosine / (cosine + std::sqrt(a2 + (1.0 - a2) * cosine * cosine));
}

/// A white diffuse surface and a white GGX lobe at a point: BRDF times cosine, and the pdf of their samples.
class Surfaces {
public:
    explicit Surfaces(const ShadingPoint& at) : at_(at) {
        static const measure::LightSamplerPtr bsdfs[kSurfaces] = {measure::cosine_sampler(),
                                                                  measure::ggx_sampler(kGlossyAlpha)};
        for (const measure::LightSamplerPtr& bsdf : bsdfs) {
            bsdf_.push_back(bsdf->point_sampler());
            bsdf_.back()->move_to(at);
        }
    }
    struct Value {
        double reflectance = 0.0, pdf = 0.0;
    };
    Value of(std::size_t surface, const float wi[3]) const {
        const double cosine = cosine_of(at_, wi);
        if (!(cosine > 0.0)) return {};
        const double pdf = bsdf_[surface]->pdf(wi);
        return {surface == 0 ? pdf : pdf * visible_share(cosine), pdf};
    }
    AcdfDirectionSample sample(std::size_t surface, double u0, double u1) const {
        return bsdf_[surface]->sample(u0, u1);
    }

private:
    ShadingPoint at_;
    std::vector<std::unique_ptr<PointSampler>> bsdf_;
};

/// What a row of texels gives a point, the same for all samplers.
struct LitTexel {
    std::uint32_t column = 0;
    double light = 0.0, mean = 0.0, measure = 0.0; ///< root of the mean square, mean, solid angle
    std::size_t hidden = 0;
    Direction wi{};
    std::array<Surfaces::Value, kSurfaces> surface;
};

/// Sums over visible and hidden texels, apart: together they are the open.
struct CaseSums {
    build::Combination sums[kSurfaces][2][kEstimators];

    explicit CaseSums(AcdfHeuristic h)
        : sums{{{{1.0, h}, {0.5, h}}, {{1.0, h}, {0.5, h}}}, {{{1.0, h}, {0.5, h}}, {{1.0, h}, {0.5, h}}}} {}
    void add(const LitTexel& texel, double pdf) {
        for (std::size_t s = 0; s < kSurfaces; ++s) {
            const auto& [reflectance, bsdf] = texel.surface[s];
            const double mean = texel.mean * reflectance;
            for (build::Combination& sum : sums[s][texel.hidden])
                sum.add(texel.light * reflectance, &mean, 1, texel.measure, pdf, bsdf);
        }
    }
    PointVariances result() const {
        PointVariances out;
        for (std::size_t s = 0; s < kSurfaces; ++s)
            for (std::size_t e = 0; e < kEstimators; ++e) {
                build::Combination open = sums[s][0][e];
                open.add(sums[s][1][e]);
                set(out[2 * s], e, open);
                set(out[2 * s + 1], e, sums[s][0][e]);
            }
        return out;
    }

private:
    static void set(PointVariance& out, std::size_t estimator, const build::Combination& sum) {
        const double e = sum.integral();
        if (estimator == with_mis) out.reflected = e; // alone, what is never sampled is not summed
        const bool black = !(e > 0.0) && sum.violations() == 0;
        out.variance[estimator] = black ? 0.0 : sum.violations() > 0 ? HUGE_VAL : sum.relative_variance() * e * e;
    }
};

/// All that is summed at a point, for all samplers.
class PointSums {
public:
    PointSums(const compress::Target& target, const std::vector<SamplerAtPoints>& samplers,
              const std::vector<std::vector<float>>& everywhere, const SurfacePoint& point, AcdfHeuristic heuristic)
        : target_(target), everywhere_(everywhere), point_(point), surfaces_(point.shading),
          sums_(samplers.size(), CaseSums(heuristic)) {
        for (const SamplerAtPoints& each : samplers) {
            at_.push_back(each.needs == Given::nothing ? nullptr : each.sampler->point_sampler());
            if (at_.back()) at_.back()->move_to(point.shading);
        }
    }
    std::vector<PointVariances> all(const build::TexelCosines& cosines) {
        for (std::uint32_t r = 0; r < target_.rows; ++r) {
            find_lit(cosines, r);
            for (std::size_t k = 0; k < sums_.size(); ++k)
                for (const LitTexel& texel : lit_)
                    sums_[k].add(texel, at_[k] ? double{at_[k]->pdf(texel.wi.data())}
                                               : double{everywhere_[k][index(r, texel.column)]});
        }
        std::vector<PointVariances> out;
        for (const CaseSums& sums : sums_) out.push_back(sums.result());
        return out;
    }

private:
    std::size_t index(std::uint32_t row, std::uint32_t column) const {
        return std::size_t{row} * target_.columns + column;
    }
    void find_lit(const build::TexelCosines& cosines, std::uint32_t r) {
        lit_.clear();
        const float* light = target_.row(r);
        cosines.for_each_above(point_.shading.n, r, [&](std::uint32_t c, double) {
            if (light[c] == 0.0f) return;
            LitTexel texel;
            texel.column = c;
            texel.light = light[c];
            texel.mean = target_.means.size() == 1 ? target_.means[0][index(r, c)] : light[c];
            texel.measure = target_.column_measure[c] * target_.row_measure[r];
            texel.wi = texel_middle(target_, r, c);
            texel.hidden = point_.hidden(texel.wi.data()) ? 1 : 0;
            for (std::size_t s = 0; s < kSurfaces; ++s) texel.surface[s] = surfaces_.of(s, texel.wi.data());
            lit_.push_back(texel);
        });
    }

    const compress::Target& target_;
    const std::vector<std::vector<float>>& everywhere_;
    const SurfacePoint& point_;
    Surfaces surfaces_;
    std::vector<CaseSums> sums_;
    std::vector<std::unique_ptr<PointSampler>> at_; ///< null: everywhere the same
    std::vector<LitTexel> lit_;
};

/// The view, and a direction along the surface, by the number of a point.
SurfacePoint surface_point(ShadingPoint shading, std::size_t number, float along[3]) {
    const double n[3] = {shading.n[0], shading.n[1], shading.n[2]};
    double x[3], y[3], sine[2], cosine[2];
    measure::surface_frame(n, x, y);
    const double turns[2] = {0.7548776662466927, 0.5698402909980532}; // spread evenly in both (Roberts' R2)
    for (int k = 0; k < 2; ++k)
        acdf_sincospi(2.0 * std::fmod(turns[k] * static_cast<double>(number + 1), 1.0) - 1.0, &sine[k], &cosine[k]);
    for (int k = 0; k < 3; ++k) {
        const double seen = n[k] + cosine[0] * x[k] + sine[0] * y[k];
        shading.wo[k] = static_cast<float>(std::sqrt(0.5) * seen);
        along[k] = static_cast<float>(cosine[1] * x[k] + sine[1] * y[k]);
    }
    return {shading, {}};
}

} // namespace

std::vector<SurfacePoint> half_hidden_points(std::uint32_t count) {
    std::vector<SurfacePoint> out;
    for (const build::Normal& n : build::random_normals(count)) {
        Direction along;
        out.push_back(surface_point({{n[0], n[1], n[2]}, {}, {}}, out.size(), along.data()));
        out.back().hidden = [along](const float wi[3]) {
            return along[0] * wi[0] + along[1] * wi[1] + along[2] * wi[2] > 0.0f;
        };
    }
    return out;
}

std::vector<SurfacePoint> mesh_points(const std::vector<measure::ScenePoint>& points) {
    std::vector<SurfacePoint> out;
    for (const measure::ScenePoint& point : points) {
        float along[3];
        out.push_back(surface_point(point.shading(), out.size(), along));
        out.back().hidden = [&point](const float wi[3]) { return point.hidden({wi[0], wi[1], wi[2]}); };
    }
    return out;
}

std::vector<std::vector<PointVariances>> point_variances(const compress::Target& target,
                                                         const std::vector<SamplerAtPoints>& samplers,
                                                         const std::vector<SurfacePoint>& points,
                                                         AcdfHeuristic heuristic) {
    std::vector<std::vector<float>> everywhere;
    for (const SamplerAtPoints& each : samplers)
        everywhere.push_back(each.needs == Given::nothing ? texel_pdfs(target, *each.sampler)
                                                          : std::vector<float>());
    const build::TexelCosines cosines(target);
    std::vector<std::vector<PointVariances>> of_points(points.size()), out(samplers.size());
    compress::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
        of_points[i] = PointSums(target, samplers, everywhere, points[i], heuristic).all(cosines);
    });
    for (std::size_t k = 0; k < samplers.size(); ++k)
        for (const std::vector<PointVariances>& each : of_points) out[k].push_back(each[k]);
    return out;
}

std::vector<float> texel_pdfs(const compress::Target& target, const measure::LightSampler& sampler) {
    std::vector<float> out(target.values.size());
    compress::parallel_for(0u, target.rows, [&](std::uint32_t r) {
        const std::unique_ptr<PointSampler> point = sampler.point_sampler();
        point->move_to({});
        for (std::uint32_t c = 0; c < target.columns; ++c)
            out[std::size_t{r} * target.columns + c] = point->pdf(texel_middle(target, r, c).data());
    });
    return out;
}

namespace {

using CaseValues = std::array<std::array<double, kCases>, kEstimators>;

/// Estimates of what one point reflects, of all cases from the same samples.
class Estimates {
public:
    Estimates(const measure::MapLight& light, PointSampler& sampler, const SurfacePoint& point,
              AcdfHeuristic heuristic)
        : light_(light), sampler_(sampler), point_(point), surfaces_(point.shading),
          power_(heuristic == ACDF_HEURISTIC_POWER) {
        sampler_.move_to(point.shading);
    }
    CaseValues one(measure::Random& random, std::uint32_t samples) {
        CaseValues out{};
        random.begin_set();
        for (std::uint32_t i = 0; i < samples; ++i) add_light_sample(random, 1.0 / samples, light_alone, out);
        const double share = 2.0 / samples;
        random.begin_set();
        for (std::uint32_t i = 0; i < samples / 2; ++i) add_light_sample(random, share, with_mis, out);
        for (std::size_t s = 0; s < kSurfaces; ++s) {
            random.begin_set();
            for (std::uint32_t i = 0; i < samples / 2; ++i) {
                const std::array<double, 2> u = random.pair();
                const AcdfDirectionSample sample = surfaces_.sample(s, u[0], u[1]);
                if (sample.pdf > 0.0f)
                    add(sample.direction, s, share * weight(sample.pdf, sampler_.pdf(sample.direction)), with_mis,
                        out);
            }
        }
        return out;
    }

private:
    /// Of a sample, over its pdf.
    double weight(double pdf, double other) const {
        const double ratio = other / pdf;
        return 1.0 / (pdf * (1.0 + (power_ ? ratio * ratio : ratio)));
    }
    void add_light_sample(measure::Random& random, double share, Estimator estimator, CaseValues& out) {
        const std::array<double, 2> u = random.pair();
        const AcdfDirectionSample sample = sampler_.sample(u[0], u[1]);
        if (!(sample.pdf > 0.0f)) return;
        for (std::size_t s = 0; s < kSurfaces; ++s) {
            const double other = estimator == with_mis ? surfaces_.of(s, sample.direction).pdf : 0.0;
            add(sample.direction, s, share * weight(sample.pdf, other), estimator, out);
        }
    }
    void add(const float wi[3], std::size_t surface, double weight, Estimator estimator, CaseValues& out) const {
        const double value = surfaces_.of(surface, wi).reflectance * light_.radiance(wi) * weight;
        out[estimator][2 * surface] += value;
        if (value > 0.0 && !point_.hidden(wi)) out[estimator][2 * surface + 1] += value;
    }

    const measure::MapLight& light_;
    PointSampler& sampler_;
    const SurfacePoint& point_;
    Surfaces surfaces_;
    bool power_;
};

} // namespace

std::vector<PointVariances> sobol_variances(const measure::MapLight& light, const measure::LightSampler& sampler,
                                            const std::vector<SurfacePoint>& points,
                                            const std::vector<PointVariances>& exact, AcdfHeuristic heuristic,
                                            std::uint32_t samples, std::uint32_t seeds) {
    samples += samples % 2;
    std::vector<PointVariances> out = exact;
    compress::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
        const std::unique_ptr<PointSampler> own = sampler.point_sampler();
        Estimates estimates(light, *own, points[i], heuristic);
        measure::Random random(i, measure::Numbers::sobol);
        std::vector<CaseValues> taken;
        for (std::uint32_t seed = 0; seed < seeds; ++seed) taken.push_back(estimates.one(random, samples));
        for (std::size_t c = 0; c < kCases; ++c)
            for (std::size_t e = 0; e < kEstimators; ++e) {
                std::vector<double> values;
                for (const CaseValues& each : taken) values.push_back(each[e][c]);
                double& variance = out[i][c].variance[e];
                if (std::isfinite(variance)) variance = unbiased_variance(values) * samples;
            }
    });
    return out;
}

std::array<std::array<double, kCases>, kEstimators> relative_variances(const std::vector<PointVariances>& points) {
    std::array<std::array<double, kCases>, kEstimators> out{};
    for (std::size_t c = 0; c < kCases; ++c) {
        double reflected = 0.0;
        for (const PointVariances& point : points) reflected += point[c].reflected;
        if (!(reflected > 0.0)) continue;
        const double scale = static_cast<double>(points.size()) / (reflected * reflected);
        for (std::size_t e = 0; e < kEstimators; ++e)
            for (const PointVariances& point : points) out[e][c] += scale * point[c].variance[e];
    }
    return out;
}

} // namespace acdf::tools
