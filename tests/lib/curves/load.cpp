// Files of curves are loaded where the room is at hand, by planes as without, and refused where it is not.
#include "tests/lib/reader/load.h"
#include "tests/lib/curves/open.h"
#include "tests/lib/curves/planes.h"
#include "tests/lib/reader/golden_files.h"

#include <acdf/environment_view.h>
#include <acdf/moved.h>

#include <gtest/gtest.h>

using namespace acdf_test;
using acdf::File;
using acdf::Status;
using acdf::with_curves;

namespace {

// Children in 300 segments of a curve of 301: more than a byte can count.
EnvironmentSpec wide_preorder() {
    EnvironmentSpec spec;
    spec.columns = 301;
    spec.rows = 4000;
    std::vector<std::uint32_t> columns;
    for (std::uint32_t i = 1; i < 301; ++i) columns.push_back(i);
    CurveSpec root = even_curve(0, columns);
    root.link_bytes = 2;
    root.children.assign(301, -1);
    spec.tree.curves.clear();
    for (int i = 0; i < 300; ++i) root.children[static_cast<std::size_t>(300 - i)] = i + 1;
    spec.tree.curves.push_back(root);
    for (std::uint32_t i = 0; i < 300; ++i) spec.tree.curves.push_back(even_curve(1, {7 * i + 3, 9 * i + 1000}));
    return spec;
}

TEST(Memory, planesAreTheSame) {
    for (const EnvironmentSpec& spec : {preorder_environment(), chain(64), chain(1), wide_preorder()}) {
        EnvironmentSpec same = spec;
        const Bytes plain = same.encode(), packed = as_planes(spec).encode();
        File a, b;
        const Status plain_status = File::from_memory(plain.data(), plain.size(), a, with_curves());
        const Status status = File::from_memory(packed.data(), packed.size(), b, with_curves());
        ASSERT_TRUE(plain_status.ok()) << plain_status.message;
        ASSERT_TRUE(status.ok()) << status.message;
        EXPECT_TRUE(findings(packed).rules.empty()) << findings(packed).text;
        ASSERT_EQ(TreeOf(a).units, TreeOf(b).units);
        EXPECT_EQ(std::memcmp(TreeOf(a).data, TreeOf(b).data, 2 * TreeOf(a).units), 0);
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(TreeOf(b).data) % 64, 0u);
    }
}

TEST(Damage, planesWithAFlippedBitAreRefused) {
    const Bytes file = as_planes(preorder_environment()).encode();
    for (std::size_t bit = 0; bit < 8 * file.size(); ++bit) {
        Bytes damaged = file;
        damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ 1u << bit % 8);
        ASSERT_FALSE(load(damaged).ok()) << bit;
    }
}

// Which fit it is, what is missing, and what helps.
TEST(WithoutCurves, filesAreRefusedAsUnsupported) {
    int refused = 0;
    each_golden_file([&](const Bytes& bytes) {
        File with, without;
        ASSERT_TRUE(File::from_memory(bytes.data(), bytes.size(), with, with_curves()).ok());
        const Status status = File::from_memory(bytes.data(), bytes.size(), without);
        const bool curves = TreeOf(with).data;
        ASSERT_EQ(status.ok(), !curves) << status.message;
        if (!curves) return;
        ++refused;
        const std::string message = status.message;
        EXPECT_EQ(status.code, ACDF_UNSUPPORTED);
        EXPECT_EQ(status.rule, 5002);
        EXPECT_NE(message.find("it has curves (chunk TREE)"), std::string::npos) << message;
        EXPECT_NE(message.find("acdf_curves()"), std::string::npos) << message;
        AcdfError error;
        EXPECT_EQ(acdf_from_memory(bytes.data(), bytes.size(), &error), nullptr);
        EXPECT_EQ(error.message, message);
        std::multiset<int> rules;
        acdf::validate(bytes.data(), bytes.size(), [&](const acdf::Finding& f) { rules.insert(f.number); });
        EXPECT_EQ(rules, std::multiset<int>{5002});
    });
    EXPECT_GE(refused, 10);
}

// Their pointers would lead to functions of this process.
TEST(WithCurves, viewsCannotBeMoved) {
    int curves = 0;
    each_golden_file([&](const Bytes& bytes) {
        File file;
        ASSERT_TRUE(File::from_memory(bytes.data(), bytes.size(), file, with_curves()).ok());
        AcdfMove moves[ACDF_MAX_MOVES];
        const int count = file.memory(moves);
        if (!TreeOf(file).data || file.kind() != ACDF_KIND_ENVIRONMENT) return;
        ++curves;
        AcdfEnvironment moved = file.environment().data();
        acdf_move_environment(&moved, moves, count);
        EXPECT_EQ(moved.curves, nullptr);
        EXPECT_EQ(moved.tree, nullptr);
        EXPECT_TRUE(acdf::EnvironmentView(moved).empty());
    });
    EXPECT_GE(curves, 5);
}

} // namespace
