#include <acdf/renderers.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>

namespace acdf::builder {
namespace {

constexpr Channels luminance{}, average{ACDF_CHANNELS_WEIGHTED, {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}};

constexpr TargetOptions looked_up(Domain domain, AcdfFilter filter, Wrap wrap, const Channels& channels) {
    TargetOptions target;
    target.channels = channels;
    target.domain = domain;
    target.filter = filter;
    target.wrap = wrap;
    return target;
}
constexpr TargetOptions latlong(Wrap wrap, const Channels& channels = luminance) {
    return looked_up(Domain::latlong, ACDF_FILTER_BILINEAR, wrap, channels);
}

constexpr const char* closed = "how its light takes samples is not published, so that the file may be used alone";

constexpr Axes usd{2, 3, 1}, pbrt{-1, 2, 3}; // (y, z, x) and (-x, y, z)

// Where it is not known whether rows repeat, they do: then a file has pdf for either.
constexpr Renderer known[] = {
    {"pbrt-v4",
     looked_up(Domain::octahedral, ACDF_FILTER_NEAREST, Wrap::clamp, average),
     pbrt,
     {},
     true,
     true,
     ACDF_HEURISTIC_POWER,
     "its lights are given a normal (LightSampleContext), and its path integrator weights a light and a BSDF "
     "sample "
     "by "
     "the power heuristic (PathIntegrator::SampleLd)"},
    {"pbrt-v3",
     latlong(Wrap::repeat),
     pbrt,
     {},
     true,
     true,
     ACDF_HEURISTIC_POWER,
     "its lights are given a normal (Interaction), and its integrators weight a light and a BSDF sample by the "
     "power "
     "heuristic (EstimateDirect)"},
    {"mitsuba3",
     latlong(Wrap::clamp),
     usd,
     {},
     true,
     true,
     ACDF_HEURISTIC_POWER,
     "its emitters are given a normal (Interaction3f), and its path integrator weights an emitter and a BSDF "
     "sample "
     "by "
     "the power heuristic (PathIntegrator::mis_weight)"},
    {"cycles",
     latlong(Wrap::repeat, average),
     {1, 2, 3},
     Axes{2, -1, 3},
     false,
     true,
     ACDF_HEURISTIC_POWER,
     "its background light is given a position and no normal (background_light_sample), and it weights a light and "
     "a "
     "BSDF sample by the power heuristic (light_sample_mis_weight_nee)"},
    {"luxcore",
     latlong(Wrap::repeat),
     pbrt,
     {},
     true,
     true,
     ACDF_HEURISTIC_POWER,
     "its lights are given the BSDF, which has a normal (InfiniteLight::Illuminate), and its path tracer weights a "
     "light "
     "and a BSDF sample by the power heuristic (PathTracer)"},
    {"three",
     latlong(Wrap::clamp),
     {1, 3, -2},
     {},
     false,
     true,
     ACDF_HEURISTIC_POWER,
     "three-gpu-pathtracer samples the environment without a normal (sampleEquirectProbability), and weights a "
     "light and "
     "a BSDF sample by the power heuristic (misHeuristic)"},
    {"arnold", latlong(Wrap::repeat), usd, {}, false, false, ACDF_HEURISTIC_BALANCE, closed},
    {"renderman", latlong(Wrap::repeat), {-1, -2, 3}, {}, false, false, ACDF_HEURISTIC_BALANCE, closed},
    {"karma", latlong(Wrap::repeat), usd, {}, false, false, ACDF_HEURISTIC_BALANCE, closed},
    {"storm",
     latlong(Wrap::clamp),
     usd,
     {},
     false,
     false,
     ACDF_HEURISTIC_BALANCE,
     "it filters the map and takes no samples, so that the file serves other programs of that frame, alone"},
    {"unreal",
     latlong(Wrap::clamp),
     {-2, -1, 3},
     {},
     false,
     false,
     ACDF_HEURISTIC_BALANCE,
     "its path tracer samples a map of its own making, so that the file serves other programs of that frame, "
     "alone"},
};

} // namespace

void Axes::turn(const float from[3], float to[3]) const noexcept {
    const int axes[3] = {x, y, z};
    float turned[3];
    for (int k = 0; k < 3; ++k) {
        const float v = from[std::abs(axes[k]) - 1];
        turned[k] = axes[k] < 0 ? -v : v;
    }
    std::memcpy(to, turned, sizeof turned);
}

Axes Axes::inverse() const noexcept {
    const int axes[3] = {x, y, z};
    int out[3] = {1, 2, 3};
    for (int k = 0; k < 3; ++k) out[std::abs(axes[k]) - 1] = axes[k] < 0 ? -(k + 1) : k + 1;
    return {out[0], out[1], out[2]};
}

std::string Axes::text(const char* letters) const {
    std::string out;
    for (const int axis : {x, y, z})
        out += std::string(out.empty() ? "(" : ", ") + (axis < 0 ? "-" : "") + letters[std::abs(axis) - 1];
    return out + ")";
}

const Axes* Renderer::axes_of(Projection projection) const noexcept {
    if (projection == Projection::latlong || projection == Projection::octahedral) return &axes;
    return projection == Projection::mirrorball && mirrorball ? &*mirrorball : nullptr;
}

AcdfKind Renderer::kind() const noexcept { return has_normal ? ACDF_KIND_LOCAL : ACDF_KIND_ENVIRONMENT; }

// Made for all normals alike, an environment beside a cosine counts surfaces that face away from the light as much
// as those that are seen: without a scene the mean does better (docs/integrate.md).
Partner Renderer::partner(const EnvironmentOptions& options) const noexcept {
    const FitOptions& fit = options.fit;
    Partner out;
    if (!adds_bsdf_samples || fit.fit != ACDF_FIT_VARIANCE || fit.max_weight > 0.0 ||
        options.goal.kind == Goal::Kind::variance)
        return out;
    out.kind = options.normals.empty() ? ACDF_PARTNER_MEAN : ACDF_PARTNER_COSINE;
    out.heuristic = heuristic;
    return out;
}

Partner Renderer::partner(const LocalOptions& options) const noexcept {
    Partner out;
    if (!adds_bsdf_samples || !options.sharing || options.cosine_share > 0.0 || options.max_weight > 0.0 ||
        options.visibility.point)
        return out;
    out.kind = ACDF_PARTNER_COSINE;
    out.heuristic = heuristic;
    return out;
}

Renderers renderers() noexcept { return {known, sizeof known / sizeof *known}; }

const Renderer* find_renderer(const char* name) noexcept {
    for (const Renderer& renderer : renderers())
        if (name && std::strcmp(renderer.name, name) == 0) return &renderer;
    return nullptr;
}

} // namespace acdf::builder
