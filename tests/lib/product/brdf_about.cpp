// Pdfs of many directions, about as they are (acdf/product/brdf_about.h), beside those of the cells that they
// may be of.
#include "tests/lib/batch/brdf.h"
#include "tests/lib/reader/brdf_forms.h"
#include "tests/lib/reader/tables/tables_pair.h"

#include <acdf/product/brdf_about.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace acdf_test;

namespace {

/// The first position of a guide's step that holds one.
double step_of(double position) {
    if (!(position >= 1.0625)) return 0.0; // the first one has all before it
    int exponent;
    const double part = 2.0 * std::frexp(position, &exponent);
    return std::ldexp(std::floor(16.0 * part) / 16.0, exponent - 1);
}

/// A position of the cell that is taken to hold one: two borders of azimuths are looked at behind the step's first
/// one.
double taken_for(const AcdfBrdfTables* tables, int axis, double position) {
    const double step = step_of(position);
    if (axis == 1) return step;
    const auto* borders = static_cast<const std::int32_t*>(acdf_brdf_words(tables, tables->borders[0]));
    const std::uint32_t before = acdf_brdf_borders_below(tables, 0, step);
    return acdf_brdf_borders_below(tables, 0, position) <= before + 2 ? position : borders[before + 1];
}

/// Those of positions which are off by some; azimuths go round.
std::vector<double> taken_near(const AcdfBrdf& brdf, int axis, double position, double reach) {
    const double whole = axis == 0 ? brdf.columns : brdf.rows;
    std::vector<double> out;
    const auto add = [&](double p) {
        out.push_back(taken_for(brdf.tables, axis, std::clamp(p, 0.0, whole - 1.0)));
    };
    for (const double p : {position - reach, position, position + reach}) {
        add(p);
        if (axis == 0 && !acdf_brdf_mirrored(&brdf)) add(p < 0.0 ? p + whole : p - whole);
    }
    return out;
}

/// Whether a pdf is that of a cell near a direction: as near as floats resolve half-vectors.
bool is_near(const AcdfBrdf& brdf, const AcdfBrdfView& view, const float wi[3], float pdf) {
    AcdfBrdfPosition place;
    double sign, half[3];
    if (!acdf_brdf_half(&view, wi, half, &place) || place.length < 1e-3) return true; // none, or lost in rounding
    acdf_brdf_half_position(&brdf, &view, wi, &place, &sign);
    const double turn = 3e-5 + 1e-6 / std::hypot(half[0], half[1]);
    for (const double column : taken_near(brdf, 0, place.position[0], turn * brdf.columns))
        for (const double row : taken_near(brdf, 1, place.position[1], turn * place.position[1])) {
            const double position[2] = {column, row};
            const std::uint32_t cell = acdf_brdf_find_cell(brdf.tables, position);
            const float there = acdf_brdf_pair_found(&brdf, &view, cell, &place);
            if (std::fabs(pdf - there) <= 1e-3f * there + 1e-37f) return true;
        }
    return false;
}

std::vector<float> about(const AcdfBrdf& brdf, const AcdfBrdfView& view, const float (*wi)[3], std::size_t count) {
    std::vector<float> out(count + 1, 7.0f);
    acdf_brdf_view_pdfs_about(nullptr, &brdf, &view, wi, count, out.data());
    EXPECT_EQ(out[count], 7.0f);
    return out;
}

TEST(BrdfAbout, PdfsAreThoseOfCellsNearby) {
    for (auto& [name, spec] : brdf_forms()) {
        SCOPED_TRACE(name);
        const TablesPair pair(spec.encode());
        const AcdfBrdf brdf = pair.fast.brdf().data();
        if (!brdf.tables || !brdf.tables->grid) continue;
        const Queries asked(pair.plain.brdf(), 4000);
        for (std::size_t first = 0; first < 4000; first += 100) {
            AcdfBrdfView view;
            if (!acdf_brdf_view(&brdf, asked.wo()[first], &view) || !(view.pair[0] + view.pair[1] > 0.0)) continue;
            const std::vector<float> pdf = about(brdf, view, asked.wi() + first, 100);
            for (std::size_t i = 0; i < 100; ++i) {
                ASSERT_TRUE(is_near(brdf, view, asked.wi()[first + i], pdf[i])) << first + i;
                ASSERT_EQ(about(brdf, view, asked.wi() + first + i, 1)[0], pdf[i]) << "alone";
            }
        }
    }
}

TEST(BrdfAbout, WhateverIsGivenPdfsAreNumbers) {
    const TablesPair pair(shared_brdf().encode());
    const AcdfBrdf brdf = pair.fast.brdf().data();
    const float wo[3] = {0.6f, 0.0f, 0.8f}, nan = std::nanf(""), large = 3e38f;
    const float wi[][3] = {{nan, 0, 1},       {0, nan, 1},         {0, 0, nan},           {0, 0, 0},
                           {large, 0, 0},     {0, large, large},   {-0.6f, 0, -0.8f},     {INFINITY, 0, 0},
                           {0, 0, -INFINITY}, {1e-40f, 0, 1e-40f}, {-0.6f, 1e-30f, -0.8f}};
    AcdfBrdfView view;
    ASSERT_TRUE(acdf_brdf_view(&brdf, wo, &view));
    for (const float pdf : about(brdf, view, wi, std::size(wi))) {
        EXPECT_GE(pdf, 0.0f);
        EXPECT_LE(pdf, 1e30f);
    }
}

TEST(BrdfAbout, WithoutATableOfCellsTheyAreExact) {
    const TablesPair pair(many_borders().encode());
    const AcdfBrdf brdf = pair.plain.brdf().data();
    const Queries asked(pair.plain.brdf(), 100);
    AcdfBrdfView view;
    const float wo[3] = {0.6f, 0.0f, 0.8f};
    ASSERT_TRUE(acdf_brdf_view(&brdf, wo, &view));
    const std::vector<float> pdf = about(brdf, view, asked.wi(), 100);
    for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(pdf[i], acdf_brdf_view_pdf(&brdf, &view, asked.wi()[i]));
}

} // namespace
