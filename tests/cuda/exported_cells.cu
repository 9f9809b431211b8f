#include "exported.h"

#include "exported_cells.h" // by acdf export

namespace acdf_cuda {
namespace {

struct Draw {
    const std::uint32_t* tables;
    Asked asked;
    __device__ float operator()(unsigned i) const {
        const float2 u = asked.numbers[i];
        const AcdfShaderSample s = acdf_sample_float(tables, u.x, u.y);
        return s.x + s.y + s.z + s.pdf;
    }
};
struct Density {
    const std::uint32_t* tables;
    Asked asked;
    __device__ float operator()(unsigned i) const {
        float w[3];
        asked.direction(i, w);
        return acdf_pdf(tables, w[0], w[1], w[2]);
    }
};

} // namespace

Timed time_exported_cells_draw(const std::uint32_t* tables, const Asked& asked) {
    return time(Draw{tables, asked});
}
Timed time_exported_cells_density(const std::uint32_t* tables, const Asked& asked) {
    return time(Density{tables, asked});
}

} // namespace acdf_cuda
