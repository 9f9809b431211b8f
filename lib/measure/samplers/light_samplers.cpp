#include "measure/samplers/light_samplers.h"

#include "measure/samplers/compensated_cdf.h"
#include "measure/samplers/downsampled_cdf.h"
#include "measure/samplers/hierarchical_warp.h"
#include "measure/samplers/ideal_row.h"
#include "measure/samplers/local_baselines.h"
#include "measure/samplers/point_samplers.h"
#include "measure/samplers/tiling.h"
#include "measure/surface_frame.h"
#include "visibility/visible_view.h"

#include <acdf/moved.h>

#include <algorithm>
#include <stdexcept>

namespace acdf::measure {
namespace {

class TilingPoint final : public PointSampler {
public:
    explicit TilingPoint(const TilingOnTheFly& tiling) : tiling_(tiling) {}
    void move_to(const ShadingPoint& point) override { tiling_.at(point.n, point_); }
    AcdfDirectionSample sample(double u0, double u1) const override {
        return tiling_.sample(point_, below_one(u0), u1);
    }
    float pdf(const float wi[3]) const override { return tiling_.pdf(point_, wi); }

private:
    const TilingOnTheFly& tiling_;
    TilingOnTheFly::Point point_;
};

/// What needs no tables.
struct NoTable {
    static std::uint64_t bytes() { return 0; }
};

class CosinePoint final : public PointSampler {
public:
    explicit CosinePoint(const NoTable&) {}
    void move_to(const ShadingPoint& point) override { point_ = point; }
    AcdfDirectionSample sample(double u0, double u1) const override {
        return CosineHemisphere::sample(point_.n, u0, u1);
    }
    float pdf(const float wi[3]) const override { return CosineHemisphere::pdf(point_.n, wi); }

private:
    ShadingPoint point_;
};

struct EnvironmentFile {
    const File& file;
    EnvironmentView view{file.environment()};
    explicit EnvironmentFile(const File& f) : file(f) {}
    std::uint64_t bytes() const { return memory_of(file); }
};

class EnvironmentPoint final : public PointSampler {
public:
    explicit EnvironmentPoint(const EnvironmentFile& file) : view_(file.view) {}
    void move_to(const ShadingPoint&) override {}
    AcdfDirectionSample sample(double u0, double u1) const override {
        return view_.sample(below_one(u0), below_one(u1));
    }
    float pdf(const float wi[3]) const override { return view_.pdf(wi); }
    float recommended_light_share() const override { return view_.recommended_light_share(); }

private:
    EnvironmentView view_;
};

struct SkyFile {
    const File& file;
    MixedEnvironment view;
    SkyFile(const File& f, const MixedEnvironment& v) : file(f), view(v) {}
    std::uint64_t bytes() const { return memory_of(file) + 4 * std::uint64_t{view.data().top->words}; }
};

class SkyPoint final : public PointSampler {
public:
    explicit SkyPoint(const SkyFile& file) : view_(file.view) {}
    void move_to(const ShadingPoint&) override {}
    AcdfDirectionSample sample(double u0, double u1) const override {
        return view_.sample(below_one(u0), below_one(u1));
    }
    float pdf(const float wi[3]) const override { return view_.pdf(wi); }

private:
    const MixedEnvironment& view_;
};

struct LocalFile {
    const File& file;
    VisibleLocalView view;
    LocalFile(const File& f, bool with_visibility)
        : file(f), view(with_visibility ? visible_view(f) : VisibleLocalView(f.local())) {}
    std::uint64_t bytes() const { return memory_of(file); }
};

class LocalPoint final : public PointSampler {
public:
    explicit LocalPoint(const LocalFile& file) : view_(file.view), point_() {}
    void move_to(const ShadingPoint& point) override {
        point_ = view_.at(point.position, point.n);
        std::copy_n(point.n, 3, normal_);
    }
    AcdfDirectionSample sample(double u0, double u1) const override { return view_.sample(point_, u0, u1); }
    float pdf(const float wi[3]) const override { return view_.pdf(point_, wi); }
    float recommended_light_share() const override { return view_.local().recommended_light_share(normal_); }

private:
    VisibleLocalView view_;
    AcdfVisiblePoint point_;
    float normal_[3] = {0.0f, 0.0f, 1.0f};
};

/// A point's surface, with its normal as z.
class Surface {
public:
    explicit Surface(const float n[3]) {
        for (int k = 0; k < 3; ++k) axis_[2][k] = n[k];
        surface_frame(axis_[2], axis_[0], axis_[1]);
    }
    template <class Number>
    void to_local(const float w[3], Number out[3]) const {
        for (int i = 0; i < 3; ++i)
            out[i] = static_cast<Number>(axis_[i][0] * w[0] + axis_[i][1] * w[1] + axis_[i][2] * w[2]);
    }
    template <class Number>
    void to_world(const Number w[3], float out[3]) const {
        for (int k = 0; k < 3; ++k)
            out[k] = static_cast<float>(w[0] * axis_[0][k] + w[1] * axis_[1][k] + w[2] * axis_[2][k]);
    }

private:
    double axis_[3][3];
};

constexpr float kUp[3] = {0.0f, 0.0f, 1.0f};

/// Of a class with sample(wo, u) and pdf(wo, wi), which are 0 for wo below the surface.
template <class Brdf>
class BrdfPoint final : public PointSampler {
public:
    explicit BrdfPoint(const Brdf& brdf) : brdf_(brdf), surface_(kUp) {}

    void move_to(const ShadingPoint& point) override {
        surface_ = Surface(point.n);
        surface_.to_local(point.wo, wo_);
    }
    AcdfDirectionSample sample(double u0, double u1) const override {
        const double u[2] = {u0, u1};
        const BrdfSample s = brdf_.sample(wo_, u);
        AcdfDirectionSample out;
        surface_.to_world(s.wi, out.direction);
        out.pdf = static_cast<float>(s.pdf);
        return out;
    }
    float pdf(const float wi[3]) const override {
        double local[3];
        surface_.to_local(wi, local);
        return static_cast<float>(brdf_.pdf(wo_, local));
    }

private:
    const Brdf& brdf_;
    Surface surface_;
    double wo_[3] = {0.0, 0.0, 1.0};
};

struct Tabulated {
    const TabulatedBrdf& table;
    explicit Tabulated(const TabulatedBrdf& t) : table(t) {}
    BrdfSample sample(const double wo[3], const double u[2]) const { return table.sample(wo, u); }
    double pdf(const double wo[3], const double wi[3]) const { return table.pdf(wo, wi); }
    std::uint64_t bytes() const { return table.bytes(); }
};

struct BrdfFile {
    const File& file;
    AcdfBrdf data{file.brdf().data()};
    explicit BrdfFile(const File& f) : file(f) {}
    std::uint64_t bytes() const { return memory_of(file); }
};

/// The view is looked up once for all samples of a point.
class BrdfFilePoint final : public PointSampler {
public:
    explicit BrdfFilePoint(const BrdfFile& file) : data_(file.data), surface_(kUp), view_() {}

    void move_to(const ShadingPoint& point) override {
        float wo[3];
        surface_ = Surface(point.n);
        surface_.to_local(point.wo, wo);
        seen_ = acdf_brdf_view(&data_, wo, &view_) != 0;
    }
    AcdfDirectionSample sample(double u0, double u1) const override {
        if (!seen_) return {{0.0f, 0.0f, 1.0f}, 0.0f};
        const AcdfDirectionSample s = acdf_brdf_view_sample(&data_, &view_, u0, u1);
        AcdfDirectionSample out;
        surface_.to_world(s.direction, out.direction);
        out.pdf = s.pdf;
        return out;
    }
    float pdf(const float wi[3]) const override {
        if (!seen_) return 0.0f;
        float local[3];
        surface_.to_local(wi, local);
        return acdf_brdf_view_pdf(&data_, &view_, local);
    }

private:
    const AcdfBrdf& data_;
    Surface surface_;
    AcdfBrdfView view_;
    bool seen_ = false;
};

} // namespace

std::uint64_t memory_of(const File& file) {
    AcdfMove parts[ACDF_MAX_MOVES];
    std::uint64_t sum = 0;
    for (int i = file.memory(parts); i-- > 0;) sum += parts[i].bytes;
    return sum;
}

LightSamplerPtr full_cdf_sampler(const compress::Target& target) {
    return std::make_unique<SameEverywhere<LocalFullCdf>>(target);
}

LightSamplerPtr tiling_sampler(const compress::Target& target, std::uint32_t columns, std::uint32_t rows) {
    return std::make_unique<MovedToPoints<TilingOnTheFly, TilingPoint>>(target, columns, rows);
}

LightSamplerPtr downsampled_cdf_sampler(const compress::Target& target, std::uint32_t columns, std::uint32_t rows) {
    return std::make_unique<SameEverywhere<DownsampledCdf>>(target, columns, rows);
}

LightSamplerPtr alias_sampler(const compress::Target& target, AliasNumbers numbers) {
    return std::make_unique<SameEverywhere<AliasTable>>(target, numbers);
}

LightSamplerPtr hierarchical_sampler(const compress::Target& target) {
    return std::make_unique<SameEverywhere<HierarchicalWarp>>(target);
}

LightSamplerPtr compensated_sampler(const compress::Target& target, double s) {
    return std::make_unique<SameEverywhere<CompensatedCdf>>(target, s);
}

LightSamplerPtr ideal_sampler(const compress::Target& target, double shares) {
    return std::make_unique<MovedToPoints<IdealRows, IdealRow>>(target, shares);
}

LightSamplerPtr cosine_sampler() { return std::make_unique<MovedToPoints<NoTable, CosinePoint>>(); }

LightSamplerPtr ggx_sampler(double alpha) {
    return std::make_unique<MovedToPoints<GgxSampler, BrdfPoint<GgxSampler>>>(alpha);
}

LightSamplerPtr tabulated_brdf_sampler(const TabulatedBrdf& table) {
    return std::make_unique<MovedToPoints<Tabulated, BrdfPoint<Tabulated>>>(table);
}

LightSamplerPtr file_sampler(const File& file) {
    if (file.kind() == ACDF_KIND_ENVIRONMENT)
        return std::make_unique<MovedToPoints<EnvironmentFile, EnvironmentPoint>>(file);
    if (file.kind() == ACDF_KIND_LOCAL) return std::make_unique<MovedToPoints<LocalFile, LocalPoint>>(file, true);
    if (file.kind() == ACDF_KIND_BRDF) return std::make_unique<MovedToPoints<BrdfFile, BrdfFilePoint>>(file);
    throw std::invalid_argument("a table does not say what light it samples");
}

LightSamplerPtr sky_sampler(const File& file, const MixedEnvironment& sky) {
    return std::make_unique<MovedToPoints<SkyFile, SkyPoint>>(file, sky);
}

LightSamplerPtr normals_alone_sampler(const File& file) {
    if (file.kind() != ACDF_KIND_LOCAL) throw std::invalid_argument("is not a local environment");
    return std::make_unique<MovedToPoints<LocalFile, LocalPoint>>(file, false);
}

} // namespace acdf::measure
