// Loops over the numbers of a row. Compilers make vectors of them, of the width that the processor has; all widths
// give the same bits, for each number is made by the same operations.
#pragma once

#include <cstddef>
#include <cstdint>

namespace acdf::compress {

/// Of the cache.
constexpr std::size_t kFloatsOfLine = 16;
constexpr std::size_t whole_lines(std::size_t floats) {
    return (floats + kFloatsOfLine - 1) / kFloatsOfLine * kFloatsOfLine;
}

/// Whether any value may be NaN, infinite or negative (-0 among them).
bool may_be_bad(const float* values, std::size_t count);
/// out[i] = w[0] rgb[3 i] + w[1] rgb[3 i + 1] + w[2] rgb[3 i + 2].
void weigh_texels(const float* rgb, std::size_t count, const float w[3], float* out);

/// Sum and maximum of values that are not negative.
struct Stretch {
    double sum = 0.0;
    float largest = 0.0f;
};
Stretch stretch_of(const float* values, std::size_t count);

/// out = a + b.
void add_rows_of(const float* a, const float* b, std::size_t count, float* out);
/// Of a heap whose numbers from `leaves`, a power of two, to 2 `leaves` - 1 are there, the others: sums of two.
void add_pairs(float* heap, std::uint32_t leaves);
/// out[i] = pairs[2 i] + pairs[2 i + 1].
void halve_row(const float* pairs, std::size_t count, float* out);

/// Adds to `out` the squares of light, times `unit`, times `measure`; at least the smallest normal number where
/// there is light.
void add_squares(const float* light, std::size_t count, float unit, float measure, float* out);

/// out[i] = (values[i] unit)^2 row_measure measure[i]; at least the smallest normal number where there is a value.
void squares_of(const float* values, const float* measure, std::size_t count, float unit, float row_measure,
                float* out);

/// A row as bilinear lookups see it. Within a texel the row is linear from the middle c to both sides, so that the
/// mean over the texel of the product of two rows is the scalar product of three numbers of each. With s the mean
/// of both neighbours and d half their difference: ((s + 2c)(s' + 2c') + 3cc' + dd') / 12.
struct RowArrays {
    float *even, *middle, *odd;
    float* square; ///< of the row itself
    float* lit;    ///< the largest of a texel and its neighbours: positive where there is any light
};
/// light[-1] and light[count] are there.
void form_row(const float* light, std::size_t count, float unit, const RowArrays& out);
/// As add_squares, of bilinear lookups: shares are those of the square of the row above, its product with the row,
/// the row's square, its product with the row below, and the square of that.
void add_bilinear_squares(const RowArrays& above, const RowArrays& own, const RowArrays& below,
                          const float shares[5], std::size_t count, float* out);

} // namespace acdf::compress
