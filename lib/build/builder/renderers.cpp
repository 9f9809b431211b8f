#include <acdf/renderers.h>

#include <cmath>
#include <cstdlib>
#include <cstring>

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

constexpr Axes usd{2, 3, 1}, pbrt{-1, 2, 3}; // (y, z, x) and (-x, y, z)

// Where it is not known whether rows repeat, they do: then a file has density for either.
constexpr Renderer known[] = {
    {"pbrt-v4", looked_up(Domain::octahedral, ACDF_FILTER_NEAREST, Wrap::clamp, average), pbrt, {}},
    {"pbrt-v3", latlong(Wrap::repeat), pbrt, {}},
    {"mitsuba3", latlong(Wrap::clamp), usd, {}},
    {"cycles", latlong(Wrap::repeat, average), {1, 2, 3}, Axes{2, -1, 3}},
    {"luxcore", latlong(Wrap::repeat), pbrt, {}},
    {"three", latlong(Wrap::clamp), {1, 3, -2}, {}},
    {"arnold", latlong(Wrap::repeat), usd, {}},
    {"renderman", latlong(Wrap::repeat), {-1, -2, 3}, {}},
    {"karma", latlong(Wrap::repeat), usd, {}},
    {"storm", latlong(Wrap::clamp), usd, {}},
    {"unreal", latlong(Wrap::clamp), {-2, -1, 3}, {}},
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

Renderers renderers() noexcept { return {known, sizeof known / sizeof *known}; }

const Renderer* find_renderer(const char* name) noexcept {
    for (const Renderer& renderer : renderers())
        if (name && std::strcmp(renderer.name, name) == 0) return &renderer;
    return nullptr;
}

} // namespace acdf::builder
