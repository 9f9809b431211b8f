// An .acdf file as the sampler of pbrt-v4's image infinite light: README.md beside this file lists the lines of
// pbrt that call it. Made for and tried with pbrt-v4 at commit 5f7a6068, on the CPU.
#pragma once

#include <acdf/random.h>
#include <acdf/reader.h>
#include <acdf/visibility/visibility.h>

#include <pbrt/base/bxdf.h>
#include <pbrt/util/error.h>
#include <pbrt/util/transform.h>
#include <pbrt/util/vecmath.h>

#include <memory>
#include <string>

namespace pbrt {

/// Samples directions of light from a file of `acdf env` or `acdf local`, visibility cells included. All directions
/// are in the light's own space. pdfs are in sr^-1. Thread-safe once open.
class AcdfSampler {
public:
    /// Opens the file; ends pbrt with a message where that fails. An empty path leaves the light closed.
    void Open(const std::string& path) {
        if (path.empty()) return;
        file = std::make_shared<acdf::File>();
        if (acdf::Status status = acdf::File::open(path.c_str(), *file); !status.ok())
            ErrorExit("%s: %s", path, status.message);
        isLocal = file->kind() == ACDF_KIND_LOCAL;
        if (!isLocal && file->kind() != ACDF_KIND_ENVIRONMENT)
            ErrorExit("%s: a file of acdf env or acdf local is needed", path);
        if (isLocal)
            if (acdf::Status status = acdf::VisibleLocalView::of(*file, local); !status.ok())
                ErrorExit("%s: %s", path, status.message);
        sky = isLocal ? local.local().environment() : file->environment();
    }
    /// Whether a file is open: pbrt's own tables are then neither built nor used.
    bool IsOpen() const { return !sky.empty(); }

    /// Samples a direction for a point in render space. `ns` is the shading normal on the side that counts
    /// (FacingViewer), or zero: in media and where both sides count. Returns its pdf; 0: there is nothing to
    /// sample. `allowIncompletePDF` as in pbrt: the integrator weighs BSDF samples, too, so that the pdf may be 0
    /// where they suffice.
    Float Sample(const Transform& renderFromLight, Point3f p, Normal3f ns, Point2f u, bool allowIncompletePDF,
                 Vector3f* wLight) const {
        double uu[2];
        acdf_widen(u[0], u[1], uu); // pbrt's numbers have 24 bits each: a double holds those of both
        acdf::DirectionSample s = UsesNormal(ns, allowIncompletePDF)
                                      ? local.sample(At(renderFromLight, p, ns), uu[0], uu[1])
                                      : Sky(allowIncompletePDF).sample(uu[0], uu[1]);
        *wLight = Vector3f(-s.direction[0], s.direction[1], s.direction[2]); // pbrt is left-handed
        return s.pdf;
    }
    /// The pdf with which Sample returns `wLight` at that point.
    Float PDF(const Transform& renderFromLight, Point3f p, Normal3f ns, Vector3f wLight,
              bool allowIncompletePDF) const {
        float w[3] = {-wLight.x, wLight.y, wLight.z};
        return UsesNormal(ns, allowIncompletePDF) ? local.pdf(At(renderFromLight, p, ns), w)
                                                  : Sky(allowIncompletePDF).pdf(w);
    }

private:
    // A file made for MIS has pdf 0 where BSDF samples suffice. Light samples alone use the whole environment of a
    // local file, which is complete.
    bool UsesNormal(Normal3f ns, bool allowIncompletePDF) const {
        return isLocal && ns != Normal3f(0, 0, 0) && (allowIncompletePDF || !local.local().requires_mis());
    }
    const acdf::EnvironmentView& Sky(bool allowIncompletePDF) const {
        if (!allowIncompletePDF && sky.requires_mis())
            ErrorExit(
                "the light's .acdf file was made for MIS, and this integrator takes light samples alone; make it "
                "with --mis none");
        return sky;
    }
    AcdfVisiblePoint At(const Transform& renderFromLight, Point3f p, Normal3f ns) const {
        Normal3f n = renderFromLight.ApplyInverse(ns);
        float normal[3] = {-n.x, n.y, n.z};
        if (!local.has_cells()) return local.at(normal);
        p = renderFromLight.ApplyInverse(p); // render space is relative to the camera
        float position[3] = {p.x, p.y, p.z}; // as the mesh has them: the file stores the mesh's axes
        return local.at(position, normal);
    }

    std::shared_ptr<acdf::File> file;
    acdf::EnvironmentView sky;
    acdf::VisibleLocalView local;
    bool isLocal = false;
};

/// The shading normal on the side from which light counts: the viewer's where the surface reflects, the other one
/// where it transmits, and zero (the whole environment) where it does both. pbrt does not turn normals to the
/// viewer.
inline Normal3f FacingViewer(Normal3f ns, Vector3f wo, BxDFFlags flags) {
    if (IsReflective(flags) && IsTransmissive(flags)) return Normal3f(0, 0, 0);
    return FaceForward(ns, IsTransmissive(flags) ? -wo : wo);
}

} // namespace pbrt
