// Counts of rays by site: one cell of the grid and one normal, with what is known of normals beforehand.
#pragma once

#include "compress/visibility/beside_cosine.h"
#include "compress/visibility/counts.h"
#include "compress/visibility/parts.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace acdf::compress {

/// Of a set of sites, one number a part: rays and those that met nothing; and, once for each ray of the sites, what
/// its normal is given by all light, and how often samples of the cosine fall there.
struct RaySums {
    std::vector<float> all, seen, light, cosine;
    float rays = 0.0f;

    explicit RaySums(std::size_t parts) : all(parts), seen(parts), light(parts), cosine(parts) {}
    void clear();
    void add(const RaySums& other);
    /// Becomes what of `whole` is not in `part`.
    void become_rest(const RaySums& whole, const RaySums& part);
};

class RaySites {
public:
    static constexpr std::size_t axes = 6; ///< of positions, then of normals

    /// All but `beside` must outlive this; it is there where samples of the cosine count.
    RaySites(const VisibilityParts& parts, const VisibilityCounts::Sorted& counts, const BesideCosine* beside);

    std::size_t count() const { return first_.size() - 1; }
    std::size_t parts() const { return part_count_; }
    /// The middle of its cell of the grid, or of its normals.
    float coordinate(std::uint32_t site, std::size_t axis) const;
    /// The width of cells along an axis; 0 of normals.
    float width(std::size_t axis) const { return axis < 3 ? counts_.width() : 0.0f; }
    void add(std::uint32_t site, RaySums& sums) const;
    /// BesideCosine::masses of its normal, and how many rays it has.
    const std::vector<float>& masses(std::uint32_t site) const { return normals_[normal(site)].masses; }
    float rays(std::uint32_t site) const { return rays_[site]; }

private:
    struct Normal {
        std::array<float, 3> middle{};
        std::vector<float> light, cosine, masses;
    };
    std::uint32_t normal(std::uint32_t site) const {
        return VisibilityCounts::normal_of(counts_[first_[site]].key);
    }
    void describe(Normal& out, const BesideCosine* beside) const;

    const VisibilityParts& parts_;
    const VisibilityCounts::Sorted& counts_;
    std::size_t part_count_;
    std::vector<std::uint32_t> first_; ///< of the counts of each site, and behind the last one
    std::vector<float> rays_;
    std::vector<Normal> normals_;
};

} // namespace acdf::compress
