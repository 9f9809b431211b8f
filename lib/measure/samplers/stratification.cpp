#include "measure/samplers/stratification.h"

#include "compress/boxes.h"
#include "compress/sum.h"
#include "measure/samplers/probe_grid.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace acdf::measure {
namespace {

using compress::Target;

constexpr int kCuts = 6;
constexpr double kLargestAngle = 0.01; ///< beyond which visibility is taken to vary, sr
constexpr std::uint32_t kNone = 0xFFFFFFFFu;

class Stratifier {
public:
    Stratifier(const Target& target, std::uint32_t strata)
        : target_(target), strata_(strata), stratum_(target.values.size(), kNone), column_(target.columns),
          row_(target.rows) {
        for (std::uint32_t c = 0; c < target.columns; ++c)
            acdf_sincospi(1.0 - (2.0 * c + 1.0) / target.columns, &column_[c][1], &column_[c][0]);
        for (std::uint32_t r = 0; r < target.rows; ++r)
            row_[r] = 0.5 * (acdf_row_z(r, target.rows) + acdf_row_z(r + 1, target.rows));
        whole_ = ProbeGrid(target).flux() * std::pow(kLargestAngle, 0.25);
    }

    std::vector<std::uint32_t> run() {
        const double step = deviation();
        for (int cut = kCuts - 1; cut >= 0; --cut) {
            std::vector<bool> seen(stratum_.size(), false);
            for (std::uint32_t i = 0; i < seen.size(); ++i)
                if (!seen[i] && target_.values[i] >= cut * step) divide(connected(i, cut * step, seen), cut == 0);
        }
        return std::move(stratum_);
    }

private:
    using Direction = std::array<double, 3>;

    Direction direction(std::uint32_t texel) const {
        if (compress::is_octahedral(target_))
            return compress::octahedral_direction(target_, texel % target_.columns + 0.5,
                                                  texel / target_.columns + 0.5);
        const double z = row_[texel / target_.columns], radius = std::sqrt((1.0 - z) * (1.0 + z));
        const auto& [x, y] = column_[texel % target_.columns];
        return {radius * x, radius * y, z};
    }
    double solid_angle(std::uint32_t texel) const {
        return target_.column_measure[texel % target_.columns] * target_.row_measure[texel / target_.columns];
    }

    double deviation() const {
        compress::Sum angle, flux, square;
        for (std::uint32_t i = 0; i < stratum_.size(); ++i) {
            const double value = target_.values[i], omega = solid_angle(i);
            angle.add(omega);
            flux.add(value * omega);
            square.add(value * value * omega);
        }
        const double mean = flux.value() / angle.value();
        return std::sqrt(std::max(0.0, square.value() / angle.value() - mean * mean));
    }

    /// The texels of at least `radiance` that hang together with `first`, in azimuth all around.
    std::vector<std::uint32_t> connected(std::uint32_t first, double radiance, std::vector<bool>& seen) const {
        const std::uint32_t columns = target_.columns;
        std::vector<std::uint32_t> region = {first};
        seen[first] = true;
        const auto visit = [&](std::uint32_t texel) {
            if (seen[texel] || !(target_.values[texel] >= radiance)) return;
            seen[texel] = true;
            region.push_back(texel);
        };
        for (std::size_t k = 0; k < region.size(); ++k) {
            const std::uint32_t at = region[k], c = at % columns, r = at / columns;
            visit(at - c + (c + 1) % columns);
            visit(at - c + (c + columns - 1) % columns);
            if (r > 0) visit(at - columns);
            if (r + 1 < target_.rows) visit(at + columns);
        }
        return region;
    }

    /// How many strata a region should hold.
    std::uint32_t wanted(const std::vector<std::uint32_t>& region) const {
        double flux = 0.0, angle = 0.0;
        for (const std::uint32_t i : region) {
            angle += solid_angle(i);
            flux += target_.values[i] * solid_angle(i);
        }
        const double share = flux * std::pow(std::min(angle, kLargestAngle), 0.25) / whole_;
        return static_cast<std::uint32_t>(std::lround(std::min(share, 1.0) * strata_));
    }

    void divide(const std::vector<std::uint32_t>& region, bool last) {
        std::vector<std::uint32_t> held;
        std::vector<std::uint32_t> open; // texels
        for (const std::uint32_t i : region) {
            if (is_point(i)) held.push_back(i);
            if (stratum_[i] == kNone) open.push_back(i);
        }
        const auto left = static_cast<std::uint32_t>(strata_ - points_.size());
        const std::uint32_t goal = last ? strata_ : wanted(region);
        const auto before = static_cast<std::uint32_t>(last ? points_.size() : held.size());
        place(last ? points_ : held, std::min(goal > before ? goal - before : 0, left), open, last);
    }

    bool is_point(std::uint32_t texel) const {
        return std::find(points_.begin(), points_.end(), texel) != points_.end();
    }

    /// Adds `count` points among the `open` texels, far from those `held`, and gives the texels to them; with
    /// `all`, to those held if there is none to be added.
    void place(const std::vector<std::uint32_t>& held, std::uint32_t count, const std::vector<std::uint32_t>& open,
               bool all) {
        count = std::min(count, static_cast<std::uint32_t>(open.size()));
        if (open.empty() || (count == 0 && !all)) return;
        std::vector<double> nearest(open.size(), -2.0), own(open.size(), -2.0); // cosines to points: all, new ones
        const auto take = [&](std::uint32_t texel, std::uint32_t stratum) {     // kNone: only keeps others away
            const Direction d = direction(texel);
            for (std::size_t k = 0; k < open.size(); ++k) {
                const Direction w = direction(open[k]);
                const double cosine = open[k] == texel ? 2.0 : d[0] * w[0] + d[1] * w[1] + d[2] * w[2];
                nearest[k] = std::max(nearest[k], cosine);
                if (stratum == kNone || !(cosine > own[k])) continue;
                own[k] = cosine;
                stratum_[open[k]] = stratum;
            }
        };
        if (count == 0) {
            for (std::uint32_t s = 0; s < points_.size(); ++s) take(points_[s], s);
            return;
        }
        for (const std::uint32_t point : held) take(point, kNone);
        for (std::uint32_t k = 0; k < count; ++k) {
            const std::uint32_t next =
                held.empty() && k == 0 ? *std::max_element(open.begin(), open.end(),
                                                           [&](std::uint32_t a, std::uint32_t b) {
                                                               return target_.values[a] < target_.values[b];
                                                           })
                                       : open[static_cast<std::size_t>(
                                             std::min_element(nearest.begin(), nearest.end()) - nearest.begin())];
            take(next, static_cast<std::uint32_t>(points_.size()));
            points_.push_back(next);
        }
    }

    const Target& target_;
    std::uint32_t strata_;
    double whole_ = 0.0;                        ///< metric of all
    std::vector<std::uint32_t> stratum_;        ///< of each texel
    std::vector<std::uint32_t> points_;         ///< texels, one a stratum
    std::vector<std::array<double, 2>> column_; ///< cosine and sine of the azimuth
    std::vector<double> row_;                   ///< z
};

} // namespace

std::vector<std::uint32_t> stratify(const Target& target, std::uint32_t strata) {
    if (strata == 0) throw std::invalid_argument("a stratified map needs at least one stratum");
    return Stratifier(target, strata).run();
}

} // namespace acdf::measure
