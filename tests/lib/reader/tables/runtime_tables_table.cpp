// Runtime tables of table files beside the traversal that they replace: the same bits for all calls.
#include "tests/inputs/sanitized.h"
#include "tests/lib/reader/table_random.h"

#include "reader/check/check.h"
#include "reader/memory.h"
#include "reader/tables/entry_widths.h"

#include <acdf/builder.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace acdf;
using namespace acdf::test;

/// Samples and pdfs of a file with runtime tables and without are the same to the bit: at sampled points,
/// anywhere, and next to the borders between steps.
class AsWalked {
public:
    explicit AsWalked(std::vector<std::uint8_t> bytes) : bytes_(std::move(bytes)) {
        LoadOptions options;
        options.tables = false;
        EXPECT_TRUE(File::from_memory(bytes_.data(), bytes_.size(), plain_, options).ok());
        EXPECT_TRUE(File::from_memory(bytes_.data(), bytes_.size(), fast_).ok());
        EXPECT_EQ(plain_.table_bytes(), 0u);
        EXPECT_LE(fast_.table_bytes(), 8 * fast_.size() + (1u << 20));
    }
    bool has_tables() const { return fast_.table_bytes() > 0; }
    double cells_told() const { return static_cast<double>(told_) / static_cast<double>(asked_); }

    void check(const std::uint32_t* index, int times, std::mt19937_64& random) {
        const std::uint32_t count = fast_.table().sampled_count();
        for (int n = 0; n < times && !testing::Test::HasFatalFailure(); ++n) {
            double u[8] = {}, x[8] = {}, y[8] = {};
            for (std::uint32_t i = 0; i < count; ++i) u[i] = next_double(random);
            const double pdf = fast_.table().sample(index, u, x);
            ASSERT_EQ(pdf, plain_.table().sample(index, u, y));
            ASSERT_EQ(std::memcmp(x, y, sizeof x), 0);
            if (pdf > 0.0) same_pdf(index, x);
            for (std::uint32_t i = 0; i < count; ++i) {
                const AcdfAxis& a = fast_.table().sampled_axis(i);
                const double position =
                    random() % 3 == 0 ? std::floor(uniform(random) * a.resolution) : uniform(random) * a.resolution;
                x[i] = acdf_table_coordinate(&a, position);
                if (random() % 3 == 0) x[i] = std::nextafter(x[i], random() % 2 == 0 ? a.low : a.high);
                if (random() % 50 == 0) x[i] = random() % 2 == 0 ? NAN : a.high + (a.high - a.low);
            }
            same_pdf(index, x);
        }
    }

private:
    void same_pdf(const std::uint32_t* index, const double* x) {
        const AcdfTable table = fast_.table().data();
        ASSERT_EQ(fast_.table().pdf(index, x), plain_.table().pdf(index, x));
        const AcdfBin* bin = acdf_table_bin(&table, index);
        const AcdfEntryBin* grids = bin ? acdf_table_entries(&table, bin) : nullptr;
        double position[ACDF_MAX_AXES];
        std::uint32_t step[ACDF_MAX_AXES];
        if (!grids || !acdf_table_step(&table, x, position, step)) return;
        ++asked_;
        told_ += acdf_entry_of_position(table.entries, grids, table.axis_count - table.indexed_count,
                                        step + table.indexed_count) >= ACDF_ENTRY_CELL;
    }

    std::vector<std::uint8_t> bytes_;
    File plain_, fast_;
    std::size_t asked_ = 0, told_ = 0;
};

TEST(TableEntries, GiveTheSameBits) {
    int with_tables = 0;
    for (const Space& space : spaces())
        for (std::uint64_t seed = 0; seed < 16 && !HasFatalFailure(); ++seed) {
            SCOPED_TRACE(std::string(space.name) + " " + std::to_string(seed));
            AsWalked pair(random_table(space, seed, seed % 4 == 0));
            with_tables += pair.has_tables();
            std::mt19937_64 random(seed);
            pair.check(nullptr, 600, random);
        }
    EXPECT_GT(with_tables, 30);
}

// Six bins, of which that of index 1, 1 has no share.
std::vector<std::uint8_t> table_of_bins() {
    compress::Cascade cascade;
    RandomTableTree tree(3, {60, 70}, 2, false);
    for (int bin = 0; bin < 6; ++bin) tree.add_bin(cascade);
    std::vector<float> shares(6, 0.2f);
    shares[4] = 0.0f;
    return table_file(cascade,
                      {axis("i", 2, 0, 2, ACDF_AXIS_INDEXED), axis("j", 3, 0, 3, ACDF_AXIS_INDEXED),
                       axis("x", 60, 0, 1), axis("y", 70, 2, 1)},
                      shares);
}

TEST(TableEntries, OfBinsGiveTheSameBits) {
    AsWalked pair(table_of_bins());
    ASSERT_TRUE(pair.has_tables());
    std::mt19937_64 random(4);
    for (std::uint32_t bin = 0; bin < 6; ++bin) {
        const std::uint32_t index[2] = {bin / 3, bin % 3};
        pair.check(index, 500, random);
    }
}

std::uint64_t cells_below(const AcdfTable& table, std::uint32_t at) {
    const AcdfCurve curve = acdf_curve_at(table.tree, at);
    std::uint64_t cells = 0;
    for (std::uint32_t i = 0; i < curve.segments; ++i) {
        const std::uint32_t link = acdf_curve_link(&curve, i);
        cells += link == 0 ? 1 : cells_below(table, at + link);
    }
    return cells;
}

// Counted while the file is checked, and by whoever asks how wide cells are, with that and without. Returns whether
// it was counted.
bool expect_counts(const std::vector<std::uint8_t>& bytes) {
    File file;
    Parts parts;
    TreeSurvey survey;
    const TreeSurvey none;
    EXPECT_TRUE(File::from_memory(bytes.data(), bytes.size(), file).ok());
    parts.survey = &survey;
    check(bytes.data(), bytes.size(), Limits(), nullptr, nullptr, parts);
    give_block({}, parts.inflated);
    if (!survey.done()) return false;
    const AcdfTable table = file.table().data();
    EntryWidthsFinder by_survey(table, survey), by_walk(table, none);
    std::uint64_t all = 0;
    for (std::uint32_t bin = 0; bin < file.description().bin_count; ++bin) {
        const std::uint32_t root = table.bins[bin].root;
        const std::uint64_t cells = cells_below(table, root);
        EntryWidths surveyed, walked;
        EXPECT_TRUE(by_survey.find(root, surveyed) && by_walk.find(root, walked));
        EXPECT_EQ(surveyed.cells, cells);
        EXPECT_EQ(walked.cells, cells);
        all += cells;
    }
    EXPECT_EQ(survey.cells(), all);
    return true;
}

TEST(TableEntries, CellsAreCountedWhileFilesAreChecked) {
    int counted = expect_counts(table_of_bins());
    for (const Space& space : spaces())
        for (std::uint64_t seed = 0; seed < 16; ++seed) counted += expect_counts(random_table(space, seed, false));
    EXPECT_GT(counted, 30);
}

/// A box of positions or of random numbers of each sampled axis.
template <class T>
struct EntryBox {
    T low[ACDF_MAX_AXES], high[ACDF_MAX_AXES];
};

/// What an entry is to lead to: the deepest curve that holds all of it, or (of positions alone) a cell.
struct LedTo {
    std::uint32_t at;
    bool cell;
};

// Segment i of a curve, of positions from `low` to `high`; and of random numbers.
EntryBox<std::uint32_t> part_of(const AcdfCurve& curve, std::uint32_t i, EntryBox<std::uint32_t> of) {
    const std::uint32_t axis = acdf_curve_axis(&curve);
    AcdfRange range = {of.low[axis], of.high[axis], 0.0};
    acdf_curve_narrow(&curve, i, &range);
    of.low[axis] = range.low;
    of.high[axis] = range.high;
    return of;
}
EntryBox<double> part_of(const AcdfCurve& curve, std::uint32_t i, EntryBox<double> of) {
    const std::uint32_t axis = acdf_curve_axis(&curve);
    const double low = of.low[axis], width = of.high[axis] - low, all = acdf_curve_maximum(&curve);
    of.low[axis] = low + width * (acdf_curve_cumulative(&curve, i) / all);
    if (i + 1 < curve.segments) of.high[axis] = low + width * (acdf_curve_cumulative(&curve, i + 1) / all);
    return of;
}

template <class T>
bool holds(const EntryBox<T>& box, const EntryBox<T>& entry, std::uint32_t axis, T border) {
    return box.low[axis] + border <= entry.low[axis] && entry.high[axis] <= box.high[axis] - border;
}

template <class T>
LedTo led_to(const AcdfTable& table, std::uint32_t root, const EntryBox<T>& whole, const EntryBox<T>& entry,
             T border) {
    EntryBox<T> box = whole;
    for (std::uint32_t at = root;;) {
        const AcdfCurve curve = acdf_curve_at(table.tree, at);
        const std::uint32_t axis = acdf_curve_axis(&curve);
        std::uint32_t i = 0;
        for (; i < curve.segments; ++i) {
            EntryBox<T> part = part_of(curve, i, box);
            if (part.low[axis] == whole.low[axis]) part.low[axis] -= border; // nothing is beyond
            if (part.high[axis] == whole.high[axis]) part.high[axis] += border;
            if (part.low[axis] < part.high[axis] && holds(part, entry, axis, border)) break;
        }
        if (i == curve.segments) return {at, false};
        const std::uint32_t link = acdf_curve_link(&curve, i);
        const bool dark = acdf_curve_cumulative(&curve, i) == acdf_curve_cumulative(&curve, i + 1);
        if (link == 0 || dark) return {at, true};
        box = part_of(curve, i, box);
        at += link;
    }
}

// All entries of a bin: returns how many are cells.
std::size_t expect_entries_lead_deep(const AcdfTable& table, std::uint32_t bin) {
    const AcdfEntryBin* grids = acdf_entry_bin(table.entries, bin);
    const std::uint32_t first = table.indexed_count, end = table.axis_count, root = table.bins[bin].root;
    const auto* const words = reinterpret_cast<const std::uint32_t*>(table.entries);
    EntryBox<std::uint32_t> all_places = {};
    EntryBox<double> all_numbers = {};
    std::uint32_t positions[ACDF_MAX_AXES] = {}, position_count = 1, number_count = 1;
    for (std::uint32_t axis = first; axis < end; ++axis) {
        const AcdfEntryAxis& a = grids->axes[axis - first];
        all_places.high[axis] = table.axes[axis].resolution;
        all_numbers.high[axis] = 1.0;
        positions[axis] = ((table.axes[axis].resolution - 1) >> a.shift) + 1;
        position_count *= positions[axis];
        number_count *= a.number_steps;
    }
    std::size_t cells = 0;
    for (std::uint32_t k = 0; k < position_count; ++k) {
        EntryBox<std::uint32_t> entry = all_places;
        for (std::uint32_t axis = first; axis < end; ++axis) {
            const AcdfEntryAxis& a = grids->axes[axis - first];
            entry.low[axis] = k / a.position_stride % positions[axis] << a.shift;
            entry.high[axis] = std::min(entry.low[axis] + (1u << a.shift), table.axes[axis].resolution);
        }
        const LedTo to = led_to<std::uint32_t>(table, root, all_places, entry, 0);
        const std::uint32_t found = words[grids->positions + k];
        EXPECT_EQ(found >= ACDF_ENTRY_CELL, to.cell);
        if (!to.cell) {
            EXPECT_EQ(acdf_entry_curve(table.entries, found & ~ACDF_ENTRY_CELL)->at, to.at);
        }
        cells += to.cell;
    }
    for (std::uint32_t k = 0; k < number_count; ++k) {
        EntryBox<double> entry = all_numbers;
        for (std::uint32_t axis = first; axis < end; ++axis) {
            const AcdfEntryAxis& a = grids->axes[axis - first];
            entry.low[axis] = static_cast<double>(k / a.number_stride % a.number_steps) / a.number_steps;
            entry.high[axis] = entry.low[axis] + 1.0 / a.number_steps;
        }
        const AcdfEntryCurve* found = acdf_entry_curve(table.entries, words[grids->numbers + k]);
        EXPECT_EQ(found->at, led_to(table, root, all_numbers, entry, 0x1p-40).at);
    }
    return cells;
}

TEST(TableEntries, LeadAsDeepAsTheyCan) {
    int with_tables = 0;
    std::size_t cells = 0;
    const auto expect_deep = [&](const std::vector<std::uint8_t>& bytes, std::uint32_t bins) {
        File file;
        ASSERT_TRUE(File::from_memory(bytes.data(), bytes.size(), file).ok());
        const AcdfTable table = file.table().data();
        for (std::uint32_t bin = 0; table.entries && bin < bins; ++bin) {
            if (acdf_entry_bin(table.entries, bin)->positions == 0) continue;
            ++with_tables;
            cells += expect_entries_lead_deep(table, bin);
        }
    };
    expect_deep(table_of_bins(), 6);
    for (const Space& space : spaces())
        for (std::uint64_t seed = 0; seed < 16 && !HasFailure(); ++seed) {
            SCOPED_TRACE(std::string(space.name) + " " + std::to_string(seed));
            expect_deep(random_table(space, seed, false), 1);
        }
    EXPECT_GT(with_tables, 30);
    EXPECT_GT(cells, 1000u);
}

// A table as they are in use: entries of half of all points are cells.
TEST(TableEntries, OfAFittedFileGiveTheSameBits) {
    constexpr std::uint32_t side = 256;
    std::vector<float> values(side * side);
    std::mt19937_64 random(7);
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const double x = (i % side + 0.5) / side, y = (i / side + 0.5) / side;
        values[i] = static_cast<float>((1.2 + std::sin(5.0 * x)) * (1.2 + std::cos(7.0 * y)) *
                                           (0.8 + 0.4 * uniform(random)) +
                                       (std::hypot(x - 0.3, y - 0.6) < 0.01 ? 500.0 : 0.0));
    }
    builder::Array array;
    array.data = values.data();
    array.shape = {side, side};
    builder::TableOptions options;
    options.goal = builder::Goal::of_budget(32 << 10);
    builder::Table made;
    ASSERT_TRUE(builder::table(array, options, made).ok());
    AsWalked pair(made.bytes);
    ASSERT_TRUE(pair.has_tables());
    pair.check(nullptr, acdf_test::repeated(20000), random);
    EXPECT_GT(pair.cells_told(), 0.3);
}

} // namespace
