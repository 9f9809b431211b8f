// Sums over every box that halving can make of an environment map, made again for each frame in the same memory.
#pragma once

#include "compress/halvings/costs.h"
#include "compress/halvings/kernels.h"
#include "compress/target.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace acdf::compress {

/// What a MovingSums is made for.
struct MovingShape {
    std::uint32_t columns = 1, rows = 1;
    AcdfParameterization parameterization = ACDF_PARAM_LATLONG;
    std::uint32_t planes = 1; ///< channels that count, each on its own
    bool bilinear = false;
    bool repeats = false; ///< beyond the first row is the last one: of bilinear lookups of lat-long maps
};

/// The light of a frame, and the integrals of its square. Light is written to row(), row by row and by any number
/// of threads; take_row() follows each row; then make() adds up. The sums are those of all rows, whichever were
/// new.
class MovingSums final : public HalvedCosts {
public:
    explicit MovingSums(const MovingShape& shape);
    ~MovingSums() override;

    const MovingShape& shape() const { return shape_; }
    /// The light of a row: finite and not negative.
    float* row(std::size_t plane, std::uint32_t r) { return light_at(plane, std::int64_t{r}); }
    /// To be called once the row's light is there.
    void take_row(std::uint32_t r);
    /// Adds up what depends on rows [first, last), the only ones that are new since the last call.
    void make(const Loop& loop, std::uint32_t first, std::uint32_t last);
    void make_all(const Loop& loop) {
        unit_ = 0.0f;
        make(loop, 0, shape_.rows);
    }

    /// The largest light; infinity where a row has any.
    float largest() const { return largest_; }
    double total() const { return total_; } ///< integral of light, of several planes their sum

    float cost(HalvedBox box) const override { return of_square(box, table_.at(box)); }
    const HalvedTable* squares() const override { return &table_; }
    double least_square() const override { return mean_square_ * double{unit_} * double{unit_}; }

private:
    struct RowForm;
    struct Scratch;
    struct Squares final : HalvedRows {
        explicit Squares(MovingSums& sums) : sums(sums) {}
        const float* read(std::uint32_t row, std::uint32_t begin, std::uint32_t, float*) const override {
            return sums.squares_.get() + row * sums.square_pitch_ + begin;
        }
        void prepare(std::uint32_t first, std::uint32_t last, std::size_t slot) override {
            sums.square_rows(first, last, slot);
        }
        MovingSums& sums;
    };
    struct Columns {
        std::uint32_t begin, count;
    };
    using Floats = std::unique_ptr<float[]>;

    float* light_at(std::size_t plane, std::int64_t r) {
        return light_.get() + (plane * (shape_.rows + std::size_t{2}) + static_cast<std::size_t>(r + 1)) * pitch_ +
               kBefore;
    }
    void fill_row_ends(std::size_t plane, std::uint32_t r);
    void fill_outside_rows();
    void add_totals();
    double mean_of_row(std::size_t plane, std::int64_t r);
    void mark_depending(std::uint32_t first, std::uint32_t last);
    void square_rows(std::uint32_t first, std::uint32_t last, std::size_t slot);
    void square_row(std::uint32_t r, Columns columns, Scratch& scratch);
    RowArrays form_of(std::size_t plane, std::int64_t r, Columns columns, Scratch& scratch);

    static constexpr std::size_t kBefore = 16; // floats before a row's first: the one at the other end, and padding

    MovingShape shape_;
    std::vector<double> row_measure_, column_measure_;
    const HalvedAxes axes_;
    std::size_t pitch_, square_pitch_;
    Floats light_, squares_;
    Squares square_rows_{*this};
    HalvedTable table_;
    std::vector<double> row_sums_; ///< planes x rows
    std::vector<float> row_peaks_; ///< the largest of a row
    /// Of bilinear lookups: what the squares of the row above, its product with the row, ... count in a row; and
    /// what the three rows count in its mean.
    std::vector<std::array<float, 5>> square_shares_;
    std::vector<std::array<double, 3>> mean_shares_;
    std::vector<std::unique_ptr<Scratch>> scratch_;
    float largest_ = 0.0f, unit_ = 0.0f;
    double total_ = 0.0, mean_square_ = 0.0;
};

} // namespace acdf::compress
