// Gathers neighbours in the tree of an environment into groups (acdf/groups.h).
#include "tables/groups.h"

#include "memory.h"
#include "tables/group_cells.h"
#include "tables/squares.h"

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
constexpr u32 kNoCurve = ~0u;
constexpr u32 kMostSteps = 255;                    // of positions, along a group
constexpr u32 kFewestCells = 16, kMostCells = 256; // in a group, at most
static_assert(kMostCells < TreeSurvey::kMany);
constexpr std::size_t kCellBytes = sizeof(AcdfGroupCell) + sizeof(float);
// Bytes of a group with one block, usually: itself, its boxes and its part of both grids.
constexpr std::size_t kGroupBytes = 248;

u32 bits_of(u32 count) {
    u32 bits = 0;
    while (std::uint64_t{1} << bits < count) ++bits;
    return bits;
}

// Groups are two thirds full, usually.
std::size_t groups_about(std::size_t cells, std::size_t most_cells) { return cells * 3 / (2 * most_cells) + 1; }

// Bytes of tables, usually.
std::size_t about(std::size_t cells, std::size_t most_cells) {
    const std::size_t groups = groups_about(cells, most_cells),
                      blocks = (cells - cells * ACDF_BLOCK_CELLS / most_cells) / ACDF_BLOCK_CELLS;
    return cells * kCellBytes + groups * kGroupBytes + blocks * 4 * ACDF_GROUP_WORDS;
}

class GroupsMaker {
public:
    GroupsMaker(const AcdfEnvironment& environment, const TreeSurvey& survey, Scratch* scratch, Instructions most,
                const AcdfParallel& parallel)
        : environment_(environment), survey_(survey), scratch_(scratch), instructions_(most), parallel_(parallel),
          curves_(scratch), runs_(scratch), groups_(scratch), numbers_(scratch), places_(scratch) {}

    AcdfGroups* make(std::size_t most_bytes, const AcdfAllocator& allocator, AcdfBlock& block);

private:
    /// Cells that follow each other, below segments of a curve.
    struct Group {
        GroupRun run;
        u32 cells;
        Cell box;
    };

    bool remember_heights();
    bool gather(u32 most_cells);
    bool gather(u32 at, const Cell& above);
    bool add(const Group& group);
    /// Of a segment of the curve at `at`, or below it.
    u32 cells_of(u32 at, u32 link) const {
        return link == 0
                   ? 1
                   : survey_.cells(at + link, reinterpret_cast<const std::uint16_t*>(environment_.tree)[at + link]);
    }
    bool square() const { return environment_.parameterization == ACDF_PARAM_OCTAHEDRAL; }
    /// Of positions, along a group: floats tell a place in half a turn well enough.
    u32 most_steps(u32 axis) const {
        return std::min(kMostSteps, (axis == 0 ? environment_.columns : environment_.rows) / 2);
    }
    /// Whether cells there may be in a group, as far as that axis tells. At the poles a direction moves faster than
    /// its height: cells there are by themselves.
    bool is_narrow(u32 axis, u32 first, u32 last) const {
        return last - first <= most_steps(axis) &&
               (axis == 0 || square() || (first > 0 && last < environment_.rows));
    }
    AcdfGroups* assemble(const SquaresMaker& numbers, const SquaresMaker& places, std::size_t words,
                         const AcdfAllocator& allocator, AcdfBlock& block);

    AcdfEnvironment environment_;
    const TreeSurvey& survey_;
    Scratch* scratch_;
    Instructions instructions_;
    const AcdfParallel& parallel_;
    Growable<double> heights_, sines_; ///< of each border between rows: of the angle to the pole
    u32 key_bits_ = 0, shift_[2] = {0, 0}, most_cells_ = 0;
    u32 cells_ = 0, more_ = 0; ///< of the groups so far: cells, blocks beside the first one of each
    Growable<GroupCurve> curves_;
    Growable<GroupRun> runs_;
    Growable<AcdfGroup> groups_;
    KeyBoxes numbers_, places_;
};

bool GroupsMaker::remember_heights() {
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

// A group and its keys.
bool GroupsMaker::add(const Group& found) {
    if (groups_.size() == kMostGroups) return false;
    KeySpan number[2] = {{1, 0}, {1, 0}}, place[2];
    AcdfGroup group = {};
    for (int axis = 0; axis < 2; ++axis) {
        const Cell& box = found.box;
        const u32 last = (1u << kDrawnBits) - 1;
        const double width = box.high[axis] - box.low[axis];
        const bool drawn = width > kLeastWidth;
        place[axis] = {box.first[axis] << shift_[axis], (box.last[axis] << shift_[axis]) - 1};
        if (drawn)
            number[axis] = {std::min(static_cast<u32>(box.low[axis] * kDrawnSteps), last),
                            std::min(static_cast<u32>(box.high[axis] * kDrawnSteps), last)};
        group.low[axis] = drawn ? box.low[axis] : 2.0;
        group.scale[axis] = drawn ? 1.0 / width : 1.0;
        group.first[axis] = box.first[axis];
        group.last[axis] = box.last[axis];
    }
    group.cells = cells_;
    group.count = found.cells;
    group.more = more_;
    numbers_.add(number[0], number[1]);
    places_.add(place[0], place[1]);
    groups_.add(group);
    runs_.add(found.run);
    cells_ += found.cells;
    more_ += (found.cells - 1) / ACDF_BLOCK_CELLS;
    return !(numbers_.failed() || places_.failed() || groups_.failed() || runs_.failed() || curves_.failed());
}

bool GroupsMaker::gather(u32 most_cells) {
    const Cell whole = {1.0,   {0.0, 0.0}, {1.0, 1.0}, {0, 0}, {environment_.columns, environment_.rows},
                        false, false};
    const std::size_t about = groups_about(survey_.cells(), most_cells) * 5 / 4;
    most_cells_ = most_cells;
    cells_ = more_ = 0;
    numbers_.cut(0);
    places_.cut(0);
    curves_.cut(0);
    runs_.cut(0);
    groups_.cut(0);
    if (!(numbers_.reserve(about) && places_.reserve(about) && curves_.reserve(about / 2) && runs_.reserve(about) &&
          groups_.reserve(about)))
        return false;
    return gather(environment_.root, whole);
}

// Groups below a curve, in their order.
bool GroupsMaker::gather(u32 at, const Cell& above) {
    const AcdfCurve curve = acdf_curve_at(environment_.tree, at);
    CellParts parts(curve, above);
    const u32 axis = parts.axis(), other = 1 - axis;
    const bool narrow_across = is_narrow(other, above.first[other], above.last[other]);
    Group group = {{kNoCurve, 0, 0}, 0, above};
    CurveSegment end = {};
    const auto add_group = [&] {
        if (group.run.curve == kNoCurve) {
            group.run.curve = static_cast<u32>(curves_.size());
            curves_.add({above, at});
        }
        group.box.high[axis] = parts.high(end);
        return add(group);
    };
    for (u32 i = 0; i < curve.segments; ++i) {
        const u32 link = parts.link(), cells = cells_of(at, link);
        const CurveSegment segment = parts.segment();
        const bool narrow = narrow_across && is_narrow(axis, segment.first, segment.last);
        if (group.cells > 0 && narrow && group.cells + cells <= most_cells_ &&
            segment.last - group.box.first[axis] <= most_steps(axis)) {
            group.run.last = i + 1;
            group.cells += cells;
            group.box.last[axis] = segment.last;
            end = segment;
        } else {
            if (group.cells > 0 && !add_group()) return false;
            group.run.first = i;
            group.run.last = i + 1;
            group.cells = cells;
            group.box.first[axis] = segment.first;
            group.box.last[axis] = segment.last;
            group.box.low[axis] = parts.low(segment);
            end = segment;
            if (!narrow || cells > most_cells_) { // it is divided further, or a group by itself
                if (!(link == 0 ? add_group() : gather(at + link, parts.cell(above, segment)))) return false;
                group.cells = 0;
                continue;
            }
        }
    }
    return group.cells == 0 || add_group();
}

AcdfGroups* GroupsMaker::make(std::size_t most_bytes, const AcdfAllocator& allocator, AcdfBlock& block) {
    if (!survey_.done()) return nullptr;
    const u32 bits[2] = {bits_of(environment_.columns), bits_of(environment_.rows)};
    const std::size_t cells = survey_.cells();
    key_bits_ = std::max(bits[0], bits[1]);
    for (int axis = 0; axis < 2; ++axis) shift_[axis] = key_bits_ - bits[axis];
    if (cells < 2 || key_bits_ > kDrawnBits || cells * kCellBytes > most_bytes ||
        (!square() && environment_.rows > survey_.most_steps()) || !remember_heights())
        return nullptr;
    for (u32 most = kFewestCells; most <= kMostCells; most *= 2) {
        if (about(cells, most) + heights_.bytes() > most_bytes || !gather(most)) continue;
        // Both grids are given up as soon as they do not fit.
        const std::size_t others =
            4 * (sizeof(AcdfGroups) / 4 + groups_.bytes() / 4 + (groups_.size() + more_) * ACDF_GROUP_WORDS +
                 whole_lines(cells * sizeof(AcdfGroupCell) / 4) + whole_lines(cells) +
                 whole_lines(heights_.bytes() / 4));
        SquaresMaker numbers(scratch_, instructions_), places(scratch_, instructions_);
        if (others > most_bytes) continue;
        if (!numbers.make(numbers_, kDrawnBits, SquaresMaker::kUsualWork, most_bytes - others)) return nullptr;
        const std::size_t but_places = others + 4 * numbers.words();
        if (but_places > most_bytes) continue;
        if (!places.make(places_, key_bits_, SquaresMaker::kUsualWork, most_bytes - but_places)) return nullptr;
        const std::size_t bytes = but_places + 4 * places.words();
        if (bytes <= most_bytes) return assemble(numbers, places, bytes / 4, allocator, block);
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
    const auto room = [&](std::size_t count) { // of words; what is left of the last line becomes 0
        const std::size_t first = at;
        at = whole_lines(at + count);
        std::fill(tables + first + count, tables + at, 0u);
        return static_cast<u32>(first);
    };
    out->words = static_cast<u32>(words);
    out->count = cells_;
    out->shift[0] = shift_[0];
    out->shift[1] = shift_[1];
    out->groups = copy(groups_);
    out->boxes = room(groups_.size() * ACDF_GROUP_WORDS);
    out->more = room(std::size_t{more_} * ACDF_GROUP_WORDS);
    out->cells = room(std::size_t{cells_} * sizeof(AcdfGroupCell) / 4);
    out->densities = room(cells_);
    if (heights_.size() > 0) out->heights = copy(heights_);
    at = numbers.place(tables, at, out->numbers);
    places.place(tables, at, out->places);
    write_group_cells({environment_, heights_.data(), sines_.data(), curves_.data(), runs_.data(), groups_.data(),
                       groups_.size(), cells_, tables + out->boxes, tables + out->more,
                       reinterpret_cast<AcdfGroupCell*>(tables + out->cells),
                       reinterpret_cast<float*>(tables + out->densities)},
                      instructions_, parallel_);
    return out;
}

} // namespace

AcdfGroups* make_groups(const AcdfEnvironment& environment, const TreeSurvey& survey, std::size_t most_bytes,
                        const AcdfAllocator& allocator, AcdfBlock& block, Scratch* scratch, Instructions most,
                        const AcdfParallel& parallel) noexcept {
    GroupsMaker maker(environment, survey, scratch, most, parallel);
    return maker.make(most_bytes, allocator, block);
}

} // namespace acdf
