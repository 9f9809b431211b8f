// Gathers neighbours in the tree of an environment into groups (acdf/groups.h).
#include "make_groups.h"

#include "make_group_cells.h"
#include "make_squares.h"
#include "memory.h"

#include <algorithm>
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

/// CellParts of a curve that follow each other, and what is below them.
struct Run {
    u32 first, last, cells; ///< segments; how many cells
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
    GroupsMaker(const AcdfEnvironment& environment, const TreeSurvey& survey, Scratch* scratch)
        : environment_(environment), curves_(survey), scratch_(scratch), written_(environment), numbers_(scratch),
          places_(scratch) {}

    AcdfGroups* make(std::size_t most_bytes, const AcdfAllocator& allocator, AcdfBlock& block);

private:
    bool gather(u32 most_cells);
    template <class Add>
    bool each_run(Add&& add) const;
    template <class Add>
    bool each_run(u32 at, const Cell& above, std::size_t& next, Add& add) const;
    bool add(const Run& run);
    AcdfGroup group_of(const Run& run) const;
    void count(const Run& run);
    bool square() const { return environment_.parameterization == ACDF_PARAM_OCTAHEDRAL; }
    bool may_be_grouped(const Cell& box) const;
    /// Of positions, along a group: floats tell a place in half a turn well enough.
    u32 most_steps(u32 axis) const {
        return std::min(kMostSteps, (axis == 0 ? environment_.columns : environment_.rows) / 2);
    }
    AcdfGroups* assemble(const SquaresMaker& numbers, const SquaresMaker& places, std::size_t words,
                         const AcdfAllocator& allocator, AcdfBlock& block);

    AcdfEnvironment environment_;
    const TreeSurvey& curves_;
    Scratch* scratch_;
    GroupCells written_;
    u32 key_bits_ = 0, shift_[2] = {0, 0}, most_cells_ = 0;
    u32 groups_ = 0, cells_ = 0, more_ = 0; ///< so far: groups, their cells, blocks beside the first one of each
    KeyBoxes numbers_, places_;
};

// At the poles a direction moves faster than its height: cells there are by themselves.
bool GroupsMaker::may_be_grouped(const Cell& box) const {
    return box.last[0] - box.first[0] <= most_steps(0) && box.last[1] - box.first[1] <= most_steps(1) &&
           (square() || (box.first[1] > 0 && box.last[1] < environment_.rows));
}

// Keys of a group.
bool GroupsMaker::add(const Run& run) {
    if (groups_ == kMostGroups) return false;
    KeySpan number[2] = {{1, 0}, {1, 0}}, place[2];
    for (int axis = 0; axis < 2; ++axis) {
        const Cell& box = run.box;
        const u32 last = (1u << kDrawnBits) - 1;
        place[axis] = {box.first[axis] << shift_[axis], (box.last[axis] << shift_[axis]) - 1};
        if (box.high[axis] - box.low[axis] > kLeastWidth)
            number[axis] = {std::min(static_cast<u32>(box.low[axis] * kDrawnSteps), last),
                            std::min(static_cast<u32>(box.high[axis] * kDrawnSteps), last)};
    }
    numbers_.add(number[0], number[1]);
    places_.add(place[0], place[1]);
    count(run);
    return !(numbers_.failed() || places_.failed());
}

AcdfGroup GroupsMaker::group_of(const Run& run) const {
    AcdfGroup group = {};
    for (int axis = 0; axis < 2; ++axis) {
        const double width = run.box.high[axis] - run.box.low[axis];
        const bool drawn = width > kLeastWidth;
        group.low[axis] = drawn ? run.box.low[axis] : 2.0;
        group.scale[axis] = drawn ? 1.0 / width : 1.0;
        group.first[axis] = run.box.first[axis];
        group.last[axis] = run.box.last[axis];
    }
    group.cells = cells_;
    group.count = run.cells;
    group.more = more_;
    return group;
}

void GroupsMaker::count(const Run& run) {
    ++groups_;
    cells_ += run.cells;
    more_ += (run.cells - 1) / ACDF_BLOCK_CELLS;
}

bool GroupsMaker::gather(u32 most_cells) {
    most_cells_ = most_cells;
    groups_ = cells_ = more_ = 0;
    numbers_.cut(0);
    places_.cut(0);
    return each_run([&](const Run& run, const GroupCurve&) { return add(run); });
}

// Calls add(run, curve) for each run of segments that makes a group, in their order, as long as it returns true.
// They are found twice: what is known of them takes more memory than time.
template <class Add>
bool GroupsMaker::each_run(Add&& add) const {
    const Cell whole = {1.0,   {0.0, 0.0}, {1.0, 1.0}, {0, 0}, {environment_.columns, environment_.rows},
                        false, false};
    std::size_t next = 0;
    return each_run(environment_.root, whole, next, add);
}

// Below the curve that is `next` in the order of the survey.
template <class Add>
bool GroupsMaker::each_run(u32 at, const Cell& above, std::size_t& next, Add& add) const {
    const AcdfCurve curve = acdf_curve_at(environment_.tree, at);
    const GroupCurve divided = {curve, above, at};
    CellParts parts(curve, above, 0);
    const u32 axis = parts.axis();
    Run run = {};
    ++next;
    for (u32 i = 0; i < curve.segments; ++i) {
        const u32 link = parts.link(), cells = link == 0 ? 1 : curves_[next].cells;
        const Cell part = parts.next().in(above, axis);
        const bool narrow = may_be_grouped(part);
        if (run.cells > 0 && narrow && run.cells + cells <= most_cells_ &&
            part.last[axis] - run.box.first[axis] <= most_steps(axis)) {
            run.last = i + 1;
            run.cells += cells;
            run.box.last[axis] = part.last[axis];
            run.box.high[axis] = part.high[axis];
        } else {
            if (run.cells > 0 && !add(run, divided)) return false;
            run = {i, i + 1, cells, part};
            if (!narrow || cells > most_cells_) { // it is divided further, or a group by itself
                if (!(link == 0 ? add(run, divided) : each_run(at + link, part, next, add))) return false;
                run.cells = 0;
                continue;
            }
        }
        if (link != 0) next += curves_[next].curves;
    }
    return run.cells == 0 || add(run, divided);
}

AcdfGroups* GroupsMaker::make(std::size_t most_bytes, const AcdfAllocator& allocator, AcdfBlock& block) {
    if (!curves_.done()) return nullptr;
    const u32 bits[2] = {bits_of(environment_.columns), bits_of(environment_.rows)};
    const std::size_t cells = curves_.cells();
    key_bits_ = std::max(bits[0], bits[1]);
    for (int axis = 0; axis < 2; ++axis) shift_[axis] = key_bits_ - bits[axis];
    if (cells < 2 || key_bits_ > kDrawnBits || cells * kCellBytes > most_bytes ||
        (!square() && environment_.rows > curves_.most_steps()) || !written_.remember_heights())
        return nullptr;
    for (u32 most = kFewestCells; most <= kMostCells; most *= 2) {
        if (about(cells, most) + written_.heights().bytes() > most_bytes || !gather(most)) continue;
        SquaresMaker numbers(scratch_), places(scratch_);
        if (!numbers.make(numbers_, kDrawnBits) || !places.make(places_, key_bits_)) return nullptr;
        const std::size_t words =
            sizeof(AcdfGroups) / 4 + numbers.words() + places.words() + groups_ * sizeof(AcdfGroup) / 4 +
            (std::size_t{groups_} + more_) * ACDF_GROUP_WORDS + whole_lines(cells * sizeof(AcdfGroupCell) / 4) +
            whole_lines(cells) + whole_lines(written_.heights().bytes() / 4);
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
    out->groups = room(groups_ * sizeof(AcdfGroup) / 4);
    out->boxes = room(std::size_t{groups_} * ACDF_GROUP_WORDS);
    out->more = room(std::size_t{more_} * ACDF_GROUP_WORDS);
    out->cells = room(std::size_t{cells_} * sizeof(AcdfGroupCell) / 4);
    out->densities = room(cells_);
    if (written_.heights().size() > 0) out->heights = copy(written_.heights());
    at = numbers.place(tables, at, out->numbers);
    places.place(tables, at, out->places);
    const GroupCells::Tables parts = {reinterpret_cast<AcdfGroup*>(tables + out->groups), tables + out->boxes,
                                      tables + out->more, reinterpret_cast<AcdfGroupCell*>(tables + out->cells),
                                      reinterpret_cast<float*>(tables + out->densities)};
    groups_ = cells_ = more_ = 0;
    each_run([&](const Run& run, const GroupCurve& curve) {
        parts.groups[groups_] = group_of(run);
        written_.write(parts, groups_, curve, run.first, run.last);
        count(run);
        return true;
    });
    return out;
}

} // namespace

AcdfGroups* make_groups(const AcdfEnvironment& environment, const TreeSurvey& survey, std::size_t most_bytes,
                        const AcdfAllocator& allocator, AcdfBlock& block, Scratch* scratch) noexcept {
    GroupsMaker maker(environment, survey, scratch);
    return maker.make(most_bytes, allocator, block);
}

} // namespace acdf
