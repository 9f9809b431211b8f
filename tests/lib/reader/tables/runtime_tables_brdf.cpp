// Runtime tables of BRDFs beside the traversal that they replace: the same samples and pdfs to the bit, on files
// made by hand, of many cells and of the frozen ones.
#include "tests/lib/batch/brdf.h"
#include "tests/lib/reader/brdf_forms.h"
#include "tests/lib/reader/tables/tables_pair.h"

#include <fstream>
#include <iterator>

using namespace acdf_test;

namespace {

struct BrdfPair : TablesPair {
    using TablesPair::TablesPair;
    const AcdfBrdfTables* tables() const { return fast.brdf().data().tables; }
};

bool same(const acdf::DirectionSample& a, const acdf::DirectionSample& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

void expect_the_walk(const BrdfPair& pair, std::size_t count) {
    const acdf::BrdfView fast = pair.fast.brdf(), plain = pair.plain.brdf();
    const Queries asked(plain, count);
    std::size_t strays = 0; // out of the cell whose pdf they have: floats do not resolve cells of 2^-24
    for (std::size_t i = 0; i < count; ++i) {
        const float *wo = asked.wo()[i], *wi = asked.wi()[i];
        const double* u = asked.u()[i];
        ASSERT_TRUE(same(fast.sample(wo, u[0], u[1]), plain.sample(wo, u[0], u[1]))) << i;
        ASSERT_EQ(fast.pdf(wo, wi), plain.pdf(wo, wi)) << i;
        AcdfBrdfView views[2];
        ASSERT_EQ(acdf_brdf_view(&fast.data(), wo, &views[0]), acdf_brdf_view(&plain.data(), wo, &views[1]));
        if (!acdf_brdf_view(&fast.data(), wo, &views[0])) continue;
        ASSERT_TRUE(same(acdf_brdf_view_sample(&fast.data(), &views[0], u[0], u[1]),
                         acdf_brdf_view_sample(&plain.data(), &views[1], u[0], u[1])))
            << i;
        ASSERT_EQ(acdf_brdf_view_pdf(&fast.data(), &views[0], wi), acdf_brdf_view_pdf(&plain.data(), &views[1], wi))
            << i;
        const AcdfDirectionSample about = acdf_brdf_view_about(&fast.data(), &views[0], u[0], u[1]);
        const double there = acdf_brdf_view_pdf(&fast.data(), &views[0], about.direction);
        strays += !(std::fabs(about.pdf - there) <= 1e-4 * there);
        ASSERT_EQ(fast.albedo(wo), plain.albedo(wo));
        const acdf::DirectionSample s = fast.sample(wo, u[0], u[1]);
        if (s.pdf > 0.0f && s.direction[2] > 0.0f) {
            ASSERT_EQ(fast.pdf(wo, s.direction), s.pdf) << i;
        }
    }
    EXPECT_LE(strays, count / 10);
}

TEST(RuntimeTablesOfBrdfs, AreTheTraversalBitForBit) {
    for (auto& [name, spec] : brdf_forms()) {
        SCOPED_TRACE(name);
        expect_the_walk(BrdfPair(spec.encode()), 3000);
    }
}

class GoldenTablesOfBrdfs : public testing::TestWithParam<const char*> {};

TEST_P(GoldenTablesOfBrdfs, AreTheTraversalBitForBit) {
    std::ifstream in(std::string(ACDF_TEST_DIR "/golden/v1.0/") + GetParam() + ".acdf", std::ios::binary);
    const std::vector<std::uint8_t> bytes((std::istreambuf_iterator<char>(in)), {});
    expect_the_walk(BrdfPair(bytes), 5000);
}

INSTANTIATE_TEST_SUITE_P(V1_0, GoldenTablesOfBrdfs,
                         testing::Values("brdf", "brdf_mirrored", "brdf_anisotropic", "brdf_floor",
                                         "brdf_separate"),
                         [](const auto& info) { return std::string(info.param); });

TEST(RuntimeTablesOfBrdfs, AreForWhatIsIsotropicAndShared) {
    const BrdfPair shared(shared_brdf().encode());
    ASSERT_NE(shared.tables(), nullptr);
    EXPECT_NE(shared.tables()->grid, 0u);
    EXPECT_NE(shared.tables()->guesses, 0u);
    EXPECT_EQ(shared.fast.table_bytes(), 4u * shared.tables()->words);
    BrdfSpec floor = shared_brdf();
    floor.diffuse_share = 0.5f;
    EXPECT_EQ(BrdfPair(floor.encode()).tables(), nullptr);
    EXPECT_EQ(BrdfPair(separate_brdf().encode()).tables(), nullptr);
}

TEST(RuntimeTablesOfBrdfs, HaveNoGridOfManyBorders) {
    const BrdfPair pair(many_borders().encode());
    ASSERT_NE(pair.tables(), nullptr);
    EXPECT_EQ(pair.tables()->grid, 0u);
    EXPECT_NE(pair.tables()->guesses, 0u);
}

TEST(RuntimeTablesOfBrdfs, AreNoneWhereManyViewsShareFewRows) {
    BrdfSpec spec = many_borders();
    spec.nodes.clear(), spec.bins.clear();
    for (std::uint32_t i = 0; i < 40000; ++i) {
        spec.nodes.push_back(static_cast<float>(i) / 40000.0f);
        spec.bins.push_back({i % 3, 0.01f});
    }
    const BrdfPair pair(spec.encode());
    EXPECT_EQ(pair.tables(), nullptr); // 650 MB
    expect_the_walk(pair, 100);
}

#ifdef ACDF_BRDF_GUESSES
/// Most guesses are right, or samples would take the traversal.
TEST(RuntimeTablesOfBrdfs, GuessMostCells) {
    BrdfSpec spec = shared_brdf(); // eight by eight cells, half-way between views those of one
    spec.columns = spec.rows = 1024, spec.splits.clear(), spec.codes.assign(3, {});
    std::uint32_t tiles = 0;
    halve(spec, {{0, 0}, {1024, 1024}}, 6, tiles);
    for (std::size_t row = 0; row < 3; ++row) spec.codes[row].assign(spec.splits.size(), 120);
    const BrdfPair pair(spec.encode());
    const AcdfBrdf brdf = pair.fast.brdf().data();
    ASSERT_NE(pair.tables(), nullptr);
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    int right = 0;
    for (int i = 0; i < 1000; ++i) {
        const double z = uniform(random);
        const float wo[3] = {static_cast<float>(std::sqrt(1.0 - z * z)), 0.0f, static_cast<float>(z)};
        AcdfBrdfView view;
        ASSERT_TRUE(acdf_brdf_view(&brdf, wo, &view));
        double u[2] = {uniform(random), uniform(random)};
        AcdfRange range[2];
        const std::uint32_t guess = acdf_brdf_guess(pair.tables(), view.lower, u);
        double probability;
        acdf_brdf_whole(&brdf, range);
        right += acdf_blend_sample_tile(&brdf.blend, &view.mix, u, range, &probability) == guess;
    }
    EXPECT_GT(right, 600);
}

/// Where a guess is wrong, samples go on beyond a side of its cell: there lies what the middle of that side
/// touches.
TEST(RuntimeTablesOfBrdfs, NameCellsBeyondSides) {
    const BrdfPair pair(many_borders().encode());
    const AcdfBrdf brdf = pair.fast.brdf().data();
    ASSERT_NE(pair.tables(), nullptr);
    const auto* paths = static_cast<const AcdfBrdfPath*>(acdf_brdf_words(pair.tables(), pair.tables()->paths));
    const std::uint32_t steps[2] = {brdf.columns, brdf.rows};
    for (std::uint32_t cell = 0; cell < brdf.blend.tiles->tile_count; ++cell)
        for (std::uint32_t side_of = 0; side_of < 4; ++side_of) {
            const std::uint32_t axis = side_of >> 1, other = 1 - axis;
            const bool below = side_of & 1;
            const std::uint32_t way = acdf_way_number(acdf_brdf_way(axis, below));
            const AcdfBrdfPath &from = paths[cell], &beyond = paths[from.beyond[way]];
            const std::int32_t side = below ? from.low[axis] : from.high[axis];
            if (side == (below ? 0 : static_cast<std::int32_t>(steps[axis]))) {
                ASSERT_EQ(from.beyond[way], cell) << way;
                continue;
            }
            const std::int32_t middle = from.low[other] + (from.high[other] - from.low[other]) / 2;
            ASSERT_EQ(below ? beyond.high[axis] : beyond.low[axis], side) << cell << ' ' << way;
            ASSERT_LE(beyond.low[other], middle) << cell << ' ' << way;
            ASSERT_GT(beyond.high[other], middle) << cell << ' ' << way;
        }
}
#endif

} // namespace
