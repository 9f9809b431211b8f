#include "measure/samplers/product_samplers.h"

#include "measure/samplers/ggx_lobe.h"
#include "measure/samplers/light_samplers.h"
#include "measure/samplers/point_samplers.h"
#include "visibility/visible_view.h"

#include <acdf/product/product.h>

#include <algorithm>
#include <stdexcept>

namespace acdf::measure {
namespace {

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
        point_ = sampler_.at(point.position, frame_of(point), point.wo);
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
    const std::uint64_t bytes = memory_of(light) + brdf_bytes;
    if (light.kind() == ACDF_KIND_LOCAL)
        return std::make_unique<Made>(
            Table{ProductSampler<AnyLobe>(visible_view(light).data(), lobe, options), bytes});
    if (light.kind() == ACDF_KIND_ENVIRONMENT)
        return std::make_unique<Made>(
            Table{ProductSampler<AnyLobe>(light.environment().data(), lobe, options), bytes});
    throw std::invalid_argument("the light of a product is an environment or a local environment");
}

} // namespace

int product_parts(std::uint32_t samples) {
    const std::uint32_t many = std::min<std::uint32_t>(samples, ACDF_CUT_MAX_PARTS);
    return static_cast<int>(
        std::clamp<std::uint32_t>(std::max(std::min(12 * many, 64u), many), 8, ACDF_CUT_MAX_PARTS));
}

std::unique_ptr<LightSampler> product_sampler(const File& light, const File& brdf, int parts) {
    if (brdf.kind() != ACDF_KIND_BRDF)
        throw std::invalid_argument("the second part of a product is a BRDF, or ggx");
    return made(light, BrdfLobe(brdf.brdf().data()), parts, memory_of(brdf));
}

std::unique_ptr<LightSampler> product_sampler(const File& light, double alpha, int parts) {
    return made(light, GgxLobe(alpha), parts, 0);
}

} // namespace acdf::measure
