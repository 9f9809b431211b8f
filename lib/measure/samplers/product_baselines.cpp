#include "measure/samplers/product_baselines.h"

#include "measure/samplers/ggx_lobe.h"
#include "measure/samplers/light_samplers.h"
#include "measure/samplers/point_samplers.h"
#include "measure/samplers/tiling.h"

#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

namespace acdf::measure {
namespace {

class Half final : public LightSampler {
public:
    Half(const LightSampler& a, const LightSampler& b) : a_(a), b_(b) {}
    std::unique_ptr<PointSampler> point_sampler() const override {
        return std::make_unique<Point>(a_.point_sampler(), b_.point_sampler());
    }
    std::uint64_t bytes() const override { return a_.bytes() + b_.bytes(); }

private:
    class Point final : public PointSampler {
    public:
        Point(std::unique_ptr<PointSampler> a, std::unique_ptr<PointSampler> b)
            : a_(std::move(a)), b_(std::move(b)) {}
        void move_to(const ShadingPoint& point) override {
            a_->move_to(point);
            b_->move_to(point);
        }
        AcdfDirectionSample sample(double u0, double u1) const override {
            const bool first = u0 < 0.5;
            const PointSampler &own = first ? *a_ : *b_, &other = first ? *b_ : *a_;
            AcdfDirectionSample out = own.sample(first ? 2.0 * u0 : 2.0 * u0 - 1.0, u1);
            if (out.pdf > 0.0f) out.pdf = 0.5f * (out.pdf + other.pdf(out.direction));
            return out;
        }
        float pdf(const float wi[3]) const override { return 0.5f * (a_->pdf(wi) + b_->pdf(wi)); }

    private:
        std::unique_ptr<PointSampler> a_, b_;
    };
    const LightSampler &a_, &b_;
};

template <class AnyLobe>
struct ProductTiles {
    TilingOnTheFly tiling;
    AnyLobe lobe;
    std::uint32_t columns, rows;
    std::uint64_t brdf_bytes;
    std::vector<double> flux;                 ///< of each tile
    std::vector<std::array<float, 3>> middle; ///< of each tile

    ProductTiles(const compress::Target& target, std::uint32_t c, std::uint32_t r, const AnyLobe& l,
                 std::uint64_t b)
        : tiling(target, c, r), lobe(l), columns(c), rows(r), brdf_bytes(b), flux(tiling.flux()) {
        for (std::uint32_t y = 0; y < rows; ++y)
            for (std::uint32_t x = 0; x < columns; ++x) {
                const double phi = ACDF_PI * (1.0 - (2.0 * x + 1.0) / columns), theta = ACDF_PI * (y + 0.5) / rows;
                middle.push_back({static_cast<float>(std::sin(theta) * std::cos(phi)),
                                  static_cast<float>(std::sin(theta) * std::sin(phi)),
                                  static_cast<float>(std::cos(theta))});
            }
    }
    std::uint64_t bytes() const { return tiling.bytes() + brdf_bytes; }
};

template <class AnyLobe>
class ProductTilesPoint final : public PointSampler {
public:
    explicit ProductTilesPoint(const ProductTiles<AnyLobe>& tiles) : tiles_(tiles), weight_(tiles.flux.size()) {
        point_.cumulative.assign(tiles.flux.size() + 1, 0.0);
    }
    void move_to(const ShadingPoint& point) override {
        const SurfaceFrame frame = frame_of(point);
        float wo[3], wi[3];
        typename AnyLobe::Point lobe{};
        frame.to_local(point.wo, wo);
        const bool seen = tiles_.lobe.at(wo, lobe);
        double light = 0.0, reflected = 0.0;
        for (std::size_t i = 0; i < weight_.size(); ++i) {
            frame.to_local(tiles_.middle[i].data(), wi);
            // BRDF times cosine: what the lobe's own sampler follows.
            weight_[i] = seen && wi[2] > 0.0f ? double{tiles_.lobe.pdf(lobe, wi)} : 0.0;
            light += tiles_.flux[i];
            reflected += tiles_.flux[i] * weight_[i];
        }
        const double floor = reflected > 0.0 ? 0.05 * reflected / light : 1.0;
        for (std::size_t i = 0; i < weight_.size(); ++i)
            point_.cumulative[i + 1] = point_.cumulative[i] + tiles_.flux[i] * (weight_[i] + floor);
    }
    AcdfDirectionSample sample(double u0, double u1) const override {
        return tiles_.tiling.sample(point_, below_one(u0), u1);
    }
    float pdf(const float wi[3]) const override { return tiles_.tiling.pdf(point_, wi); }

private:
    const ProductTiles<AnyLobe>& tiles_;
    TilingOnTheFly::Point point_;
    std::vector<double> weight_;
};

template <class AnyLobe>
std::unique_ptr<LightSampler> tiles_of(const compress::Target& target, std::uint32_t columns, std::uint32_t rows,
                                       const AnyLobe& lobe, std::uint64_t brdf_bytes) {
    return std::make_unique<MovedToPoints<ProductTiles<AnyLobe>, ProductTilesPoint<AnyLobe>>>(target, columns, rows,
                                                                                              lobe, brdf_bytes);
}

} // namespace

std::unique_ptr<LightSampler> half_and_half(const LightSampler& a, const LightSampler& b) {
    return std::make_unique<Half>(a, b);
}

std::unique_ptr<LightSampler> product_tiles_sampler(const compress::Target& target, std::uint32_t columns,
                                                    std::uint32_t rows, const File& brdf) {
    if (brdf.kind() != ACDF_KIND_BRDF) throw std::invalid_argument("tiles are weighted by a BRDF, or ggx");
    return tiles_of(target, columns, rows, BrdfLobe(brdf.brdf().data()), memory_of(brdf));
}

std::unique_ptr<LightSampler> product_tiles_sampler(const compress::Target& target, std::uint32_t columns,
                                                    std::uint32_t rows, double alpha) {
    return tiles_of(target, columns, rows, GgxLobe(alpha), 0);
}

} // namespace acdf::measure
