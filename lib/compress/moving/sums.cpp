#include "compress/moving/sums.h"

#include "compress/halvings/sums.h"
#include "compress/row_nodes.h"
#include "compress/sum.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace acdf::compress {
namespace {

constexpr std::uint32_t kColumnsTogether = 512; // columns whose squares are made before those of the next

} // namespace

struct MovingSums::RowForm {
    std::int64_t row = -2;
    std::vector<float> even, middle, odd, square, lit;

    RowArrays arrays() { return {even.data(), middle.data(), odd.data(), square.data(), lit.data()}; }
};

struct MovingSums::Scratch {
    std::vector<RowForm> forms; ///< three a plane
};

MovingSums::MovingSums(const MovingShape& shape)
    : HalvedCosts(axes_), shape_(shape),
      row_measure_(empty_target(shape.columns, shape.rows, shape.parameterization).row_measure),
      column_measure_(empty_target(shape.columns, 1, shape.parameterization).column_measure),
      axes_{HalvedAxis(row_measure_), HalvedAxis(column_measure_)},
      pitch_(whole_lines(kBefore + shape.columns + 1)), square_pitch_(whole_lines(shape.columns)),
      light_(new float[shape.planes * (shape.rows + std::size_t{2}) * pitch_]()),
      squares_(new float[shape.rows * square_pitch_]()),
      table_(axes_, square_rows_, std::numeric_limits<std::size_t>::max()),
      row_sums_(std::size_t{shape.planes} * shape.rows), row_peaks_(shape.rows) {
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

void MovingSums::mark_depending(std::uint32_t first, std::uint32_t last) {
    if (!shape_.bilinear) return table_.mark(first, last);
    first = first > 0 ? first - 1 : 0;
    last = std::min(last + 1, shape_.rows);
    table_.mark(first, last);
    if (shape_.parameterization == ACDF_PARAM_OCTAHEDRAL) table_.mark(shape_.rows - last, shape_.rows - first);
    if (!shape_.repeats) return;
    if (first == 0) table_.mark(shape_.rows - 1, shape_.rows);
    if (last == shape_.rows) table_.mark(0, 1);
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
    else table_.mark(0, shape_.rows);
    unit_ = unit;
    while (scratch_.size() < loop.slots()) {
        scratch_.push_back(std::make_unique<Scratch>());
        Scratch& scratch = *scratch_.back();
        scratch.forms.resize(shape_.bilinear ? 3 * shape_.planes : 0);
        for (RowForm& form : scratch.forms)
            for (auto* of : {&form.even, &form.middle, &form.odd, &form.square, &form.lit})
                of->resize(kColumnsTogether);
    }
    table_.make(loop);
}

// ---- squares ----

/// A stretch of columns after the other: what rows share stays in the nearest cache.
void MovingSums::square_rows(std::uint32_t first, std::uint32_t last, std::size_t slot) {
    Scratch& scratch = *scratch_[slot];
    for (std::uint32_t begin = 0; begin < shape_.columns; begin += kColumnsTogether) {
        const Columns columns{begin, std::min(kColumnsTogether, shape_.columns - begin)};
        for (RowForm& form : scratch.forms) form.row = -2;
        for (std::uint32_t r = first; r < last; ++r) square_row(r, columns, scratch);
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

} // namespace acdf::compress
