#include "build/probe/bad_texels.h"

#include "compress/threads.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace acdf::build {
namespace {

/// Of a part of the image.
struct Found {
    std::uint64_t nan = 0, infinite = 0, negative = 0;
    std::size_t first = SIZE_MAX;       // texel index
    Channels largest{0.0f, 0.0f, 0.0f}; // finite value of each channel

    Found& join(const Found& o) {
        nan += o.nan;
        infinite += o.infinite;
        negative += o.negative;
        first = std::min(first, o.first);
        for (std::size_t k = 0; k < 3; ++k) largest[k] = std::max(largest[k], o.largest[k]);
        return *this;
    }
};

bool is_radiance(float value) { return value >= 0.0f && std::isfinite(value); }

Found look_at(const float* rgb, std::size_t begin, std::size_t end, Found found) {
    for (std::size_t i = begin; i < end; ++i) {
        bool nan = false, infinite = false, negative = false;
        for (std::size_t k = 0; k < 3; ++k) {
            const float v = rgb[3 * i + k];
            if (is_radiance(v)) found.largest[k] = std::max(found.largest[k], v);
            else if (std::isnan(v)) nan = true;
            else if (std::isinf(v)) infinite = true;
            else negative = true;
        }
        if (!nan && !infinite && !negative) continue;
        ++(nan ? found.nan : infinite ? found.infinite : found.negative);
        found.first = std::min(found.first, i);
    }
    return found;
}

Found look_at_all(const float* rgb, std::size_t texels, int threads) {
    Found found;
    compress::with_threads(threads, [&] {
        found = tbb::parallel_reduce(
            tbb::blocked_range<std::size_t>(0, texels, std::size_t{1} << 16), Found{},
            [&](const tbb::blocked_range<std::size_t>& range, const Found& sum) {
                return look_at(rgb, range.begin(), range.end(), sum);
            },
            [](Found a, const Found& b) { return a.join(b); });
    });
    return found;
}

void replace(float* rgb, std::size_t texels, const Channels& for_infinity) {
    for (std::size_t i = 0; i < 3 * texels; ++i) {
        if (is_radiance(rgb[i])) continue;
        rgb[i] = std::isinf(rgb[i]) && rgb[i] > 0.0f ? for_infinity[i % 3] : 0.0f;
    }
}

} // namespace

Channels largest_radiance(const float* rgb, std::size_t count, int threads) {
    return look_at_all(rgb, count, threads).largest;
}

void repair_texels(float* rgb, int width, int first, int rows, BadPixels policy, int threads, BadTexels& bad,
                   const Channels* largest) {
    const std::size_t row = static_cast<std::size_t>(width), texels = row * static_cast<std::size_t>(rows);
    const Found found = look_at_all(rgb, texels, threads);
    if (found.first == SIZE_MAX) return;
    if (bad.count() == 0) {
        bad.x = static_cast<int>(found.first % row);
        bad.y = first + static_cast<int>(found.first / row);
    }
    bad.nan += found.nan;
    bad.infinite += found.infinite;
    bad.negative += found.negative;
    const Channels& clamped = largest ? *largest : found.largest;
    replace(rgb, texels, policy == BadPixels::clamp ? clamped : Channels{0.0f, 0.0f, 0.0f});
}

std::string text(const BadTexels& bad) {
    return std::to_string(bad.nan) + " NaN, " + std::to_string(bad.infinite) + " infinite and " +
           std::to_string(bad.negative) + " negative texels, the first at " + std::to_string(bad.x) + "," +
           std::to_string(bad.y);
}

} // namespace acdf::build
