// Stands in for pbrt's lights and integrators: functions with pbrt's names and variables that hold the lines of
// docs/examples/pbrt/README.md as they stand there (lines.py compares), so that following the page compiles.
#pragma once

#include "acdf_light.h"

#include <optional>
#include <string>

namespace pbrt {

constexpr Float Pi = 3.14159265f;

struct LightSampleContext {
    Point3f point;
    Normal3f ns;
    Point3f p() const { return point; }
};

struct SurfaceInteraction {
    Point3f pi;
    Normal3f n;
    Vector3f wo;
    operator LightSampleContext() const { return {pi, n}; }
};

struct Bsdf {
    BxDFFlags flags;
    BxDFFlags Flags() const { return flags; }
};

struct LightSample { // of a point (a pdf) or of a ray (two)
    Vector3f w;
    Float pdf = 0;
};

struct PiecewiseConstant2D { // pbrt's own table; evenly distributed
    Point2f Sample(Point2f u, Float* pdf) const { return *pdf = 1, u; }
    Float PDF(Point2f) const { return 1; }
};

inline Vector3f EqualAreaSquareToSphere(Point2f) { return {0, 0, 1}; }
inline Point2f EqualAreaSphereToSquare(Vector3f) { return {}; }

class ImageInfiniteLight {
public:
    ImageInfiniteLight(Transform renderFromLight, std::string acdfFile) : renderFromLight(renderFromLight) {
        acdf.Open(acdfFile);
        if (acdf.IsOpen()) return;
        has_tables = true; // where pbrt makes them
    }

    std::optional<LightSample> SampleLi(LightSampleContext ctx, Point2f u, bool allowIncompletePDF) const {
        const int lambda = 0;
        if (acdf.IsOpen()) {
            Vector3f wLight;
            Float pdf = acdf.Sample(renderFromLight, ctx.p(), ctx.ns, u, allowIncompletePDF, &wLight);
            if (pdf == 0) return {};
            Vector3f wi = renderFromLight(wLight);
            // clang-format off
            return LightLiSample(ImageLe(EqualAreaSphereToSquare(wLight), lambda), wi, pdf, Interaction(ctx.p() + wi * (2 * sceneRadius), &mediumInterface));
            // clang-format on
        }
        return {};
    }

    Float PDF_Li(LightSampleContext ctx, Vector3f w, bool allowIncompletePDF) const {
        Vector3f wLight = renderFromLight.ApplyInverse(w);
        // clang-format off
        if (acdf.IsOpen()) return acdf.PDF(renderFromLight, ctx.p(), ctx.ns, wLight, allowIncompletePDF);
        // clang-format on
        return distribution.PDF(EqualAreaSphereToSquare(wLight)) / (4 * Pi);
    }

    std::optional<LightSample> SampleLe(Point2f u1) const {
        const int lambda = 0;
        // clang-format off
        Vector3f wLight;
        Float mapPDF = acdf.IsOpen() ? 4 * Pi * acdf.Sample(renderFromLight, Point3f(), Normal3f(), u1, false, &wLight) : 0;
        if (!acdf.IsOpen()) wLight = EqualAreaSquareToSphere(distribution.Sample(u1, &mapPDF));
        if (mapPDF == 0) return {};
        Vector3f w = -renderFromLight(wLight);
        // clang-format on
        const Vector3f ray = w;
        Float pdfDir = mapPDF / (4 * Pi), pdfPos = 1 / (Pi * sceneRadius * sceneRadius);
        return LightLeSample(ImageLe(EqualAreaSphereToSquare(wLight), lambda), ray, pdfPos, pdfDir);
    }

    void PDF_Le(Vector3f ray, Float* pdfDir) const {
        Vector3f wl = -renderFromLight.ApplyInverse(ray);
        // clang-format off
        Float mapPDF = acdf.IsOpen() ? 4 * Pi * acdf.PDF(renderFromLight, Point3f(), Normal3f(), wl, false) : distribution.PDF(EqualAreaSphereToSquare(wl));
        // clang-format on
        *pdfDir = mapPDF / (4 * Pi);
    }

    bool has_tables = false;

private:
    static Point3f Interaction(Point3f p, const int*) { return p; }
    static int ImageLe(Point2f, int) { return 0; }
    static LightSample LightLiSample(int, Vector3f wi, Float pdf, Point3f) { return {wi, pdf}; }
    static LightSample LightLeSample(int, Vector3f w, Float, Float pdf) { return {w, pdf}; }

    Transform renderFromLight;
    Float sceneRadius = 1;
    int mediumInterface = 0;
    PiecewiseConstant2D distribution;
    AcdfSampler acdf;
};

struct ParameterDictionary {
    std::string acdf;
    std::string GetOneString(const std::string& name, const std::string& otherwise) const {
        return name == "acdf" && !acdf.empty() ? acdf : otherwise;
    }
};
inline std::string ResolveFilename(const std::string& name) { return name; }

inline ImageInfiniteLight create_infinite(const ParameterDictionary& parameters, const Transform& renderFromLight) {
    std::string acdfFile = ResolveFilename(parameters.GetOneString("acdf", ""));
    return ImageInfiniteLight(renderFromLight, acdfFile);
}

/// How SampleLd and Li of pbrt's integrators make the contexts of one vertex; the first two of `path`, then of
/// `volpath`.
struct Contexts {
    LightSampleContext of[5];
};
inline Contexts contexts_of(const SurfaceInteraction& intr, const Bsdf& bsdf) {
    Contexts out;
    const BxDFFlags flags = bsdf.Flags();
    const SurfaceInteraction &isect = intr, &pi = intr;
    {
        LightSampleContext ctx = intr;
        ctx.ns = FacingViewer(ctx.ns, intr.wo, flags);
        out.of[0] = out.of[2] = ctx;
    }
    {
        LightSampleContext prevIntrCtx = intr;
        prevIntrCtx.ns = FacingViewer(prevIntrCtx.ns, isect.wo, bsdf.Flags());
        out.of[1] = prevIntrCtx;
    }
    {
        LightSampleContext prevIntrContext = isect;
        prevIntrContext.ns = FacingViewer(prevIntrContext.ns, isect.wo, bsdf.Flags());
        out.of[3] = prevIntrContext;
    }
    {
        const struct { Bsdf Sw; } bssrdfSample = {bsdf};
        LightSampleContext prevIntrContext = pi;
        prevIntrContext.ns = FacingViewer(prevIntrContext.ns, pi.wo, bssrdfSample.Sw.Flags());
        out.of[4] = prevIntrContext;
    }
    return out;
}

} // namespace pbrt
