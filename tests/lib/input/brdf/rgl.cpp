// RGL tensor files against a slow evaluation that integrates the tables anew for every pair of directions.
#include "input/brdf/rgl.h"
#include "tests/lib/input/brdf/brdf.h"

#include <algorithm>

namespace {

using namespace acdf::input;
using namespace acdf::test;

std::unique_ptr<RglBrdf> parse(const Bytes& file) { return parse_rgl("t", file.data(), file.size()); }

/// One table, bilinear between corners, as plain numbers.
struct Grid {
    std::size_t rows, columns;
    std::vector<double> v;

    double at(std::size_t r, std::size_t c) const { return v[r * columns + c]; }
    double operator()(double x, double y) const {
        const double column = x * double(columns - 1), row = y * double(rows - 1);
        const std::size_t c = std::min(std::size_t(column), columns - 2), r = std::min(std::size_t(row), rows - 2);
        const double s = column - double(c), t = row - double(r);
        return (at(r, c) * (1 - s) + at(r, c + 1) * s) * (1 - t) +
               (at(r + 1, c) * (1 - s) + at(r + 1, c + 1) * s) * t;
    }
    /// Integral from x = 0 to X at height y: the midpoint of a linear piece gives it exactly.
    double along(double X, double y) const {
        double sum = 0.0;
        for (std::size_t c = 0; c + 1 < columns; ++c) {
            const double a = double(c) / double(columns - 1), b = std::min(X, double(c + 1) / double(columns - 1));
            if (b > a) sum += (b - a) * (*this)(0.5 * (a + b), y);
        }
        return sum;
    }
    double below(double Y) const {
        double sum = 0.0;
        for (std::size_t r = 0; r + 1 < rows; ++r) {
            const double a = double(r) / double(rows - 1), b = std::min(Y, double(r + 1) / double(rows - 1));
            if (b > a) sum += (b - a) * along(1.0, 0.5 * (a + b));
        }
        return sum;
    }
};

/// The slice at a view angle; each of the file's scaled to integral 1 first if `normalised`.
Grid slice_at(const RglParts& parts, const std::vector<float>& values, const std::vector<std::uint64_t>& size,
              double phi, double theta, std::size_t channel, std::size_t channels, bool normalised) {
    const std::size_t n = size[0] * size[1];
    const auto slice = [&](std::size_t p, std::size_t t) {
        Grid g{size[0], size[1], {}};
        const std::size_t begin = ((p * parts.theta.size() + t) * channels + channel) * n;
        for (std::size_t i = 0; i < n; ++i) g.v.push_back(double(values[begin + i]));
        const double whole = g.below(1.0);
        for (double& v : g.v) v /= normalised ? whole : 1.0;
        return g;
    };
    const auto node = [](const std::vector<float>& nodes, double x) {
        std::size_t i = 0;
        while (i + 2 < nodes.size() && double(nodes[i + 1]) <= x) ++i;
        if (nodes.size() < 2) return std::pair<std::size_t, double>(0, 0.0);
        const double t = (x - double(nodes[i])) / (double(nodes[i + 1]) - double(nodes[i]));
        return std::pair<std::size_t, double>(i, std::min(1.0, std::max(0.0, t)));
    };
    const auto [p, s] = node(parts.phi, phi);
    const auto [t, r] = node(parts.theta, theta);
    Grid out = slice(p, t);
    for (double& v : out.v) v *= (1 - s) * (1 - r);
    const auto add = [&](std::size_t i, std::size_t j, double weight) {
        if (weight == 0.0) return;
        const Grid g = slice(i, j);
        for (std::size_t k = 0; k < n; ++k) out.v[k] += weight * g.v[k];
    };
    add(p, t + 1, (1 - s) * r);
    add(p + 1, t, s * (1 - r));
    add(p + 1, t + 1, s * r);
    return out;
}

Rgb slow_rho(const RglParts& parts, Direction wo, Direction wi) {
    if (parts.phi.size() > 2 && parts.phi.back() - parts.phi.front() < 2.0f) { // a quarter
        const double sx = wo[0] >= 0.0 ? -1.0 : 1.0, sy = wo[1] >= 0.0 ? -1.0 : 1.0;
        wo = {wo[0] * sx, wo[1] * sy, wo[2]}, wi = {wi[0] * sx, wi[1] * sy, wi[2]};
    } else if (parts.phi.size() > 2 && parts.phi.back() - parts.phi.front() < 4.0f && wo[1] >= 0.0) { // a half
        wo = {-wo[0], -wo[1], wo[2]}, wi = {-wi[0], -wi[1], wi[2]};
    }
    const bool isotropic = parts.phi.size() <= 2;
    Direction m = {wo[0] + wi[0], wo[1] + wi[1], wo[2] + wi[2]};
    const double length = std::sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
    const double theta_m = std::acos(m[2] / length), theta_o = std::acos(wo[2]), phi_o = std::atan2(wo[1], wo[0]);
    double y = (std::atan2(m[1], m[0]) - (isotropic ? phi_o : 0.0) + kPi) / (2.0 * kPi);
    y -= std::floor(y);
    const double x = std::sqrt(2.0 * theta_m / kPi);
    const Grid vndf = slice_at(parts, parts.vndf, parts.vndf_size, phi_o, theta_o, 0, 1, true);
    const double u = vndf.along(x, y) / vndf.along(1.0, y), v = vndf.below(y);
    RglParts flat;
    flat.theta = {0.0f};
    double scale = 1.0;
    if (parts.jacobian) {
        const Grid ndf = slice_at(flat, parts.ndf, parts.ndf_shape, 0, 0, 0, 1, false);
        const Grid sigma = slice_at(flat, parts.sigma, parts.sigma_shape, 0, 0, 0, 1, false);
        scale = ndf(x, y) / (4.0 * sigma(std::sqrt(2.0 * theta_o / kPi), (phi_o + kPi) / (2.0 * kPi)));
    }
    Rgb out;
    for (std::size_t c = 0; c < 3; ++c) {
        const Grid colour = slice_at(parts, parts.colour, parts.colour_size, phi_o, theta_o, c, 3, false);
        out[c] = std::max(0.0, colour(u, v)) * scale / wi[2];
    }
    return out;
}

RglParts anisotropic(double from, double to) {
    RglParts parts;
    parts.phi.clear();
    for (int i = 0; i <= 4; ++i) parts.phi.push_back(static_cast<float>(from + (to - from) * i / 4.0));
    return parts;
}

TEST(InputBrdfRgl, EqualsTheSlowEvaluation) {
    RglParts cases[] = {{}, {}, anisotropic(-kPi, kPi), anisotropic(-kPi, 0.0), anisotropic(-kPi, -0.5 * kPi)};
    cases[1].jacobian = 0;
    std::mt19937_64 random(3);
    for (RglParts& parts : cases) {
        parts.fill(random());
        const auto brdf = parse(parts.bytes());
        EXPECT_EQ(brdf->isotropic, parts.phi.size() == 1);
        for (int i = 0; i < 400; ++i) {
            const Direction wo = random_direction(random), wi = random_direction(random);
            const Rgb value = rho(*brdf, wo, wi), slow = slow_rho(parts, wo, wi);
            for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(value[c], slow[c], 2e-5 * slow[c] + 1e-9);
        }
    }
}

TEST(InputBrdfRgl, ConstantTablesByHand) {
    RglParts parts;
    parts.fill(4);
    std::fill(parts.ndf.begin(), parts.ndf.end(), 3.0f);
    std::fill(parts.sigma.begin(), parts.sigma.end(), 0.5f);
    for (std::size_t i = 0; i < parts.colour.size(); ++i) parts.colour[i] = float(1 + i / 20 % 3); // 20 a channel
    const auto brdf = parse(parts.bytes());
    const Rgb value = rho(*brdf, at_angles(0.4, 1.0), at_angles(kPi / 3.0, 2.0));
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(value[c], (1.0 + double(c)) * 3.0 / (4.0 * 0.5) / 0.5, 1e-5);
    EXPECT_EQ(rho(*brdf, at_angles(0.4, 1.0), at_angles(1.6, 2.0)), (Rgb{0.0, 0.0, 0.0}));
    EXPECT_EQ(rho(*brdf, at_angles(1.6, 1.0), at_angles(0.4, 2.0)), (Rgb{0.0, 0.0, 0.0}));
}

TEST(InputBrdfRgl, IsotropicTurnsAnisotropicDoesNot) {
    std::mt19937_64 random(5);
    for (const bool isotropic : {true, false}) {
        RglParts parts = isotropic ? RglParts{} : anisotropic(-kPi, kPi);
        parts.fill(6);
        std::fill(parts.sigma.begin(), parts.sigma.end(), 0.5f); // which the format lets vary with phi
        const auto brdf = parse(parts.bytes());
        double largest = 0.0;
        for (int i = 0; i < 200; ++i) {
            const Direction wo = random_direction(random), wi = random_direction(random);
            const double a = rho(*brdf, wo, wi)[1], b = rho(*brdf, turned(wo, 0.9), turned(wi, 0.9))[1];
            largest = std::max(largest, std::abs(a - b) / a);
        }
        EXPECT_EQ(largest < 1e-9, isotropic) << largest;
    }
}

TEST(InputBrdfRgl, MirrorSymmetryIsFoundInTheTables) {
    RglParts parts;
    parts.fill(7);
    EXPECT_FALSE(parse(parts.bytes())->mirror);
    EXPECT_GT(parse(parts.bytes())->asymmetry, 0.1);
    for (auto* table : {&parts.vndf, &parts.colour}) {
        const std::size_t rows = (table == &parts.vndf ? parts.vndf_size : parts.colour_size)[0];
        const std::size_t columns = (table == &parts.vndf ? parts.vndf_size : parts.colour_size)[1];
        for (std::size_t i = 0; i < table->size(); ++i) {
            const std::size_t r = i / columns % rows, begin = i - r * columns;
            (*table)[begin + (rows - 1 - r) * columns] = (*table)[i];
        }
    }
    for (std::size_t i = 0; i < 5; ++i) parts.ndf[10 + i] = parts.ndf[i];
    std::fill(parts.sigma.begin(), parts.sigma.end(), 0.5f);
    const auto brdf = parse(parts.bytes());
    EXPECT_TRUE(brdf->mirror);
    std::mt19937_64 random(8);
    for (int i = 0; i < 200; ++i) {
        const Direction wo = random_direction(random), wi = random_direction(random);
        const double a = rho(*brdf, wo, wi)[0];
        EXPECT_NEAR(rho(*brdf, mirrored(wo), mirrored(wi))[0], a, 1e-5 * a);
    }
}

TEST(InputBrdfRgl, NegativeValuesAreZeroAndCounted) {
    RglParts parts;
    parts.fill(9);
    for (float& v : parts.colour) v = -v;
    const auto brdf = parse(parts.bytes());
    ASSERT_EQ(brdf->notes.size(), 1u);
    EXPECT_EQ(brdf->notes[0].rfind("240 of 240 numbers of 'rgb' are negative", 0), 0u) << brdf->notes[0];
    EXPECT_EQ(rho(*brdf, at_angles(0.4, 1.0), at_angles(0.6, 2.0)), (Rgb{0.0, 0.0, 0.0}));
    parts.fill(9);
    parts.vndf[3] = -1.0f;
    EXPECT_EQ(parse(parts.bytes())->notes[0], "1 of 168 numbers of 'vndf' are negative and taken as 0");
}

TEST(InputBrdfRgl, SpectraBecomeColours) {
    RglParts parts;
    for (int nm = 360; nm <= 1000; nm += 4) parts.wavelengths.push_back(static_cast<float>(nm));
    parts.jacobian = 0;
    parts.fill(10);
    const auto paint = [&](const auto& spectrum) {
        for (std::size_t i = 0; i < parts.colour.size(); ++i)
            parts.colour[i] = static_cast<float>(spectrum(double(parts.wavelengths[i / 20 % parts.bands()])));
        return rho(*parse(parts.bytes()), at_angles(0.4, 1.0), at_angles(kPi / 3.0, 2.0));
    };
    const Rgb grey = paint([](double) { return 0.35; });
    for (const double v : grey) EXPECT_NEAR(v, 0.7, 1e-5);
    const Rgb red = paint([](double nm) { return nm > 600.0 ? 1.0 : 0.0; });
    EXPECT_GT(red[0], 1.0);
    EXPECT_LT(red[1], 0.2);
    const Rgb blue = paint([](double nm) { return nm < 480.0 ? 1.0 : 0.0; });
    EXPECT_GT(blue[2], 1.5);
    EXPECT_LT(blue[1], 0.3);
    // The mean wavelength of each channel's weights: y of CIE 1931 is centred at 560 nm for equal energy.
    const std::vector<double> weights = srgb_weights(parts.wavelengths);
    double mean = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < parts.wavelengths.size(); ++i) {
        const std::size_t n = parts.wavelengths.size();
        const double y =
            0.2126 * 1.2048 * weights[i] + 0.7152 * 0.9483 * weights[n + i] + 0.0722 * 0.9087 * weights[2 * n + i];
        mean += y * double(parts.wavelengths[i]), sum += y;
    }
    EXPECT_NEAR(mean / sum, 560.0, 2.0);
}

TEST(InputBrdfRgl, EveryTruncationIsRefused) {
    RglParts parts;
    parts.fill(11);
    const Bytes file = parts.bytes();
    for (std::size_t length = 0; length < file.size(); ++length) {
        const Bytes cut(file.begin(),
                        file.begin() + static_cast<std::ptrdiff_t>(length)); // exactly sized, for ASan
        ASSERT_NE(refusal_of([&] { parse(cut); }), "") << length;
    }
}

TEST(InputBrdfRgl, DamagedFilesAreRefused) {
    RglParts good;
    good.fill(12);
    const auto changed = [&](const auto& change) {
        RglParts parts = good;
        change(parts);
        return parts.bytes();
    };
    EXPECT_REFUSED(parse(changed([](RglParts& p) {
                       p.theta = {0.0f, 0.6f, 0.6f, 1.5f};
                   })),
                   "'theta_i' does not increase");
    EXPECT_REFUSED(parse(changed([](RglParts& p) { p.theta[1] = std::nanf(""); })), "'theta_i' are NaN");
    for (const auto& angles : std::vector<std::vector<float>>{
             {0.0f, 0.6f, 1.1f, 90.0f}, {-0.1f, 0.6f, 1.1f, 1.5f}, {0.0f, 0.6f, 1.1f, 3e38f}})
        EXPECT_REFUSED(parse(changed([&](RglParts& p) { p.theta = angles; })), "'theta_i' has numbers that are no");
    EXPECT_REFUSED(parse(changed([](RglParts& p) { p.phi = {1e30f}; })), "'phi_i' has numbers that are no");
    EXPECT_REFUSED(parse(changed([](RglParts& p) { p.vndf[5] = HUGE_VALF; })), "'vndf' are NaN or infinite");
    EXPECT_REFUSED(parse(changed([](RglParts& p) { p.colour[0] = std::nanf(""); })), "1 numbers of field 'rgb'");
    EXPECT_REFUSED(parse(changed([](RglParts& p) { std::fill(p.vndf.begin(), p.vndf.begin() + 42, 0.0f); })),
                   "'vndf' is 0 everywhere");
    EXPECT_REFUSED(parse(changed([](RglParts& p) { p.sigma[0] = 0.0f; })),
                   "'sigma' has numbers that are not above 0");
    EXPECT_REFUSED(parse(changed([](RglParts& p) {
                       p.vndf_size = {1, 6}, p.vndf.resize(24);
                   })),
                   "'vndf' does not fit");
    EXPECT_REFUSED(parse(changed([](RglParts& p) { p.phi = {0.0f, 1.0f, 2.0f}, p.fill(1); })), "'phi_i' covers");
    EXPECT_REFUSED(parse(changed([](RglParts& p) {
                       p.wavelengths = {1000.0f, 1100.0f}, p.fill(1);
                   })),
                   "visible light");
}

TEST(InputBrdfRgl, FieldsMustBeThere) {
    RglParts parts;
    parts.fill(13);
    EXPECT_REFUSED(parse(TensorWriter{}.bytes()), "'theta_i' is missing");
    TensorWriter twice = parts.writer();
    twice.floats("ndf", {1}, {1.0f});
    EXPECT_REFUSED(parse(twice.bytes()), "'ndf' comes twice");
    TensorWriter integer;
    integer.add("theta_i", 6, {1}, Bytes(4));
    EXPECT_REFUSED(parse(integer.bytes()), "'theta_i' is not 1-dimensional float32");
    TensorWriter polarised;
    polarised.floats("theta_d", {0, 9}, {});
    polarised.floats("M", {1, 1, 1, 1, 4, 4}, std::vector<float>(16));
    EXPECT_REFUSED(parse(polarised.bytes()), "polarised");
}

TEST(InputBrdfRgl, HostileHeadersAreRefused) {
    const auto one_field = [](std::uint8_t type, const std::vector<std::uint64_t>& shape) {
        TensorWriter out;
        out.add("ndf", type, shape, Bytes(16));
        return out.bytes();
    };
    const std::uint64_t huge = std::uint64_t{1} << 63;
    EXPECT_REFUSED(parse(one_field(10, {huge, 2})), "does not lie inside");
    EXPECT_REFUSED(parse(one_field(10, {huge, 0, huge})), "does not lie inside");
    EXPECT_REFUSED(parse(one_field(10, {5})), "does not lie inside");
    EXPECT_REFUSED(parse(one_field(0, {1})), "unknown type 0");
    EXPECT_REFUSED(parse(one_field(12, {1})), "unknown type 12");
    EXPECT_REFUSED(parse(one_field(10, {1, 1, 1, 1, 1, 1, 1, 1, 1})), "9 dimensions");
    RglParts parts;
    parts.fill(14);
    const auto patched = [&](std::size_t at, std::uint8_t value) {
        Bytes file = parts.bytes();
        file[at] = value;
        return file;
    };
    EXPECT_REFUSED(parse(patched(0, 'T')), "not a tensor file");
    EXPECT_REFUSED(parse(patched(12, 2)), "version 2.0");
    EXPECT_REFUSED(parse(patched(13, 7)), "version 1.7");
    EXPECT_REFUSED(parse(patched(16, 1)), "fields"); // 65,546 of them
    EXPECT_REFUSED(parse(patched(18, 0)), "0 bytes");
    EXPECT_REFUSED(parse(patched(20, '\n')), "not made of letters");
}

} // namespace
