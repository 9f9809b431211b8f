// The sampler that the authors of the RGL material database publish for its files: a baseline.
#pragma once

#include "input/brdf/rgl.h"
#include "measure/samplers/brdf_samplers.h"

namespace acdf::measure {

/// Warps a uniform point by the luminance of the view, then by the pdf of visible normals, both bilinear with
/// marginal and conditional CDFs (Dupuy and Jakob 2018, §4.3); then reflects wo at that normal. Real: float is the
/// precision of the published program, and what is timed; double is what pdfs are compared with.
template <class Real>
class RglSamplerOf {
public:
    explicit RglSamplerOf(const input::RglBrdf& brdf) : tables_(brdf.tables()) {} ///< which must live as long

    BrdfSample sample(const double wo[3], const double u[2]) const; ///< u in [0, 1]
    double pdf(const double wo[3], const double wi[3]) const;
    /// Of the tables that sampling needs, CDFs included, as floats.
    std::size_t bytes() const { return tables_.vndf.bytes() + tables_.luminance.bytes(); }

private:
    const input::RglTables& tables_;
};

using RglSampler = RglSamplerOf<double>;

} // namespace acdf::measure
