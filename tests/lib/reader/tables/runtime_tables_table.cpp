// Runtime tables of table files beside the walk that they stand for: the same bits, whatever is asked.
#include "tests/inputs/sanitized.h"
#include "tests/lib/reader/table_random.h"

#include "reader/check/check.h"
#include "reader/memory.h"
#include "reader/tables/entry_widths.h"

#include <acdf/builder.h>
#include <acdf/reader.h>

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

/// Draws and densities of a file with runtime tables and without are the same to the bit: at drawn points,
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
        told_ += acdf_entry_of_place(table.entries, grids, table.axis_count - table.indexed_count,
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
