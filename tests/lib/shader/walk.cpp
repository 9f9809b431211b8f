// Traversals for shaders beside the reader's: each sample has the pdf that both return for its direction, samples
// are the reader's, and so are pdfs, but for the rounding of floats and directions next to a border.
#include "tests/inputs/directions.h"
#include "tests/inputs/sanitized.h"
#include "tests/lib/reader/golden_files.h"
#include "tests/lib/reader/local_random.h"
#include "tests/lib/reader/normals_builder.h"
#include "tests/lib/reader/random_halvings.h"
#include "tests/lib/shader/walked_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

namespace {

using namespace acdf_test;

const std::uint32_t kStep = kSanitized ? 3 : 1; // from seed to seed
// Of a pdf: what floats round on the way to a leaf, and at most.
constexpr double kNear = 1e-5, kRounded = 1e-3;

using Vector = std::array<float, 3>;

Vector towards(double phi, double z) {
    const double sine = std::sqrt((1.0 - z) * (1.0 + z));
    return {static_cast<float>(sine * std::cos(phi)), static_cast<float>(sine * std::sin(phi)),
            static_cast<float>(z)};
}
Vector anywhere(std::mt19937_64& random) {
    const double phi = 2.0 * M_PI * uniform(random);
    return towards(phi, 2.0 * uniform(random) - 1.0);
}

/// One normal by both.
class WalkPoint {
public:
    WalkPoint(const WalkedFile& given, const float n[3])
        : file_(given), normal_{n[0], n[1], n[2]}, shader_(acdf_point_at(given.tables.words(), n[0], n[1], n[2])) {
        if (given.local()) reader_ = given.file.local().at(n);
    }
    AcdfWalkSample sample(std::uint32_t n0, std::uint32_t n1) const {
        return acdf_walk_sample(file_.tables.words(), shader_, n0, n1);
    }
    float pdf(const float d[3]) const { return acdf_walk_pdf(file_.tables.words(), shader_, d[0], d[1], d[2]); }
    acdf::DirectionSample read(double u0, double u1) const {
        return file_.local() ? file_.file.local().sample(reader_, u0, u1) : file_.file.environment().sample(u0, u1);
    }
    float read_pdf(const float d[3]) const {
        return file_.local() ? file_.file.local().pdf(reader_, d) : file_.file.environment().pdf(d);
    }
    float reach() const {
        const bool square = file_.tables.words()[ACDF_WALK_OCTAHEDRAL] != 0;
        return (square ? static_cast<float>(ACDF_OCTAHEDRAL_SPEED) : 1.0f) * 0x1p-20f;
    }
    /// Whether a pdf is between those for normals that floats do not distinguish from this one: on an edge between
    /// bins they give a little to the next.
    bool told_of_near_normal(const float d[3], float pdf) const {
        if (!file_.local()) return false;
        float least = read_pdf(d), most = least;
        for (int k = 0; k < 27; ++k) {
            Vector near = normal_;
            near[0] += static_cast<float>(k % 3 - 1) * 4e-7f;
            near[1] += static_cast<float>(k / 3 % 3 - 1) * 4e-7f;
            near[2] += static_cast<float>(k / 9 - 1) * 4e-7f;
            const float other = file_.file.local().pdf(near.data(), d);
            least = std::min(least, other);
            most = std::max(most, other);
        }
        return pdf >= least && pdf <= most;
    }
    /// What is rounded of a pdf, sr^-1: cosines to the normal.
    double faint() const { return 2e-7 * cosine_share() + 1e-30; }
    double cosine_share() const { return double{shader_.cosine}; }
    /// Whether the two differ in what serves the normal: on a border between bins that are served differently.
    bool differs() const {
        if (!file_.local()) return false;
        const bool nothing = shader_.mix.root == ACDF_WALK_NONE;
        if (nothing != (reader_.what == ACDF_LOCAL_NOTHING)) return true;
        const bool mixed = shader_.mix.root == file_.tables.words()[ACDF_WALK_MIXTURE];
        return !nothing && mixed != (reader_.what == ACDF_LOCAL_ROWS);
    }

private:
    const WalkedFile& file_;
    Vector normal_;
    AcdfShaderPoint shader_;
    AcdfLocalPoint reader_ = {};
};

struct WalkCounted {
    int draws = 0, other_cells = 0, directions = 0, other_pdfs = 0, rounded = 0, normals = 0, other_normals = 0;
    WalkCounted& operator+=(const WalkCounted& more) {
        draws += more.draws, other_cells += more.other_cells;
        directions += more.directions, other_pdfs += more.other_pdfs;
        rounded += more.rounded;
        normals += more.normals, other_normals += more.other_normals;
        return *this;
    }
};

// Whether pdfs are equal but for rounding.
bool nearly(const WalkPoint& point, double a, double b, double most = kRounded) {
    return std::fabs(a - b) <= most * std::max(a, b) + point.faint();
}

// Whether the reader has a pdf for a direction, or for one next to it: 2^-20 radians away, or as far as 2^-20
// of the side of the square is, or (next to a pole) turned about that by as much.
bool told_near(const WalkPoint& point, const float d[3], float pdf) {
    if (nearly(point, pdf, point.read_pdf(d))) return true;
    std::vector<Vector> near = {{d[0], d[1], d[2]},
                                {d[0] - 0x1p-20f * d[1], d[1] + 0x1p-20f * d[0], d[2]},
                                {d[0] + 0x1p-20f * d[1], d[1] - 0x1p-20f * d[0], d[2]}};
    for (int k = 0; k < 54; ++k) {
        const float step = k < 27 ? 0x1p-20f : point.reach();
        near.push_back({d[0] + static_cast<float>(k % 3 - 1) * step,
                        d[1] + static_cast<float>(k / 3 % 3 - 1) * step,
                        d[2] + static_cast<float>(k / 9 % 3 - 1) * step});
    }
    const auto any = [&near](const auto& told) { return std::any_of(near.begin(), near.end(), told); };
    return any([&](const Vector& at) { return nearly(point, pdf, point.read_pdf(at.data())); }) ||
           any([&](const Vector& at) { return point.told_of_near_normal(at.data(), pdf); });
}

void compare_walk_sample(const WalkPoint& point, std::uint32_t n0, std::uint32_t n1, WalkCounted& counted) {
    const AcdfWalkSample s = point.sample(n0, n1);
    const acdf::DirectionSample told = point.read(n0 * 0x1p-32, n1 * 0x1p-32);
    const float d[3] = {s.x, s.y, s.z};
    ++counted.draws;
    ASSERT_EQ(s.pdf > 0.0f, told.pdf > 0.0f) << n0 << ' ' << n1;
    if (!(s.pdf > 0.0f)) return;
    ASSERT_EQ(acdf_float_bits(point.pdf(d)), acdf_float_bits(s.pdf)) << n0 << ' ' << n1;
    ASSERT_NEAR(std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), 1.0, 1e-6);
    if (n0 * 0x1p-32 < point.cosine_share()) { // about the normal: anywhere, next to borders too
        ASSERT_TRUE(told_near(point, d, s.pdf)) << n0 << ' ' << n1;
    } else {
        ASSERT_TRUE(nearly(point, point.read_pdf(d), s.pdf) || point.told_of_near_normal(d, s.pdf))
            << n0 << ' ' << n1 << ' ' << point.read_pdf(d) << " is not " << s.pdf;
    }
    counted.rounded += !nearly(point, point.read_pdf(d), s.pdf, kNear);
    counted.other_cells += !nearly(point, told.pdf, s.pdf);
}

void compare_walk_pdf(const WalkPoint& point, const float d[3], WalkCounted& counted) {
    const float pdf = point.pdf(d);
    ++counted.directions;
    ASSERT_TRUE(std::isfinite(pdf) && pdf >= 0.0f);
    ASSERT_TRUE(told_near(point, d, pdf))
        << d[0] << ' ' << d[1] << ' ' << d[2] << ' ' << pdf << ' ' << point.read_pdf(d);
    counted.other_pdfs += !nearly(point, pdf, point.read_pdf(d));
}

WalkCounted compare_walk(const WalkedFile& file, int normals, int each) {
    std::mt19937_64 random(9);
    WalkCounted counted, edges;
    for (int i = 0; i < normals && !testing::Test::HasFatalFailure(); ++i) {
        Vector normal = anywhere(random);
        if (i % 4 == 0) normal = edge_normal(random);
        const WalkPoint point(file, normal.data());
        ++counted.normals;
        counted.other_normals += point.differs();
        if (point.differs()) continue;
        for (int k = 0; k < each && !testing::Test::HasFatalFailure(); ++k) {
            const auto n0 = static_cast<std::uint32_t>(random()), n1 = static_cast<std::uint32_t>(random());
            compare_walk_sample(point, k == 0 ? 0u : n0, k == 1 ? ~0u : n1, k < 2 ? edges : counted);
            const Vector any = anywhere(random);
            compare_walk_pdf(point, any.data(), counted);
            const double piece =
                0.25 * M_PI * static_cast<double>(random() % 8); // at their seams, close to the poles
            Vector beside = towards(piece, 1.0 - std::exp(-30.0 * uniform(random)));
            if (random() % 2) beside[2] = -beside[2];
            compare_walk_pdf(point, beside.data(), counted);
        }
    }
    return counted;
}

TEST(ShaderTraversal, AnswersAsTheReaderOnGoldenFiles) {
    int files = 0;
    each_golden_file([&](std::vector<std::uint8_t> bytes) {
        const WalkedFile file(std::move(bytes));
        if (!file.status.ok() || file.file.kind() == ACDF_KIND_BRDF || file.file.kind() == ACDF_KIND_INDEXED)
            return;
        ++files;
        compare_walk(file, file.local() ? 200 : 1, file.local() ? 10 : 2000);
    });
    EXPECT_GE(files, 9);
}

// Random numbers lead to other tiles than the reader's, with the same pdfs.
TEST(ShaderTraversal, HasThePdfsOfTheReaderOnRandomRows) {
    WalkCounted all;
    for (std::uint32_t seed = 0; seed < 80; seed += kStep) {
        SCOPED_TRACE(seed);
        const WalkedFile file(random_normals(seed).encode());
        ASSERT_TRUE(file.status.ok()) << file.status.message;
        all += compare_walk(file, 40, 8);
        if (HasFatalFailure()) return;
    }
    EXPECT_LT(all.other_pdfs, 1e-3 * all.directions);
    EXPECT_LT(all.other_normals, 2e-2 * all.normals);
}

TEST(ShaderTraversal, AnswersAsTheReaderOnRandomEnvironments) {
    WalkCounted all;
    int files = 0;
    for (std::uint32_t seed = 0; seed < 80; ++seed) {
        RandomOptions options = varied_options(seed);
        options.octahedral = seed % 2 == 1;
        SCOPED_TRACE(seed);
        const WalkedFile file(RandomHalvings(seed, options).make().encode());
        ASSERT_TRUE(file.status.ok()) << file.status.message;
        ++files;
        all += compare_walk(file, 1, 400);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(files, 60);
    EXPECT_LT(all.other_cells, 1e-4 * all.draws);
    EXPECT_LT(all.rounded, 1e-4 * all.draws);
}

TEST(ShaderTraversal, NothingServesWhatIsNoNormal) {
    const WalkedFile file(random_normals(3).encode());
    ASSERT_TRUE(file.status.ok());
    const float nan = std::nanf(""), up[3] = {0.0f, 0.0f, 1.0f};
    for (const float bad : {0.0f, nan, INFINITY, -INFINITY}) {
        const float normal[3] = {0.0f, 0.0f, bad};
        const WalkPoint point(file, normal);
        EXPECT_EQ(point.sample(1, 2).pdf, 0.0f) << bad;
        EXPECT_EQ(point.pdf(up), 0.0f) << bad;
    }
    for (const float bad : {0.0f, 2.0f, 0.99f, 1.01f, nan, INFINITY, 1e-30f, 3e38f}) {
        const float direction[3] = {0.0f, bad, 0.0f};
        EXPECT_EQ(WalkPoint(file, up).pdf(direction), 0.0f) << bad;
    }
}

TEST(ShaderTraversal, CurvesAreRefusedWithAReason) {
    std::ifstream in(ACDF_TEST_DIR "/golden/v1.0/tilted.acdf", std::ios::binary);
    const WalkedFile file({std::istreambuf_iterator<char>(in), {}});
    EXPECT_EQ(file.status.code, ACDF_UNSUPPORTED);
    EXPECT_NE(std::string(file.status.message).find("--fit variance"), std::string::npos) << file.status.message;
}

} // namespace
