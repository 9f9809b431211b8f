#include "compress/halvings/table.h"

#include "compress/halvings/kernels.h"

#include <algorithm>
#include <new>

namespace acdf::compress {
namespace {

/// Steps of grids whose tables have all levels. Of larger ones, which would not stay in the cache, what is smaller
/// than two steps by two is added when it is asked for.
constexpr std::size_t kWhole = std::size_t{1} << 20;
constexpr std::size_t kBlocks = 64; // that rows are divided into, each of which is added up by one thread

} // namespace

HalvedTable::HalvedTable(const HalvedAxes& axes, HalvedRows& rows, std::size_t most_values)
    : axes_(axes), rows_(rows) {
    const std::size_t steps = std::size_t{axes.rows.steps()} * axes.columns.steps();
    whole_ = steps <= std::min(kWhole, most_values / 4);
    const std::size_t finest[2] = {axes.rows.end(), axes.columns.end()};
    for (std::size_t axis = 0; axis < 2; ++axis) end_[axis] = whole_ ? 2 * finest[axis] : finest[axis];
    while (!whole_ && end_[0] * end_[1] > std::max<std::size_t>(most_values, 4)) end_[end_[0] < end_[1]] /= 2;
    for (std::size_t axis = 0; axis < 2; ++axis) kept_[axis] = (whole_ ? finest[axis] : end_[axis]) / 2;
    stride_ = whole_lines(end_[1]) + kFloatsOfLine;
    table_.reset(static_cast<float*>(std::calloc(end_[0] * stride_, sizeof(float))));
    if (!table_) throw std::bad_alloc();
    dirty_.resize(kept_[0]);
}

std::uint32_t HalvedTable::complete_rows() const {
    return std::min(static_cast<std::uint32_t>(end_[0]), axes_.rows.complete());
}

std::uint32_t HalvedTable::complete_columns() const {
    return std::min(static_cast<std::uint32_t>(end_[1]), axes_.columns.complete());
}

void HalvedTable::mark(std::uint32_t first, std::uint32_t last) {
    for (std::size_t i = 0; i < dirty_.size(); ++i) {
        const auto range = static_cast<std::uint32_t>(kept_[0] + i);
        if (axes_.rows.low(range) < last && axes_.rows.high(range) > first) dirty_[i] = 1;
    }
}

void HalvedTable::make(const Loop& loop) {
    while (scratch_.size() < loop.slots()) scratch_.emplace_back(std::size_t{3} * axes_.columns.steps());
    const std::size_t blocks = std::min(kBlocks, kept_[0]), of_block = kept_[0] / blocks;
    loop.run(blocks, 1, [&](std::size_t begin, std::size_t end, std::size_t slot) {
        for (std::size_t block = begin; block < end; ++block) {
            const std::size_t low = kept_[0] + block * of_block;
            prepare(static_cast<std::uint32_t>(low), static_cast<std::uint32_t>(low + of_block), slot);
            for (std::size_t i = low; i < low + of_block; ++i)
                if (dirty_[i - kept_[0]]) add_steps(static_cast<std::uint32_t>(i), scratch_[slot].data());
            for (std::size_t count = of_block / 2, n = low / 2; count > 0; count /= 2, n /= 2)
                for (std::size_t k = 0; k < count; ++k) add_halves(static_cast<std::uint32_t>(n + k));
        }
    });
    for (std::size_t n = blocks; n-- > 1;) add_halves(static_cast<std::uint32_t>(n));
    std::fill(dirty_.begin(), dirty_.end(), std::uint8_t{0});
}

/// Of ranges [first, last) those stretches that are new.
void HalvedTable::prepare(std::uint32_t first, std::uint32_t last, std::size_t slot) {
    const auto is_dirty = [&](std::uint32_t range) { return dirty_[range - kept_[0]] != 0; };
    for (std::uint32_t range = first; range < last; ++range) {
        if (!is_dirty(range)) continue;
        const std::uint32_t begin = range;
        while (range + 1 < last && is_dirty(range + 1)) ++range;
        rows_.prepare(axes_.rows.low(begin), axes_.rows.high(range), slot);
    }
}

/// Sums of a range of rows of the finest level that has all of them.
void HalvedTable::add_steps(std::uint32_t range, float* scratch) {
    const std::uint32_t columns = axes_.columns.steps(), first = axes_.rows.low(range),
                        last = axes_.rows.high(range);
    float *sums = of_rows(range), *more = scratch + columns, *together = more + columns;
    const float* steps = rows_.read(first, 0, columns, scratch);
    if (last - first == 1) return add_columns(steps, sums);
    const float* below = rows_.read(first + 1, 0, columns, more);
    if (whole_) {
        add_columns(steps, of_rows(2 * range));
        add_columns(below, of_rows(2 * range + 1));
        return add_rows_of(of_rows(2 * range), of_rows(2 * range + 1), end_[1], sums);
    }
    add_rows_of(steps, below, columns, together);
    for (std::uint32_t r = first + 2; r < last; ++r)
        add_rows_of(together, rows_.read(r, 0, columns, scratch), columns, together);
    add_columns(together, sums);
}

/// All ranges of columns, of the steps of a row.
void HalvedTable::add_columns(const float* steps, float* sums) const {
    const auto kept = static_cast<std::uint32_t>(kept_[1]);
    const HalvedAxis& columns = axes_.columns;
    if (2 * kept == columns.steps()) {
        halve_row(steps, kept, sums + kept);
        if (whole_) std::copy_n(steps, columns.steps(), sums + std::size_t{2} * kept);
    } else
        for (std::uint32_t n = kept; n < 2 * kept; ++n) {
            const std::uint32_t low = columns.low(n), high = columns.high(n);
            sums[n] = steps[low];
            for (std::uint32_t c = low + 1; c < high; ++c) sums[n] += steps[c];
            if (!whole_ || high - low == 1) continue;
            sums[2 * n] = steps[low];
            sums[2 * n + 1] = steps[low + 1];
        }
    add_pairs(sums, kept);
}

/// Where anything below a range is new.
void HalvedTable::add_halves(std::uint32_t range) {
    std::size_t first = range, last = range + std::size_t{1};
    while (first < kept_[0]) first *= 2, last *= 2;
    const auto from = dirty_.begin() + std::ptrdiff_t(first - kept_[0]),
               to = dirty_.begin() + std::ptrdiff_t(last - kept_[0]);
    if (std::find(from, to, 1) == to) return;
    add_rows_of(of_rows(2 * range), of_rows(2 * range + 1), end_[1], of_rows(range));
}

float HalvedTable::added(HalvedBox box) const {
    constexpr std::uint32_t kTogether = 64;
    float scratch[kTogether], sum = 0.0f;
    const std::uint32_t end = axes_.columns.high(box.columns);
    for (std::uint32_t r = axes_.rows.low(box.rows); r < axes_.rows.high(box.rows); ++r)
        for (std::uint32_t c = axes_.columns.low(box.columns); c < end; c += kTogether) {
            const std::uint32_t count = std::min(kTogether, end - c);
            const float* steps = rows_.read(r, c, c + count, scratch);
            for (std::uint32_t i = 0; i < count; ++i) sum += steps[i];
        }
    return sum;
}

} // namespace acdf::compress
