// The random numbers that acdf_brdf_invert returns sample the direction that it was given.
#include "tests/lib/reader/brdf_forms.h"
#include "tests/lib/reader/brdf_loaded.h"
#include "tests/lib/reader/half_vectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

using namespace acdf_test;

namespace {

using Direction = std::array<float, 3>;

class BrdfInvert : public testing::TestWithParam<std::pair<std::string, BrdfSpec>> {
protected:
    BrdfInvert() : spec_(GetParam().second), loaded_(spec_.encode()), view_(loaded_.view()) {}

    double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }
    Direction at_angles(double cosine) {
        const double s = std::sqrt(std::max(0.0, 1.0 - cosine * cosine)), phi = 2.0 * pi * uniform();
        return {float(s * std::cos(phi)), float(s * std::sin(phi)), float(cosine)};
    }
    /// Half of them nearly along the surface: there directions may be nearly opposite.
    Direction some_wo(int i) { return at_angles(i % 2 ? std::exp(-16.0 * uniform()) : uniform()); }

    /// What invert promises of a direction, and that it returns numbers where there is a pdf.
    void expect_back(const Direction& wo, const Direction& wi) {
        double u[2];
        const float p = view_.pdf(wo.data(), wi.data());
        const bool found = view_.invert(wo.data(), wi.data(), u);
        if (spec_.diffuse_share == 0.0f) {
            ASSERT_EQ(found, p > 0.0f);
        }
        if (!found) return;
        ASSERT_TRUE(u[0] >= 0.0 && u[0] <= 1.0 && u[1] >= 0.0 && u[1] <= 1.0) << u[0] << " " << u[1];
        const auto back = view_.sample(wo.data(), u[0], u[1]);
        ASSERT_GT(back.pdf, 0.0f);
        if (room(wo, wi) < 4.0) return; // rounding leads anywhere
        const Halves halves(wo.data(), wi.data());
        const double off = moved(back.direction, wi), cosine = 0.5 * halves.length;
        const double sine =
            std::hypot(double{wo[0]} + double{wi[0]}, double{wo[1]} + double{wi[1]}) / halves.length;
        ASSERT_LE(off, 0x1p-20 / cosine + 0x1p-29 / std::max(sine, 0x1p-15)) << u[0] << " " << u[1];
        if (off > 0x1p-23) ++moved_;
        ++all_;
        // The same cell, in which pdfs differ by what moving does.
        const Halves there(wo.data(), back.direction);
        const double change = std::fabs(there.length * halves.dot / (there.dot * halves.length) - 1.0);
        ASSERT_NEAR(back.pdf, p, (1e-4 + change) * double(p)) << u[0] << " " << u[1];
    }
    /// How many directions floats resolve across the cell of wi, or fewer.
    double room(const Direction& wo, const Direction& wi) const {
        const AcdfBrdf& brdf = view_.data();
        AcdfBrdfView at = {};
        AcdfBrdfPosition place = {};
        AcdfRange range[2];
        double sign = 1.0, reach[2];
        float reflected[3];
        EXPECT_TRUE(acdf_brdf_view(&brdf, wo.data(), &at) &&
                    acdf_brdf_half_position(&brdf, &at, wi.data(), &place, &sign));
        EXPECT_GT(acdf_brdf_find(&brdf, &at, &place, range, nullptr), 0.0);
        acdf_brdf_reflect(&brdf, &at, place.position, sign, reflected, reach);
        return std::min((range[0].high - range[0].low) / reach[0], (range[1].high - range[1].low) / reach[1]);
    }
    static double moved(const float a[3], const Direction& b) {
        double most = 0.0;
        for (std::size_t k = 0; k < 3; ++k) most = std::max(most, std::fabs(double{a[k]} - double{b[k]}));
        return most;
    }

    BrdfSpec spec_;
    Loaded loaded_;
    acdf::BrdfView view_;
    std::mt19937_64 random_{13};
    int moved_ = 0, all_ = 0;
};

TEST_P(BrdfInvert, samplesWhatWasSampled) {
    for (int i = 0; i < 4000; ++i) {
        const Direction wo = some_wo(i);
        const auto s = view_.sample(wo.data(), uniform(), uniform());
        if (s.pdf > 0.0f) expect_back(wo, {s.direction[0], s.direction[1], s.direction[2]});
        if (HasFatalFailure()) FAIL() << i;
    }
    EXPECT_LE(moved_, all_ / 100);
}

TEST_P(BrdfInvert, drawsAnyDirection) {
    for (int i = 0; i < 4000; ++i) {
        const Direction wo = some_wo(i);
        expect_back(wo, at_angles(2.0 * uniform() - 1.0));
        if (HasFatalFailure()) FAIL() << i;
    }
    EXPECT_LE(moved_, all_ / 100);
}

// Nearer than floats resolve: a sample that would come to lie beyond the border is moved by a part of its cell.
TEST_P(BrdfInvert, drawsDirectionsAtTheBordersOfCells) {
    const AcdfBrdf& brdf = view_.data();
    const std::vector<RowCell> cells = spec_.is_halved() ? spec_.cells(0) : std::vector<RowCell>();
    for (std::size_t n = 0; n < 40 * std::min<std::size_t>(cells.size(), 100); ++n) {
        const RowCell& cell = cells[n / 40 * 7919 % cells.size()];
        const std::size_t axis = n % 2;
        const Direction wo = some_wo(static_cast<int>(n));
        AcdfBrdfView at;
        ASSERT_TRUE(acdf_brdf_view(&brdf, wo.data(), &at));
        double position[2] = {brdf.columns * uniform(), brdf.rows * uniform()}, reach[2];
        position[axis] = axis == 0 ? cell.box[0][1] : acdf_half_row(cell.box[1][1]);
        Direction wi;
        acdf_brdf_reflect(&brdf, &at, position, 1.0, wi.data(), reach);
        expect_back(wo, wi);
        if (HasFatalFailure()) FAIL() << n;
    }
}

// Of samples that are not moved the very numbers come back.
TEST_P(BrdfInvert, returnsTheNumbersOfSamples) {
    for (int i = 0; i < 2000; ++i) {
        const Direction wo = at_angles(0.05 + 0.9 * uniform());
        const double share = double{spec_.diffuse_share}, u[2] = {uniform(), share + (1.0 - share) * uniform()};
        const auto s = view_.sample(wo.data(), u[0], u[1]);
        const Direction wi = {s.direction[0], s.direction[1], s.direction[2]};
        if (!(s.pdf > 0.0f) || room(wo, wi) < 1e3) continue;
        double back[2];
        ASSERT_TRUE(view_.invert(wo.data(), s.direction, back));
        ASSERT_NEAR(back[0], u[0], 2e-3) << i;
        ASSERT_NEAR(back[1], u[1], 2e-3) << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Forms, BrdfInvert, testing::ValuesIn(brdf_forms()), [](const auto& form) {
    std::string name = form.param.first;
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
});

} // namespace
