// encode_tree and store: what goes in comes out through the reader.
#include "compress_cascade_cells.h"
#include "synthetic.h"

#include "compress/store.h"
#include "measure/cells.h"

#include <gtest/gtest.h>

#include <cstring>
#include <stdexcept>

namespace {

using namespace acdf::compress;

struct Stored {
    std::vector<std::uint8_t> bytes;
    acdf::File file;
};

Stored stored(const Cascade& cascade, std::uint32_t columns, std::uint32_t rows,
              AcdfCodec codec = ACDF_CODEC_NONE) {
    Stored s;
    s.bytes = store(encode_tree(cascade, 0.0), environment_description(columns, rows), codec);
    const acdf::Status status = acdf::File::from_memory(s.bytes.data(), s.bytes.size(), s.file);
    EXPECT_TRUE(status.ok()) << status.message;
    return s;
}

/// The stored cells are those of the cascade, in the same order, probabilities within 32-bit rounding.
void expect_cells(const Cascade& cascade, std::uint32_t columns, std::uint32_t rows) {
    Target grid;
    grid.columns = columns;
    grid.rows = rows;
    const auto expected = acdf_test::cells_of(cascade, grid);
    const Stored s = stored(cascade, columns, rows);
    ASSERT_FALSE(s.file.empty());
    std::size_t i = 0;
    acdf::measure::for_each_cell(s.file, s.file.bin(0).root, [&](const acdf::measure::Cell& cell) {
        ASSERT_LT(i, expected.size());
        const auto& e = expected[i++];
        for (int axis = 0; axis < 2; ++axis) {
            EXPECT_EQ(cell.range[axis].low, e.low[axis]);
            EXPECT_EQ(cell.range[axis].high, e.high[axis]);
            EXPECT_NEAR(cell.range[axis].tilt, e.tilt[axis], 0.5 / 32768);
        }
        EXPECT_NEAR(cell.probability, e.probability, 1e-7);
        EXPECT_EQ(cell.probability > 0.0, e.probability > 0.0);
    });
    EXPECT_EQ(i, expected.size());
}

TEST(Store, ReturningToAnAxis) {
    expect_cells({{{1, {3}, {0.25, 0.75}, {1, 2}, {}},
                   {0, {2, 5}, {0.5, 0.25, 0.25}, {-1, 3, -1}, {}},
                   {0, {7}, {0.1, 0.9}, {}, {}},
                   {1, {1}, {0.375, 0.625}, {-1, 4}, {}},
                   {0, {4}, {0.2, 0.8}, {}, {}}},
                  {0}},
                 8, 6);
}

TEST(Store, ASharedChild) {
    expect_cells({{{1, {1, 2}, {0.5, 0.25, 0.25}, {1, 1, 1}, {}}, {0, {3, 4}, {0.25, 0.5, 0.25}, {}, {}}}, {0}}, 9,
                 3);
}

TEST(Store, Tilts) {
    expect_cells({{{1, {4}, {0.5, 0.5}, {1, -1}, {0.5, -0.25}}, {0, {3}, {0.7, 0.3}, {}, {-0.999, 0.999}}}, {0}}, 8,
                 8);
    expect_cells({{{0, {}, {1.0}, {}, {0.3}}}, {0}}, 5, 5);
}

TEST(Store, DarkSegments) {
    expect_cells({{{1, {2, 3}, {0.0, 1.0, 0.0}, {-1, 1, -1}, {}}, {0, {1, 5}, {0.0, 1.0, 0.0}, {}, {}}}, {0}}, 6,
                 4);
}

TEST(Store, LargestEnvironment) {
    expect_cells(
        {{{0, {1, 0xFFFF}, {0.1, 0.2, 0.7}, {-1, 1, -1}, {}}, {1, {1, 0xFFFF}, {0.1, 0.2, 0.7}, {}, {}}}, {0}},
        0x10000, 0x10000);
}

/// The arrays of a curve as the sampling header reads them; an environment never needs wide positions.
void expect_positions(const std::vector<std::uint32_t>& knots, bool wide) {
    Curve curve{0, knots, std::vector<double>(knots.size() + 1, 0.3 / double(knots.size())), {}, {}};
    curve.probability[0] = 0.7;
    curve.tilts.assign(curve.segments(), -0.5);
    for (const double tolerance : {0.0, 1.0}) { // cumulative values wide and narrow
        const EncodedTree tree = encode_tree({{curve}, {0}}, tolerance);
        ASSERT_EQ(tree.bytes.size() % 4, 0u);
        std::vector<std::uint32_t> aligned(tree.bytes.size() / 4);
        std::memcpy(aligned.data(), tree.bytes.data(), tree.bytes.size());
        const AcdfCurve read = acdf_curve_at(reinterpret_cast<const std::uint8_t*>(aligned.data()), 0);
        EXPECT_EQ(acdf_wide_positions(&read), wide);
        EXPECT_EQ(acdf_wide_cumulative(&read), tolerance == 0.0);
        AcdfRange range = {0, 0xFFFFFFFF, 0.0};
        for (std::uint32_t i = 0; i < knots.size(); ++i) {
            acdf_curve_narrow(&read, i, &range);
            EXPECT_EQ(range.high, knots[i]);
            EXPECT_EQ(range.tilt, -0.5);
        }
        const std::size_t size =
            4 + knots.size() * (tolerance == 0.0 ? 4 : 2) + knots.size() * (wide ? 4 : 2) + (knots.size() + 1) * 2;
        EXPECT_GE(tree.bytes.size(), size);
        EXPECT_LT(tree.bytes.size(), size + 6); // padding before wide positions and after the tilts
    }
}

TEST(Store, PositionsWidenBeyondSixteenBits) {
    expect_positions({1, 0xFFFE, 0xFFFF}, false);
    expect_positions({1, 0xFFFF, 0x10000}, true);
    expect_positions({1, 70000}, true);
    expect_positions({7, 0xFFFFFFFE}, true);
}

TEST(Store, TheRootIsThatOfTheBin) {
    // Curve 0 belongs to nobody but the second root.
    const Cascade cascade{{{0, {1}, {0.5, 0.5}, {}, {}}, {0, {1, 2}, {0.25, 0.25, 0.5}, {}, {}}}, {1, 0}};
    const EncodedTree tree = encode_tree(cascade);
    ASSERT_EQ(tree.roots, (std::vector<std::uint32_t>{2, 0}));
    EXPECT_EQ(tree.bytes.size(), 8u + 12u);
}

TEST(Store, LinksWidenWhereSixteenBitsDoNotReach) {
    // The last child lies behind a curve of 65,536 segments, more than 65,535 words away.
    Cascade cascade;
    cascade.roots = {0};
    cascade.curves.push_back({1, {1, 2}, {0.25, 0.25, 0.5}, {1, -1, 2}, {}});
    Curve large{0, {}, {}, {}, {}};
    for (std::uint32_t i = 1; i < 0x10000; ++i) large.knots.push_back(i);
    large.probability.assign(0x10000, 0x1p-16);
    cascade.curves.push_back(large);
    cascade.curves.push_back({0, {500}, {0.25, 0.75}, {}, {}});
    expect_cells(cascade, 0x10000, 3);
    const EncodedTree tree = encode_tree(cascade);
    std::uint32_t header;
    std::memcpy(&header, tree.bytes.data(), 4);
    EXPECT_EQ((header & ACDF_CURVE_LINKS_MASK) >> ACDF_CURVE_LINKS_SHIFT, ACDF_LINKS_32 + 0u);
}

TEST(Store, NarrowsRarelyReachedCurvesFirst) {
    // The same lopsided child twice; where one sample in a million comes by, 16 bits are enough.
    const Curve child{0, {1}, {1e-3 / 7, 1.0 - 1e-3 / 7}, {}, {}};
    const Cascade cascade{{{1, {1}, {1e-6, 1.0 - 1e-6}, {1, 2}, {}}, child, child}, {0}};
    const EncodedTree tree = encode_tree(cascade, 1e-7);
    const auto wide = [&](std::size_t at) {
        std::uint32_t header;
        std::memcpy(&header, tree.bytes.data() + at, 4);
        return (header & ACDF_CURVE_WIDE_CUMULATIVE) != 0;
    };
    const std::size_t root_bytes = 4 + 4 + 2 + 4 + 2; // header, wide cumulative, knot, two links, padding
    ASSERT_TRUE(wide(0));
    EXPECT_FALSE(wide(root_bytes));
    EXPECT_TRUE(wide(root_bytes + 8));
}

TEST(Store, RefusesWhatTheFormatCannotHold) {
    Curve curve;
    curve.probability.assign(ACDF_MAX_SEGMENTS + 1, 1.0 / (ACDF_MAX_SEGMENTS + 1));
    for (std::uint32_t i = 1; i <= ACDF_MAX_SEGMENTS; ++i) curve.knots.push_back(i);
    EXPECT_THROW(encode_tree({{curve}, {0}}), std::invalid_argument);

    const EncodedTree tree = encode_tree({{{0, {}, {1.0}, {}, {}}}, {0}});
    Description description = environment_description(1, 1);
    description.axes[0].name = "sixteen letters.";
    EXPECT_THROW(store(tree, description), std::invalid_argument);
    description = environment_description(1, 1);
    description.shares = {0.5f, 0.5f};
    EXPECT_THROW(store(tree, description), std::invalid_argument);
}

TEST(Store, DescribesTheFile) {
    Description d = environment_description(12, 7);
    d.fit = ACDF_FIT_PDF;
    d.filter = ACDF_FILTER_BILINEAR;
    d.total = 42.5;
    d.channel_weights[0] = 1.0, d.channel_weights[1] = 0.5, d.channel_weights[2] = 0.25;
    d.metadata = {{"source", "sky.exr"}, {"empty", ""}};
    for (const AcdfCodec codec : {ACDF_CODEC_NONE, ACDF_CODEC_ZLIB}) {
        const auto bytes = store(encode_tree({{{0, {}, {1.0}, {}, {}}}, {0}}), d, codec);
        EXPECT_EQ(bytes.size() % ACDF_ALIGNMENT, 0u);
        acdf::File file;
        const acdf::Status status = acdf::File::from_memory(bytes.data(), bytes.size(), file);
        ASSERT_TRUE(status.ok()) << status.message;
        EXPECT_EQ(file.kind(), ACDF_KIND_ENVIRONMENT);
        EXPECT_EQ(file.size(), bytes.size());
        EXPECT_EQ(file.description().fit, ACDF_FIT_PDF + 0u);
        EXPECT_EQ(file.description().filter, ACDF_FILTER_BILINEAR + 0u);
        EXPECT_EQ(file.description().channel_weights[1], 0.5);
        EXPECT_EQ(file.axis(0).resolution, 12u);
        EXPECT_EQ(file.axis(1).resolution, 7u);
        EXPECT_EQ(file.environment().total(), 42.5);
        EXPECT_EQ(file.metadata_count(), 2u);
        const acdf::Text source = file.metadata("source");
        EXPECT_EQ(std::string(source.data, source.size), "sky.exr");
        EXPECT_EQ(file.metadata("empty").size, 0u);
    }
}

TEST(Store, CompressionChangesNoSample) {
    const Target t = acdf_test::noise_target(64, 32, 1);
    Cascade cascade{{{1, {}, {}, {}, {}}}, {0}};
    for (std::uint32_t r = 0; r < 32; ++r) {
        if (r > 0) cascade.curves[0].knots.push_back(r);
        cascade.curves[0].probability.push_back(1.0 / 32);
        cascade.curves[0].children.push_back(static_cast<std::int32_t>(r + 1));
        cascade.curves.push_back({0, {10, 20 + r, 63}, {0.25, 0.25, 0.125, 0.375}, {}, {}});
    }
    const Stored plain = stored(cascade, 64, 32), small = stored(cascade, 64, 32, ACDF_CODEC_ZLIB);
    EXPECT_LT(small.bytes.size(), plain.bytes.size());
    std::mt19937_64 random(3);
    for (int i = 0; i < 1000; ++i) {
        const double u0 = acdf_test::uniform(random), u1 = acdf_test::uniform(random);
        const auto a = plain.file.environment().sample(u0, u1), b = small.file.environment().sample(u0, u1);
        EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0);
    }
}

} // namespace
