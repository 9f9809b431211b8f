// Rows of normals or views that are mixed for a block of calls. Compiled once for each set of instructions, as
// vectors-inl.h.
#if defined(ACDF_BATCH_MIXTURES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ACDF_BATCH_MIXTURES_INL_H
#undef ACDF_BATCH_MIXTURES_INL_H
#else
#define ACDF_BATCH_MIXTURES_INL_H
#endif

#include "batch/conditions.h"
#include "batch/rows.h"
#include "batch/vectors-inl.h"

#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace acdf {
namespace batch {
namespace HWY_NAMESPACE {
#if !ACDF_BATCH_SINGLY

// Each normal or view serves calls that follow one another.
struct Mixtures {
    HWY_ALIGN float vectors[3 * kBlock];
    HWY_ALIGN std::uint32_t row[ACDF_MOST_ROWS_MIXED][kBlock]; // until they are known, bins
    HWY_ALIGN double weight[ACDF_MOST_ROWS_MIXED][kBlock];     // 0 where there are fewer
    bool served[kBlock];                                       // whether rows serve it; else some row, for nothing
    std::uint8_t of[kBlock];                                   // which serves a call

    // Takes the normals or views of calls from `first` on. Returns how many they are.
    std::size_t take(const float* given, std::size_t each, std::size_t first, std::size_t count) {
        const std::size_t conditions = number_conditions(first, count, each, of);
        std::memcpy(vectors, given + 3 * (first / each), 3 * conditions * sizeof(float));
        std::memset(vectors + 3 * conditions, 0,
                    3 * (kBlock - conditions) * sizeof(float)); // they fill the last vector
        return conditions;
    }
    const float* vector_of(std::size_t call) const { return vectors + 3 * std::size_t{of[call]}; }
    bool serves(std::size_t call) const { return served[of[call]]; }

    // Reads the bins of a condition: of those that weigh something their rows. `stored` becomes false where one has
    // none. Weights become those of rows; without any, one row serves for nothing.
    template <int most>
    void take_rows(const AcdfBin* bins, std::size_t i, bool valid) {
        bool counts[most], stored = valid, any = false;
        std::uint32_t some = 0;
        for (int k = 0; k < most; ++k) {
            const AcdfBin& bin = bins[row[k][i]];
            const bool near = weight[k][i] > 0.0;
            weight[k][i] = near ? weight[k][i] * static_cast<double>(bin.share) : 0.0;
            counts[k] = weight[k][i] > 0.0;
            stored &= !near || bin.root != ACDF_NO_ROOT;
            row[k][i] = bin.root;
            any |= counts[k];
            if (counts[k]) some = bin.root;
        }
        served[i] = any && stored;
        for (int k = 0; k < most; ++k) {
            if (!counts[k] || !stored) row[k][i] = stored ? some : 0;
            if (!served[i]) weight[k][i] = k == 0 ? 1.0 : 0.0;
        }
    }
};

// acdf_whole_weights of those that are > 0.
template <int most>
void make_whole(std::size_t count, Mixtures& mixtures) {
    for (std::size_t i = 0; i < count; i += hn::Lanes(Doubles())) {
        const auto weight = [&mixtures, i](int k) { return mixtures.weight[k] + i; };
        Double sum = set(0.0), largest = set(0.0), number = set(0.0), left = set(ACDF_WEIGHTS);
        for (int k = 0; k < most; ++k) {
            const Double x = hn::Load(Doubles(), weight(k));
            const auto larger = hn::Gt(x, largest);
            sum = hn::Add(sum, x);
            largest = hn::IfThenElse(larger, x, largest);
            number = hn::IfThenElse(larger, set(k), number);
        }
        for (int k = 0; k < most; ++k) {
            const Double x = hn::Load(Doubles(), weight(k));
            const Double rounded = hn::Floor(hn::Add(hn::Mul(hn::Div(x, sum), set(ACDF_WEIGHTS)), set(0.5)));
            const Double whole = hn::IfThenElseZero(hn::Gt(x, set(0.0)), hn::Max(rounded, set(1.0)));
            left = hn::Sub(left, whole);
            hn::Store(whole, Doubles(), weight(k));
        }
        for (int k = 0; k < most; ++k) {
            const Double own = hn::IfThenElseZero(hn::Eq(number, set(k)), left);
            hn::Store(hn::Add(hn::Load(Doubles(), weight(k)), own), Doubles(), weight(k));
        }
    }
}

// Sets the rows of each call.
template <int most>
void set_rows(const AcdfNormalRows* rows, const Mixtures& mixtures, std::size_t count, Tiles& tiles) {
    for (std::size_t i = 0; i < count; ++i)
        for (int k = 0; k < most; ++k) {
            const std::uint32_t row = mixtures.row[k][mixtures.of[i]];
            tiles.set(i, k, row_ends(rows, row), acdf_row_before(rows, row), mixtures.weight[k][mixtures.of[i]]);
        }
}

#endif
} // namespace HWY_NAMESPACE
} // namespace batch
} // namespace acdf
HWY_AFTER_NAMESPACE();

#endif
