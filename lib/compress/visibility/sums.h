// What rays from some points find of each part of the sphere.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// What a ray finds, or is expected to.
enum class Ray : std::uint8_t { unknown, arrives, is_met };

/// What is known of the parts in a cell: sums over its points.
struct VisibilitySums {
    std::vector<float> all, seen; ///< one a part
    float points = 0.0f;

    explicit VisibilitySums(std::size_t parts = 0) : all(parts, 0.0f), seen(parts, 0.0f) {}
    void add(const VisibilitySums& other) {
        points += other.points;
        for (std::size_t p = 0; p < all.size(); ++p) all[p] += other.all[p];
        for (std::size_t p = 0; p < seen.size(); ++p) seen[p] += other.seen[p];
    }
    /// What all rays to a part found; of few points unknown.
    Ray ray(std::size_t part) const {
        constexpr float kFew = 8.0f;
        if (!(all[part] > 0.0f) || points < kFew) return Ray::unknown;
        if (!(seen[part] > 0.0f)) return Ray::is_met;
        return seen[part] >= all[part] ? Ray::arrives : Ray::unknown;
    }
    /// One point's light, as VisibilityLight::given has it.
    void add(const float* given) {
        const std::size_t count = all.size();
        float *const a = all.data(), *const s = seen.data();
        points += 1.0f;
        for (std::size_t p = 0; p < count; ++p) a[p] += std::fabs(given[p]);
        for (std::size_t p = 0; p < count; ++p) s[p] += given[p] > 0.0f ? given[p] : 0.0f;
    }
};

} // namespace acdf::compress
