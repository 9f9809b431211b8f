#include "tables/table_entries.h"

#include "memory.h"
#include "tables/curve_segments.h"
#include "tables/entry_widths.h"
#include "tables/growable.h"

#include <algorithm>
#include <cstring>
#include <new>

namespace acdf {

namespace {

using u32 = std::uint32_t;

constexpr u32 kFewestBinCells = 16;        // of a bin whose tree is not traversed from its root
constexpr double kEntriesACell = 8.0;      // of each grid, at most
constexpr double kNumberEntries = 0x1p16;  // at most: samples wait for memory as long as more of them save
constexpr u32 kMostEntryBits = 12;         // of entries along an axis
constexpr double kNumberBorder = 0x1p-40;  // of random numbers: what is nearer to one, rounding may carry across
constexpr u32 kFewestEntryUnits = 1 << 14; // of a tree whose tables need more than a large page
constexpr u32 kMostPath = 64;              // curves

/// Entries of a grid along an axis.
struct EntrySpan {
    u32 first = 0, last = 0;
    bool any() const { return first < last; }
};

/// An axis of what a path through the tree has led to.
struct ReachedSide {
    double low = 0.0, high = 1.0; ///< random numbers
    u32 first = 0, last = 1;      ///< positions
    EntrySpan positions, numbers; ///< that lie in it
};

/// What a path through the tree has led to, on all axes.
struct Reached {
    double probability = 1.0;
    ReachedSide side[ACDF_MAX_AXES];
};

/// The members of one of the two grids: of positions or of numbers.
struct EntryKind {
    EntrySpan ReachedSide::*spans;
    u32 AcdfEntryAxis::*stride; ///< entries to the next one
    u32 AcdfEntryBin::*grid;
};
constexpr EntryKind kPositions = {&ReachedSide::positions, &AcdfEntryAxis::position_stride,
                                  &AcdfEntryBin::positions};
constexpr EntryKind kNumbers = {&ReachedSide::numbers, &AcdfEntryAxis::number_stride, &AcdfEntryBin::numbers};

class EntriesMaker {
public:
    EntriesMaker(const AcdfTable& table, u32 bin_count, std::size_t most_bytes, Scratch* scratch)
        : table_(table), bin_count_(bin_count), most_bytes_(most_bytes), first_axis_(table.indexed_count),
          axes_(acdf_table_sampled_count(&table)), widths_(scratch), bins_(scratch), grids_(scratch),
          curves_(scratch), steps_(scratch), pdfs_(scratch) {}

    /// False where there can be none.
    bool measure(const TreeSurvey& survey);
    /// False where they take more than most_bytes.
    bool make();
    AcdfEntries* assemble(const AcdfAllocator& allocator, AcdfBlock& block) const;

private:
    Reached whole() const;
    void lay_out(const EntryWidths& widths, AcdfEntryBin& bin) const;
    /// Of the grids over positions and over random numbers: whether any entry lies in what is reached.
    struct Found {
        bool positions, numbers;
    };
    bool visit(u32 at, Reached& reached, Found found, u32 depth);
    bool add_cell(const Reached& reached);
    bool add_curve(u32 at, const Reached& reached, Found found, u32 depth);
    u32 add_path(u32 depth);
    /// The entries along an axis that lie in its side: whether there are any.
    bool find_positions(u32 axis, ReachedSide& side) const;
    bool find_numbers(u32 axis, ReachedSide& side) const;
    /// Entries of what is reached lead to `entry`: of those along one axis only a span.
    void fill(const EntryKind& kind, const Reached& reached, u32 along, EntrySpan span, u32 entry);
    u32 resolution(u32 axis) const { return table_.axes[first_axis_ + axis].resolution; }
    std::size_t curve_words() const { return sizeof(AcdfEntryCurve) / 4 + 2 * std::size_t{axes_}; }
    std::size_t words() const;

    const AcdfTable& table_;
    u32 bin_count_;
    std::size_t most_bytes_;
    u32 first_axis_, axes_;
    double entries_a_cell_ = 0.0;
    std::size_t cells_ = 0;        ///< of all bins
    Growable<EntryWidths> widths_; ///< of each bin
    Growable<AcdfEntryBin> bins_;
    Growable<u32> grids_, curves_; ///< curves: curve_words() each
    Growable<AcdfEntryStep> steps_;
    Growable<double> pdfs_;
    AcdfEntryStep path_[kMostPath];
    u32 path_at_[kMostPath + 1];        ///< where so many of them stand
    const AcdfEntryBin* bin_ = nullptr; ///< that is entered
    u32 curve_count_ = 0;
};

Reached EntriesMaker::whole() const {
    Reached out;
    for (u32 axis = 0; axis < table_.axis_count; ++axis) out.side[axis].last = table_.axes[axis].resolution;
    for (u32 axis = 0; axis < axes_; ++axis) {
        find_positions(axis, out.side[first_axis_ + axis]);
        find_numbers(axis, out.side[first_axis_ + axis]);
    }
    return out;
}

// Entries along each axis: about as many times finer than its cells as along the others.
void EntriesMaker::lay_out(const EntryWidths& widths, AcdfEntryBin& bin) const {
    const auto cells = static_cast<double>(widths.cells), all_entries = entries_a_cell_ * cells;
    const auto share_out = [&](double some, const double* width, const u32* most, u32* bits) {
        for (double entries = 2.0; entries <= some; entries *= 2.0) {
            u32 next = axes_;
            for (u32 axis = 0; axis < axes_; ++axis)
                if (bits[axis] < most[axis] &&
                    (next == axes_ || width[axis] / cells + bits[axis] < width[next] / cells + bits[next]))
                    next = axis;
            if (next == axes_) return;
            ++bits[next];
        }
    };
    u32 all[ACDF_MAX_AXES] = {}, place[ACDF_MAX_AXES] = {}, number[ACDF_MAX_AXES] = {}, most[ACDF_MAX_AXES];
    for (u32 axis = 0; axis < axes_; ++axis) {
        while (std::uint64_t{1} << all[axis] < resolution(axis)) ++all[axis];
        most[axis] = std::min(all[axis], kMostEntryBits);
    }
    share_out(all_entries, widths.place, most, place);
    std::fill(most, most + axes_, kMostEntryBits);
    share_out(std::min(all_entries, kNumberEntries), widths.number, most, number);
    u32 positions = 1, numbers = 1;
    for (u32 axis = axes_; axis-- > 0;) {
        AcdfEntryAxis& a = bin.axes[axis];
        a.border = acdf_table_border(&table_.axes[first_axis_ + axis]);
        a.shift = all[axis] - place[axis];
        a.position_stride = positions;
        a.number_steps = 1u << number[axis];
        a.number_stride = numbers;
        positions *= ((resolution(axis) - 1) >> a.shift) + 1;
        numbers *= a.number_steps;
    }
    bin.positions = positions; // so many of each, until they have room
    bin.numbers = numbers;
}

void EntriesMaker::fill(const EntryKind& kind, const Reached& reached, u32 along, EntrySpan span, u32 entry) {
    if (!span.any()) return;
    EntrySpan spans[ACDF_MAX_AXES];
    std::size_t at[ACDF_MAX_AXES];
    for (u32 axis = 0; axis < axes_; ++axis) {
        spans[axis] = axis == along ? span : reached.side[first_axis_ + axis].*kind.spans;
        at[axis] = spans[axis].first;
    }
    u32* const grid = &grids_[bin_->*kind.grid];
    const u32 last = axes_ - 1; // entries along it are next to each other
    for (;;) {
        std::size_t line = 0;
        for (u32 axis = 0; axis < last; ++axis) line += at[axis] * bin_->axes[axis].*kind.stride;
        std::fill(grid + line + spans[last].first, grid + line + spans[last].last, entry);
        u32 axis = last;
        while (axis > 0 && ++at[axis - 1] == spans[axis - 1].last) --axis, at[axis] = spans[axis].first;
        if (axis == 0) return;
    }
}

bool EntriesMaker::find_positions(u32 axis, ReachedSide& side) const {
    const u32 shift = bin_->axes[axis].shift;
    side.positions.first = static_cast<u32>((std::uint64_t{side.first} + (std::uint64_t{1} << shift) - 1) >> shift);
    side.positions.last = side.last == resolution(axis) ? ((side.last - 1) >> shift) + 1 : side.last >> shift;
    return side.positions.any();
}

bool EntriesMaker::find_numbers(u32 axis, ReachedSide& side) const {
    const u32 steps = bin_->axes[axis].number_steps;
    const auto round_up = [](double x) { return static_cast<u32>(x) + (static_cast<u32>(x) < x); };
    const double low = (side.low + kNumberBorder) * steps, high = std::max(side.high - kNumberBorder, 0.0) * steps;
    side.numbers.first = side.low == 0.0 ? 0 : round_up(low);
    side.numbers.last = side.high == 1.0 ? steps : static_cast<u32>(high);
    return side.numbers.any();
}

// Where so many steps stand. Those of the curve above are not written again if they are the newest ones.
u32 EntriesMaker::add_path(u32 depth) {
    const auto end = static_cast<u32>(steps_.size());
    const bool goes_on = depth > 0 && path_at_[depth - 1] + depth - 1 == end;
    path_at_[depth] = goes_on ? path_at_[depth - 1] : end;
    for (u32 i = goes_on ? depth - 1 : 0; i < depth; ++i) steps_.add(path_[i]);
    return path_at_[depth];
}

// The way to it is asked for by random numbers alone.
bool EntriesMaker::add_curve(u32 at, const Reached& reached, Found found, u32 depth) {
    AcdfEntryCurve curve = {};
    curve.probability = reached.probability;
    curve.at = at;
    if (found.numbers) {
        curve.first = add_path(depth);
        curve.count = depth;
    }
    u32* out = curves_.add(curve_words(), 0);
    if (!out) return false;
    std::memcpy(out, &curve, sizeof curve);
    out += sizeof curve / 4;
    for (u32 axis = 0; axis < axes_; ++axis) {
        *out++ = reached.side[first_axis_ + axis].first;
        *out++ = reached.side[first_axis_ + axis].last;
    }
    ++curve_count_;
    return !steps_.failed() && curves_.bytes() + steps_.bytes() <= most_bytes_;
}

// A cell in which entries lie.
bool EntriesMaker::add_cell(const Reached& reached) {
    fill(kPositions, reached, 0, reached.side[first_axis_].positions,
         static_cast<u32>(pdfs_.size()) | ACDF_ENTRY_CELL);
    AcdfTablePosition place = {};
    for (u32 axis = first_axis_; axis < table_.axis_count; ++axis) {
        place.range[axis].low = reached.side[axis].first;
        place.range[axis].high = reached.side[axis].last;
    }
    pdfs_.add(reached.probability > 0.0 ? acdf_table_cell_pdf(&table_, reached.probability, &place) : 0.0);
    return !pdfs_.failed();
}

// A curve that is reached by so many steps, in what it divides entries lie, and what is below it. Each entry is
// filled once: those between what goes on below it lead to the curve.
bool EntriesMaker::visit(u32 at, Reached& reached, Found found, u32 depth) {
    const u32 number = curve_count_;
    if (!add_curve(at, reached, found, depth)) return false;
    const AcdfCurve curve = acdf_curve_at(table_.tree, at);
    const u32 axis = acdf_curve_axis(&curve) - first_axis_;
    ReachedSide& side = reached.side[first_axis_ + axis];
    const ReachedSide above = side;
    const double of_all = reached.probability;
    CurveSegments segments(curve, above.first, above.last);
    const double maximum = segments.maximum(), width = above.high - above.low;
    EntrySpan positions = above.positions, numbers = above.numbers; // that are left
    const auto fill_up_to = [&](const EntryKind& kind, EntrySpan& left, const EntrySpan& below) {
        fill(kind, reached, axis, {left.first, below.first}, number);
        left.first = below.last;
    };
    const bool walked = maximum > 0xFFFF || depth == kMostPath; // what is below
    bool all = true;
    side.high = above.low;
    while (all && !walked && segments.number() < curve.segments) {
        const u32 link = segments.link();
        const CurveSegment segment = segments.next();
        const u32 part = segment.to - segment.from;
        side.low = side.high;
        side.high = segments.number() == curve.segments ? above.high : above.low + width * (segment.to / maximum);
        side.first = segment.first;
        side.last = segment.last;
        const bool divided = link > 0 && part > 0;
        const Found below = {found.positions && find_positions(axis, side),
                             found.numbers && divided && find_numbers(axis, side)};
        if (!below.positions && !below.numbers) continue;
        if (below.positions) fill_up_to(kPositions, positions, side.positions);
        if (below.numbers) fill_up_to(kNumbers, numbers, side.numbers);
        reached.probability = part > 0 ? acdf_positive(of_all * (part / maximum)) : 0.0;
        path_[depth] = {static_cast<std::uint16_t>(maximum), static_cast<std::uint16_t>(segment.from),
                        static_cast<std::uint16_t>(part), static_cast<std::uint16_t>(axis)};
        all = divided ? visit(at + link, reached, below, depth + 1) : add_cell(reached);
    }
    if (found.positions) fill_up_to(kPositions, positions, {positions.last, positions.last});
    if (found.numbers) fill_up_to(kNumbers, numbers, {numbers.last, numbers.last});
    side = above;
    reached.probability = of_all;
    return all;
}

bool EntriesMaker::measure(const TreeSurvey& survey) {
    EntryWidthsFinder finder(table_, survey);
    if (bin_count_ * (sizeof(EntryWidths) + sizeof(AcdfEntryBin)) > most_bytes_ ||
        !widths_.add(bin_count_, EntryWidths{}))
        return false;
    for (u32 bin = 0; bin < bin_count_; ++bin) {
        if (!(table_.bins[bin].share > 0.0f)) continue;
        if (!finder.find(table_.bins[bin].root, widths_[bin])) return false;
        cells_ += widths_[bin].cells >= kFewestBinCells ? widths_[bin].cells : 0;
    }
    return cells_ > 0;
}

bool EntriesMaker::make() {
    // Of a cell: entries of both grids, and what curves and cells usually take, if entries lie in most of them.
    const auto cells = static_cast<double>(cells_), most = static_cast<double>(most_bytes_);
    const auto about = [&](double entries) { return cells * (6.0 * entries + 40.0 * std::min(entries, 1.0)); };
    entries_a_cell_ = kEntriesACell;
    while (about(entries_a_cell_) > most) entries_a_cell_ /= 2.0;
    const std::size_t some = cells_ / 4; // curves, usually
    if (!curves_.reserve(some * curve_words()) || !steps_.reserve(2 * some) || !pdfs_.reserve(some)) return false;
    if (!bins_.add(bin_count_, AcdfEntryBin{}) || !grids_.add(16, 0)) return false; // so that none begins at 0
    for (u32 bin = 0; bin < bin_count_; ++bin) {
        if (widths_[bin].cells < kFewestBinCells) continue;
        bin_ = &bins_[bin];
        lay_out(widths_[bin], bins_[bin]);
        const u32 positions = bin_->positions, numbers = bin_->numbers;
        bins_[bin].positions = static_cast<u32>(grids_.size());
        bins_[bin].numbers = bin_->positions + positions;
        Reached all = whole();
        if (!grids_.add(std::size_t{positions} + numbers, 0) ||
            !visit(table_.bins[bin].root, all, {true, true}, 0) || 4 * words() > most_bytes_)
            return false;
    }
    return true;
}

std::size_t EntriesMaker::words() const {
    return sizeof(AcdfEntries) / 4 + whole_lines(bins_.bytes() / 4) + whole_lines(curves_.size()) +
           whole_lines(steps_.bytes() / 4) + whole_lines(pdfs_.bytes() / 4) + whole_lines(grids_.size());
}

AcdfEntries* EntriesMaker::assemble(const AcdfAllocator& allocator, AcdfBlock& block) const {
    block = take_block(allocator, 4 * words());
    if (!block.data) return nullptr;
    u32* const tables = static_cast<u32*>(block.data);
    auto* const out = new (block.data) AcdfEntries();
    std::size_t at = sizeof(AcdfEntries) / 4;
    out->words = static_cast<u32>(words());
    out->bins = copy_lines(bins_, tables, at);
    out->curves = copy_lines(curves_, tables, at);
    out->curve_words = static_cast<u32>(curve_words());
    out->steps = copy_lines(steps_, tables, at);
    out->densities = copy_lines(pdfs_, tables, at);
    const u32 grids = copy_lines(grids_, tables, at);
    auto* const bins = reinterpret_cast<AcdfEntryBin*>(tables + out->bins);
    for (u32 bin = 0; bin < bin_count_; ++bin)
        if (bins[bin].positions > 0) {
            bins[bin].positions += grids;
            bins[bin].numbers += grids;
        }
    return out;
}

} // namespace

AcdfEntries* make_table_entries(const AcdfTable& table, u32 bin_count, const TreeSurvey& survey,
                                std::size_t most_bytes, const AcdfAllocator& allocator, AcdfBlock& block) noexcept {
    Scratch pages;
    EntriesMaker maker(table, bin_count, most_bytes, table.tree_units >= kFewestEntryUnits ? &pages : nullptr);
    return maker.measure(survey) && maker.make() ? maker.assemble(allocator, block) : nullptr;
}

} // namespace acdf
