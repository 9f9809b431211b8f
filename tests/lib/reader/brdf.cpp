// acdf/brdf.h against a decoder written from the specification (SPEC.md §11), on files of which no fit would
// think.
#include "tests/lib/curves/open.h"
#include "tests/lib/reader/brdf_forms.h"
#include "tests/lib/reader/brdf_loaded.h"

#include <acdf/acdf.h>
#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

using namespace acdf_test;

namespace {

using Direction = std::array<float, 3>;

Direction at_angles(double cosine, double phi) {
    const double s = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    return {float(s * std::cos(phi)), float(s * std::sin(phi)), float(cosine)};
}

/// Where a row of half-vectors begins, in steps of 2^-28 of 1 - cos(theta_h).
double begin_of_row(std::uint32_t row) {
    const double t = std::max(0.0, (double(row) - 152.0) / 360.0), sine = std::sin(0.25 * pi * t * t);
    return std::max<double>(row, std::floor(2.0 * sine * sine * std::ldexp(1.0, 28) * (1.0 + 1e-15)));
}

/// The row that holds a position.
std::uint32_t row_of(double position) {
    std::uint32_t row = 0;
    while (row + 1 < BrdfSpec::half_rows && begin_of_row(row + 1) <= position) ++row;
    return row;
}

/// Of the cells of a row that which holds a square.
const RowCell& cell_of(const std::vector<RowCell>& cells, const std::uint32_t square[2]) {
    for (const RowCell& cell : cells)
        if (square[0] >= cell.box[0][0] && square[0] < cell.box[0][1] && square[1] >= cell.box[1][0] &&
            square[1] < cell.box[1][1])
            return cell;
    throw std::logic_error("cells leave a gap");
}

/// Bins and weights of a view.
std::vector<std::pair<std::size_t, double>> weights_of(const BrdfSpec& spec, const Direction& wo) {
    const double g = std::sqrt(1.0 - double{wo[2]});
    std::size_t i = 0;
    while (i + 2 < spec.nodes.size() && double{spec.nodes[i + 1]} <= g) ++i;
    const double t = std::min(
        1.0, std::max(0.0, (g - double{spec.nodes[i]}) / (double{spec.nodes[i + 1]} - double{spec.nodes[i]})));
    std::vector<std::pair<std::size_t, double>> out;
    for (std::size_t k = 0; k < 2; ++k) {
        const double weight = k == 0 ? 1.0 - t : t;
        if (spec.azimuths == 1) {
            out.push_back({i + k, weight});
            continue;
        }
        const double c = spec.azimuths * (0.5 + std::atan2(double{wo[1]}, double{wo[0]}) / (2.0 * pi));
        const auto first = static_cast<std::size_t>(c) % spec.azimuths;
        out.push_back({(i + k) * spec.azimuths + first, weight * (1.0 - (c - std::floor(c)))});
        out.push_back({(i + k) * spec.azimuths + (first + 1) % spec.azimuths, weight * (c - std::floor(c))});
    }
    return out;
}

/// Weights of rows, times the shares of their bins, as whole numbers (SPEC.md §15.2, step 3).
std::vector<std::pair<std::size_t, double>> whole_weights_of(const BrdfSpec& spec, const Direction& wo) {
    std::vector<std::pair<std::size_t, double>> out;
    double sum = 0.0, left = std::ldexp(1.0, 21);
    for (const auto& [bin, weight] : weights_of(spec, wo))
        if (const double w = weight * double{spec.bins[bin].share}; w > 0.0) {
            out.push_back({bin, w});
            sum += w;
        }
    auto most = out.begin();
    for (auto at = out.begin(); at != out.end(); ++at)
        if (at->second > most->second) most = at;
    for (auto& [bin, w] : out) {
        w = std::max(1.0, std::floor(w / sum * std::ldexp(1.0, 21) + 0.5));
        left -= w;
    }
    most->second += left;
    return out;
}

double expected_pdf(const BrdfSpec& spec, const std::vector<std::vector<RowCell>>& rows, const Direction& wo,
                    const Direction& wi) {
    double h[3], length = 0.0, dot = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        h[k] = double{wo[k]} + double{wi[k]};
        length += h[k] * h[k];
    }
    length = std::sqrt(length);
    for (std::size_t k = 0; k < 3; ++k) dot += double{wo[k]} * h[k] / length;
    if (h[2] < 0.0)
        for (double& x : h) x = -x;
    double phi = std::atan2(h[1], h[0]);
    if (spec.azimuths == 1) phi -= std::atan2(double{wo[1]}, double{wo[0]});
    phi = std::remainder(phi, 2.0 * pi);
    const double x = spec.flags & 1 ? spec.columns * std::abs(phi) / pi : spec.columns * (0.5 + phi / (2.0 * pi));
    const std::uint32_t square[2] = {std::min(static_cast<std::uint32_t>(x), spec.columns - 1),
                                     row_of(std::ldexp(1.0 - h[2] / length, 28))};
    double sum = 0.0, all = 0.0, area = 1.0;
    for (const auto& [bin, w] : whole_weights_of(spec, wo)) {
        const RowCell& cell = cell_of(rows[spec.bins[bin].root], square);
        sum += w * cell.probability;
        all += w;
        area = double(cell.box[0][1] - cell.box[0][0]) / spec.columns * 2.0 * pi *
               std::ldexp(begin_of_row(cell.box[1][1]) - begin_of_row(cell.box[1][0]), -28);
    }
    const double light = sum / all / area / (4.0 * std::abs(dot));
    const double share = double{spec.diffuse_share};
    return (1.0 - share) * light + share * std::max(0.0, double{wi[2]}) / pi;
}

/// Specs of all forms with rows: mirrored, not, with azimuths, with a diffuse share, of any tree.
std::vector<BrdfSpec> shared_forms() {
    std::vector<BrdfSpec> out;
    for (auto& [name, spec] : brdf_forms()) {
        if (!spec.is_halved() || name == "one view") continue;
        for (BinSpec& bin : spec.bins) bin.share = std::max(bin.share, 0.1f); // every view has a table
        out.push_back(spec);
    }
    return out;
}

// Halving meets the borders of measurements that tabulate sqrt(theta_h) in 90 steps; each row has a step.
TEST(BrdfReader, rowsOfHalfVectorsBeginWhereTheSpecificationSays) {
    EXPECT_EQ(acdf_half_row(0), 0u);
    EXPECT_EQ(acdf_half_row(BrdfSpec::half_rows), 1u << 28);
    std::vector<double> begins;
    for (std::uint32_t row = 0; row <= BrdfSpec::half_rows; ++row) {
        begins.push_back(acdf_half_row(row));
        EXPECT_EQ(begins.back(), begin_of_row(row)) << row;
        EXPECT_TRUE(row == 0 || begins[row] > begins[row - 1]) << row;
    }
    for (std::uint32_t row = 0; row < BrdfSpec::half_rows; ++row)
        for (const double t : {0.0, 0.5, 1.0 - 0x1p-20})
            EXPECT_EQ(acdf_half_row_of(begins.data(), begins[row] + t * (begins[row + 1] - begins[row])), row) << t;
}

TEST(BrdfReader, evaluatesAsTheSpecificationSays) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> u(0.0, 1.0);
    for (const BrdfSpec& given : shared_forms()) {
        BrdfSpec spec = given;
        const Loaded loaded(spec.encode());
        std::vector<std::vector<RowCell>> rows;
        for (std::size_t row = 0; row < spec.halved.rows.size(); ++row) rows.push_back(spec.cells(row));
        for (int i = 0; i < 5000; ++i) {
            const Direction wo = at_angles(0.02 + 0.97 * u(random), 2.0 * pi * u(random));
            const Direction wi = at_angles(2.0 * u(random) - 1.0, 2.0 * pi * u(random));
            const double expected = expected_pdf(spec, rows, wo, wi);
            ASSERT_NEAR(loaded.view().pdf(wo.data(), wi.data()), expected, 2e-5 * expected) << i;
        }
    }
}

TEST(BrdfReader, nearestTreeServesWithoutRows) {
    BrdfSpec spec = separate_brdf();
    spec.diffuse_share = 0.0f;
    spec.tree.curves = {CurveSpec{}, CurveSpec{}}; // uniform, and the lower half of the rows alone
    spec.tree.curves[1] = even_curve(1, {4});
    spec.tree.curves[1].cumulative = {spec.tree.curves[1].maximum()};
    for (std::size_t b = 0; b < spec.bins.size(); ++b) spec.bins[b].root = b == 5 ? 1 : 0;
    const Loaded loaded(spec.encode());
    // Bin 5: elevation 1 (g = 0.75), azimuth 1 of 4 (-pi/2).
    const double cosine = 1.0 - 0.75 * 0.75;
    const Direction inside = at_angles(cosine, -0.5 * pi + 0.7), outside = at_angles(cosine, -0.5 * pi + 0.9);
    const auto at_half_vector = [&](const Direction& wo, double cap) { // in the plane of wo
        const double t = std::acos(double{wo[2]}), th = std::acos(1.0 - cap);
        const double phi = std::atan2(double{wo[1]}, double{wo[0]});
        const double ti = 2.0 * th - t;
        return Direction{float(std::sin(ti) * std::cos(phi)), float(std::sin(ti) * std::sin(phi)),
                         float(std::cos(ti))};
    };
    for (const double cap : {0.1, 0.4, 0.6}) {
        const Direction a = at_half_vector(inside, cap), b = at_half_vector(outside, cap);
        const double dot_a = std::cos(std::acos(cosine) - std::acos(1.0 - cap));
        const double uniform = 1.0 / (2.0 * pi * 4.0 * std::abs(dot_a));
        EXPECT_NEAR(loaded.view().pdf(inside.data(), a.data()), cap < 0.5 ? 2.0 * uniform : 0.0, 1e-5 * uniform)
            << cap;
        EXPECT_NEAR(loaded.view().pdf(outside.data(), b.data()), uniform, 1e-5 * uniform) << cap;
    }
}

TEST(BrdfReader, samplesHaveTheirPdf) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> u(0.0, 1.0);
    std::vector<BrdfSpec> forms = shared_forms();
    forms.push_back(separate_brdf());
    for (BrdfSpec& spec : forms) {
        const Loaded loaded(spec.encode());
        for (int i = 0; i < 4000; ++i) {
            const double cosine = i % 4 == 0 ? 1.0 : i % 4 == 1 ? 0.5 : i % 4 == 2 ? 0.1 : 1e-3;
            const Direction wo = at_angles(cosine, 2.0 * pi * u(random));
            const auto s = loaded.view().sample(wo.data(), u(random), u(random));
            ASSERT_GT(s.pdf, 0.0f);
            ASSERT_TRUE(std::isfinite(s.pdf));
            ASSERT_EQ(s.pdf, loaded.view().pdf(wo.data(), s.direction)) << cosine << " " << i;
        }
    }
}

TEST(BrdfReader, anyNumbersAreSafe) {
    const float nan = std::nanf("");
    std::vector<BrdfSpec> forms = shared_forms();
    forms.push_back(separate_brdf());
    for (BrdfSpec& spec : forms) {
        const Loaded loaded(spec.encode());
        const Direction up = {0.0f, 0.0f, 1.0f}, down = {0.6f, 0.0f, -0.8f}, bad = {nan, 0.0f, 1.0f},
                        longer = {0.0f, 0.0f, 1.1f};
        const Direction flat = {1.0f, 0.0f, 0.0f};
        for (const Direction& wo : {down, bad, longer, flat}) {
            EXPECT_EQ(loaded.view().sample(wo.data(), 0.5, 0.5).pdf, 0.0f);
            EXPECT_EQ(loaded.view().pdf(wo.data(), up.data()), 0.0f);
            EXPECT_EQ(loaded.view().albedo(wo.data()), 0.0);
        }
        for (const Direction& wi : {bad, longer}) EXPECT_EQ(loaded.view().pdf(up.data(), wi.data()), 0.0f);
        EXPECT_GE(loaded.view().pdf(up.data(), down.data()), 0.0f);
        const Direction opposite = {0.0f, 0.0f, -1.0f};
        EXPECT_EQ(loaded.view().pdf(up.data(), opposite.data()), 0.0f);
        for (const double u0 : {-1.0, 0.0, 0.5, 1.0, 2.0, double{nan}})
            for (const double u1 : {-1.0, 0.0, 0.5, 1.0, 2.0, double{nan}}) {
                const auto s = loaded.view().sample(up.data(), u0, u1);
                EXPECT_GT(s.pdf, 0.0f);
                EXPECT_TRUE(std::isfinite(s.direction[0] + s.direction[1] + s.direction[2]));
            }
    }
}

// A half-vector however short has a direction.
TEST(BrdfReader, nearlyOppositeDirectionsHaveAPdf) {
    for (const BrdfSpec& given : shared_forms()) {
        BrdfSpec spec = given;
        const Bytes bytes = spec.encode();
        acdf::File file;
        ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves()).ok());
        const acdf::BrdfView view = file.brdf();
        for (const float off : {1e-20f, 1e-32f, 1e-40f}) {
            const float wo[3] = {off, 0.6f, 0.8f}, wi[3] = {0.0f, -0.6f, -0.8f};
            const float at_x[3] = {off, 0.6f, 0.8f}, opposite[3] = {-off, -0.6f, -0.8f};
            EXPECT_GT(view.pdf(wo, wi), 0.0f) << off;
            EXPECT_EQ(view.pdf(at_x, opposite), 0.0f) << off;
        }
    }
}

// Bins of share 0: samples follow the pdf: the part of the cosine and nothing else.
TEST(BrdfReader, viewsWithoutATableSampleThePartOfTheCosine) {
    BrdfSpec spec = shared_brdf();
    spec.diffuse_share = 0.25f;
    for (BinSpec& bin : spec.bins) bin.share = 0.0f;
    const Bytes bytes = spec.encode();
    acdf::File file;
    ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves()).ok());
    const acdf::BrdfView view = file.brdf();
    const float wo[3] = {0.6f, 0.0f, 0.8f};
    for (int i = 0; i <= 64; ++i) {
        const acdf::DirectionSample s = view.sample(wo, 0.3, i / 64.0);
        EXPECT_EQ(s.pdf > 0.0f, i < 16) << i;
        EXPECT_EQ(s.pdf, i < 16 ? view.pdf(wo, s.direction) : 0.0f) << i;
        EXPECT_FLOAT_EQ(s.pdf, i < 16 ? 0.25f * s.direction[2] / static_cast<float>(pi) : 0.0f) << i;
    }
}

TEST(BrdfReader, albedoIsThatOfTheNodesAndBetweenThem) {
    BrdfSpec spec = shared_brdf();
    const Loaded loaded(spec.encode());
    for (std::size_t i = 0; i < 3; ++i) {
        const double x = double{spec.nodes[i]};
        EXPECT_NEAR(loaded.view().albedo(at_angles(1.0 - x * x, 1.0).data()), 2.0 * double{spec.bins[i].share},
                    1e-5);
    }
    EXPECT_NEAR(loaded.view().albedo(at_angles(1.0 - 0.25 * 0.25, 0.0).data()), 2.0 * 0.375, 1e-5);
}

TEST(BrdfReader, cInterfaceGivesTheSameView) {
    const Bytes bytes = shared_brdf().encode();
    AcdfError error;
    AcdfFile* file = acdf_test::from_memory_in_c(bytes.data(), bytes.size(), &error);
    ASSERT_NE(file, nullptr) << error.message;
    AcdfBrdf brdf;
    AcdfTable table;
    ASSERT_TRUE(acdf_brdf(file, &brdf));
    EXPECT_FALSE(acdf_table(file, &table));
    const Loaded loaded(bytes);
    const Direction wo = at_angles(0.6, 1.0);
    const auto a = loaded.view().sample(wo.data(), 0.3, 0.7), b = acdf_brdf_sample(&brdf, wo.data(), 0.3, 0.7);
    EXPECT_EQ(a.pdf, b.pdf);
    EXPECT_EQ(a.direction[0], b.direction[0]);
    acdf_close(file);
}

TEST(BrdfReader, compressedFilesAreTheSame) {
    BrdfSpec spec = shared_brdf();
    const Loaded plain(spec.encode());
    spec.zlib = true;
    const Loaded packed(spec.encode());
    const Direction wo = at_angles(0.4, 2.0);
    for (double u = 0.05; u < 1.0; u += 0.1)
        EXPECT_EQ(plain.view().sample(wo.data(), u, 1.0 - u).pdf, packed.view().sample(wo.data(), u, 1.0 - u).pdf);
}

} // namespace
