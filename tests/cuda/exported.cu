#include "exported.h"

#include "exported_text.h" // by acdf export

namespace acdf_cuda {
namespace {

struct Draw {
    const std::uint32_t* tables;
    Asked asked;
    __device__ float operator()(unsigned i) const {
        float n[3];
        asked.normal(i, n);
        const float2 u = asked.numbers[i];
        const AcdfWalkSample s = acdf_sample_float(tables, acdf_at(tables, n[0], n[1], n[2]), u.x, u.y);
        return s.x + s.y + s.z + s.pdf;
    }
};
struct Density {
    const std::uint32_t* tables;
    Asked asked;
    __device__ float operator()(unsigned i) const {
        float n[3], w[3];
        asked.normal(i, n);
        asked.direction(i, w);
        return acdf_pdf(tables, acdf_at(tables, n[0], n[1], n[2]), w[0], w[1], w[2]);
    }
};

/// Normals are views.
struct BrdfDraw {
    const std::uint32_t* tables;
    Asked asked;
    __device__ float operator()(unsigned i) const {
        float n[3];
        asked.normal(i, n);
        const float2 u = asked.numbers[i];
        const AcdfWalkSample s =
            acdf_sample_brdf_float(tables, acdf_view(tables, n[0], n[1], fabsf(n[2])), u.x, u.y);
        return s.x + s.y + s.z + s.pdf;
    }
};
struct BrdfDensity {
    const std::uint32_t* tables;
    Asked asked;
    __device__ float operator()(unsigned i) const {
        float n[3], w[3];
        asked.normal(i, n);
        asked.direction(i, w);
        return acdf_pdf_brdf(tables, acdf_view(tables, n[0], n[1], fabsf(n[2])), w[0], w[1], fabsf(w[2]));
    }
};

} // namespace

Timed time_exported_sample(const std::uint32_t* tables, const Asked& asked) { return time(Draw{tables, asked}); }
Timed time_exported_pdf(const std::uint32_t* tables, const Asked& asked) { return time(Density{tables, asked}); }
Timed time_exported_brdf_sample(const std::uint32_t* tables, const Asked& asked) {
    return time(BrdfDraw{tables, asked});
}
Timed time_exported_brdf_pdf(const std::uint32_t* tables, const Asked& asked) {
    return time(BrdfDensity{tables, asked});
}

} // namespace acdf_cuda
