// Many views at once: the same as one by one, on files made by hand and on the frozen ones.
#include "tests/lib/reader/wavefront.h"
#include "tests/lib/reader/brdf_loaded.h"

#include <utility>

using namespace acdf_test;

namespace {

struct Box {
    std::uint32_t low[2], high[2];
};

/// Splits a box `levels` times over, on both axes in turns, nearly each time at a position of its own. Returns what
/// number it has as a child.
std::uint16_t halve(BrdfSpec& spec, const Box& box, std::uint32_t levels, std::uint32_t& tiles) {
    if (levels == 0) return static_cast<std::uint16_t>(tile_flag | tiles++);
    const std::size_t number = spec.splits.size();
    const std::uint32_t axis = levels % 2, half = (box.high[axis] - box.low[axis]) / 2;
    const std::uint32_t position = box.low[axis] + half + static_cast<std::uint32_t>(number) % half;
    spec.splits.push_back({axis, position, {0, 0}});
    for (const std::size_t part : {0u, 1u}) {
        Box inside = box;
        (part == 0 ? inside.high : inside.low)[axis] = position;
        const std::uint16_t child = halve(spec, inside, levels - 1, tiles);
        spec.splits[number].child[part] = child;
    }
    return static_cast<std::uint16_t>(number);
}

/// 2048 cells whose borders lie at hundreds of thousands of pairs of positions.
BrdfSpec many_borders() {
    BrdfSpec spec = shared_brdf();
    spec.columns = 65536, spec.rows = 1u << 28, spec.splits.clear();
    std::uint32_t tiles = 0;
    halve(spec, {{0, 0}, {spec.columns, spec.rows}}, 11, tiles);
    spec.codes.assign(3, {});
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t i = 0; i < spec.splits.size(); ++i)
            spec.codes[row].push_back(static_cast<std::uint8_t>(2 + (5 * row + i) % 250));
    return spec;
}

/// What the vectors have tables for, at its smallest and with a chain of splits, and what they leave to the loop.
std::vector<std::pair<std::string, BrdfSpec>> forms() {
    std::vector<std::pair<std::string, BrdfSpec>> out;
    const auto add = [&](const char* name, auto change) {
        out.emplace_back(name, shared_brdf());
        change(out.back().second);
    };
    add("mirrored", [](BrdfSpec&) {});
    add("both sides", [](BrdfSpec& s) { s.flags = 0; });
    add("one view", [](BrdfSpec& s) {
        s.nodes = {0.5f}, s.bins = {{1, 0.5f}}, s.codes = {s.codes[0], s.codes[1]};
    });
    add("two views of one row", [](BrdfSpec& s) {
        s.nodes = {0.25f, 0.75f}, s.bins = {{0, 0.5f}, {0, 0.25f}}, s.codes = {s.codes[0]};
    });
    add("views close together", [](BrdfSpec& s) {
        s.nodes.clear(), s.bins.clear();
        for (int i = 0; i < 90; ++i) {
            s.nodes.push_back(i < 45 ? 0.5f + 1e-4f * float(i) : 0.51f + 0.01f * float(i - 45));
            s.bins.push_back({static_cast<std::uint32_t>(i % 3), 0.01f});
        }
        s.rows = s.columns = 8;
    });
    add("a black view", [](BrdfSpec& s) { s.bins[1].share = 0.0f; });
    add("nothing but black views", [](BrdfSpec& s) {
        for (auto& bin : s.bins) bin.share = 0.0f;
    });
    add("a chain", [](BrdfSpec& s) {
        s.columns = 64, s.splits.clear(), s.codes.assign(3, {});
        for (std::uint16_t i = 0; i < 48; ++i) {
            const auto next = static_cast<std::uint16_t>(i < 47 ? i + 1 : tile_flag | 48);
            s.splits.push_back({0, i + 1u, {static_cast<std::uint16_t>(tile_flag | i), next}});
            for (std::size_t row = 0; row < 3; ++row)
                s.codes[row].push_back(static_cast<std::uint8_t>(2 + 5 * row + i % 7));
        }
    });
    add("as many rows as may be", [](BrdfSpec& s) { s.columns = 65536, s.rows = 1u << 28; });
    add("a floor", [](BrdfSpec& s) { s.diffuse_share = 0.25f; });
    out.emplace_back("many borders", many_borders());
    out.emplace_back("trees of their own", separate_brdf());
    return out;
}

TEST(Wavefront, IsTheViewBitForBit) {
    for (auto& [name, spec] : forms()) {
        SCOPED_TRACE(name);
        const Loaded loaded(spec.encode());
        ASSERT_FALSE(loaded.file.empty());
        for (const std::size_t count : {0u, 1u, 7u, 8u, 23u, 24u, 25u, 1000u})
            expect_wavefront_is_the_view(loaded.view(), count);
    }
}

class GoldenWavefront : public testing::TestWithParam<const char*> {};

TEST_P(GoldenWavefront, IsTheViewBitForBit) {
    acdf::File file;
    const std::string path = std::string(ACDF_TEST_DIR "/golden/v1.0/") + GetParam() + ".acdf";
    ASSERT_TRUE(acdf::File::open(path.c_str(), file).ok());
    expect_wavefront_is_the_view(file.brdf(), 20000);
}

INSTANTIATE_TEST_SUITE_P(V1_0, GoldenWavefront,
                         testing::Values("brdf", "brdf_mirrored", "brdf_anisotropic", "brdf_floor",
                                         "brdf_separate"),
                         [](const auto& info) { return std::string(info.param); });

TEST(Wavefront, ServesByVectorsWhatIsIsotropicAndShared) {
    const auto served = [](BrdfSpec spec) {
        const Loaded loaded(spec.encode());
        acdf::BrdfWavefront wavefront;
        EXPECT_TRUE(acdf::BrdfWavefront::prepare(loaded.view(), wavefront).ok());
        return wavefront.instructions() != acdf::Instructions::none;
    };
    BrdfSpec floor = shared_brdf();
    floor.diffuse_share = 0.5f;
    EXPECT_FALSE(served(floor));
    EXPECT_FALSE(served(separate_brdf()));
#if defined(__x86_64__)
    EXPECT_EQ(served(shared_brdf()), __builtin_cpu_supports("avx2") != 0);
#endif
}

TEST(Wavefront, HasNoTableOfManyBorders) {
    const Loaded loaded(many_borders().encode());
    acdf::BrdfWavefront wavefront;
    ASSERT_TRUE(acdf::BrdfWavefront::prepare(loaded.view(), wavefront).ok());
    EXPECT_LT(wavefront.bytes(), std::size_t{256} * 2048); // which all the pairs of positions are more than
}

TEST(Wavefront, HasTablesInProportionToTheFile) {
    BrdfSpec spec = many_borders();
    spec.nodes.clear(), spec.bins.clear();
    for (std::uint32_t i = 0; i < 40000; ++i) {
        spec.nodes.push_back(static_cast<float>(i) / 40000.0f);
        spec.bins.push_back({i % 3, 0.01f});
    }
    const Loaded loaded(spec.encode());
    ASSERT_FALSE(loaded.file.empty());
    acdf::BrdfWavefront wavefront;
    ASSERT_TRUE(acdf::BrdfWavefront::prepare(loaded.view(), wavefront).ok());
    EXPECT_EQ(wavefront.bytes(), 0u); // a gigabyte for half a megabyte
    expect_wavefront_is_the_view(loaded.view(), 100);
}

TEST(Wavefront, MovesAndIsMadeAnew) {
    BrdfSpec spec = shared_brdf();
    const Loaded loaded(spec.encode());
    const acdf::BrdfView view = loaded.view();
    acdf::BrdfWavefront first, second;
    ASSERT_TRUE(acdf::BrdfWavefront::prepare(view, first).ok());
    const std::size_t bytes = first.bytes();
    second = std::move(first);
    EXPECT_EQ(second.bytes(), bytes);
    acdf::BrdfWavefront third(std::move(second));
    ASSERT_TRUE(acdf::BrdfWavefront::prepare(view, third, acdf::Instructions::none).ok());
    EXPECT_EQ(third.bytes(), 0u);
    const float wo[1][3] = {{0.6f, 0.0f, 0.8f}};
    const double u[1][2] = {{0.25, 0.75}};
    acdf::DirectionSample out;
    third.sample(wo, u, 1, &out);
    EXPECT_EQ(out.pdf, view.sample(wo[0], 0.25, 0.75).pdf);
}

} // namespace
