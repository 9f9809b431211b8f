#include "compress/moving/light.h"

#include "compress/halvings/kernels.h"

#include <algorithm>
#include <cmath>

namespace acdf::compress {
namespace {

std::uint8_t kind_of(float v) { return std::isnan(v) ? 1 : std::isinf(v) ? 2 : v < 0.0f ? 3 : 0; }

/// Each texel counts once, as the first kind that it has; false where all are fine.
bool mend(const float* rgb, std::size_t count, float* mended, std::uint8_t* bad) {
    bool any = false;
    for (std::size_t i = 0; i < count; ++i) {
        std::uint8_t first = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const float value = rgb[3 * i + k];
            const std::uint8_t kind = kind_of(value);
            mended[3 * i + k] = kind == 0 ? value : 0.0f;
            if (kind != 0) first = first == 0 ? kind : std::min(first, kind);
        }
        bad[i] = first;
        any = any || first != 0;
    }
    return any;
}

} // namespace

bool take_light(const float* rgb, std::uint32_t x, std::uint32_t r, std::size_t count, const TargetOptions& options,
                MovingSums& sums, std::uint8_t* bad) {
    float mended[3 * kTexelsAtOnce];
    const bool any = may_be_bad(rgb, 3 * count) && mend(rgb, count, mended, bad);
    if (any) rgb = mended;
    float* out = sums.row(0, r) + x;
    if (options.channels == ACDF_CHANNELS_SEPARATE) {
        float *green = sums.row(1, r) + x, *blue = sums.row(2, r) + x;
        for (std::size_t i = 0; i < count; ++i) {
            out[i] = rgb[3 * i];
            green[i] = rgb[3 * i + 1];
            blue[i] = rgb[3 * i + 2];
        }
    } else if (options.channels == ACDF_CHANNELS_LARGEST) {
        for (std::size_t i = 0; i < count; ++i)
            out[i] = std::max(std::max(rgb[3 * i], rgb[3 * i + 1]), rgb[3 * i + 2]);
    } else {
        const float w[3] = {static_cast<float>(options.weights.r), static_cast<float>(options.weights.g),
                            static_cast<float>(options.weights.b)};
        weigh_texels(rgb, count, w, out);
    }
    return any;
}

} // namespace acdf::compress
