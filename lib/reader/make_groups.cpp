// Gathers neighbours in the tree of an environment into groups (acdf/groups.h).
#include "make_groups.h"

#include "make_sides.h"
#include "make_squares.h"
#include "memory.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>

namespace acdf {

namespace {

using u32 = std::uint32_t;

constexpr u32 kDrawnBits = 31; // of keys of random numbers
constexpr double kDrawnSteps = 0x1p31;
constexpr double kLeastWidth = 0x1p-60; // of random numbers, that a group is found by
constexpr std::size_t kMostGroups = 65535;
constexpr u32 kMostSteps = 255;                    // of positions, along a group
constexpr u32 kFewestCells = 16, kMostCells = 256; // in a group, at most
constexpr std::size_t kCellBytes = sizeof(AcdfGroupCell) + sizeof(float);
// Bytes of a group with one block, usually: itself, its boxes and its part of both grids.
constexpr std::size_t kGroupBytes = 248;
// Where a draw in a cell is told to lie is less than 2^-24 radians off.
constexpr double kAngleSteps = 0x1p8;
constexpr float kNeverSure = 1.0f;

/// A curve, in the order of the walk of all.
struct Surveyed {
    u32 cells, curves; ///< below it, itself included
};

/// Segments of a curve that follow each other, and what is below them.
struct Run {
    u32 first, count, cells; ///< segments; cells
    Cell box;
};

u32 bits_of(u32 count) {
    u32 bits = 0;
    while (std::uint64_t{1} << bits < count) ++bits;
    return bits;
}

// Bytes of tables, usually: groups are two thirds full.
std::size_t about(std::size_t cells, std::size_t most_cells) {
    const std::size_t groups = cells * 3 / (2 * most_cells) + 1,
                      blocks = (cells - cells * ACDF_BLOCK_CELLS / most_cells) / ACDF_BLOCK_CELLS;
    return cells * kCellBytes + groups * kGroupBytes + blocks * 4 * ACDF_GROUP_WORDS;
}

class GroupsMaker {
public:
    GroupsMaker(const AcdfEnvironment& environment, u32 tree_units)
        : environment_(environment), sides_(acdf_environment_grid(&environment)),
          most_steps_(2 * std::size_t{tree_units} + 64), step_{2.0 * ACDF_PI / environment.columns,
                                                               2.0 * ACDF_PI / environment.rows} {}

    /// False where there can be no tables.
    bool survey();
    AcdfGroups* make(std::size_t most_bytes, const AcdfAllocator& allocator, AcdfBlock& block);

private:
    bool survey(u32 at, u32& cells);
    bool gather(u32 most_cells);
    bool gather(u32 at, const Cell& above, std::size_t& next);
    bool gather_run(u32 at, const AcdfCurve& curve, const Run& run);
    void add(const Cell& box, u32 count);
    void add_cell(const AcdfGroup& group, const Cell& cell);
    bool remember_heights();
    bool failed() const;
    bool square() const { return environment_.parameterization == ACDF_PARAM_OCTAHEDRAL; }
    bool may_be_grouped(const Cell& box) const;
    /// Of positions, along a group: floats tell a place in half a turn well enough.
    u32 most_steps(u32 axis) const {
        return std::min(kMostSteps, (axis == 0 ? environment_.columns : environment_.rows) / 2);
    }
    bool is_slow(const Cell& cell, int axis, double width) const;
    float density(const Cell& cell) const;
    AcdfGroups* assemble(const SquaresMaker& numbers, const SquaresMaker& places, std::size_t words,
                         const AcdfAllocator& allocator, AcdfBlock& block);

    AcdfEnvironment environment_;
    Sides sides_;
    std::size_t most_steps_, steps_ = 0;
    double step_[2]; ///< radians, of positions along an axis that is not one of heights
    u32 key_bits_ = 0, shift_[2] = {0, 0}, most_cells_ = 0;
    Growable<Surveyed> curves_;
    Cell parts_[kMostCells]; ///< of a run
    Growable<AcdfGroup> groups_;
    Growable<KeyBox> numbers_, places_;
    Growable<u32> boxes_, more_;
    Growable<AcdfGroupCell> cells_;
    Growable<float> densities_;
    Growable<double> heights_, sines_; ///< of each row: of the angle to the pole
};

bool GroupsMaker::survey() {
    const u32 bits[2] = {bits_of(environment_.columns), bits_of(environment_.rows)};
    u32 cells = 0;
    key_bits_ = std::max(bits[0], bits[1]);
    if (key_bits_ > kDrawnBits) return false;
    for (int axis = 0; axis < 2; ++axis) shift_[axis] = key_bits_ - bits[axis];
    return survey(environment_.root, cells) && cells > 1 && !curves_.failed();
}

// How many cells and curves there are below each curve. A path passes at most 64 curves; they may be shared, but
// not so often that the work is more than in proportion to the tree.
bool GroupsMaker::survey(u32 at, u32& cells) {
    const AcdfCurve curve = acdf_curve_at(environment_.tree, at);
    const std::size_t self = curves_.size();
    steps_ += curve.segments;
    if (curve.tilts || steps_ > most_steps_ || !curves_.add(1, {})) return false;
    cells = curve.segments;
    for (u32 i = 0; curve.links && i < curve.segments; ++i) {
        const u32 link = acdf_curve_link(&curve, i);
        u32 below = 1;
        if (link != 0 && !survey(at + link, below)) return false;
        cells += below - 1;
    }
    curves_[self] = {cells, static_cast<u32>(curves_.size() - self)};
    return true;
}

bool GroupsMaker::remember_heights() {
    if (square()) return true;
    if (environment_.rows > most_steps_ || !heights_.reserve(std::size_t{environment_.rows} + 1)) return false;
    if (!sines_.reserve(std::size_t{environment_.rows} + 1)) return false;
    for (u32 row = 0; row <= environment_.rows; ++row) {
        const double z = acdf_row_z(row, environment_.rows);
        heights_.add(z);
        sines_.add(std::sqrt((1.0 - z) * (1.0 + z)));
    }
    return true;
}

bool GroupsMaker::failed() const {
    return groups_.failed() || numbers_.failed() || places_.failed() || boxes_.failed() || more_.failed() ||
           cells_.failed() || densities_.failed();
}

// At the poles a direction moves faster than its height: cells there are by themselves.
bool GroupsMaker::may_be_grouped(const Cell& box) const {
    return box.last[0] - box.first[0] <= most_steps(0) && box.last[1] - box.first[1] <= most_steps(1) &&
           (square() || (box.first[1] > 0 && box.last[1] < environment_.rows));
}

// Whether a direction moves slowly enough where a cell's random numbers, that part of its group's, lead across it,
// were it as fast everywhere as where it is fastest.
bool GroupsMaker::is_slow(const Cell& cell, int axis, double width) const {
    if (axis == 0 || square()) return (cell.last[axis] - cell.first[axis]) * step_[axis] <= kAngleSteps * width;
    const u32 first = cell.first[1], last = cell.last[1];
    return heights_[first] - heights_[last] <= kAngleSteps * width * std::min(sines_[first], sines_[last]);
}

float GroupsMaker::density(const Cell& cell) const {
    if (square() || cell.dark) return sides_.density(cell);
    return acdf_cell_pdf(acdf_positive(cell.probability), cell.last[0] - cell.first[0], environment_.columns,
                         heights_[cell.first[1]] - heights_[cell.last[1]], 1.0);
}

// Blocks of no cells.
void add_blocks(Growable<u32>& boxes, std::size_t count) {
    auto* const bytes = reinterpret_cast<std::int8_t*>(boxes.add(count * ACDF_GROUP_WORDS, 0x7F7F7F7Fu));
    for (std::size_t side = 1; bytes && side < 8 * count; side += 2) // upper ones: below all
        std::memset(bytes + ACDF_BLOCK_CELLS * side, -128, ACDF_BLOCK_CELLS);
}

// A group of cells that are added next.
void GroupsMaker::add(const Cell& box, u32 count) {
    AcdfGroup group = {};
    KeyBox number = {{1, 1}, {0, 0}}, place;
    for (int axis = 0; axis < 2; ++axis) {
        const double width = box.high[axis] - box.low[axis];
        const u32 last = (1u << kDrawnBits) - 1;
        const bool drawn = width > kLeastWidth;
        group.low[axis] = drawn ? box.low[axis] : 2.0;
        group.scale[axis] = drawn ? 1.0 / width : 1.0;
        group.first[axis] = box.first[axis];
        group.last[axis] = box.last[axis];
        place.low[axis] = box.first[axis] << shift_[axis];
        place.high[axis] = (box.last[axis] << shift_[axis]) - 1;
        if (!drawn) continue;
        number.low[axis] = std::min(static_cast<u32>(box.low[axis] * kDrawnSteps), last);
        number.high[axis] = std::min(static_cast<u32>(box.high[axis] * kDrawnSteps), last);
    }
    group.cells = static_cast<u32>(cells_.size());
    group.count = count;
    group.more = static_cast<u32>(more_.size() / ACDF_GROUP_WORDS);
    add_blocks(boxes_, 1);
    add_blocks(more_, (count - 1) / ACDF_BLOCK_CELLS);
    groups_.add(group);
    numbers_.add(number);
    places_.add(place);
}

// The last group's next cell.
void GroupsMaker::add_cell(const AcdfGroup& group, const Cell& cell) {
    const std::size_t i = cells_.size() - group.cells;
    u32* const block = i < ACDF_BLOCK_CELLS
                           ? boxes_.data() + (groups_.size() - 1) * ACDF_GROUP_WORDS
                           : more_.data() + (group.more + i / ACDF_BLOCK_CELLS - 1) * ACDF_GROUP_WORDS;
    const float pdf = density(cell);
    AcdfGroupCell out = {};
    for (int axis = 0; group.count > 1 && axis < 2; ++axis) {
        const double low = (cell.low[axis] - group.low[axis]) * group.scale[axis];
        const double width = (cell.high[axis] - cell.low[axis]) * group.scale[axis];
        const bool told = pdf > 0.0f && group.low[axis] < 1.0 && width > 0.0;
        out.axis[axis].low = told ? static_cast<u32>(std::clamp(low * 0x1p32, 0.0, 0x1p32 - 1.0)) : 0;
        out.axis[axis].scale =
            told && is_slow(cell, axis, width) ? static_cast<float>(0x1p-32 / width) : kNeverSure;
        auto* const bytes = reinterpret_cast<std::int8_t*>(block) +
                            2 * ACDF_BLOCK_CELLS * static_cast<std::size_t>(axis) + i % ACDF_BLOCK_CELLS;
        auto* const positions = bytes + 4 * ACDF_GROUP_POSITIONS;
        if (told) {
            bytes[0] = static_cast<std::int8_t>(static_cast<int>(std::max(low, 0.0) * 256.0) - 128);
            bytes[ACDF_BLOCK_CELLS] =
                static_cast<std::int8_t>(std::min(static_cast<int>((low + width) * 256.0), 255) - 128);
        }
        positions[0] = static_cast<std::int8_t>(static_cast<int>(cell.first[axis] - group.first[axis]) - 128);
        positions[ACDF_BLOCK_CELLS] =
            static_cast<std::int8_t>(static_cast<int>(cell.last[axis] - group.first[axis]) - 1 - 128);
    }
    cells_.add(out);
    densities_.add(pdf);
}

bool GroupsMaker::gather(u32 most_cells) {
    const Cell whole = {1.0,   {0.0, 0.0}, {1.0, 1.0}, {0, 0}, {environment_.columns, environment_.rows},
                        false, false};
    std::size_t next = 0;
    most_cells_ = most_cells;
    groups_.cut(0);
    numbers_.cut(0);
    places_.cut(0);
    boxes_.cut(0);
    more_.cut(0);
    cells_.cut(0);
    densities_.cut(0);
    return gather(environment_.root, whole, next) && !failed();
}

// Makes a group of a run of segments, of which parts_ are.
bool GroupsMaker::gather_run(u32 at, const AcdfCurve& curve, const Run& run) {
    if (run.cells == 0) return true;
    if (groups_.size() == kMostGroups) return false;
    add(run.box, run.cells);
    if (failed()) return false;
    const AcdfGroup group = groups_[groups_.size() - 1];
    const auto cell_of = [&](const Cell& cell) {
        add_cell(group, cell);
        return true;
    };
    for (u32 i = 0; i < run.count; ++i) {
        const u32 link = acdf_curve_link(&curve, run.first + i);
        if (link == 0) cell_of(parts_[i]);
        else each_cell(environment_.tree, at + link, parts_[i], cell_of);
    }
    return true;
}

// Below the curve that is `next` in the order of the survey.
bool GroupsMaker::gather(u32 at, const Cell& above, std::size_t& next) {
    const AcdfCurve curve = acdf_curve_at(environment_.tree, at);
    const u32 axis = acdf_curve_axis(&curve);
    Run run = {};
    Cut low = {0, 0.0};
    ++next;
    for (u32 i = 0; i < curve.segments; ++i) {
        const Cut high = cut_of(curve, i + 1);
        const u32 link = acdf_curve_link(&curve, i);
        const Cell part = part_of(above, curve, i, low, high);
        const u32 cells = link == 0 ? 1 : curves_[next].cells;
        const bool narrow = may_be_grouped(part);
        low = high;
        if (run.cells > 0 && narrow && run.cells + cells <= most_cells_ &&
            part.last[axis] - run.box.first[axis] <= most_steps(axis)) {
            parts_[run.count++] = part;
            run.cells += cells;
            run.box.last[axis] = part.last[axis];
            run.box.high[axis] = part.high[axis];
        } else {
            if (!gather_run(at, curve, run)) return false;
            run = {i, 1, cells, part};
            parts_[0] = part;
            if (link == 0 ? !narrow : !narrow || cells > most_cells_) {
                run.cells = 0;
                if (link != 0) {
                    if (!gather(at + link, part, next)) return false;
                    continue;
                }
                if (!gather_run(at, curve, {i, 1, 1, part})) return false;
            }
        }
        if (link != 0) next += curves_[next].curves;
    }
    return gather_run(at, curve, run);
}

AcdfGroups* GroupsMaker::make(std::size_t most_bytes, const AcdfAllocator& allocator, AcdfBlock& block) {
    const std::size_t cells = curves_[0].cells;
    if (cells * kCellBytes > most_bytes || !remember_heights() || !cells_.reserve(cells) ||
        !densities_.reserve(cells))
        return nullptr;
    for (u32 most = kFewestCells; most <= kMostCells; most *= 2) {
        if (about(cells, most) + heights_.bytes() > most_bytes || !gather(most)) continue;
        SquaresMaker numbers, places;
        if (!numbers.make(numbers_.data(), groups_.size(), kDrawnBits) ||
            !places.make(places_.data(), groups_.size(), key_bits_))
            return nullptr;
        const std::size_t words = sizeof(AcdfGroups) / 4 + numbers.words() + places.words() +
                                  (groups_.bytes() + boxes_.bytes() + more_.bytes()) / 4 +
                                  whole_lines(cells_.bytes() / 4) + whole_lines(densities_.bytes() / 4) +
                                  whole_lines(heights_.bytes() / 4);
        if (4 * words <= most_bytes) return assemble(numbers, places, words, allocator, block);
    }
    return nullptr;
}

AcdfGroups* GroupsMaker::assemble(const SquaresMaker& numbers, const SquaresMaker& places, std::size_t words,
                                  const AcdfAllocator& allocator, AcdfBlock& block) {
    block = take_block(allocator, 4 * words);
    if (!block.data) return nullptr;
    u32* const tables = static_cast<u32*>(block.data);
    AcdfGroups* const out = new (block.data) AcdfGroups();
    std::size_t at = sizeof(AcdfGroups) / 4;
    const auto copy = [&](const auto& from) { return copy_lines(from, tables, at); };
    out->words = static_cast<u32>(words);
    out->count = static_cast<u32>(cells_.size());
    out->shift[0] = shift_[0];
    out->shift[1] = shift_[1];
    out->groups = copy(groups_);
    out->boxes = copy(boxes_);
    out->more = copy(more_);
    out->cells = copy(cells_);
    out->densities = copy(densities_);
    if (heights_.size() > 0) out->heights = copy(heights_);
    at = numbers.place(tables, at, out->numbers);
    places.place(tables, at, out->places);
    return out;
}

} // namespace

AcdfGroups* make_groups(const AcdfEnvironment& environment, u32 tree_units, std::size_t most_bytes,
                        const AcdfAllocator& allocator, AcdfBlock& block) noexcept {
    GroupsMaker maker(environment, tree_units);
    return maker.survey() ? maker.make(most_bytes, allocator, block) : nullptr;
}

} // namespace acdf
