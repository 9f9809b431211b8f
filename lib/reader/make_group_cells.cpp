#include "make_group_cells.h"

#include <algorithm>
#include <cmath>

namespace acdf {

namespace {

using u32 = std::uint32_t;
using u64 = std::uint64_t;

// Where a draw in a cell is told to lie is less than 2^-24 radians off.
constexpr double kAngleSteps = 0x1p8;
constexpr float kNeverSure = 1.0f;

// The bytes of a cell of a block: boxes of random numbers and of positions, of both axes the lower and the upper
// side, less 128. Boxes that no point is in have lower sides above all, and upper ones below.
constexpr u64 kNoBox = 0x807F807F, kNowhere = kNoBox << 32 | kNoBox;

// Two of them.
u64 sides(int low, int high) {
    return ((static_cast<u32>(high) & 0xFF) << 8 | (static_cast<u32>(low) & 0xFF)) ^ 0x8080;
}

// In blocks the same byte of all cells lies together.
void write_block(const u64* cells, u32* block) {
#ifdef ACDF_SQUARES_SSE2
    constexpr int count = ACDF_BLOCK_CELLS / 2;
    __m128i bytes[count];
    for (int i = 0; i < count; ++i) bytes[i] = _mm_loadu_si128(reinterpret_cast<const __m128i*>(cells) + i);
    for (int turn = 0; turn < 4; ++turn) { // each takes one bit of a cell's number from the front to the end
        __m128i mixed[count];
        for (int i = 0; i < count / 2; ++i) {
            mixed[2 * i] = _mm_unpacklo_epi8(bytes[i], bytes[i + count / 2]);
            mixed[2 * i + 1] = _mm_unpackhi_epi8(bytes[i], bytes[i + count / 2]);
        }
        for (int i = 0; i < count; ++i) bytes[i] = mixed[i];
    }
    for (int i = 0; i < count; ++i) _mm_store_si128(reinterpret_cast<__m128i*>(block) + i, bytes[i]);
#else
    auto* const bytes = reinterpret_cast<std::uint8_t*>(block);
    for (int side = 0; side < 8; ++side)
        for (int i = 0; i < ACDF_BLOCK_CELLS; ++i)
            bytes[ACDF_BLOCK_CELLS * side + i] = static_cast<std::uint8_t>(cells[i] >> 8 * side);
#endif
}

} // namespace

bool GroupCells::remember_heights() noexcept {
    if (square()) return true;
    const std::size_t count = std::size_t{environment_.rows} + 1;
    if (!heights_.reserve(count) || !sines_.reserve(count)) return false;
    for (u32 row = 0; row <= environment_.rows; ++row) {
        const double z = acdf_row_z(row, environment_.rows);
        heights_.add(z);
        sines_.add(std::sqrt((1.0 - z) * (1.0 + z)));
    }
    return true;
}

// The part of a cell's solid angle that its rows make.
double GroupCells::height(u32 first, u32 last) const noexcept {
    if (!square()) return heights_[first] - heights_[last];
    const AcdfGrid grid = acdf_environment_grid(&environment_);
    const AcdfRange rows = {first, last, 0.0};
    return acdf_grid_height(&grid, &rows);
}

// Of one group.
class GroupCells::Writer {
public:
    Writer(const GroupCells& maker, const Tables& tables, std::size_t number)
        : maker_(maker), group_(tables.groups[number]), cells_(tables.cells + group_.cells),
          densities_(tables.densities + group_.cells), boxes_(tables.boxes + number * ACDF_GROUP_WORDS),
          more_(tables.more + std::size_t{group_.more} * ACDF_GROUP_WORDS) {}

    void end() {
        for (; in_block_ < ACDF_BLOCK_CELLS; ++in_block_) block_[in_block_] = kNowhere;
        write_block(block_, boxes_);
    }

    bool operator()(const Cell& above, u32 axis, const CellPart& part, bool same) {
        if (axis == 0) add<0>(above, part, same);
        else add<1>(above, part, same);
        return true;
    }

private:
    // A cell on an axis of its group.
    struct Along {
        AcdfGroupAxis axis;
        u64 box, positions; // their bytes among those of a cell, were it axis 0
    };
    static constexpr AcdfGroupAxis kUntold = {0, kNeverSure};

    // The cell of a part on an axis; where `same`, `above` is that of the cell before.
    template <u32 axis>
    void add(const Cell& above, const CellPart& part, bool same) {
        constexpr u32 other = 1 - axis;
        if (!same) {
            across_ = along<other>(above.low[other], above.high[other], above.first[other], above.last[other]);
            extent_ =
                axis == 0 ? maker_.height(above.first[1], above.last[1]) : turn(above.first[0], above.last[0]);
        }
        const double area =
            axis == 0 ? turn(part.first, part.last) * extent_ : extent_ * maker_.height(part.first, part.last);
        *densities_++ = part.dark ? 0.0f
                                  : acdf_area_pdf(acdf_positive(above.probability * part.share),
                                                  maker_.environment_.columns, area, 1.0);
        AcdfGroupCell& cell = *cells_++;
        if (group_.count == 1) {
            cell = {};
            return;
        }
        if (in_block_ == ACDF_BLOCK_CELLS) {
            write_block(block_, boxes_);
            in_block_ = 0;
            boxes_ = more_;
            more_ += ACDF_GROUP_WORDS;
        }
        const Along along = this->along<axis>(part.low, part.high, part.first, part.last), across = across_;
        cell.axis[axis] = part.dark ? kUntold : along.axis;
        cell.axis[other] = part.dark ? kUntold : across.axis;
        const u64 box = along.box << 16 * axis | across.box << 16 * other;
        const u64 positions = along.positions << 16 * axis | across.positions << 16 * other;
        block_[in_block_++] = (part.dark ? kNoBox : box) | positions; // no numbers are in the box of a dark one
    }

    // Radians of columns, in the order in which acdf_cell_pdf multiplies.
    double turn(u32 first, u32 last) const { return 2.0 * ACDF_PI * static_cast<double>(last - first); }

    // Whether a direction moves slowly enough where a cell's random numbers, that part of its group's, lead across
    // it, were it as fast everywhere as where it is fastest.
    template <u32 axis>
    bool is_slow(u32 first, u32 last, double width) const {
        if (axis == 0 || maker_.square()) return (last - first) * maker_.step_[axis] <= kAngleSteps * width;
        const double *const heights = maker_.heights_.data(), *const sines = maker_.sines_.data();
        return heights[first] - heights[last] <= kAngleSteps * width * std::min(sines[first], sines[last]);
    }

    template <u32 axis>
    Along along(double from, double to, u32 first, u32 last) const {
        const double low = (from - group_.low[axis]) * group_.scale[axis];
        const double width = (to - from) * group_.scale[axis];
        const u32 corner = group_.first[axis];
        const bool told = group_.low[axis] < 1.0 && width > 0.0; // else no numbers are in its box
        const double lifted = 0.5 * (low + std::fabs(low)), steps = lifted * 0x1p32; // low or 0, without a branch
        const int upper = static_cast<int>((low + width) * 256.0);
        const u32 number = static_cast<u32>(static_cast<std::int64_t>(steps < 0x1p32 - 1.0 ? steps : 0x1p32 - 1.0));
        const bool slow = told && is_slow<axis>(first, last, width);
        return {{told ? number : 0, slow ? static_cast<float>(0x1p-32 / width) : kNeverSure},
                told ? sides(static_cast<int>(lifted * 256.0), upper < 255 ? upper : 255) : kNoBox & 0xFFFF,
                sides(static_cast<int>(first - corner), static_cast<int>(last - corner) - 1) << 32};
    }

    const GroupCells& maker_;
    const AcdfGroup group_;
    AcdfGroupCell* cells_;
    float* densities_;
    u32 *boxes_, *more_; // of the block, of the next one
    u32 in_block_ = 0;
    u64 block_[ACDF_BLOCK_CELLS]; // set as far as they are counted
    Along across_ = {};
    double extent_ = 0.0; // of the axis on which cells are as they were
};

void GroupCells::write(const Tables& tables, std::size_t group, const GroupCurve& curve, u32 first,
                       u32 last) const noexcept {
    Writer writer(*this, tables, group);
    each_cell(environment_.tree, curve.at, curve.curve, first, last, curve.above, writer);
    writer.end();
}

} // namespace acdf
