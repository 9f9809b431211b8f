// tree_to_planes: what the reader puts together again is the tree, byte for byte.
#include "tests/inputs/synthetic.h"
#include "tests/lib/curves/open.h"

#include "compress/fit/fit.h"
#include "compress/store/planes.h"
#include "compress/store/store.h"

#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <cstring>

namespace {

using namespace acdf::compress;

std::uint32_t codec_of_tree(const std::vector<std::uint8_t>& file) {
    AcdfHeader header;
    std::memcpy(&header, file.data(), sizeof header);
    for (std::uint32_t i = 0; i < header.chunk_count; ++i) {
        AcdfChunk chunk;
        std::memcpy(&chunk, file.data() + sizeof header + i * sizeof chunk, sizeof chunk);
        if (chunk.type == ACDF_CHUNK_TREE) return chunk.codec;
    }
    return ~0u;
}

/// Stores a tree with zlib, expects that codec and returns the size.
std::size_t expect_the_same(const EncodedTree& tree, std::uint32_t columns, std::uint32_t rows, AcdfCodec codec) {
    const auto bytes = store(tree, environment_description(columns, rows), ACDF_CODEC_ZLIB);
    EXPECT_EQ(codec_of_tree(bytes), std::uint32_t{codec});
    acdf::File file;
    const acdf::Status status = acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves());
    EXPECT_TRUE(status.ok()) << status.message;
    if (!status.ok()) return 0;
    EXPECT_EQ(2 * std::size_t{acdf_test::TreeOf(file).units}, tree.bytes.size());
    EXPECT_EQ(std::memcmp(acdf_test::TreeOf(file).data, tree.bytes.data(), tree.bytes.size()), 0);
    return bytes.size();
}

TEST(Planes, OfEveryFitOfCurves) {
    const Target target = acdf_test::noise_target(200, 100, 5);
    for (const AcdfFit fit : {ACDF_FIT_UNIFORM, ACDF_FIT_CDF, ACDF_FIT_PDF}) {
        FitOptions options;
        options.fit = fit;
        options.column_segments = options.row_segments = 40;
        const EncodedTree tree = acdf::compress::fit(target, options).tree;
        const std::size_t size = expect_the_same(tree, 200, 100, ACDF_CODEC_PLANES);
        EXPECT_LT(size, store(tree, environment_description(200, 100)).size());
    }
}

/// More segments than a byte counts, every width of values, and children in an order of their own.
TEST(Planes, OfLongAndWideCurves) {
    Cascade cascade;
    cascade.roots = {0};
    cascade.curves.emplace_back();
    Curve root;
    for (std::uint32_t s = 0; s < 400; ++s) {
        if (s > 0) root.knots.push_back(160 * s);
        root.probability.push_back(s % 3 == 0 ? 1e-5 : 1.0);
        root.children.push_back(s % 2 == 0 ? static_cast<std::int32_t>(200 - s / 2) : -1);
        if (s % 2 == 0) cascade.curves.push_back({1, {s + 1, 65000}, {0.5, 0.4, 0.1}, {}, {0.5, 0.0, -0.25}});
    }
    double sum = 0.0;
    for (const double p : root.probability) sum += p;
    for (double& p : root.probability) p /= sum;
    cascade.curves[0] = root;
    expect_the_same(encode_tree(cascade, 0.0), 65536, 65536, ACDF_CODEC_PLANES);
}

TEST(Planes, NotOfCurvesWithTwoParents) {
    Cascade cascade{{{0, {}, {}, {}, {}}, {1, {2}, {0.5, 0.5}, {}, {}}}, {0}};
    for (std::uint32_t s = 0; s < 60; ++s) {
        if (s > 0) cascade.curves[0].knots.push_back(s);
        cascade.curves[0].probability.push_back(1.0 / 60);
        cascade.curves[0].children.push_back(1);
    }
    const EncodedTree tree = encode_tree(cascade, 0.0);
    EXPECT_TRUE(tree_to_planes(tree.bytes).empty());
    expect_the_same(tree, 60, 4, ACDF_CODEC_ZLIB);
}

} // namespace
