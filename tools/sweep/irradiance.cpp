#include "tools/sweep/irradiance.h"

#include "build/texel_cosines.h"
#include "compress/sum.h"
#include "compress/tiles.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace acdf::tools {

std::vector<float> texel_densities(const compress::Target& target, const measure::LightSampler& sampler) {
    std::vector<float> out(target.values.size());
    tbb::parallel_for(0u, target.rows, [&](std::uint32_t r) {
        const std::unique_ptr<measure::PointSampler> point = sampler.point_sampler();
        point->move_to({});
        for (std::uint32_t c = 0; c < target.columns; ++c) {
            compress::Box texel;
            texel.begin[0] = r;
            texel.end[0] = r + 1;
            texel.begin[1] = c;
            texel.end[1] = c + 1;
            const std::array<double, 3> middle = compress::centre(target, texel);
            const float wi[3] = {static_cast<float>(middle[0]), static_cast<float>(middle[1]),
                                 static_cast<float>(middle[2])};
            out[std::size_t{r} * target.columns + c] = point->pdf(wi);
        }
    });
    return out;
}

MeanAndWorst over_normals(const std::vector<build::Normal>& normals,
                          const std::function<double(const float n[3])>& variance) {
    std::vector<double> each(normals.size());
    tbb::parallel_for(std::size_t{0}, normals.size(),
                      [&](std::size_t i) { each[i] = variance(normals[i].data()); });
    MeanAndWorst out;
    for (double v : each) {
        out.mean += v / static_cast<double>(normals.size());
        out.worst = std::max(out.worst, v);
    }
    return out;
}

MeanAndWorst irradiance_variance(const compress::Target& target, const std::vector<float>& density,
                                 double cosine_share, const std::vector<build::Normal>& normals) {
    const build::TexelCosines cosines(target);
    return over_normals(normals, [&](const float n[3]) {
        compress::Sum irradiance, second;
        bool violated = false;
        for (std::uint32_t r = 0; r < target.rows; ++r) {
            const float* light = target.row(r);
            const float* p = density.data() + std::size_t{r} * target.columns;
            double row_irradiance = 0.0, row_second = 0.0;
            cosines.for_each_above(n, r, [&](std::uint32_t c, double cosine) {
                const double f = double{light[c]} * cosine;
                if (f == 0.0) return;
                const double mixed = (1.0 - cosine_share) * double{p[c]} + cosine_share * cosine / ACDF_PI;
                if (!(mixed > 0.0)) {
                    violated = true;
                    return;
                }
                row_irradiance += f * target.column_measure[c];
                row_second += f * f / mixed * target.column_measure[c];
            });
            irradiance.add(row_irradiance * target.row_measure[r]);
            second.add(row_second * target.row_measure[r]);
        }
        if (violated) return HUGE_VAL;
        const double e = irradiance.value();
        return e > 0.0 ? second.value() / (e * e) - 1.0 : 0.0;
    });
}

} // namespace acdf::tools
