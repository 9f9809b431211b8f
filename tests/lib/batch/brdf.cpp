// Many views at once: the same as one by one, on files made by hand and on the frozen ones.
#include "tests/lib/batch/brdf.h"
#include "tests/inputs/sanitized.h"
#include "tests/lib/reader/brdf_forms.h"
#include "tests/lib/reader/brdf_loaded.h"

using namespace acdf_test;

namespace {

TEST(Batch, IsTheViewBitForBit) {
    for (auto& [name, spec] : brdf_forms()) {
        SCOPED_TRACE(name);
        const Loaded loaded(spec.encode());
        ASSERT_FALSE(loaded.file.empty());
        for (const std::size_t count : {0u, 1u, 7u, 8u, 23u, 24u, 25u, 1000u})
            expect_batch_is_the_view(loaded.view(), count);
    }
}

class GoldenBatch : public testing::TestWithParam<const char*> {};

TEST_P(GoldenBatch, IsTheViewBitForBit) {
    acdf::File file;
    const std::string path = std::string(ACDF_TEST_DIR "/golden/v1.0/") + GetParam() + ".acdf";
    ASSERT_TRUE(acdf::File::open(path.c_str(), file).ok());
    expect_batch_is_the_view(file.brdf(), std::size_t(acdf_test::repeated(20000)));
}

INSTANTIATE_TEST_SUITE_P(V1_0, GoldenBatch,
                         testing::Values("brdf", "brdf_mirrored", "brdf_anisotropic", "brdf_floor",
                                         "brdf_separate"),
                         [](const auto& info) { return std::string(info.param); });

TEST(Batch, ServesByVectorsWhatIsIsotropicAndShared) {
    const auto served = [](BrdfSpec spec) {
        const Loaded loaded(spec.encode());
        acdf::BrdfBatch batch;
        EXPECT_TRUE(acdf::BrdfBatch::prepare(loaded.view(), batch).ok());
        return batch.instructions() != acdf::Instructions::none;
    };
    BrdfSpec floor = shared_brdf();
    floor.diffuse_share = 0.5f;
    EXPECT_FALSE(served(floor));
    EXPECT_FALSE(served(separate_brdf()));
#if defined(__x86_64__)
    EXPECT_EQ(served(shared_brdf()), __builtin_cpu_supports("avx2") != 0);
#endif
}

TEST(Batch, HasNoTableOfManyBorders) {
    const Loaded loaded(many_borders().encode());
    acdf::BrdfBatch batch;
    ASSERT_TRUE(acdf::BrdfBatch::prepare(loaded.view(), batch).ok());
    EXPECT_LT(batch.bytes(), std::size_t{256} * 2048); // which all the pairs of positions are more than
}

TEST(Batch, HasTablesInProportionToTheFile) {
    BrdfSpec spec = many_borders();
    spec.nodes.clear(), spec.bins.clear();
    for (std::uint32_t i = 0; i < 40000; ++i) {
        spec.nodes.push_back(static_cast<float>(i) / 40000.0f);
        spec.bins.push_back({i % 3, 0.01f});
    }
    const Loaded loaded(spec.encode());
    ASSERT_FALSE(loaded.file.empty());
    acdf::BrdfBatch batch;
    ASSERT_TRUE(acdf::BrdfBatch::prepare(loaded.view(), batch).ok());
    EXPECT_EQ(batch.bytes(), 0u); // a gigabyte for half a megabyte
    expect_batch_is_the_view(loaded.view(), 100);
}

TEST(Batch, MovesAndIsMadeAnew) {
    BrdfSpec spec = shared_brdf();
    const Loaded loaded(spec.encode());
    const acdf::BrdfView view = loaded.view();
    acdf::BrdfBatch first, second;
    ASSERT_TRUE(acdf::BrdfBatch::prepare(view, first).ok());
    const std::size_t bytes = first.bytes();
    second = std::move(first);
    EXPECT_EQ(second.bytes(), bytes);
    acdf::BrdfBatch third(std::move(second));
    ASSERT_TRUE(acdf::BrdfBatch::prepare(view, third, acdf::Instructions::none).ok());
    EXPECT_EQ(third.bytes(), 0u);
    const float wo[1][3] = {{0.6f, 0.0f, 0.8f}};
    const double u[1][2] = {{0.25, 0.75}};
    acdf::DirectionSample out;
    third.sample(wo, u, 1, &out);
    EXPECT_EQ(out.pdf, view.sample(wo[0], 0.25, 0.75).pdf);
}

} // namespace
