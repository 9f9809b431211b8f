// BRDFs for shaders beside the reader's: each sample has the pdf that both return for its direction, samples are
// the reader's, and so are pdfs, but for the rounding of floats and directions next to a border.
#include "tests/inputs/sanitized.h"
#include "tests/lib/reader/brdf_forms.h"
#include "tests/lib/reader/brdf_queries.h"
#include "tests/lib/reader/golden_files.h"
#include "tests/lib/reader/half_vectors.h"
#include "tests/lib/shader/walked_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>

namespace {

using namespace acdf_test;

bool nearly(double a, double b, double most) { return a == b || std::fabs(a - b) <= most * std::max(a, b) + 1e-30; }

/// A view by both.
class BrdfPoint {
public:
    BrdfPoint(const WalkedFile& given, const float o[3])
        : file_(given), wo_{o[0], o[1], o[2]}, shader_(acdf_brdf_view_of(given.tables.words(), o[0], o[1], o[2])) {}
    AcdfWalkSample sample(std::uint32_t n0, std::uint32_t n1) const {
        return acdf_brdf_walk_sample(file_.tables.words(), shader_, n0, n1);
    }
    float pdf(const float d[3]) const {
        return acdf_brdf_walk_pdf(file_.tables.words(), shader_, d[0], d[1], d[2]);
    }
    acdf::DirectionSample read(double u0, double u1) const { return file_.file.brdf().sample(wo_, u0, u1); }
    float read_pdf(const float d[3]) const { return file_.file.brdf().pdf(wo_, d); }
    /// How much pdfs differ that are the same.
    double rounds(const float d[3]) const { return Halves(wo_, d).rounded() + weighed(); }
    bool has_rows() const { return file_.file.brdf().data().halved; }
    double moves(const float d[3]) const { return Halves(wo_, d).moved() + weighed(); }

    /// Whether the reader has this pdf for directions that floats hardly distinguish from these, or less and more
    /// of it, a hundredth apart: next to the azimuth of a view the share of the other view is known to few digits.
    bool told_near(const float d[3], float pdf) const {
        bool less = false, more = false;
        for (int k = 0; k < 54; ++k) {
            float wo[3], wi[3];
            for (int axis = 0, rest = k % 27; axis < 3; ++axis, rest /= 3) {
                const float step = static_cast<float>(rest % 3 - 1) * 0x1p-22f;
                wo[axis] = wo_[axis] + (k < 27 ? 0.0f : step);
                wi[axis] = d[axis] + (k < 27 ? step : 0.0f);
            }
            const float told = file_.file.brdf().pdf(wo, wi);
            if (nearly(pdf, told, 1e-4 + Halves(wo, wi).moved() + weighed())) return true;
            less |= told < pdf && told > 0.995f * pdf;
            more |= told > pdf && told < 1.005f * pdf;
        }
        return less && more;
    }

private:
    /// The reader rounds weights of rows to whole numbers, out of 2^21.
    double weighed() const {
        AcdfBrdfView view;
        double most = 0.0;
        if (!acdf_brdf_view(&file_.file.brdf().data(), wo_, &view)) return 0.0;
        for (int k = 0; k < view.mix.count; ++k) most = std::max(most, 1.0 / view.mix.weight[k]);
        return most;
    }

    const WalkedFile& file_;
    float wo_[3];
    AcdfShaderView shader_;
};

struct BrdfCounted {
    int draws = 0, other_cells = 0, lost = 0, densities = 0, other_pdfs = 0;
    BrdfCounted& operator+=(const BrdfCounted& more) {
        draws += more.draws, other_cells += more.other_cells, lost += more.lost;
        densities += more.densities, other_pdfs += more.other_pdfs;
        return *this;
    }
};

void compare_brdf_pdf(const BrdfPoint& point, const float d[3], BrdfCounted& counted) {
    const float pdf = point.pdf(d), told = point.read_pdf(d);
    ASSERT_TRUE(std::isfinite(pdf) && pdf >= 0.0f);
    ++counted.densities;
    if (nearly(pdf, told, point.rounds(d))) return;
    ++counted.other_pdfs;
    ASSERT_TRUE(point.told_near(d, pdf)) << d[0] << ' ' << d[1] << ' ' << d[2] << ' ' << pdf << ' ' << told;
}

void compare_brdf_sample(const BrdfPoint& point, std::uint32_t n0, std::uint32_t n1, BrdfCounted& counted) {
    const AcdfWalkSample s = point.sample(n0, n1);
    const acdf::DirectionSample told = point.read(n0 * 0x1p-32, n1 * 0x1p-32);
    const float d[3] = {s.x, s.y, s.z};
    ASSERT_EQ(s.pdf > 0.0f, told.pdf > 0.0f) << n0 << ' ' << n1;
    if (!(s.pdf > 0.0f)) return;
    ++counted.draws;
    const float own = point.pdf(d);
    counted.lost += own == 0.0f; // wo and wi nearly opposite
    if (own > 0.0f) {
        ASSERT_EQ(acdf_float_bits(own), acdf_float_bits(s.pdf)) << n0 << ' ' << n1;
    }
    ASSERT_NEAR(std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), 1.0, 1e-6);
    compare_brdf_pdf(point, d, counted);
    // Of rows other numbers lead to a cell than in the reader.
    counted.other_cells += !point.has_rows() && !nearly(s.pdf, told.pdf, 1e-3 + point.moves(d));
}

BrdfCounted compare_brdf(const WalkedFile& file, std::size_t count) {
    const BrdfQueries asked(file.file.brdf(), count);
    BrdfCounted counted, ends;
    for (std::size_t i = 0; i < count && !testing::Test::HasFatalFailure(); ++i) {
        const BrdfPoint point(file, asked.wo()[i]);
        std::uint32_t n[2];
        bool inside = true; // else they, and what they sample, lie on the borders of cells
        for (int k = 0; k < 2; ++k) {
            const double u = asked.u()[i][k];
            inside = inside && u > 1e-6 && u < 1.0 - 1e-6 && u != 0.5;
            n[k] = u > 0.0 ? static_cast<std::uint32_t>(std::min(u * 0x1p32, 0x1p32 - 1.0)) : 0;
        }
        SCOPED_TRACE(i);
        compare_brdf_sample(point, n[0], n[1], inside ? counted : ends);
        compare_brdf_pdf(point, asked.wi()[i], inside ? counted : ends); // half of them are samples
    }
    return counted;
}

void expect_few(const BrdfCounted& all) {
    EXPECT_LT(all.other_cells, 1e-3 * all.draws);
    EXPECT_LT(all.other_pdfs, 1e-3 * all.densities);
    EXPECT_LT(all.lost, 1e-3 * all.draws);
}

TEST(ShaderBrdf, AnswersAsTheReaderOnGoldenFiles) {
    BrdfCounted all;
    int files = 0;
    each_golden_file([&](std::vector<std::uint8_t> bytes) {
        const WalkedFile file(std::move(bytes));
        if (!file.status.ok() || file.file.kind() != ACDF_KIND_BRDF) return;
        ++files;
        all += compare_brdf(file, 4000);
    });
    EXPECT_GE(files, 3);
    expect_few(all);
}

TEST(ShaderBrdf, AnswersAsTheReaderOnEveryForm) {
    BrdfCounted all;
    for (auto& [name, spec] : brdf_forms()) {
        SCOPED_TRACE(name);
        if (!spec.is_halved()) continue;
        const WalkedFile file(spec.encode());
        ASSERT_TRUE(file.status.ok()) << file.status.message;
        all += compare_brdf(file, 2000);
        if (HasFatalFailure()) return;
    }
    expect_few(all);
}

TEST(ShaderBrdf, AnswersAsTheReaderOnRandomFiles) {
    BrdfCounted all;
    for (std::uint32_t seed = 0; seed < 100; seed += acdf_test::kSanitized ? 3 : 1) {
        SCOPED_TRACE(seed);
        const WalkedFile file(random_brdf(seed).encode());
        ASSERT_TRUE(file.status.ok()) << file.status.message;
        all += compare_brdf(file, 400);
        if (HasFatalFailure()) return;
    }
    expect_few(all);
}

// Each cell of the reader gets as many samples as it has probability.
TEST(ShaderBrdf, SamplesFollowTheirPdf) {
    for (const std::uint32_t flags : {0u, 1u}) {
        BrdfSpec spec = shared_brdf();
        spec.flags = flags;
        const WalkedFile file(spec.encode());
        ASSERT_TRUE(file.status.ok()) << file.status.message;
        const acdf::BrdfView reader = file.file.brdf();
        const AcdfBrdf& brdf = reader.data();
        const float wo[3] = {0.48f, 0.36f, 0.8f};
        const BrdfPoint point(file, wo);
        AcdfBrdfView view;
        ASSERT_TRUE(acdf_brdf_view(&brdf, wo, &view));
        struct Cell {
            double probability = 0.0;
            int samples = 0;
        };
        std::map<std::array<std::uint32_t, 2>, Cell> cells;
        constexpr std::uint32_t side = 256;
        for (std::uint32_t i = 0; i < side * side; ++i) {
            const AcdfWalkSample s = point.sample((i % side << 24) + 0x7FFFFFu, (i / side << 24) + 0x7FFFFFu);
            const float d[3] = {s.x, s.y, s.z};
            AcdfBrdfPosition place;
            AcdfRange range[2];
            double sign;
            ASSERT_TRUE(acdf_brdf_half_position(&brdf, &view, d, &place, &sign));
            const double p = acdf_brdf_find(&brdf, &view, &place, range, nullptr);
            Cell& cell = cells[{range[0].low, range[1].low}];
            cell.probability = p;
            ++cell.samples;
        }
        double all = 0.0;
        for (const auto& [corner, cell] : cells) {
            EXPECT_NEAR(cell.samples / double(side * side), cell.probability, 4e-3)
                << corner[0] << ' ' << corner[1];
            all += cell.probability;
        }
        EXPECT_NEAR(all, 1.0, 1e-9);
    }
}

TEST(ShaderBrdf, NothingIsReflectedBelowTheSurface) {
    const WalkedFile file(shared_brdf().encode());
    const float up[3] = {0.0f, 0.0f, 1.0f}, nan = std::nanf("");
    for (const float bad : {0.0f, -1.0f, 2.0f, 0.99f, 1.01f, nan, INFINITY, 1e-30f, 3e38f}) {
        const float direction[3] = {0.0f, 0.0f, bad};
        EXPECT_EQ(BrdfPoint(file, direction).sample(1, 2).pdf, 0.0f) << bad;
        EXPECT_EQ(BrdfPoint(file, direction).pdf(up), 0.0f) << bad;
        EXPECT_EQ(BrdfPoint(file, up).pdf(direction), 0.0f) << bad;
    }
}

} // namespace
