// Environments of several maps: what calls return, against sums worked out here.
#include "tests/lib/compress/chi_square.h"
#include "tests/lib/indexed/indexed_builder.h"
#include "tests/lib/reader/files.h"
#include "tests/lib/reader/load.h"

#include <acdf/acdf.h>
#include <acdf/indexed/moved.h>
#include <acdf/indexed/views.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <utility>

using namespace acdf_test;

namespace {

class OpenedMaps : public OpenedFile {
public:
    explicit OpenedMaps(const IndexedSpec& spec, bool tables = true) : OpenedFile(spec.encode(), tables) {
        const acdf::Status status = acdf::IndexedEnvironment::open(file(), view_);
        EXPECT_TRUE(status.ok()) << status.message;
    }
    const acdf::IndexedEnvironment& view() const { return view_; }

private:
    acdf::IndexedEnvironment view_;
};

/// Without suns.
IndexedSpec dull() {
    IndexedSpec spec;
    spec.sun = 0;
    for (MapSpec& map : spec.maps) map = {map.share, 0.0f, 0.0f, {0.0f, 0.0f, 0.0f}, map.codes};
    return spec;
}

/// The probability of a quarter of the square of columns and rows in a map of the spec.
double quarter(const IndexedSpec& spec, std::size_t map, bool right, bool lower) {
    const auto share = [](std::uint32_t code) { return acdf_halving_share(code, 8) * 0x1p-31; };
    const std::vector<std::uint32_t>& codes = spec.maps[map].codes;
    const double left = share(codes[0]);
    const double above = right ? share(spec.halvings.nodes[4].code) : share(codes[1]);
    return (right ? 1.0 - left : left) * (lower ? 1.0 - above : above);
}

/// What the pdf at a time should be.
double mixed(const IndexedSpec& spec, double time, bool right, bool lower) {
    const double t = (time - 6.0) / 12.0, a = (1.0 - t) * 0.25, b = t * 0.75;
    return (a * quarter(spec, 0, right, lower) + b * quarter(spec, 1, right, lower)) / (a + b);
}

TEST(Indexed, whereOneSunIsNotKnownTheOtherStands) {
    for (const std::size_t unknown : {0u, 1u}) {
        IndexedSpec spec;
        const MapSpec known = spec.maps[1 - unknown];
        spec.maps[unknown] = {spec.maps[unknown].share, 0.0f, 0.0f, {0.0f, 0.0f, 0.0f}, spec.maps[unknown].codes};
        const OpenedMaps file(spec);
        for (const double time : {7.0, 12.0, 17.0}) {
            const acdf::MixedEnvironment sky = file.view().at(time);
            for (int i = 0; i < 3; ++i) EXPECT_EQ(sky.data().cone.axis[i], double{known.sun[i]}) << time;
            EXPECT_NEAR(sky.data().cone.reach, 1.0 - std::cos(double{known.radius}), 1e-12) << time;
        }
    }
}

TEST(Indexed, mixesMapsByTheirLight) {
    const IndexedSpec spec = dull();
    const OpenedMaps opened(spec);
    for (const double time : {6.0, 7.0, 9.5, 12.0, 17.75, 18.0}) {
        const acdf::MixedEnvironment sky = opened.view().at(time);
        for (const bool right : {false, true})
            for (const bool lower : {false, true}) {
                // Columns 0 to 3 have phi > 0, so y > 0; rows 0 to 3 z > 0. Half of each hemisphere.
                const float d[3] = {0.6f, right ? -0.48f : 0.48f, lower ? -0.64f : 0.64f};
                EXPECT_NEAR(sky.pdf(d), mixed(spec, time, right, lower) / (4.0 * acdf_test::pi / 4.0), 2e-6)
                    << time << right << lower;
            }
        EXPECT_NEAR(sky.total(), opened.file().description().total * (0.25 + (time - 6.0) / 12.0 * 0.5), 1e-6);
    }
}

TEST(Indexed, endsStandForAllBeyond) {
    const OpenedMaps opened{IndexedSpec()};
    const float up[3] = {0.0f, 0.6f, 0.8f};
    EXPECT_EQ(opened.view().at(-1e300).pdf(up), opened.view().at(6.0).pdf(up));
    EXPECT_EQ(opened.view().at(std::nan("")).pdf(up), opened.view().at(6.0).pdf(up));
    EXPECT_EQ(opened.view().at(19.0).pdf(up), opened.view().at(18.0).pdf(up));
    EXPECT_EQ(opened.view().at(INFINITY).pdf(up), opened.view().at(18.0).pdf(up));
    EXPECT_NE(opened.view().at(6.0).pdf(up), opened.view().at(18.0).pdf(up));
}

TEST(Indexed, sunMovesAlongTheGreatCircle) {
    const OpenedMaps opened{IndexedSpec()};
    const acdf::MixedEnvironment sky = opened.view().at(10.0); // a third
    const double thirty = acdf_test::pi / 6.0;
    EXPECT_NEAR(sky.data().cone.axis[0], std::cos(thirty), 1e-9);
    EXPECT_NEAR(sky.data().cone.axis[1], 0.0, 1e-12);
    EXPECT_NEAR(sky.data().cone.axis[2], std::sin(thirty), 1e-9);
    const double a = 2.0 / 3.0 * 0.25, b = 1.0 / 3.0 * 0.75;
    EXPECT_NEAR(sky.sun_share(), (a * 0.5 + b * 0.25) / (a + b), 1e-7);
    EXPECT_NEAR(std::acos(1.0 - sky.data().cone.reach), 0.25 - 0.125 / 3.0, 1e-6);
}

/// Numbers of each profile, both grids, with and without a lookup grid.
std::vector<IndexedSpec> forms() {
    std::vector<IndexedSpec> out;
    for (std::uint32_t sun = 0; sun <= 4; ++sun) {
        IndexedSpec spec = sun == 0 ? dull() : IndexedSpec();
        spec.sun = sun;
        spec.octahedral = sun % 2 == 1;
        spec.own[2] = sun % 3 == 0;
        if (spec.own[2])
            for (MapSpec& map : spec.maps) map.codes.push_back(90);
        out.push_back(spec);
    }
    return out;
}

TEST(Indexed, pdfIsThatOfTheSample) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (const IndexedSpec& spec : forms())
        for (const bool tables : {true, false}) {
            const OpenedMaps opened(spec, tables);
            for (const double time : {6.0, 9.5, 18.0}) {
                const acdf::MixedEnvironment sky = opened.view().at(time);
                for (int n = 0; n < 2000; ++n) {
                    double u[2] = {unit(random), unit(random)}, back[2];
                    if (n < 9) u[0] = 0.5 * (n % 3), u[1] = 0.5 * (n / 3);
                    const acdf::DirectionSample s = sky.sample(u[0], u[1]);
                    ASSERT_GT(s.pdf, 0.0f);
                    ASSERT_EQ(s.pdf, sky.pdf(s.direction)) << u[0] << ' ' << u[1] << " sun " << spec.sun;
                    ASSERT_TRUE(sky.invert(s.direction, back));
                    const acdf::DirectionSample again = sky.sample(back[0], back[1]);
                    for (int i = 0; i < 3; ++i) ASSERT_NEAR(again.direction[i], s.direction[i], 2e-6) << u[1];
                }
            }
        }
}

/// Over equal parts of z and phi.
TEST(Indexed, samplesFollowThePdf) {
    constexpr std::uint32_t kColumns = 31, kRows = 29, kPoints = 24;
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (const IndexedSpec& spec : forms()) {
        const OpenedMaps opened(spec);
        const acdf::MixedEnvironment sky = opened.view().at(9.5);
        std::vector<double> probability(kColumns * kRows, 0.0);
        double integral = 0.0;
        for (std::uint32_t y = 0; y < kRows * kPoints; ++y)
            for (std::uint32_t x = 0; x < kColumns * kPoints; ++x) {
                const double z = 1.0 - 2.0 * (y + 0.5) / (kRows * kPoints), r = std::sqrt(1.0 - z * z);
                const double phi = acdf_test::pi * (1.0 - 2.0 * (x + 0.5) / (kColumns * kPoints));
                const float d[3] = {float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)};
                const double p = sky.pdf(d) * 4.0 * acdf_test::pi / (kRows * kColumns * kPoints * kPoints);
                probability[y / kPoints * kColumns + x / kPoints] += p;
                integral += p;
            }
        EXPECT_NEAR(integral, 1.0, 2e-3) << spec.sun;
        for (double& p : probability) p /= integral;
        std::vector<std::uint32_t> observed(probability.size());
        for (int n = 0; n < 40000; ++n) {
            const acdf::DirectionSample s = sky.sample(unit(random), unit(random));
            const double turn = 0.5 - 0.5 * std::atan2(s.direction[1], s.direction[0]) / acdf_test::pi;
            const auto x = std::min(std::uint32_t(turn * kColumns), kColumns - 1);
            const auto y = std::min(std::uint32_t(0.5 * (1.0 - s.direction[2]) * kRows), kRows - 1);
            ++observed[y * kColumns + x];
        }
        const ChiSquare test = chi_square(observed, probability);
        EXPECT_GT(test.p_value, sidak(1e-3, 5))
            << "sun " << spec.sun << ", " << test.statistic << " of " << test.degrees;
        EXPECT_FALSE(test.impossible);
    }
}

TEST(Indexed, callsOfCAreTheSameAndMove) {
    const OpenedMaps opened{IndexedSpec()};
    AcdfFile* file = acdf_from_memory(opened.bytes().data(), opened.bytes().size(), nullptr);
    ASSERT_NE(file, nullptr);
    AcdfIndexed indexed;
    ASSERT_EQ(acdf_indexed(file, &indexed, nullptr), 1);
    EXPECT_EQ(acdf_environment(file, nullptr), 0);
    AcdfMove moves[ACDF_MAX_MOVES];
    const int count = acdf_indexed_memory(file, &indexed, moves);
    std::vector<std::vector<std::uint64_t>> copies;
    for (int i = 0; i < count; ++i) {
        copies.emplace_back((moves[i].bytes + 7) / 8 + 8);
        auto at = reinterpret_cast<std::uintptr_t>(copies.back().data());
        auto* to = reinterpret_cast<std::uint8_t*>((at + 63) / 64 * 64);
        std::memcpy(to, moves[i].from, moves[i].bytes);
        moves[i].to = to;
    }
    AcdfIndexed moved = indexed;
    acdf_move_indexed(&moved, moves, count);
    acdf_close(file);
    acdf_indexed_close(&indexed);
    EXPECT_EQ(indexed.top, nullptr);
    acdf_indexed_close(&indexed); // once more
    AcdfMixed sky;
    const double at = 9.5;
    acdf_indexed_at(&moved, &at, &sky);
    const acdf::MixedEnvironment same = opened.view().at(at);
    for (int n = 0; n < 100; ++n) {
        const AcdfDirectionSample s = acdf_mixed_sample(&sky, 0.01 * n, std::fmod(0.37 * n, 1.0));
        const acdf::DirectionSample t = same.sample(0.01 * n, std::fmod(0.37 * n, 1.0));
        EXPECT_EQ(std::memcmp(&s, &t, sizeof s), 0);
    }
}

TEST(Indexed, axesAreMixedOneByOne) {
    IndexedSpec spec = dull();
    spec.axes = {{"time", 1, 0, 2, 6.0, 18.0}, {"haze", 1, 0, 3, 1.0, 10.0}};
    spec.coordinates = {{6.0, 18.0}, {1.0, 2.0, 10.0}};
    spec.maps.clear();
    for (std::uint32_t i = 0; i < 6; ++i)
        spec.maps.push_back({i < 4 ? 0.125f : 0.25f, 0.0f, 0.0f, {0.0f, 0.0f, 0.0f}, {40 * i + 10, 250 - 40 * i}});
    const OpenedMaps opened(spec);
    // Between the second and the third haze of the later time: maps 4 and 5, a quarter of the way.
    const acdf::MixedEnvironment sky = opened.view().at(18.0, 4.0);
    ASSERT_EQ(sky.data().count, 2u);
    EXPECT_EQ(sky.data().map[0], 4u);
    EXPECT_EQ(sky.data().map[1], 5u);
    EXPECT_EQ(sky.data().weight[0], 0.75 * 0x1p21);
    const float d[3] = {0.6f, 0.48f, 0.64f};
    EXPECT_NEAR(sky.pdf(d),
                (0.75 * quarter(spec, 4, false, false) + 0.25 * quarter(spec, 5, false, false)) / acdf_test::pi,
                2e-6);
    EXPECT_EQ(opened.view().at(12.0, 1.5).data().count, 4u);
}

TEST(Indexed, otherFilesHaveNone) {
    const Bytes bytes = complete_file().encode();
    acdf::File file;
    ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves()).ok());
    OpenedMaps opened{IndexedSpec()};
    acdf::IndexedEnvironment maps;
    ASSERT_TRUE(acdf::IndexedEnvironment::open(opened.file(), maps).ok());
    EXPECT_EQ(acdf::IndexedEnvironment::open(file, maps).code, ACDF_UNSUPPORTED);
    EXPECT_TRUE(maps.empty());
    AcdfIndexed indexed;
    AcdfError error;
    EXPECT_EQ(acdf_indexed(file.get(), &indexed, &error), 0);
    EXPECT_EQ(error.code, ACDF_UNSUPPORTED);
    EXPECT_EQ(acdf_indexed(nullptr, &indexed, nullptr), 0);
    EXPECT_EQ(indexed.top, nullptr);
}

/// Counts blocks that are out; `left` more are given.
struct Blocks {
    int out = 0, left = 1000;

    AcdfAllocator allocator() {
        return {[](void* self, size_t bytes, size_t alignment) -> void* {
                    auto& blocks = *static_cast<Blocks*>(self);
                    if (blocks.left == 0) return nullptr;
                    --blocks.left;
                    ++blocks.out;
                    return std::aligned_alloc(alignment, bytes);
                },
                [](void* self, void* block, size_t) {
                    --static_cast<Blocks*>(self)->out;
                    std::free(block);
                },
                this};
    }
};

TEST(Indexed, tablesAreOfTheFilesAllocator) {
    const Bytes bytes = IndexedSpec().encode();
    Blocks blocks;
    acdf::LoadOptions options;
    options.allocator = blocks.allocator();
    acdf::File file;
    ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file, options).ok());
    const int of_file = blocks.out;
    {
        acdf::IndexedEnvironment maps;
        ASSERT_TRUE(acdf::IndexedEnvironment::open(file, maps).ok());
        EXPECT_EQ(blocks.out, of_file + 1);
        EXPECT_GT(maps.table_bytes(), 0u);
        acdf::IndexedEnvironment moved = std::move(maps);
        EXPECT_TRUE(maps.empty()); // NOLINT: what a move leaves
        EXPECT_FALSE(moved.empty());
        EXPECT_EQ(blocks.out, of_file + 1);
    }
    EXPECT_EQ(blocks.out, of_file);
    blocks.left = 0;
    acdf::IndexedEnvironment maps;
    EXPECT_EQ(acdf::IndexedEnvironment::open(file, maps).code, ACDF_OUT_OF_MEMORY);
    EXPECT_TRUE(maps.empty());
    file = acdf::File();
    EXPECT_EQ(blocks.out, 0);
}

} // namespace
