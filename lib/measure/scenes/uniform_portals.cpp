#include "measure/samplers/point_samplers.h"
#include "measure/scenes/portal_frame.h"
#include "measure/scenes/portals.h"

#include <cmath>

namespace acdf::measure {
namespace {

/// Directions through a rectangle, uniform over its solid angle (Urena et al. 2013). Its angles are those between
/// the planes from the point through its edges.
class SphericalRectangle {
public:
    explicit SphericalRectangle(const PortalView& view) : view_(view) {
        if (!view.seen()) return;
        // What a plane's normal has along the portal's axis z.
        const auto towards = [&](double edge) { return edge / std::hypot(edge, view.distance); };
        const double left = -towards(view.low[0]), right = towards(view.high[0]), upper = towards(view.high[1]);
        lower_ = -towards(view.low[1]);
        begin_ = 2.0 * ACDF_PI - std::acos(-upper * left) - std::acos(-left * lower_);
        solid_angle_ = std::max(std::acos(-lower_ * right) + std::acos(-right * upper) - begin_, 0.0);
        upper_ = upper;
    }
    double solid_angle() const { return solid_angle_; }
    bool holds(const Vec3& d) const { return view_.holds(d); }

    /// Along the portal's axes, not of unit length; u, v in [0, 1).
    Vec3 sample(double u, double v) const {
        const double angle = u * solid_angle_ + begin_;
        const double f = (std::cos(angle) * lower_ - upper_) / std::sin(angle);
        const double cosine = std::clamp(std::copysign(1.0, f) / std::sqrt(f * f + lower_ * lower_), -1.0, 1.0);
        const double x = std::clamp(cosine * view_.distance / std::sqrt(std::max(1.0 - cosine * cosine, 1e-300)),
                                    view_.low[0], view_.high[0]);
        const double across = std::hypot(x, view_.distance);
        const double h0 = view_.low[1] / std::hypot(across, view_.low[1]),
                     h1 = view_.high[1] / std::hypot(across, view_.high[1]), h = h0 + v * (h1 - h0);
        const double y =
            std::clamp(h * across / std::sqrt(std::max(1.0 - h * h, 1e-300)), view_.low[1], view_.high[1]);
        return {x, y, view_.distance};
    }

private:
    PortalView view_;
    double lower_ = 0.0, upper_ = 0.0, begin_ = 0.0, solid_angle_ = 0.0;
};

struct Portals {
    std::vector<Portal> portals;
    std::vector<PortalAxes> axes;
    bool turned;

    Portals(std::vector<Portal> given, bool is_turned) : portals(std::move(given)), turned(is_turned) {
        check_portals(portals);
        for (const Portal& portal : portals) axes.push_back(axes_of(portal));
    }
    std::uint64_t bytes() const { return portals.size() * (sizeof(Portal) + sizeof(PortalAxes)); }
};

class UniformPortalPoint final : public PointSampler {
public:
    explicit UniformPortalPoint(const Portals& portals) : portals_(portals) {}

    void move_to(const ShadingPoint& point) override {
        const Vec3 from = position_of(point, portals_.turned);
        seen_.clear();
        all_ = 0.0;
        for (std::size_t i = 0; i < portals_.portals.size(); ++i) {
            seen_.emplace_back(view_of(portals_.portals[i], portals_.axes[i], from));
            all_ += seen_.back().solid_angle();
        }
    }
    AcdfDirectionSample sample(double u0, double u1) const override {
        AcdfDirectionSample out{{0.0f, 0.0f, 1.0f}, 0.0f};
        if (!(all_ > 0.0)) return out;
        double left = u0 * all_;
        std::size_t i = 0;
        while (i + 1 < seen_.size() && left >= seen_[i].solid_angle()) left -= seen_[i++].solid_angle();
        while (!(seen_[i].solid_angle() > 0.0)) --i; // rounding: the last ones have none
        const Vec3 d = seen_[i].sample(std::min(left / seen_[i].solid_angle(), 1.0), u1);
        const Vec3 world = normalized(portals_.axes[i].to_world(d));
        for (std::size_t k = 0; k < 3; ++k) out.direction[k] = static_cast<float>(world[k]);
        out.pdf = pdf(out.direction);
        return out;
    }
    float pdf(const float wi[3]) const override {
        int count = 0;
        for (std::size_t i = 0; i < seen_.size(); ++i)
            count += seen_[i].holds(portals_.axes[i].to_local({double{wi[0]}, double{wi[1]}, double{wi[2]}}));
        return all_ > 0.0 ? static_cast<float>(count / all_) : 0.0f;
    }

private:
    const Portals& portals_;
    std::vector<SphericalRectangle> seen_;
    double all_ = 0.0;
};

} // namespace

LightSamplerPtr uniform_portal_sampler(std::vector<Portal> portals, bool turned) {
    return std::make_unique<MovedToPoints<Portals, UniformPortalPoint>>(std::move(portals), turned);
}

} // namespace acdf::measure
