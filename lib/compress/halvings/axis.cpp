#include "compress/halvings/axis.h"

namespace acdf::compress {

HalvedAxis::HalvedAxis(const std::vector<double>& measure) {
    const auto steps = static_cast<std::uint32_t>(measure.size());
    while ((std::uint64_t{1} << levels_) < steps) ++levels_;
    borders_.push_back({0, steps});
    for (std::uint32_t level = 1; level < levels_; ++level) {
        const std::vector<std::uint32_t>& above = borders_.back();
        std::vector<std::uint32_t> borders{0};
        for (std::size_t i = 0; i + 1 < above.size(); ++i) {
            borders.push_back(above[i] + (above[i + 1] - above[i]) / 2);
            borders.push_back(above[i + 1]);
        }
        borders_.push_back(std::move(borders));
    }
    if (levels_ > 0) {
        std::vector<std::uint32_t> borders(steps + 1);
        for (std::uint32_t i = 0; i <= steps; ++i) borders[i] = i;
        borders_.push_back(std::move(borders));
    }
    measures_.resize(levels_ + 1);
    measures_[levels_] = measure;
    for (std::uint32_t level = levels_; level-- > 0;) {
        for (std::uint32_t i = 0; i < count(level); ++i) {
            const std::uint32_t below = lower(level, i);
            measures_[level].push_back(can_halve(level, i)
                                           ? measures_[level + 1][below] + measures_[level + 1][below + 1]
                                           : measures_[level + 1][below]);
        }
    }
}

} // namespace acdf::compress
