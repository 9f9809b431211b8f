// Sums over every box that halving can make of an environment map, made again for each frame in the same memory.
#pragma once

#include "compress/moving/axis.h"
#include "compress/moving/kernels.h"
#include "compress/moving/loop.h"
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

/// A box: the number of a range of rows and of one of columns (MovingAxis).
struct MovingBox {
    std::uint32_t rows = 1, columns = 1;
};

/// The light of a frame, and the integrals of its square. Light is written to row(), row by row and by any number
/// of threads; take_row() follows each row; then make() adds up. The sums are those of all rows, whichever were
/// new.
class MovingSums {
public:
    explicit MovingSums(const MovingShape& shape);
    ~MovingSums();

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
    double total() const { return total_; }             ///< integral of light, of several planes their sum
    double mean_square() const { return mean_square_; } ///< square of the integral, of several planes their sum
    double unit() const { return double{unit_}; }       ///< what light was multiplied with

    const MovingAxis& row_axis() const { return rows_; }
    const MovingAxis& column_axis() const { return columns_; }
    /// Root of a box's measure times the integral of the square of light: positive where there is light.
    float cost(MovingBox box) const {
        return rows_.root(box.rows) * columns_.root(box.columns) * std::sqrt(sum(box));
    }
    float sum(MovingBox box) const {
        return box.rows < table_end_[0] && box.columns < table_end_[1]
                   ? table_[std::size_t{box.rows} * stride_ + box.columns]
                   : fine_sum(box);
    }
    /// Numbers of rows and columns below which sums are in the tables, and all there.
    std::uint32_t complete_rows() const { return std::min(table_end_[0], rows_.complete()); }
    std::uint32_t complete_columns() const { return std::min(table_end_[1], columns_.complete()); }
    /// Sums of boxes of a range of rows.
    const float* table(std::uint32_t rows) const { return table_.get() + std::size_t{rows} * stride_; }

private:
    struct RowForm;
    struct Scratch;
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
    void mark(std::uint32_t first, std::uint32_t last);
    void mark_depending(std::uint32_t first, std::uint32_t last);
    void make_kept_row(std::uint32_t i, Scratch& scratch);
    void add_columns(const float* squares, float* sums);
    void square_rows(std::uint32_t low, std::uint32_t high, Scratch& scratch);
    void square_row(std::uint32_t r, Columns columns, Scratch& scratch);
    RowArrays form_of(std::size_t plane, std::int64_t r, Columns columns, Scratch& scratch);
    void add_rows(std::uint32_t n);
    float fine_sum(MovingBox box) const;

    static constexpr std::size_t kBefore = 16; // floats before a row's first: the one at the other end, and padding

    MovingShape shape_;
    std::vector<double> row_measure_, column_measure_;
    MovingAxis rows_, columns_;
    bool whole_; ///< whether the tables have the last levels, too
    std::uint32_t table_end_[2];
    std::size_t pitch_, stride_, square_pitch_;
    Floats light_, squares_, table_;
    std::vector<double> row_sums_; ///< planes x rows
    std::vector<float> row_peaks_; ///< the largest of a row
    /// Of bilinear lookups: what the squares of the row above, its product with the row, ... count in a row; and
    /// what the three rows count in its mean.
    std::vector<std::array<float, 5>> square_shares_;
    std::vector<std::array<double, 3>> mean_shares_;
    std::vector<std::uint8_t> dirty_; ///< of each range of rows of the last level but one
    std::vector<std::unique_ptr<Scratch>> scratch_;
    float largest_ = 0.0f, unit_ = 0.0f;
    double total_ = 0.0, mean_square_ = 0.0;
};

} // namespace acdf::compress
