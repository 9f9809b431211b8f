#include "compress/moving/sums.h"

#include "compress/moving/kernels.h"
#include "compress/row_nodes.h"
#include "compress/sum.h"

#include <algorithm>
#include <cmath>

namespace acdf::compress {
namespace {

constexpr std::size_t kLine = 16; // floats of a line of the cache
/// Texels of maps whose tables have all levels. Of larger ones, which would not stay in the cache, what is smaller
/// than two texels by two is added when it is asked for.
constexpr std::size_t kWhole = std::size_t{1} << 20;
constexpr std::uint32_t kTogether = 512; // columns whose squares are made before those of the next
constexpr std::uint32_t kBlocks = 64;    // that rows are divided into, each of which is added up by one thread

std::size_t lines(std::size_t floats) { return (floats + kLine - 1) / kLine * kLine; }

/// Makes the largest light lie in [2^30, 2^46): no square overflows, and few are lost. A power of two, in steps of
/// 2^16, so that a frame that is a little brighter has the same.
float unit_for(float largest) {
    int exponent = 0;
    std::frexp(largest, &exponent);
    const int step = 16 * ((exponent + 1024) / 16) - 1024;
    return std::ldexp(1.0f, std::clamp(31 - step, -126, 126));
}

} // namespace

struct MovingSums::RowForm {
    std::int64_t row = -2;
    std::vector<float> even, middle, odd, square, lit;

    RowArrays arrays() { return {even.data(), middle.data(), odd.data(), square.data(), lit.data()}; }
};

struct MovingSums::Scratch {
    std::vector<RowForm> forms; ///< three a plane
    std::vector<float> squares;
};

MovingSums::MovingSums(const MovingShape& shape)
    : shape_(shape), row_measure_(empty_target(shape.columns, shape.rows, shape.parameterization).row_measure),
      column_measure_(empty_target(shape.columns, 1, shape.parameterization).column_measure), rows_(row_measure_),
      columns_(column_measure_),
      whole_(std::size_t{shape.columns} * shape.rows <= kWhole), table_end_{whole_ ? 2 * rows_.end() : rows_.end(),
                                                                            whole_ ? 2 * columns_.end()
                                                                                   : columns_.end()},
      pitch_(lines(kBefore + shape.columns + 1)), stride_(lines(table_end_[1]) + kLine),
      square_pitch_(lines(shape.columns)),
      light_(new float[shape.planes * (shape.rows + std::size_t{2}) * pitch_]()),
      squares_(new float[shape.rows * square_pitch_]()), table_(new float[table_end_[0] * stride_]()),
      row_sums_(std::size_t{shape.planes} * shape.rows), row_peaks_(shape.rows), dirty_(rows_.end() / 2) {
    if (!shape.bilinear) return;
    for (std::uint32_t r = 0; r < shape.rows; ++r) {
        std::array<double, 5> squares{};
        std::array<double, 3> means{};
        for (const RowNode& node : row_nodes(shape.parameterization == ACDF_PARAM_OCTAHEDRAL, shape.rows, r)) {
            const bool upper = node.height < 0.5;
            const double below = upper ? node.height + 0.5 : node.height - 0.5, above = 1.0 - below;
            const std::size_t first = upper ? 0 : 2;
            squares[first] += node.weight * above * above;
            squares[first + 1] += node.weight * 2.0 * above * below;
            squares[first + 2] += node.weight * below * below;
            means[upper ? 0 : 1] += node.weight * above;
            means[upper ? 1 : 2] += node.weight * below;
        }
        std::array<float, 5> shares;
        for (std::size_t k = 0; k < 5; ++k)
            shares[k] = static_cast<float>(squares[k] * row_measure_[r] * column_measure_[0] / 12.0);
        square_shares_.push_back(shares);
        mean_shares_.push_back(means);
    }
}

MovingSums::~MovingSums() = default;

// ---- light ----

void MovingSums::take_row(std::uint32_t r) {
    row_peaks_[r] = 0.0f;
    for (std::size_t plane = 0; plane < shape_.planes; ++plane) {
        const Stretch all = stretch_of(row(plane, r), shape_.columns);
        row_sums_[plane * shape_.rows + r] = all.sum;
        row_peaks_[r] = std::max(row_peaks_[r], all.largest);
    }
}

void MovingSums::fill_row_ends(std::size_t plane, std::uint32_t r) {
    float* values = row(plane, r);
    const std::size_t columns = shape_.columns;
    if (shape_.parameterization == ACDF_PARAM_OCTAHEDRAL) {
        const float* other = row(plane, shape_.rows - 1 - r);
        values[-1] = other[0];
        values[columns] = other[columns - 1];
        return;
    }
    values[-1] = values[columns - 1];
    values[columns] = values[0];
}

/// Across a side of the octahedral square lies the texel that mirrors it at the middle of the side.
void MovingSums::fill_outside_rows() {
    const std::size_t columns = shape_.columns;
    const std::uint32_t last = shape_.rows - 1;
    for (std::size_t plane = 0; plane < shape_.planes; ++plane)
        for (const bool foot : {false, true}) {
            float* out = light_at(plane, foot ? std::int64_t{shape_.rows} : -1);
            const float* inside = row(plane, foot ? last : 0);
            const float* other = row(plane, foot ? 0 : last);
            if (shape_.parameterization != ACDF_PARAM_OCTAHEDRAL) {
                std::copy_n((shape_.repeats ? other : inside) - 1, columns + 2, out - 1);
                continue;
            }
            std::reverse_copy(inside, inside + columns, out);
            out[-1] = other[columns - 1];
            out[columns] = other[0];
        }
}

/// Mean of a row over its columns, times their number.
double MovingSums::mean_of_row(std::size_t plane, std::int64_t r) {
    const std::int64_t last = std::int64_t{shape_.rows} - 1;
    std::int64_t of = std::clamp(r, std::int64_t{0}, last);
    if (of != r && shape_.repeats) of = last - of;
    const float* values = light_at(plane, r);
    const std::size_t columns = shape_.columns;
    const double ends =
        double{values[-1]} - double{values[columns - 1]} + double{values[columns]} - double{values[0]};
    return row_sums_[plane * shape_.rows + static_cast<std::size_t>(of)] + 0.125 * ends;
}

void MovingSums::add_totals() {
    total_ = mean_square_ = 0.0;
    for (std::size_t plane = 0; plane < shape_.planes; ++plane) {
        Sum sum;
        for (std::uint32_t r = 0; r < shape_.rows; ++r) {
            double mean = row_sums_[plane * shape_.rows + r];
            if (shape_.bilinear) {
                mean = 0.0;
                for (std::size_t k = 0; k < 3; ++k)
                    mean += mean_shares_[r][k] * mean_of_row(plane, std::int64_t{r} + std::int64_t(k) - 1);
            }
            sum.add(mean * row_measure_[r]);
        }
        const double of_plane = sum.value() * column_measure_[0];
        total_ += of_plane;
        mean_square_ += of_plane * of_plane;
    }
}

// ---- which sums are made again ----

void MovingSums::mark(std::uint32_t first, std::uint32_t last) {
    for (std::uint32_t i = 0; i < dirty_.size(); ++i)
        if (rows_.border(i) < last && rows_.border(i + 1) > first) dirty_[i] = 1;
}

void MovingSums::mark_depending(std::uint32_t first, std::uint32_t last) {
    if (!shape_.bilinear) return mark(first, last);
    first = first > 0 ? first - 1 : 0;
    last = std::min(last + 1, shape_.rows);
    mark(first, last);
    if (shape_.parameterization == ACDF_PARAM_OCTAHEDRAL) mark(shape_.rows - last, shape_.rows - first);
    if (!shape_.repeats) return;
    if (first == 0) mark(shape_.rows - 1, shape_.rows);
    if (last == shape_.rows) mark(0, 1);
}

void MovingSums::make(const Loop& loop, std::uint32_t first, std::uint32_t last) {
    largest_ = *std::max_element(row_peaks_.begin(), row_peaks_.end());
    if (shape_.bilinear) {
        for (std::size_t plane = 0; plane < shape_.planes; ++plane)
            for (std::uint32_t r = 0; r < shape_.rows; ++r) fill_row_ends(plane, r);
        fill_outside_rows();
    }
    add_totals();
    if (!(largest_ > 0.0f) || !std::isfinite(largest_)) {
        unit_ = 0.0f; // all are made next time
        return;
    }
    const float unit = unit_for(largest_);
    if (unit == unit_) mark_depending(first, last);
    else mark(0, shape_.rows);
    unit_ = unit;
    while (scratch_.size() < loop.slots()) {
        scratch_.push_back(std::make_unique<Scratch>());
        Scratch& scratch = *scratch_.back();
        scratch.squares.resize(square_pitch_);
        scratch.forms.resize(shape_.bilinear ? 3 * shape_.planes : 0);
        for (RowForm& form : scratch.forms)
            for (auto* of : {&form.even, &form.middle, &form.odd, &form.square, &form.lit}) of->resize(kTogether);
    }
    const std::uint32_t kept = rows_.end() / 2, blocks = std::min(kBlocks, kept), of_block = kept / blocks;
    loop.run(blocks, 1, [&](std::size_t begin, std::size_t end, std::size_t slot) {
        for (std::size_t block = begin; block < end; ++block) {
            const auto low = static_cast<std::uint32_t>(block) * of_block;
            square_rows(low, low + of_block, *scratch_[slot]);
            for (std::uint32_t i = low; i < low + of_block; ++i)
                if (dirty_[i]) make_kept_row(i, *scratch_[slot]);
            for (std::uint32_t count = of_block / 2, n = (kept + low) / 2; count > 0; count /= 2, n /= 2)
                for (std::uint32_t k = 0; k < count; ++k) add_rows(n + k);
        }
    });
    for (std::uint32_t n = blocks; n-- > 1;) add_rows(n);
    std::fill(dirty_.begin(), dirty_.end(), std::uint8_t{0});
}

/// Where anything below a range is new.
void MovingSums::add_rows(std::uint32_t n) {
    const std::uint32_t kept = rows_.end() / 2;
    std::uint32_t first = n, last = n + 1;
    while (first < kept) first *= 2, last *= 2;
    if (std::find(dirty_.begin() + first - kept, dirty_.begin() + last - kept, 1) == dirty_.begin() + last - kept)
        return;
    add_rows_of(table(2 * n), table(2 * n + 1), table_end_[1], table_.get() + n * stride_);
}

// ---- squares ----

void MovingSums::make_kept_row(std::uint32_t i, Scratch& scratch) {
    const std::uint32_t first = rows_.border(i), last = rows_.border(i + 1), n = rows_.end() / 2 + i;
    float* sums = table_.get() + n * stride_;
    const float *upper = squares_.get() + first * square_pitch_, *lower = upper + square_pitch_;
    if (last - first == 1) return add_columns(upper, sums);
    if (whole_) {
        add_columns(upper, sums + n * stride_);
        add_columns(lower, sums + (n + 1) * stride_);
        return add_rows_of(sums + n * stride_, sums + (n + 1) * stride_, table_end_[1], sums);
    }
    add_rows_of(upper, lower, shape_.columns, scratch.squares.data());
    add_columns(scratch.squares.data(), sums);
}

/// All ranges of columns, of the squares of a row.
void MovingSums::add_columns(const float* squares, float* sums) {
    const std::uint32_t kept = columns_.end() / 2;
    if (2 * kept == shape_.columns) {
        halve_row(squares, kept, sums + kept);
        if (whole_) std::copy_n(squares, shape_.columns, sums + 2 * kept);
    } else
        for (std::uint32_t k = 0; k < kept; ++k) {
            const std::uint32_t c = columns_.border(k);
            const bool two = columns_.border(k + 1) - c == 2;
            sums[kept + k] = two ? squares[c] + squares[c + 1] : squares[c];
            if (!two || !whole_) continue;
            sums[2 * (kept + k)] = squares[c];
            sums[2 * (kept + k) + 1] = squares[c + 1];
        }
    add_pairs(sums, kept);
}

/// Of ranges [low, high) of rows. A stretch of columns after the other: what rows share stays in the nearest cache.
void MovingSums::square_rows(std::uint32_t low, std::uint32_t high, Scratch& scratch) {
    for (std::uint32_t begin = 0; begin < shape_.columns; begin += kTogether) {
        const Columns columns{begin, std::min(kTogether, shape_.columns - begin)};
        for (RowForm& form : scratch.forms) form.row = -2;
        for (std::uint32_t i = low; i < high; ++i)
            for (std::uint32_t r = rows_.border(i); dirty_[i] && r < rows_.border(i + 1); ++r)
                square_row(r, columns, scratch);
    }
}

void MovingSums::square_row(std::uint32_t r, Columns columns, Scratch& scratch) {
    float* out = squares_.get() + r * square_pitch_ + columns.begin;
    std::fill_n(out, columns.count, 0.0f);
    for (std::size_t plane = 0; plane < shape_.planes; ++plane)
        if (shape_.bilinear) {
            const std::int64_t row = r;
            add_bilinear_squares(form_of(plane, row - 1, columns, scratch), form_of(plane, row, columns, scratch),
                                 form_of(plane, row + 1, columns, scratch), square_shares_[r].data(), columns.count,
                                 out);
        } else
            add_squares(row(plane, r) + columns.begin, columns.count, unit_,
                        static_cast<float>(row_measure_[r] * column_measure_[0]), out);
}

RowArrays MovingSums::form_of(std::size_t plane, std::int64_t r, Columns columns, Scratch& scratch) {
    RowForm& form = scratch.forms[3 * plane + static_cast<std::size_t>((r + 3) % 3)];
    if (form.row != r) form_row(light_at(plane, r) + columns.begin, columns.count, unit_, form.arrays());
    form.row = r;
    return form.arrays();
}

float MovingSums::fine_sum(MovingBox box) const {
    const std::uint32_t begin = columns_.low(box.columns), end = columns_.high(box.columns);
    float sum = 0.0f;
    for (std::size_t r = rows_.low(box.rows); r < rows_.high(box.rows); ++r) {
        const float* squares = squares_.get() + r * square_pitch_;
        for (std::uint32_t c = begin; c < end; ++c) sum += squares[c];
    }
    return sum;
}

} // namespace acdf::compress
