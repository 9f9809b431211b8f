// encode_tree and store: what goes in comes out through the reader.
#include "tests/inputs/synthetic.h"
#include "tests/lib/compress/cascade_cells.h"

#include "build/accuracy/cells.h"
#include "compress/store/store.h"

#include <acdf/curves/curves.h>
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
    const acdf::Status status =
        acdf::File::from_memory(s.bytes.data(), s.bytes.size(), s.file, acdf::with_curves());
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
    acdf::build::for_each_cell(s.file, s.file.bin(0).root, [&](const acdf::build::Cell& cell) {
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

/// The first curve of a tree, decoded where it is aligned.
struct Decoded {
    explicit Decoded(const EncodedTree& tree, std::uint32_t at = 0) : words(tree.bytes.size() / 4 + 1) {
        std::memcpy(words.data(), tree.bytes.data(), tree.bytes.size());
        end = 2 * acdf_curve_decode(reinterpret_cast<const std::uint8_t*>(words.data()), at, &curve);
    }
    std::uint32_t cumulative_code() const { return ACDF_CURVE_CUMULATIVE_CODE(curve.header); }
    std::uint32_t position_code() const { return ACDF_CURVE_POSITION_CODE(curve.header); }
    std::uint32_t link_code() const { return ACDF_CURVE_LINK_CODE(curve.header); }

    std::vector<std::uint32_t> words;
    AcdfCurve curve;
    std::size_t end;
};

/// Stores one tilted curve with values of every width and reads its knots and tilts again.
void expect_positions(const std::vector<std::uint32_t>& knots, std::uint32_t code) {
    Curve curve{0, knots, std::vector<double>(knots.size() + 1, 0.3 / double(knots.size())), {}, {}};
    curve.probability[0] = 0.7;
    curve.tilts.assign(curve.segments(), -0.5);
    const double prices[] = {1.0, 1e-7, 0.0};
    for (std::uint32_t width = 0; width < 3; ++width) {
        const EncodedTree tree = encode_tree({{curve}, {0}}, prices[width]);
        const Decoded read(tree);
        EXPECT_EQ(read.position_code(), code);
        EXPECT_EQ(read.cumulative_code(), width);
        EXPECT_EQ(read.end, tree.bytes.size());
        for (std::uint32_t i = 0; i < knots.size(); ++i) {
            AcdfTiltedRange range = {0, 0xFFFFFFFF, 0.0};
            acdf_curve_narrow(&read.curve, i, &range);
            EXPECT_EQ(range.high, knots[i]);
            EXPECT_EQ(range.low, i == 0 ? 0 : knots[i - 1]);
            EXPECT_EQ(range.tilt, -0.5);
        }
    }
}

TEST(Store, PositionsAreAsWideAsTheyMustBe) {
    expect_positions({1, 0xFE, 0xFF}, 0);
    expect_positions({1, 0xFF, 0x100}, 1);
    expect_positions({1, 0xFFFE, 0xFFFF}, 1);
    expect_positions({1, 0xFFFF, 0x10000}, 2);
    expect_positions({7, 0xFFFFFFFE}, 2);
}

TEST(Store, OneByteCountsFromTheLowEndOfTheRange) {
    // The lower curve splits rows 300 to 900, at 310 and at 555: 10 and 255 from 300.
    const Cascade cascade{
        {{1, {300, 900}, {0.25, 0.5, 0.25}, {-1, 1, -1}, {}}, {1, {310, 555}, {0.2, 0.3, 0.5}, {}, {}}}, {0}};
    expect_cells(cascade, 1, 1000);
    Cascade far = cascade;
    far.curves[1].knots[1] = 556;
    expect_cells(far, 1, 1000);
    const EncodedTree near_tree = encode_tree(cascade), far_tree = encode_tree(far);
    const Decoded root(near_tree);
    const std::uint32_t child = acdf_curve_link(&root.curve, 1);
    EXPECT_EQ(Decoded(near_tree, child).position_code(), 0u);
    EXPECT_EQ(Decoded(far_tree, child).position_code(), 1u);
}

TEST(Store, ASharedChildWhoseRangesBeginAtDifferentPositions) {
    // Left of column 3 the last curve refines rows 2 to 6, right of it rows 0 to 8.
    const Cascade cascade{{{0, {3}, {0.5, 0.5}, {1, 2}, {}},
                           {1, {2, 6}, {0.25, 0.5, 0.25}, {-1, 2, -1}, {}},
                           {1, {4, 5}, {0.25, 0.25, 0.5}, {}, {}}},
                          {0}};
    expect_cells(cascade, 8, 8);
}

TEST(Store, ManySegments) {
    for (const std::uint32_t segments : {62u, 63u, 64u, 65u, 255u, 256u, 300u}) {
        SCOPED_TRACE(segments);
        Curve curve{0, {}, std::vector<double>(segments, 1.0 / segments), {}, {}};
        for (std::uint32_t i = 1; i < segments; ++i) curve.knots.push_back(2 * i);
        expect_cells({{curve}, {0}}, 2 * segments, 1);
        EXPECT_EQ(Decoded(encode_tree({{curve}, {0}})).curve.segments, segments);
    }
}

TEST(Store, TheRootIsThatOfTheBin) {
    // Curve 0 belongs to nobody but the second root.
    const Cascade cascade{{{0, {1}, {0.5, 0.5}, {}, {}}, {0, {1, 2}, {0.25, 0.25, 0.5}, {}, {}}}, {1, 0}};
    const EncodedTree tree = encode_tree(cascade, 1.0); // header, one byte a value, one a knot
    ASSERT_EQ(tree.roots, (std::vector<std::uint32_t>{2, 0}));
    EXPECT_EQ(tree.bytes.size(), 4u + 6u);
}

/// A tree whose last child lies behind a curve of so many segments.
Cascade far_link(std::uint32_t segments) {
    Cascade cascade;
    cascade.roots = {0};
    cascade.curves.push_back({1, {1, 2}, {0.25, 0.25, 0.5}, {1, -1, 2}, {}});
    Curve large{0, {}, {}, {}, {}};
    for (std::uint32_t i = 1; i < segments; ++i) large.knots.push_back(i);
    large.probability.assign(segments, 1.0 / segments);
    cascade.curves.push_back(large);
    cascade.curves.push_back({0, {segments / 2}, {0.25, 0.75}, {}, {}});
    return cascade;
}

/// Readers take no more curves than a quarter of TREE's bytes, and a curve of one cell has two.
TEST(Store, ManyBinsOfOneCellShareTheirCurve) {
    const Curve bare{1, {}, {1.0}, {}, {}}, split{0, {3}, {0.25, 0.75}, {}, {}};
    Cascade cascade{std::vector<Curve>(12, bare), {}};
    cascade.curves[2] = split;
    for (std::uint32_t i = 0; i < 12; ++i) cascade.roots.push_back(i);
    const EncodedTree tree = encode_tree(cascade);
    EXPECT_LE(tree.bytes.size(), 12u);
    for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(tree.roots[i], i == 2 ? 1u : 0u);
    // Where the others make up for them they are left as they are.
    const EncodedTree two = encode_tree({{bare, split, bare}, {0, 1, 2}}, 0.0);
    EXPECT_LT(two.roots[1], two.roots[2]);
}

TEST(Store, LinksAreAsWideAsTheyMustBe) {
    const std::uint32_t segments[] = {20, 2000, 0x10000};
    for (std::uint32_t code = 1; code <= 3; ++code) {
        const Cascade cascade = far_link(segments[code - 1]);
        expect_cells(cascade, 0x10000, 3);
        EXPECT_EQ(Decoded(encode_tree(cascade)).link_code(), code);
    }
}

TEST(Store, LinksOfExactly255And256Units) {
    // Each more segment of the curve between moves the last child by half a unit or more.
    bool narrow = false, wide = false;
    for (std::uint32_t n = 100; n < 400; ++n) {
        const EncodedTree tree = encode_tree(far_link(n), 1.0);
        const Decoded root(tree);
        const std::uint32_t link = acdf_curve_link(&root.curve, 2);
        EXPECT_EQ(Decoded(tree, link).curve.segments, 2u);
        EXPECT_EQ(root.link_code(), link <= 255 ? 1u : 2u);
        narrow |= link > 250 && link <= 255;
        wide |= link >= 256 && link < 262;
    }
    EXPECT_TRUE(narrow && wide);
}

TEST(Store, NarrowsRarelyReachedCurvesFirst) {
    // The same lopsided child twice; where one sample in a million comes by, fewer bits are enough.
    const Curve child{0, {1}, {1e-3 / 7, 1.0 - 1e-3 / 7}, {}, {}};
    const Cascade cascade{{{1, {1}, {1e-6, 1.0 - 1e-6}, {1, 2}, {}}, child, child}, {0}};
    const EncodedTree tree = encode_tree(cascade, 1e-8);
    const Decoded root(tree);
    const Decoded rare(tree, acdf_curve_link(&root.curve, 0)), usual(tree, acdf_curve_link(&root.curve, 1));
    EXPECT_LT(rare.cumulative_code(), usual.cumulative_code());
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

TEST(Store, ACurveWithoutKnotsTakesNoWiderPositions) { // wherever its range begins
    const EncodedTree tree = encode_tree({{{0, {300}, {0.5, 0.5}, {-1, 1}, {}}, {0, {}, {1.0}, {}, {}}}, {0}}, 0.0);
    const AcdfCurve root = acdf_curve_at(tree.bytes.data(), 0);
    const AcdfCurve child = acdf_curve_at(tree.bytes.data(), acdf_curve_link(&root, 1));
    EXPECT_EQ(child.segments, 1u);
    EXPECT_EQ(ACDF_CURVE_POSITION_CODE(child.header), 0u);
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
        const acdf::Status status = acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves());
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
