// What the reader allocates: its calls are caught by the linker (--wrap), zlib's and the test's are not.
#include "tests/lib/curves/open.h"
#include "tests/lib/curves/planes.h"
#include "tests/lib/reader/count_allocations.h"

#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

using namespace acdf_test;

namespace {

// 200000 curves of two segments and four bytes: as many as rule 6018 allows, the tree with the most scratch a byte.
EnvironmentSpec large() {
    EnvironmentSpec spec;
    CurveSpec curve;
    curve.positions = {1};
    curve.cumulative = {128};
    spec.columns = 2;
    spec.tree.curves.assign(200000, curve);
    return spec;
}

TEST(Allocation, isBelowFourTimesTheFile) {
    for (bool zlib : {false, true}) {
        EnvironmentSpec spec = large();
        spec.zlib = zlib;
        Bytes bytes = spec.encode();
        bytes.insert(bytes.begin(), 1, 0); // at an odd address: it must be copied
        const std::size_t size = bytes.size() - 1, in_memory = size + (zlib ? 4 * spec.tree.curves.size() : 0);
        acdf::File file;
        {
            Counted counted;
            ASSERT_TRUE(acdf::File::from_memory(bytes.data() + 1, size, file, acdf::with_curves()).ok());
        }
        EXPECT_GT(bytes_taken, size); // the copy, so that the count is known to count
        EXPECT_LE(bytes_taken, 4 * in_memory);
    }
}

/// Opens a file in place and without runtime tables, counting what is taken.
void check_in_place(const Bytes& bytes) {
    acdf::File file;
    acdf::LoadOptions options;
    options.tables = false;
    Counted counted;
    ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves(options)).ok());
}

TEST(Allocation, inPlaceOnlyTheScratchOfTheChecks) {
    const Bytes bytes = large().encode();
    check_in_place(bytes);
    EXPECT_EQ(calls, 4u);                           // and what an open file is
    EXPECT_LE(10 * bytes_taken, 21 * bytes.size()); // 8 bytes a curve, 12 a run of 64 units
}

TEST(Allocation, nothingForWhatIsRefusedBefore) {
    EnvironmentSpec spec = large();
    spec.zlib = true; // 800 kB from about 1 kB
    const Bytes bytes = spec.encode();
    acdf::Limits limits;
    limits.max_inflated_bytes = 100000;
    acdf::File file;
    Counted counted;
    EXPECT_EQ(acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves(limits)).rule, 3012);
    EXPECT_EQ(calls, 0u);
    limits.max_file_bytes = 100;
    EXPECT_EQ(acdf::File::from_memory(bytes.data() + 1, bytes.size(), file, acdf::with_curves(limits)).rule, 1004);
    EXPECT_EQ(calls, 0u);
}

TEST(Allocation, planesTakeTwiceTheTreeForAMoment) {
    const EnvironmentSpec spec = preorder_environment();
    const Bytes plain = EnvironmentSpec(spec).encode(), bytes = as_planes(spec).encode();
    acdf::File file;
    std::size_t in_place = 0;
    {
        Counted counted;
        ASSERT_TRUE(acdf::File::from_memory(plain.data(), plain.size(), file, acdf::with_curves()).ok());
        in_place = bytes_taken;
    }
    const std::size_t tree = 2 * TreeOf(file).units;
    acdf::Limits limits;
    {
        Counted counted;
        ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves(limits)).ok());
        EXPECT_LE(bytes_taken, in_place + tree + 64 + 2 * tree + 44);
    }
    limits.max_inflated_bytes = tree - 1;
    Counted counted;
    EXPECT_EQ(acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves(limits)).rule, 3012);
    EXPECT_EQ(calls, 0u);
}

TEST(Allocation, noneWhileSampling) {
    const Bytes bytes = complete_environment().encode();
    acdf::File file;
    ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves()).ok());
    const acdf::EnvironmentView view = file.environment();
    Counted counted;
    float sum = 0.0f;
    for (int i = 0; i < 1000; ++i) sum += view.pdf(view.sample(i / 1000.0, 0.3).direction);
    EXPECT_GT(sum, 0.0f);
    EXPECT_EQ(calls, 0u);
}

} // namespace
