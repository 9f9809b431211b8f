// Visibility cells from a renderer's own rays, on a floor with a wall.
#include "tests/inputs/sanitized.h"
#include "tests/lib/build/walled_floor.h"

#include <acdf/curves/curves.h>
#include <acdf/learn.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <thread>

namespace walled_floor::learned_from_rays {
namespace {

using builder::LearnedVisibility;
using builder::LearnOptions;

/// Of the light alone.
const std::vector<std::uint8_t>& light() {
    static const std::vector<std::uint8_t> bytes = [] {
        builder::LocalOptions options;
        options.goal = builder::Goal::of_budget(32 << 10);
        builder::Local made;
        EXPECT_TRUE(builder::local(target(), options, made).ok());
        return made.bytes;
    }();
    return bytes;
}

LearnOptions floor_options() {
    LearnOptions out;
    const float low[3] = {-4.0f, -4.0f, -0.01f}, high[3] = {4.0f, 4.0f, 2.0f};
    std::copy_n(low, 3, out.low);
    std::copy_n(high, 3, out.high);
    out.bytes = 96 << 10;
    return out;
}

LearnedVisibility made(const LearnOptions& options = floor_options()) {
    LearnedVisibility out;
    const builder::Status status = LearnedVisibility::make(light().data(), light().size(), options, out);
    EXPECT_TRUE(status.ok()) << status.message;
    return out;
}

struct Ray {
    VisibilityPoint from;
    float direction[3];
    bool visible;
};

/// Light samples of a renderer.
std::vector<Ray> rays(std::uint64_t count, const Wall& wall = {}) {
    File file;
    EXPECT_TRUE(File::from_memory(light().data(), light().size(), file, acdf::with_curves()).ok());
    const LocalEnvironmentView view = file.local();
    std::mt19937_64 random(5);
    std::vector<Ray> out;
    for (std::uint64_t i = 0; i < count; ++i) {
        Ray ray{};
        point_of(i, ray.from);
        const double u0 = uniform(random), u1 = uniform(random);
        const DirectionSample s = view.sample(ray.from.normal, u0, u1);
        if (!(s.pdf > 0.0f)) continue;
        std::copy_n(s.direction, 3, ray.direction);
        ray.visible = !wall.hides(ray.from.position, ray.direction);
        out.push_back(ray);
    }
    return out;
}

void add(const std::vector<Ray>& from, LearnedVisibility& to) {
    for (const Ray& ray : from) to.add(ray.from.position, ray.from.normal, ray.direction, ray.visible);
}

/// After 200,000 rays.
LearnedVisibility& learned(bool beside_cosine = false) {
    const auto make = [](bool beside) {
        LearnOptions options = floor_options();
        options.beside_cosine = beside;
        LearnedVisibility out = made(options);
        add(rays(200000), out);
        EXPECT_TRUE(out.update().ok());
        return out;
    };
    static LearnedVisibility alone = make(false), beside = make(true);
    return beside_cosine ? beside : alone;
}

std::string contents(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The bytes of its file, by the way of a disk.
std::string bytes_of(const LearnedVisibility& of) {
    const std::string path = testing::TempDir() + "learned.acdf";
    EXPECT_TRUE(of.save(path.c_str()).ok());
    const std::string out = contents(path);
    std::remove(path.c_str());
    return out;
}

TEST(LearnedVisibility, IsUnbiased) { expect_unbiased(visible_view(*learned().file()), Wall(), 300); }
TEST(LearnedVisibility, IsUnbiasedBesideCosineAndAlone) {
    ACDF_NOT_SANITIZED();
    expect_unbiased(visible_view(*learned(true).file()), Wall(), 200);
}
TEST(LearnedVisibility, IsUnbiasedWhereAnObjectLeaves) {
    ACDF_NOT_SANITIZED();
    expect_unbiased(visible_view(*learned().file()), {1.0, 0.0, 0.0, 0.0}, 200);
}
TEST(LearnedVisibility, IsUnbiasedWhereAnObjectMoves) {
    ACDF_NOT_SANITIZED();
    expect_unbiased(visible_view(*learned().file()), {-2.0, -1.0, 4.0, 3.0}, 200);
}
TEST(LearnedVisibility, IsUnbiasedWhereADoorOpens) { // all was hidden, but for what passes beside the wall
    ACDF_NOT_SANITIZED();
    LearnedVisibility closed = made();
    add(rays(50000, {1.0, -1e3, 1e3, 1e3}), closed);
    ASSERT_TRUE(closed.update().ok());
    expect_unbiased(visible_view(*closed.file()), Wall(), 200);
}
TEST(LearnedVisibility, IsUnbiasedWhereLearningIsCutShort) {
    LearnedVisibility few = made();
    add(rays(50), few);
    ASSERT_TRUE(few.update().ok());
    expect_unbiased(visible_view(*few.file()), Wall(), 200);
}

TEST(LearnedVisibility, IsThatOfNormalsWhereNothingWasLearned) {
    LearnedVisibility nothing = made();
    EXPECT_FALSE(visible_view(*nothing.file()).has_cells());
    ASSERT_TRUE(nothing.update().ok());
    const auto file = nothing.file();
    const VisibleLocalView view = visible_view(*file);
    std::mt19937_64 random(9);
    for (int i = 0; i < 1000; ++i) {
        VisibilityPoint point;
        point_of(std::uint64_t(i), point);
        const auto d = acdf_test::random_direction(random);
        const double plain = double{view.local().pdf(point.normal, d.data())};
        EXPECT_NEAR(double{view.pdf(view.at(point.position, point.normal), d.data())}, plain,
                    0.1 * plain); // codes of even odds
    }
}

/// Beside cosine samples: an estimate of one of each, by the balance heuristic.
double relative_variance(const VisibleLocalView& view, bool beside_cosine) {
    double sum = 0.0;
    for (int i = 0; i < 150; ++i) {
        VisibilityPoint point;
        point_of(3000017 + std::uint64_t(i), point);
        const Exact found =
            exact(view, view.at(point.position, point.normal), point, Wall(), beside_cosine ? 1.0 : 0.0);
        EXPECT_EQ(found.lost, 0);
        const double mean = found.irradiance * found.irradiance;
        if (mean > 0.0) sum += found.variance / mean + (beside_cosine ? 0.5 : 0.0);
    }
    return sum;
}

TEST(LearnedVisibility, SamplesWhatAPositionSees) {
    const auto plain = made().file(), seen = learned().file();
    EXPECT_LT(relative_variance(visible_view(*seen), false), relative_variance(visible_view(*plain), false) / 2.0);
}
TEST(LearnedVisibility, BesideCosineSamplesWhatTheseLeaveOver) {
    const auto alone = learned().file(), beside = learned(true).file();
    EXPECT_LT(relative_variance(visible_view(*beside), true), relative_variance(visible_view(*alone), true));
    EXPECT_GT(relative_variance(visible_view(*beside), false), relative_variance(visible_view(*alone), false));
}

TEST(LearnedVisibility, IsTheSameInAnyOrderAndByAnyNumberOfThreads) {
    const std::vector<Ray> all = rays(60000);
    LearnedVisibility one = made(), many = made();
    add(all, one);
    std::vector<std::thread> threads;
    constexpr std::size_t count = 8;
    for (std::size_t t = 0; t < count; ++t)
        threads.emplace_back([&, t] {
            for (std::size_t i = all.size(); i-- > 0;)
                if (i % count == t)
                    many.add(all[i].from.position, all[i].from.normal, all[i].direction, all[i].visible);
        });
    for (std::thread& thread : threads) thread.join();
    builder::Control control;
    control.threads = 1;
    ASSERT_TRUE(one.update(control).ok());
    control.threads = 3;
    ASSERT_TRUE(many.update(control).ok());
    EXPECT_EQ(bytes_of(one), bytes_of(many));
}

TEST(LearnedVisibility, ViewsStayValidWhileTheNextIsMade) {
    LearnedVisibility changing = made();
    const std::vector<Ray> all = rays(20000);
    add(all, changing);
    ASSERT_TRUE(changing.update().ok());
    const auto kept = changing.file();
    const VisibleLocalView view = visible_view(*kept);
    const auto pdf_of = [&](const Ray& ray) {
        return view.pdf(view.at(ray.from.position, ray.from.normal), ray.direction);
    };
    std::vector<float> before;
    for (const Ray& ray : all) before.push_back(pdf_of(ray));
    std::thread adding([&] { add(all, changing); });
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(changing.update().ok());
    adding.join();
    EXPECT_NE(changing.file(), kept);
    for (std::size_t i = 0; i < all.size(); ++i) ASSERT_EQ(pdf_of(all[i]), before[i]);
}

TEST(LearnedVisibility, SavedFilesBeginTheNextFrame) {
    const std::string bytes = bytes_of(learned());
    LearnedVisibility next;
    ASSERT_TRUE(LearnedVisibility::make(bytes.data(), bytes.size(), floor_options(), next).ok());
    EXPECT_TRUE(visible_view(*next.file()).has_cells());
    EXPECT_EQ(bytes_of(next), bytes);
    EXPECT_LE(bytes.size(), light().size() + floor_options().bytes + 256);
    add(rays(200000), next);
    ASSERT_TRUE(next.update().ok());
    EXPECT_EQ(bytes_of(next), bytes); // of the same rays
}

TEST(LearnedVisibility, IgnoresWhatIsNoRay) {
    constexpr float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    LearnedVisibility strange = made(), nothing = made();
    const float up[3] = {0.0f, 0.0f, 1.0f}, inside[3] = {0.5f, 0.5f, 0.0f};
    for (const float bad : {nan, inf, -inf, 3e38f, -3e38f})
        for (int k = 0; k < 3; ++k) {
            float position[3] = {0.5f, 0.5f, 0.0f}, vector[3] = {0.0f, 0.0f, 1.0f};
            position[k] = vector[k] = bad;
            strange.add(position, up, up, true);
            if (!std::isfinite(bad)) strange.add(inside, vector, up, true);
            if (!std::isfinite(bad)) strange.add(inside, up, vector, true);
        }
    const float zero[3] = {}, down[3] = {0.0f, 0.0f, -1.0f};
    strange.add(inside, zero, up, true);
    strange.add(inside, up, zero, true);
    strange.add(inside, up, down, true);
    ASSERT_TRUE(strange.update().ok());
    ASSERT_TRUE(nothing.update().ok());
    EXPECT_EQ(bytes_of(strange), bytes_of(nothing));
}

TEST(LearnedVisibility, ErrorsAreValues) {
    using Code = builder::ErrorCode;
    LearnedVisibility out;
    const auto code = [&](const std::vector<std::uint8_t>& bytes, const LearnOptions& options) {
        const Code found = LearnedVisibility::make(bytes.data(), bytes.size(), options, out).code;
        EXPECT_TRUE(out.empty());
        return found;
    };
    EXPECT_EQ(code({1, 2, 3}, floor_options()), Code::bad_source);
    LearnOptions point = floor_options(), turned = point, endless = point;
    std::copy_n(point.low, 3, point.high);
    std::swap(turned.low[1], turned.high[1]);
    endless.high[0] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(code(light(), point), Code::invalid_argument);
    EXPECT_EQ(code(light(), turned), Code::invalid_argument);
    EXPECT_EQ(code(light(), endless), Code::invalid_argument);

    builder::LocalOptions options;
    options.goal = builder::Goal::of_budget(32 << 10);
    builder::Local other;
    options.sharing = false;
    options.fit.fit = ACDF_FIT_CDF;
    options.goal = {};
    ASSERT_TRUE(builder::local(target(), options, other).ok());
    EXPECT_EQ(code(other.bytes, floor_options()), Code::bad_source);
    options = {};
    options.goal = builder::Goal::of_budget(32 << 10);
    options.mis.kind = ACDF_PARTNER_COSINE;
    ASSERT_TRUE(builder::local(target(), options, other).ok());
    EXPECT_EQ(code(other.bytes, floor_options()), Code::bad_source);

    EXPECT_EQ(out.update().code, Code::invalid_argument);
    EXPECT_EQ(out.save("x").code, Code::invalid_argument);
    EXPECT_EQ(learned().save("/no/such/folder/x.acdf").code, Code::bad_source);
}

TEST(LearnedVisibility, OfAFlatFloor) {
    LearnOptions flat = floor_options();
    flat.low[2] = flat.high[2] = 0.0f;
    LearnedVisibility floor = made(flat);
    add(rays(20000), floor);
    ASSERT_TRUE(floor.update().ok());
    const auto file = floor.file();
    const float at[3] = {1.0f, 2.0f, 0.0f}, up[3] = {0.0f, 0.0f, 1.0f};
    EXPECT_TRUE(visible_view(*file).at(at, up).in_cell);
}

} // namespace
} // namespace walled_floor::learned_from_rays
