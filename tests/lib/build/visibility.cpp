// Files with visibility cells, on a floor with a wall.
#include "tests/lib/build/walled_floor.h"

#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace walled_floor;
using acdf_test::Normal;
using acdf_test::random_direction;

builder::LocalOptions options(std::uint64_t bytes) {
    builder::LocalOptions out;
    out.goal = builder::Goal::of_budget(bytes);
    return out;
}

builder::LocalOptions with_visibility(std::uint64_t bytes) {
    builder::LocalOptions out = options(bytes);
    out.visibility.point = point_of;
    out.visibility.occluded = [](const VisibilityPoint& p, const float* d) { return Wall().hides(p.position, d); };
    return out;
}

struct Built {
    builder::Local local;
    File file;

    explicit Built(const builder::LocalOptions& options) {
        const builder::Status status = builder::local(target(), options, local);
        EXPECT_TRUE(status.ok()) << status.message;
        EXPECT_TRUE(File::from_memory(local.bytes.data(), local.bytes.size(), file).ok());
    }
    VisibleLocalView view() const { return visible_view(file); }
};

const Built& placed() {
    static const Built built(with_visibility(96 << 10));
    return built;
}
const Built& plain() {
    static const Built built(options(96 << 10));
    return built;
}

TEST(VisibilityFiles, AreUnbiased) {
    ACDF_NOT_SANITIZED();
    expect_unbiased(placed().view(), Wall(), 1000);
}
TEST(VisibilityFiles, AreUnbiasedWhereTheWallIsGone) {
    ACDF_NOT_SANITIZED();
    expect_unbiased(placed().view(), {1.0, 0.0, 0.0, 0.0}, 300);
}
TEST(VisibilityFiles, AreUnbiasedWhereTheWallStandsElsewhere) {
    expect_unbiased(placed().view(), {-2.0, -1.0, 4.0, 3.0}, 300);
}

TEST(VisibilityFiles, FillTheirBudget) {
    EXPECT_LE(placed().local.bytes.size(), 96u << 10);
    EXPECT_GE(placed().local.bytes.size(), 90u << 10);
    EXPECT_TRUE(placed().view().has_cells());
    EXPECT_FALSE(plain().view().has_cells());
}

/// A size that cannot be had is reported in bytes of the whole file.
TEST(VisibilityFiles, AreNotMadeLargerThanTheirBudget) {
    builder::Local result;
    const builder::Status status = builder::local(target(), with_visibility(2 << 10), result);
    EXPECT_EQ(status.code, builder::ErrorCode::out_of_reach);
    const std::string text = status.message,
                      start = "a size of 2048 bytes is out of reach; the smallest possible is about ";
    ASSERT_EQ(text.rfind(start, 0), 0u) << text;
    const std::uint64_t least = std::stoull(text.substr(start.size())), enough = least + least / 4;
    const Built built(with_visibility(enough));
    EXPECT_LE(built.local.bytes.size(), enough);
    EXPECT_TRUE(built.view().has_cells());
}

/// Floats have no room for a margin around a floor that is flat and far away.
TEST(VisibilityFiles, OfAFloorFarFromTheOrigin) {
    builder::LocalOptions far = with_visibility(16 << 10);
    far.visibility.point = [](std::uint64_t index, VisibilityPoint& point) {
        point_of(index, point);
        point = {{point.position[0], point.position[1], 1e7f}, {0.0f, 0.0f, 1.0f}};
        if (index % 5 == 0) point.position[2] = 3e38f; // no position is so far out
        return true;
    };
    far.visibility.occluded = [](const VisibilityPoint&, const float*) { return false; };
    const Built built(far);
    EXPECT_TRUE(built.view().has_cells());
    const float at[3] = {1.0f, 2.0f, 1e7f}, up[3] = {0.0f, 0.0f, 1.0f};
    EXPECT_TRUE(built.view().at(at, up).in_cell);
}

TEST(VisibilityFiles, SampleWhatAPositionSees) {
    double local = 0.0, place = 0.0;
    for (int i = 0; i < 250; ++i) {
        VisibilityPoint point;
        point_of(2000003 + std::uint64_t(i), point);
        const Exact with = exact(placed().view(), placed().view().at(point.position, point.normal), point, Wall());
        const Exact without = exact(plain().view(), plain().view().at(point.normal), point, Wall());
        if (!(with.irradiance > 0.0)) continue;
        place += with.variance / (with.irradiance * with.irradiance);
        local += without.variance / (without.irradiance * without.irradiance);
    }
    EXPECT_LT(place, local / 3.0) << local / place;
}

TEST(VisibilityFiles, LoseNothingThatANormalMaySee) {
    const VisibleLocalView view = placed().view();
    std::mt19937_64 random(7);
    for (int i = 0; i < 100000; ++i) {
        const Normal normal = random_direction(random), direction = random_direction(random);
        const float *const n = normal.data(), *const d = direction.data();
        const float x[3] = {float(9.0 * uniform(random) - 4.5), float(9.0 * uniform(random) - 4.5),
                            float(2.5 * uniform(random) - 0.2)};
        const bool drawn = view.pdf(view.at(x, n), d) > 0.0f;
        ASSERT_EQ(drawn, view.local().pdf(n, d) > 0.0f);
        const double cosine =
            double{n[0]} * double{d[0]} + double{n[1]} * double{d[1]} + double{n[2]} * double{d[2]};
        if (cosine > 1e-3) { // there is light everywhere
            ASSERT_TRUE(drawn);
        }
    }
}

TEST(VisibilityFiles, AreTheSameForAnyNumberOfThreads) {
    ACDF_NOT_SANITIZED();
    for (int threads : {1, 3}) {
        builder::Local again;
        builder::Control control;
        control.threads = threads;
        ASSERT_TRUE(builder::local(target(), with_visibility(24 << 10), again, control).ok());
        static const std::vector<std::uint8_t> first = again.bytes;
        EXPECT_TRUE(again.bytes == first) << threads;
    }
}

TEST(VisibilityFiles, ErrorsAreValues) {
    using Code = builder::ErrorCode;
    builder::Local result;
    const auto code = [&](const builder::LocalOptions& o, const builder::Control& control = {}) {
        const Code found = builder::local(target(), o, result, control).code;
        EXPECT_TRUE(result.bytes.empty());
        return found;
    };
    builder::LocalOptions thrown = with_visibility(24 << 10), empty = thrown, half = thrown, cells = thrown;
    thrown.visibility.occluded = [](const VisibilityPoint&, const float*) -> bool {
        throw std::runtime_error("no");
    };
    EXPECT_EQ(code(thrown), Code::callback_failed);
    empty.visibility.point = [](std::uint64_t, VisibilityPoint&) { return false; };
    EXPECT_EQ(code(empty), Code::bad_source);
    half.visibility.occluded = {};
    EXPECT_EQ(code(half), Code::invalid_argument);
    cells.goal = builder::Goal::of_cells(100);
    EXPECT_EQ(code(cells), Code::invalid_argument);
    builder::Control control;
    control.progress = [](double share, const char*) { return share < 0.5; };
    EXPECT_EQ(code(with_visibility(24 << 10), control), Code::cancelled);
}

} // namespace
