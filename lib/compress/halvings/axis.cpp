#include "compress/halvings/axis.h"

#include <cmath>

namespace acdf::compress {

HalvedAxis::HalvedAxis(const std::vector<double>& measure) {
    const auto steps = static_cast<std::uint32_t>(measure.size());
    borders_ = {0, steps};
    while (end_ < steps) {
        std::vector<std::uint32_t> halved{0};
        for (std::size_t i = 0; i + 1 < borders_.size(); ++i) {
            halved.push_back(borders_[i] + (borders_[i + 1] - borders_[i]) / 2);
            halved.push_back(borders_[i + 1]);
        }
        borders_ = std::move(halved);
        end_ *= 2;
    }
    std::vector<double> of(std::size_t{2} * end_, 0.0);
    steps_.resize(of.size());
    for (std::uint32_t i = 0; i < end_ / 2; ++i) {
        const std::uint32_t n = end_ / 2 + i;
        for (std::uint32_t step = borders_[i]; step < borders_[i + 1]; ++step) {
            of[n] += measure[step];
            if (!can_halve(n)) continue;
            of[2 * n + step - borders_[i]] = measure[step];
            steps_[2 * n + step - borders_[i]] = {step, step + 1};
        }
        steps_[n] = {borders_[i], borders_[i + 1]};
    }
    for (std::uint32_t n = end_ / 2; n-- > 1;) {
        of[n] = of[2 * n] + of[2 * n + 1];
        steps_[n] = {steps_[2 * n].low, steps_[2 * n + 1].high};
    }
    for (const double m : of) roots_.push_back(static_cast<float>(std::sqrt(m)));
}

} // namespace acdf::compress
