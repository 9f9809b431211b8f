// Light beside an MIS partner that follows the cosine: from which radiance on it leaves anything to a normal.
#pragma once

#include "compress/halvings/costs.h"
#include "compress/local/halved/growth.h"
#include "compress/local/halved/moments.h"
#include "compress/partner.h"

#include <array>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Water filling (docs/method.md): of light L the samples in proportion to (L - threshold) cos, where that is above
/// 0.
struct LitNormal {
    double threshold = 0.0, irradiance = 0.0;
};

/// How much light of which radiance lies in each block.
class Radiances {
public:
    /// `unit`: what light is multiplied with.
    Radiances(const Blocks& blocks, double unit);

    /// `ratio`: samples of ours for one of the partner's.
    LitNormal seen(const Direction& normal, double ratio) const;
    /// More than the largest radiance in a box of blocks, and not much.
    double brightest(HalvedBox box) const;

private:
    struct Part {
        std::uint32_t level;
        float light, area;
    };
    const Blocks& blocks_;
    std::vector<std::uint32_t> begin_; ///< of each block its parts
    std::vector<Part> parts_;
};

/// Thresholds of the normals that see a direction, by how much its light is worth to them.
class FilledLight {
public:
    static constexpr std::size_t kLevels = 16;
    static constexpr std::size_t kClasses = 6;

    FilledLight(const Blocks& blocks, const SomeNormals& normals, const Radiances& radiances, double ratio);

    /// Of light in a block, per measure, mean over normals: (L - T)^2 / L, how its spread within a tile counts;
    float spread(HalvedBox block, float light) const;
    /// L - T, what it takes of samples;
    double above(HalvedBox block, double light) const;
    /// and the cost of a cell of such light, over that without a partner (compress/partner.h).
    float cost(HalvedBox block, float light) const;

    /// Normals of similar thresholds, and the threshold for all of a class.
    const std::vector<SomeNormals>& classes() const { return classes_; }
    double threshold(std::size_t of_class) const { return class_threshold_[of_class]; }
    /// All normals, as their light counts.
    const SomeNormals& normals() const { return normals_; }

private:
    using Shares = std::array<float, kLevels>;
    std::size_t cell(HalvedBox block) const;

    const Blocks& blocks_;
    SomeNormals normals_;
    std::array<float, kLevels> level_{};
    std::vector<Shares> shares_; ///< of levels, in each cell of a few blocks
    std::vector<SomeNormals> classes_;
    std::vector<double> class_threshold_;
};

/// What is below tiles beside a partner.
class FilledCosts final : public HalvedCosts {
public:
    /// Both must outlive it.
    FilledCosts(const Blocks& blocks, const SharedLight& shared, const FilledLight& light);

    float cost(HalvedBox box) const override;
    double alone(HalvedBox box) const override { return shared_.costs().alone(box); }
    double least_square() const override { return 1.0; }
    /// The samples that a cell takes: some of all light, for points without a normal.
    double weight(HalvedBox box) const override;

private:
    double radiance(HalvedBox box) const { return shared_.alone(box) / axes().measure(box); }

    const Blocks& blocks_;
    const SharedLight& shared_;
    const FilledLight& light_;
};

} // namespace acdf::compress
