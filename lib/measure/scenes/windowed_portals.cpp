#include "compress/parallel.h"
#include "compress/sum.h"
#include "measure/samplers/point_samplers.h"
#include "measure/scenes/portal_frame.h"
#include "measure/scenes/portals.h"

#include <cmath>

namespace acdf::measure {
namespace {

/// Of every cell beside its light, so that none with light that the sums miss has pdf 0: a share of the mean.
constexpr double kFloor = 1e-3;
/// The light of a cell is looked up at this many points along each axis.
constexpr int kLookups = 4;

/// The hemisphere that a portal faces, on a square of cells: x and y are the angles of a direction with the
/// portal's axis z, seen along its axes y and x, from -pi/2 to pi/2. Straight lines along the portal's sides are
/// straight and upright there.
class RectifiedMap {
public:
    RectifiedMap(const compress::Target& target, const PortalAxes& axes, std::uint32_t size)
        : axes_(axes), size_(size), sums_((std::size_t{size} + 1) * (size + 1), 0.0) {
        if (size == 0) throw std::invalid_argument("a map of a portal needs cells");
        std::vector<double> light(std::size_t{size} * size);
        compress::parallel_for(0u, size, [&](std::uint32_t row) {
            for (std::uint32_t column = 0; column < size; ++column)
                light[std::size_t{row} * size + column] = light_of(target, column, row);
        });
        compress::Sum all;
        for (const double value : light) all.add(value);
        if (!(all.value() > 0.0)) throw std::invalid_argument("no light comes through a portal");
        const double floor = kFloor * all.value() / static_cast<double>(light.size());
        for (std::uint32_t row = 0; row < size; ++row) {
            double before = 0.0;
            for (std::uint32_t column = 0; column < size; ++column) {
                before += light[std::size_t{row} * size + column] + floor;
                sums_[at(column + 1, row + 1)] = sums_[at(column + 1, row)] + before;
            }
        }
    }

    const PortalAxes& axes() const { return axes_; }
    std::uint32_t size() const { return size_; }
    double sum(std::uint32_t column, std::uint32_t row) const { return sums_[at(column, row)]; }
    /// The light below and left of a position, linear within cells.
    double sum_at(double x, double y) const {
        const auto column = std::min(static_cast<std::uint32_t>(x), size_ - 1),
                   row = std::min(static_cast<std::uint32_t>(y), size_ - 1);
        const double s = x - column, t = y - row;
        return (1.0 - t) * ((1.0 - s) * sum(column, row) + s * sum(column + 1, row)) +
               t * ((1.0 - s) * sum(column, row + 1) + s * sum(column + 1, row + 1));
    }
    double cell(std::uint32_t column, std::uint32_t row) const {
        return (sum(column + 1, row + 1) - sum(column, row + 1)) - (sum(column + 1, row) - sum(column, row));
    }
    /// The place of a tangent, in cells.
    double place(double tangent) const { return (std::atan(tangent) / ACDF_PI + 0.5) * size_; }
    double tangent(double place) const { return std::tan((place / size_ - 0.5) * ACDF_PI); }
    std::uint64_t bytes() const { return sums_.size() * sizeof(double); }

private:
    std::size_t at(std::uint32_t column, std::uint32_t row) const {
        return std::size_t{row} * (size_ + 1) + column;
    }

    double light_of(const compress::Target& target, std::uint32_t column, std::uint32_t row) const {
        double sum = 0.0;
        for (int j = 0; j < kLookups; ++j)
            for (int i = 0; i < kLookups; ++i) {
                const double a = tangent(column + (i + 0.5) / kLookups), b = tangent(row + (j + 0.5) / kLookups);
                const double square = 1.0 + a * a + b * b;
                const Vec3 d = (1.0 / std::sqrt(square)) * axes_.to_world({a, b, 1.0});
                const float direction[3] = {static_cast<float>(d[0]), static_cast<float>(d[1]),
                                            static_cast<float>(d[2])};
                std::uint32_t texel[2];
                double ignored;
                if (!acdf_sphere_square(target.columns, target.rows, direction, texel, &ignored)) continue;
                const double solid_angle = (1.0 + a * a) * (1.0 + b * b) / (square * std::sqrt(square));
                sum += double{target.row(texel[1])[texel[0]]} * solid_angle;
            }
        return sum;
    }

    PortalAxes axes_;
    std::uint32_t size_;
    std::vector<double> sums_; ///< (size + 1)^2, row by row
};

/// What a point sees of a map through a portal.
struct Window {
    const RectifiedMap* map = nullptr;
    PortalView view;
    double low[2] = {}, high[2] = {}, light = 0.0;

    Window(const RectifiedMap& of, const PortalView& seen) : map(&of), view(seen) {
        if (!seen.seen()) return;
        for (std::size_t k = 0; k < 2; ++k) {
            low[k] = of.place(seen.low[k] / seen.distance);
            high[k] = of.place(seen.high[k] / seen.distance);
        }
        light = std::max(column_sum(high[0]) - column_sum(low[0]), 0.0);
    }

    /// Of the rectangle's rows, left of a position.
    double column_sum(double x) const { return map->sum_at(x, high[1]) - map->sum_at(x, low[1]); }

    /// A direction along the portal's axes, not of unit length.
    Vec3 sample(double u, double v) const {
        const double begin = column_sum(low[0]);
        const double x = invert(low[0], high[0], begin + u * light, [&](double at) { return column_sum(at); });
        const auto column = std::min(static_cast<std::uint32_t>(x), map->size() - 1);
        const auto row_sum = [&](double y) { // of the column's cells
            const auto row = std::min(static_cast<std::uint32_t>(y), map->size() - 1);
            const double t = y - row;
            return (1.0 - t) * (map->sum(column + 1, row) - map->sum(column, row)) +
                   t * (map->sum(column + 1, row + 1) - map->sum(column, row + 1));
        };
        const double below = row_sum(low[1]), all = row_sum(high[1]) - below;
        const double y = invert(low[1], high[1], below + v * all, row_sum);
        return {map->tangent(x), map->tangent(y), 1.0};
    }
    /// The light of a direction's cell, per solid angle; `d` unit, along the portal's axes.
    double light_at(const Vec3& d) const {
        if (!view.holds(d)) return 0.0;
        const std::uint32_t most = map->size() - 1;
        const auto column = std::min(static_cast<std::uint32_t>(map->place(d[0] / d[2])), most),
                   row = std::min(static_cast<std::uint32_t>(map->place(d[1] / d[2])), most);
        const double cells = map->size() / ACDF_PI; // a radian
        return map->cell(column, row) * cells * cells * d[2] /
               ((d[2] * d[2] + d[0] * d[0]) * (d[2] * d[2] + d[1] * d[1]));
    }

private:
    /// Where a function that grows, linear within cells, has a value.
    template <class Function>
    static double invert(double low, double high, double value, const Function& function) {
        auto first = static_cast<std::uint32_t>(low), last = static_cast<std::uint32_t>(high);
        while (first < last) { // the cell with the value: the last border whose sum is not above it
            const std::uint32_t middle = first + (last - first + 1) / 2;
            if (function(middle) <= value) first = middle;
            else last = middle - 1;
        }
        const double a = std::max(low, double(first)), b = std::min(high, double(first) + 1.0);
        const double at_a = function(a), at_b = function(b);
        return at_b > at_a ? a + (b - a) * std::clamp((value - at_a) / (at_b - at_a), 0.0, 1.0) : a;
    }
};

struct WindowedPortals {
    std::vector<Portal> portals;
    bool turned;
    std::vector<std::unique_ptr<const RectifiedMap>> maps;
    std::vector<const RectifiedMap*> map_of; ///< one a portal: those that face the same way have one together

    WindowedPortals(const compress::Target& target, std::vector<Portal> given, bool is_turned, std::uint32_t size)
        : portals(std::move(given)), turned(is_turned) {
        check_portals(portals);
        for (const Portal& portal : portals) {
            const PortalAxes axes = axes_of(portal);
            const auto same = std::find_if(maps.begin(), maps.end(), [&](const auto& map) {
                return dot(map->axes().x, axes.x) > 1.0 - 1e-12 && dot(map->axes().y, axes.y) > 1.0 - 1e-12;
            });
            if (same != maps.end()) {
                map_of.push_back(same->get());
                continue;
            }
            maps.push_back(std::make_unique<const RectifiedMap>(target, axes, size));
            map_of.push_back(maps.back().get());
        }
    }
    std::uint64_t bytes() const {
        std::uint64_t sum = portals.size() * sizeof(Portal);
        for (const auto& map : maps) sum += map->bytes();
        return sum;
    }
};

class WindowedPortalPoint final : public PointSampler {
public:
    explicit WindowedPortalPoint(const WindowedPortals& portals) : portals_(portals) {}

    void move_to(const ShadingPoint& point) override {
        const Vec3 from = position_of(point, portals_.turned);
        windows_.clear();
        all_ = 0.0;
        for (std::size_t i = 0; i < portals_.portals.size(); ++i) {
            const RectifiedMap& map = *portals_.map_of[i];
            const Window window(map, view_of(portals_.portals[i], map.axes(), from));
            if (!(window.light > 0.0)) continue;
            windows_.push_back(window);
            all_ += window.light;
        }
    }
    AcdfDirectionSample sample(double u0, double u1) const override {
        AcdfDirectionSample out{{0.0f, 0.0f, 1.0f}, 0.0f};
        if (windows_.empty()) return out;
        double left = u0 * all_;
        std::size_t i = 0;
        while (i + 1 < windows_.size() && left >= windows_[i].light) left -= windows_[i++].light;
        const Window& window = windows_[i];
        const Vec3 d = window.sample(std::min(left / window.light, 1.0), u1);
        const Vec3 world = normalized(window.map->axes().to_world(d));
        for (std::size_t k = 0; k < 3; ++k) out.direction[k] = static_cast<float>(world[k]);
        out.pdf = pdf(out.direction);
        return out;
    }
    float pdf(const float wi[3]) const override {
        const Vec3 world{double{wi[0]}, double{wi[1]}, double{wi[2]}};
        double sum = 0.0;
        for (const Window& window : windows_) sum += window.light_at(window.map->axes().to_local(world));
        return windows_.empty() ? 0.0f : static_cast<float>(sum / all_);
    }

private:
    const WindowedPortals& portals_;
    std::vector<Window> windows_;
    double all_ = 0.0;
};

} // namespace

LightSamplerPtr windowed_portal_sampler(const compress::Target& target, const std::vector<Portal>& portals,
                                        bool turned, std::uint32_t size) {
    return std::make_unique<MovedToPoints<WindowedPortals, WindowedPortalPoint>>(target, portals, turned, size);
}

} // namespace acdf::measure
