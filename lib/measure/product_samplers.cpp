#include "measure/product_samplers.h"

#include "measure/brdf_samplers.h"
#include "measure/point_samplers.h"
#include "measure/surface_frame.h"

#include <acdf/product.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace acdf::measure {
namespace {

/// GgxSampler as ProductSampler asks for it. Its density over the cosine stands for the BRDF.
class GgxLobe {
public:
    struct Point {
        double wo[3];
    };

    explicit GgxLobe(double alpha) : ggx_(alpha) {}

    static bool at(const float wo[3], Point& point) {
        std::copy_n(wo, 3, point.wo);
        return wo[2] > 0.0f;
    }
    static float value(const Point&, const float wi[3], float pdf) { return pdf / std::max(0.02f, wi[2]); }
    float pdf(const Point& point, const float wi[3]) const {
        const double w[3] = {wi[0], wi[1], wi[2]};
        return static_cast<float>(ggx_.pdf(point.wo, w));
    }
    ProductSample sample(const Point& point, double u0, double u1) const {
        const double u[2] = {below_one(u0), below_one(u1)};
        const BrdfSample s = ggx_.sample(point.wo, u);
        return {{static_cast<float>(s.wi[0]), static_cast<float>(s.wi[1]), static_cast<float>(s.wi[2])},
                static_cast<float>(s.pdf)};
    }

private:
    GgxSampler ggx_;
};

template <class AnyLobe>
struct ProductTable {
    ProductSampler<AnyLobe> sampler;
    std::uint64_t files;

    std::uint64_t bytes() const { return files; }
};

template <class AnyLobe>
class ProductAtPoint final : public PointSampler {
public:
    explicit ProductAtPoint(const ProductTable<AnyLobe>& table) : sampler_(table.sampler), point_() {
        point_.share = -1.0;
    }
    void move_to(const ShadingPoint& point) override {
        const double n[3] = {point.n[0], point.n[1], point.n[2]};
        double tangent[3], bitangent[3];
        SurfaceFrame frame;
        measure::surface_frame(n, tangent, bitangent);
        for (int k = 0; k < 3; ++k) {
            frame.tangent[k] = static_cast<float>(tangent[k]);
            frame.bitangent[k] = static_cast<float>(bitangent[k]);
            frame.normal[k] = point.n[k];
        }
        point_ = sampler_.at(frame, point.wo);
    }
    AcdfDirectionSample sample(double u0, double u1) const override { return sampler_.sample(point_, u0, u1); }
    float pdf(const float wi[3]) const override { return sampler_.pdf(point_, wi); }

private:
    const ProductSampler<AnyLobe>& sampler_;
    typename ProductSampler<AnyLobe>::Point point_;
};

template <class AnyLobe>
std::unique_ptr<LightSampler> made(const File& light, const AnyLobe& lobe, int parts, std::uint64_t brdf_bytes) {
    using Table = ProductTable<AnyLobe>;
    using Made = MovedToPoints<Table, ProductAtPoint<AnyLobe>>;
    const ProductOptions options{parts};
    const std::uint64_t bytes = light.size() + brdf_bytes;
    if (light.kind() == ACDF_KIND_LOCAL)
        return std::make_unique<Made>(Table{ProductSampler<AnyLobe>(light.local().data(), lobe, options), bytes});
    if (light.kind() == ACDF_KIND_ENVIRONMENT)
        return std::make_unique<Made>(
            Table{ProductSampler<AnyLobe>(light.environment().data(), lobe, options), bytes});
    throw std::invalid_argument("the light of a product is an environment or a local environment");
}

} // namespace

int product_parts(std::uint32_t samples) {
    if (samples < 8) return 1;
    return static_cast<int>(std::clamp<std::uint32_t>(samples, 16, 64));
}

std::unique_ptr<LightSampler> product_sampler(const File& light, const File& brdf, int parts) {
    if (brdf.kind() != ACDF_KIND_BRDF)
        throw std::invalid_argument("the second part of a product is a BRDF, or ggx");
    return made(light, BrdfLobe(brdf.brdf().data()), parts, brdf.size());
}

std::unique_ptr<LightSampler> product_sampler(const File& light, double alpha, int parts) {
    return made(light, GgxLobe(alpha), parts, 0);
}

} // namespace acdf::measure
