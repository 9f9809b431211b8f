#include "compress/halvings/kernels.h"

#include "compress/widths.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace acdf::compress {
namespace {

constexpr float kLeast = std::numeric_limits<float>::min();
constexpr std::size_t kLanes = 16;

} // namespace

ACDF_WIDTHS bool may_be_bad(const float* values, std::size_t count) {
    std::uint32_t signs = 0; // also that of a difference, where the number is larger than any finite one
    for (std::size_t i = 0; i < count; ++i) {
        std::uint32_t bits;
        std::memcpy(&bits, values + i, sizeof bits);
        signs |= bits | (0x7F7FFFFFu - bits);
    }
    return signs >> 31 != 0;
}

ACDF_WIDTHS void weigh_texels(const float* rgb, std::size_t count, const float w[3], float* out) {
    const float wr = w[0], wg = w[1], wb = w[2];
    for (std::size_t i = 0; i < count; ++i) out[i] = wr * rgb[3 * i] + wg * rgb[3 * i + 1] + wb * rgb[3 * i + 2];
}

ACDF_WIDTHS Stretch stretch_of(const float* values, std::size_t count) {
    constexpr std::size_t kTogether = 256;
    Stretch out;
    float peak[kLanes] = {};
    std::size_t i = 0;
    while (i + kLanes <= count) {
        float sum[kLanes] = {};
        const std::size_t end = std::min(i + kTogether, count / kLanes * kLanes);
        for (; i < end; i += kLanes)
            for (std::size_t k = 0; k < kLanes; ++k) {
                sum[k] += values[i + k];
                peak[k] = values[i + k] > peak[k] ? values[i + k] : peak[k];
            }
        for (const float s : sum) out.sum += double{s};
    }
    for (; i < count; ++i) {
        out.sum += double{values[i]};
        out.largest = std::max(out.largest, values[i]);
    }
    for (const float p : peak) out.largest = std::max(out.largest, p);
    return out;
}

ACDF_WIDTHS void add_rows_of(const float* a, const float* b, std::size_t count, float* out) {
    for (std::size_t i = 0; i < count; ++i) out[i] = a[i] + b[i];
}

ACDF_WIDTHS void halve_row(const float* pairs, std::size_t count, float* out) {
    for (std::size_t i = 0; i < count; ++i) out[i] = pairs[2 * i] + pairs[2 * i + 1];
}

void add_pairs(float* heap, std::uint32_t leaves) {
    for (std::size_t count = leaves / 2; count > 0; count /= 2) halve_row(heap + 2 * count, count, heap + count);
}

ACDF_WIDTHS void add_squares(const float* light, std::size_t count, float unit, float measure, float* out) {
    for (std::size_t i = 0; i < count; ++i) {
        const float scaled = light[i] * unit, square = out[i] + scaled * scaled * measure;
        const float least = light[i] > 0.0f ? kLeast : 0.0f;
        out[i] = square > least ? square : least;
    }
}

ACDF_WIDTHS void squares_of(const float* values, const float* measure, std::size_t count, float unit,
                            float row_measure, float* out) {
    for (std::size_t i = 0; i < count; ++i) {
        const float scaled = values[i] * unit, square = scaled * scaled * (row_measure * measure[i]);
        const float least = values[i] > 0.0f ? kLeast : 0.0f;
        out[i] = square > least ? square : least;
    }
}

ACDF_WIDTHS void form_row(const float* light, std::size_t count, float unit, const RowArrays& out) {
    float *even = out.even, *middle = out.middle, *odd = out.odd, *square = out.square, *lit = out.lit;
    for (std::size_t c = 0; c < count; ++c) {
        const float before = light[c - 1], own = light[c], behind = light[c + 1];
        const float left = before * unit, centre = own * unit, right = behind * unit;
        const float e = 0.5f * (left + right) + 2.0f * centre, m = 1.7320508f * centre, o = 0.5f * (right - left);
        even[c] = e;
        middle[c] = m;
        odd[c] = o;
        square[c] = e * e + m * m + o * o;
        const float larger = before > behind ? before : behind;
        lit[c] = own > larger ? own : larger;
    }
}

ACDF_WIDTHS void add_bilinear_squares(const RowArrays& above, const RowArrays& own, const RowArrays& below,
                                      const float shares[5], std::size_t count, float* out) {
    const float share[5] = {shares[0], shares[1], shares[2], shares[3], shares[4]};
    const float *ae = above.even, *am = above.middle, *ao = above.odd, *as = above.square, *al = above.lit;
    const float *oe = own.even, *om = own.middle, *oo = own.odd, *os = own.square, *ol = own.lit;
    const float *be = below.even, *bm = below.middle, *bo = below.odd, *bs = below.square, *bl = below.lit;
    for (std::size_t c = 0; c < count; ++c) {
        const float with_above = oe[c] * ae[c] + om[c] * am[c] + oo[c] * ao[c];
        const float with_below = oe[c] * be[c] + om[c] * bm[c] + oo[c] * bo[c];
        const float square = share[0] * as[c] + share[1] * with_above + share[2] * os[c] + share[3] * with_below +
                             share[4] * bs[c] + out[c];
        float lit = al[c] > bl[c] ? al[c] : bl[c];
        lit = ol[c] > lit ? ol[c] : lit;
        const float least = lit > 0.0f ? kLeast : 0.0f;
        out[c] = square > least ? square : least;
    }
}

} // namespace acdf::compress
