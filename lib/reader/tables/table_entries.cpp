#include "tables/table_entries.h"

#include "memory.h"
#include "tables/growable.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>

namespace acdf {

namespace {

using u32 = std::uint32_t;

constexpr u32 kFewestBinCells = 16;        // of a bin whose tree is not walked from its root
constexpr double kEntriesACell = 8.0;      // of each grid, at most
constexpr u32 kMostEntryBits = 12;         // of entries along an axis
constexpr double kNumberBorder = 0x1p-40;  // of random numbers: what is nearer to one, rounding may carry across
constexpr u32 kFewestEntryUnits = 1 << 14; // of a tree whose tables need more than a large page
constexpr u32 kMostPath = 64;              // curves
constexpr u32 kFewCells = 16;              // below a curve: how they lie there is not looked at

/// An axis of what a path through the tree has led to.
struct ReachedSide {
    double low = 0.0, high = 1.0; ///< random numbers
    u32 first = 0, last = 1;      ///< positions
};

/// And all of them.
struct Reached {
    double probability = 1.0;
    ReachedSide side[ACDF_MAX_AXES];
};

/// A part of what a curve divides, in its cumulative values.
struct Part {
    u32 width;
    double of; ///< the maximum
    double probability(double of_all) const {
        return of_all > 0.0 && width > 0 ? acdf_positive(of_all * (width / of)) : 0.0;
    }
};

/// Calls each(i, link, part) for the segments of a curve, the sides of which `reached` takes one after the other;
/// link: to what is below, 0 where that is a cell. False as soon as that is. Then `reached` is what it was.
template <class Each>
bool each_segment(const AcdfCurve& curve, Reached& reached, const Each& each) {
    ReachedSide& side = reached.side[acdf_curve_axis(&curve)];
    const ReachedSide above = side;
    const double of_all = reached.probability, maximum = acdf_curve_maximum(&curve), width = above.high - above.low;
    const u32 code = ACDF_CURVE_POSITION_CODE(curve.header), origin = code == 0 ? above.first : 0;
    bool all = true;
    u32 from = 0;
    side.high = above.low;
    side.last = above.first;
    for (u32 i = 0; all && i < curve.segments; ++i) {
        const bool is_last = i + 1 == curve.segments;
        const u32 to = acdf_curve_cumulative(&curve, i + 1);
        side.low = side.high;
        side.first = side.last;
        side.high = is_last ? above.high : above.low + width * (to / maximum);
        side.last = is_last ? above.last : origin + acdf_load(curve.positions, i, code);
        all = each(i, of_all > 0.0 && to > from ? acdf_curve_link(&curve, i) : 0, Part{to - from, maximum});
        from = to;
    }
    side = above;
    reached.probability = of_all;
    return all;
}

/// How wide cells are, and how many: by which grids are made.
struct Widths {
    /// Sums of the logarithms of their positions and of their parts of the random numbers.
    double place[ACDF_MAX_AXES] = {}, number[ACDF_MAX_AXES] = {};
    std::size_t cells = 0;

    /// What such a sum tells of cells becomes as many parts, as logarithms tell.
    void divide(u32 axis, double sum) {
        place[axis] -= sum;
        number[axis] -= sum;
    }
};

/// Positions along an axis that a path through the tree has led to, and these logarithms.
struct ReachedWidth {
    u32 first = 0, last = 1;
    double place = 0.0, number = 0.0;
};

// The logarithm of a positive number, linear between powers of two.
double logarithm(double x) {
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    return static_cast<double>(bits) * 0x1p-52 - 1023.0;
}

class EntriesMaker {
public:
    EntriesMaker(const AcdfTable& table, u32 bin_count, const TreeSurvey& survey, std::size_t most_bytes,
                 Scratch* scratch)
        : table_(table), survey_(survey), bin_count_(bin_count), most_bytes_(most_bytes),
          first_axis_(table.indexed_count), axes_(acdf_table_sampled_count(&table)), widths_(scratch),
          bins_(scratch), grids_(scratch), curves_(scratch), steps_(scratch), densities_(scratch) {}

    /// False where there can be none.
    bool measure();
    /// False where they take more than most_bytes.
    bool make();
    AcdfEntries* assemble(const AcdfAllocator& allocator, AcdfBlock& block) const;

private:
    Reached whole() const;
    bool measure(u32 at, ReachedWidth* reached, Widths& widths);
    bool measure_bin(u32 bin, Widths& widths);
    /// Whether so many more segments may be passed.
    bool pass(std::size_t segments);
    u32 cells_below(u32 at, u32 header) const;
    void lay_out(const Widths& widths, AcdfEntryBin& bin) const;
    bool visit(u32 at, Reached& reached, u32 depth);
    bool add_cell(const Reached& reached, double probability_of_all, const Part& part);
    bool add_curve(u32 at, const Reached& reached, u32 depth);
    /// Whether any entry lies in what is reached, which then leads to `entry`.
    bool fill_places(const Reached& reached, u32 entry);
    bool fill_numbers(const Reached& reached, u32 entry);
    bool fill(const std::size_t (*span)[2], u32 AcdfEntryAxis::*stride, u32* grid, u32 entry) const;
    u32 resolution(u32 axis) const { return table_.axes[first_axis_ + axis].resolution; }
    std::size_t curve_words() const { return sizeof(AcdfEntryCurve) / 4 + 2 * std::size_t{axes_}; }
    std::size_t words() const;

    const AcdfTable& table_;
    const TreeSurvey& survey_;
    u32 bin_count_;
    std::size_t most_bytes_;
    u32 first_axis_, axes_;
    double entries_a_cell_ = 0.0;
    std::size_t cells_ = 0;      ///< of all bins
    std::size_t steps_left_ = 0; ///< segments that may still be passed
    Growable<Widths> widths_;    ///< of each bin
    Growable<AcdfEntryBin> bins_;
    Growable<u32> grids_, curves_; ///< curves: curve_words() each
    Growable<AcdfEntryStep> steps_;
    Growable<double> densities_;
    AcdfEntryStep path_[kMostPath];
    const AcdfEntryBin* bin_ = nullptr; ///< that is entered
    u32 curve_count_ = 0;
};

Reached EntriesMaker::whole() const {
    Reached out;
    for (u32 axis = 0; axis < table_.axis_count; ++axis) out.side[axis].last = table_.axes[axis].resolution;
    return out;
}

// A path passes at most 64 curves. False where curves have tilts, or are shared so often that passing all of them
// is more work than in proportion to the tree. How a few cells divide what is above them is not looked at: each
// axis as much as the others, but that of a curve without children.
bool EntriesMaker::measure(u32 at, ReachedWidth* reached, Widths& widths) {
    const AcdfCurve curve = acdf_curve_at(table_.tree, at);
    const u32 axis = acdf_curve_axis(&curve) - first_axis_, code = ACDF_CURVE_POSITION_CODE(curve.header);
    if (curve.tilts || !pass(curve.segments)) return false;
    ReachedWidth& side = reached[axis];
    const ReachedWidth above = side;
    const double of_all = above.number - logarithm(acdf_curve_maximum(&curve));
    const u32 origin = code == 0 ? above.first : 0;
    double places = 0.0, numbers = 0.0, divided = 0.0;
    std::size_t cells = 0;
    u32 from = 0;
    side.last = above.first;
    for (u32 i = 0; i < curve.segments; ++i) {
        const u32 to = acdf_curve_cumulative(&curve, i + 1), link = to > from ? acdf_curve_link(&curve, i) : 0;
        side.first = side.last;
        side.last = i + 1 == curve.segments ? above.last : origin + acdf_load(curve.positions, i, code);
        side.place = logarithm(side.last - side.first);
        side.number = to > from ? of_all + logarithm(to - from) : 0.0; // no number leads there
        from = to;
        u32 below = 1;
        if (link > 0) {
            const u32 header = reinterpret_cast<const std::uint16_t*>(table_.tree)[at + link];
            below = cells_below(at + link, header);
            if (below > kFewCells) {
                if (!measure(at + link, reached, widths)) return false;
                continue;
            }
            if (!pass(below)) return false;
            const double by = below * logarithm(below);
            if (TreeSurvey::ends(header)) widths.divide((header & ACDF_CURVE_AXIS_MASK) - first_axis_, by);
            else divided += by / axes_;
        }
        places += below * side.place;
        numbers += below * side.number;
        cells += below;
    }
    side = above;
    widths.place[axis] += places;
    widths.number[axis] += numbers;
    for (u32 other = 0; other < axes_; ++other) { // all of them are alike there
        widths.divide(other, divided);
        if (other == axis) continue;
        widths.place[other] += static_cast<double>(cells) * reached[other].place;
        widths.number[other] += static_cast<double>(cells) * reached[other].number;
    }
    widths.cells += cells;
    return true;
}

bool EntriesMaker::pass(std::size_t segments) {
    const bool enough = segments <= steps_left_;
    steps_left_ -= enough ? segments : 0;
    return enough;
}

u32 EntriesMaker::cells_below(u32 at, u32 header) const {
    return survey_.done() ? survey_.cells(at, header) : TreeSurvey::kMany;
}

bool EntriesMaker::measure_bin(u32 bin, Widths& widths) {
    ReachedWidth all[ACDF_MAX_AXES];
    for (u32 axis = 0; axis < axes_; ++axis) {
        all[axis].last = resolution(axis);
        all[axis].place = logarithm(resolution(axis));
    }
    if (!measure(table_.bins[bin].root, all, widths)) return false;
    for (u32 axis = 0; axis < axes_; ++axis)
        widths.place[axis] -= static_cast<double>(widths.cells) * all[axis].place;
    return true;
}

// Entries along each axis: about as many times finer than its cells as along the others.
void EntriesMaker::lay_out(const Widths& widths, AcdfEntryBin& bin) const {
    const auto cells = static_cast<double>(widths.cells);
    const auto share_out = [&](const double* width, const u32* most, u32* bits) {
        for (double entries = 2.0; entries <= entries_a_cell_ * cells; entries *= 2.0) {
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
    share_out(widths.place, most, place);
    std::fill(most, most + axes_, kMostEntryBits);
    share_out(widths.number, most, number);
    u32 places = 1, numbers = 1;
    for (u32 axis = axes_; axis-- > 0;) {
        AcdfEntryAxis& a = bin.axes[axis];
        a.border = acdf_table_border(&table_.axes[first_axis_ + axis]);
        a.shift = all[axis] - place[axis];
        a.place_stride = places;
        a.number_steps = 1u << number[axis];
        a.number_stride = numbers;
        places *= ((resolution(axis) - 1) >> a.shift) + 1;
        numbers *= a.number_steps;
    }
    bin.places = places; // so many of each, until they have room
    bin.numbers = numbers;
}

// Writes an entry in the spans of all axes; false where they are empty.
bool EntriesMaker::fill(const std::size_t (*span)[2], u32 AcdfEntryAxis::*stride, u32* grid, u32 entry) const {
    std::size_t at[ACDF_MAX_AXES];
    for (u32 axis = 0; axis < axes_; ++axis) {
        if (span[axis][0] >= span[axis][1]) return false;
        at[axis] = span[axis][0];
    }
    const u32 last = axes_ - 1; // entries along it are next to each other
    for (;;) {
        std::size_t line = 0;
        for (u32 axis = 0; axis < last; ++axis) line += at[axis] * bin_->axes[axis].*stride;
        std::fill(grid + line + span[last][0], grid + line + span[last][1], entry);
        u32 axis = last;
        while (axis > 0 && ++at[axis - 1] == span[axis - 1][1]) --axis, at[axis] = span[axis][0];
        if (axis == 0) return true;
    }
}

bool EntriesMaker::fill_places(const Reached& reached, u32 entry) {
    std::size_t span[ACDF_MAX_AXES][2];
    for (u32 axis = 0; axis < axes_; ++axis) {
        const u32 a = first_axis_ + axis, shift = bin_->axes[axis].shift;
        const std::size_t step = std::size_t{1} << shift, last = reached.side[a].last;
        span[axis][0] = (reached.side[a].first + step - 1) >> shift;
        span[axis][1] = last == resolution(axis) ? ((last - 1) >> shift) + 1 : last >> shift;
    }
    return fill(span, &AcdfEntryAxis::place_stride, &grids_[bin_->places], entry);
}

bool EntriesMaker::fill_numbers(const Reached& reached, u32 entry) {
    std::size_t span[ACDF_MAX_AXES][2];
    for (u32 axis = 0; axis < axes_; ++axis) {
        const u32 a = first_axis_ + axis, steps = bin_->axes[axis].number_steps;
        const double low = reached.side[a].low, high = reached.side[a].high;
        span[axis][0] = low == 0.0 ? 0 : static_cast<std::size_t>(std::ceil((low + kNumberBorder) * steps));
        span[axis][1] =
            high == 1.0 ? steps : static_cast<std::size_t>(std::floor(std::max(high - kNumberBorder, 0.0) * steps));
    }
    return fill(span, &AcdfEntryAxis::number_stride, &grids_[bin_->numbers], entry);
}

bool EntriesMaker::add_curve(u32 at, const Reached& reached, u32 depth) {
    AcdfEntryCurve curve = {};
    curve.probability = reached.probability;
    curve.at = at;
    curve.first = static_cast<u32>(steps_.size());
    curve.count = depth;
    u32* out = curves_.add(curve_words(), 0);
    if (!out) return false;
    std::memcpy(out, &curve, sizeof curve);
    out += sizeof curve / 4;
    for (u32 axis = 0; axis < axes_; ++axis) {
        *out++ = reached.side[first_axis_ + axis].first;
        *out++ = reached.side[first_axis_ + axis].last;
    }
    for (u32 i = 0; i < depth; ++i) steps_.add(path_[i]);
    ++curve_count_;
    return !steps_.failed() && curves_.bytes() + steps_.bytes() <= most_bytes_;
}

// A cell, where entries lie in it.
bool EntriesMaker::add_cell(const Reached& reached, double of_all, const Part& part) {
    if (!fill_places(reached, static_cast<u32>(densities_.size()) | ACDF_ENTRY_CELL)) return true;
    const double probability = part.probability(of_all);
    AcdfTablePlace place = {};
    for (u32 axis = first_axis_; axis < table_.axis_count; ++axis) {
        place.range[axis].low = reached.side[axis].first;
        place.range[axis].high = reached.side[axis].last;
    }
    densities_.add(probability > 0.0 ? acdf_table_density(&table_, probability, &place) : 0.0);
    return !densities_.failed();
}

// A curve that is reached by so many steps, where entries lie in what it divides, and what is below it.
bool EntriesMaker::visit(u32 at, Reached& reached, u32 depth) {
    const u32 number = curve_count_;
    const bool any_place = fill_places(reached, number), any_number = fill_numbers(reached, number);
    if (!any_place && !any_number) return true;
    if (!add_curve(at, reached, depth)) return false;
    const AcdfCurve curve = acdf_curve_at(table_.tree, at);
    const u32 maximum = acdf_curve_maximum(&curve);
    const double of_all = reached.probability;
    if (maximum > 0xFFFF || depth == kMostPath) return true; // what is below is walked
    return each_segment(curve, reached, [&](u32 i, u32 link, const Part& part) {
        if (link == 0) return add_cell(reached, of_all, part);
        reached.probability = part.probability(of_all);
        path_[depth] = {static_cast<std::uint16_t>(maximum),
                        static_cast<std::uint16_t>(acdf_curve_cumulative(&curve, i)),
                        static_cast<std::uint16_t>(part.width),
                        static_cast<std::uint16_t>(acdf_curve_axis(&curve) - first_axis_)};
        return visit(at + link, reached, depth + 1);
    });
}

bool EntriesMaker::measure() {
    steps_left_ = 2 * std::size_t{table_.tree_units} + 64;
    if (bin_count_ * (sizeof(Widths) + sizeof(AcdfEntryBin)) > most_bytes_ || !widths_.add(bin_count_, Widths{}))
        return false;
    for (u32 bin = 0; bin < bin_count_; ++bin) {
        if (!(table_.bins[bin].share > 0.0f)) continue;
        if (!measure_bin(bin, widths_[bin])) return false;
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
    if (!densities_.reserve(cells_) || !curves_.reserve(some * curve_words()) || !steps_.reserve(8 * some))
        return false;
    if (!bins_.add(bin_count_, AcdfEntryBin{}) || !grids_.add(16, 0)) return false; // so that none begins at 0
    for (u32 bin = 0; bin < bin_count_; ++bin) {
        if (widths_[bin].cells < kFewestBinCells) continue;
        bin_ = &bins_[bin];
        lay_out(widths_[bin], bins_[bin]);
        const u32 places = bin_->places, numbers = bin_->numbers;
        bins_[bin].places = static_cast<u32>(grids_.size());
        bins_[bin].numbers = bin_->places + places;
        Reached all = whole();
        if (!grids_.add(std::size_t{places} + numbers, 0) || !visit(table_.bins[bin].root, all, 0) ||
            4 * words() > most_bytes_)
            return false;
    }
    return true;
}

std::size_t EntriesMaker::words() const {
    return sizeof(AcdfEntries) / 4 + whole_lines(bins_.bytes() / 4) + whole_lines(curves_.size()) +
           whole_lines(steps_.bytes() / 4) + whole_lines(densities_.bytes() / 4) + whole_lines(grids_.size());
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
    out->densities = copy_lines(densities_, tables, at);
    const u32 grids = copy_lines(grids_, tables, at);
    auto* const bins = reinterpret_cast<AcdfEntryBin*>(tables + out->bins);
    for (u32 bin = 0; bin < bin_count_; ++bin)
        if (bins[bin].places > 0) {
            bins[bin].places += grids;
            bins[bin].numbers += grids;
        }
    return out;
}

} // namespace

AcdfEntries* make_table_entries(const AcdfTable& table, u32 bin_count, const TreeSurvey& survey,
                                std::size_t most_bytes, const AcdfAllocator& allocator, AcdfBlock& block) noexcept {
    Scratch pages;
    EntriesMaker maker(table, bin_count, survey, most_bytes,
                       table.tree_units >= kFewestEntryUnits ? &pages : nullptr);
    return maker.measure() && maker.make() ? maker.assemble(allocator, block) : nullptr;
}

} // namespace acdf
