// MERL files against a slow reader that follows the published one step by step: angles, then rotations, then
// indices.
#include "input/brdf/merl.h"
#include "tests/lib/input/brdf/brdf.h"

#include <algorithm>

namespace {

using namespace acdf::input;
using namespace acdf::test;

/// A whole file whose entries are f(channel, theta_h, theta_d, phi_d).
template <class F>
Bytes merl_file(const F& f) {
    Bytes out(MerlLayout::bytes);
    const std::int32_t header[3] = {90, 90, 180};
    std::memcpy(out.data(), header, sizeof header);
    std::size_t at = MerlLayout::header;
    for (int c = 0; c < 3; ++c)
        for (int h = 0; h < 90; ++h)
            for (int d = 0; d < 90; ++d)
                for (int p = 0; p < 180; ++p, at += sizeof(double)) {
                    const double value = f(c, h, d, p);
                    std::memcpy(&out[at], &value, sizeof value);
                }
    return out;
}

int number_of(int h, int d, int p) { return (h * 90 + d) * 180 + p; }

/// Red holds each entry's number (exact as float), green twice and blue half of it.
const Bytes& numbered() {
    static const Bytes file = merl_file([](int c, int h, int d, int p) {
        const double factor[3] = {1500.0, 1500.0 / 1.15 * 2.0, 1500.0 / 1.66 * 0.5};
        return factor[c] * number_of(h, d, p);
    });
    return file;
}

Direction turned_about(const Direction& v, const Direction& axis, double angle) { // Rodrigues
    const double c = std::cos(angle), s = std::sin(angle);
    const double along = (axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2]) * (1.0 - c);
    return {v[0] * c + axis[0] * along + (axis[1] * v[2] - axis[2] * v[1]) * s,
            v[1] * c + axis[1] * along + (axis[2] * v[0] - axis[0] * v[2]) * s,
            v[2] * c + axis[2] * along + (axis[0] * v[1] - axis[1] * v[0]) * s};
}

/// Continuous indices (theta_h, theta_d, phi_d) of a pair of directions.
std::array<double, 3> slow_indices(const Direction& in, const Direction& out) {
    Direction half = {in[0] + out[0], in[1] + out[1], in[2] + out[2]};
    const double length = std::sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]);
    for (double& x : half) x /= length;
    const double theta_h = std::acos(half[2]), phi_h = std::atan2(half[1], half[0]);
    const Direction diff = turned_about(turned_about(in, {0.0, 0.0, 1.0}, -phi_h), {0.0, 1.0, 0.0}, -theta_h);
    double phi_d = std::atan2(diff[1], diff[0]);
    if (phi_d < 0.0) phi_d += kPi;
    const double degrees = theta_h / (kPi / 2.0) * 90.0;
    return {std::sqrt(degrees * 90.0), std::acos(diff[2]) / (kPi / 2.0) * 90.0, phi_d / kPi * 180.0};
}

TEST(InputBrdfMerl, EveryLookupAsThePublishedReader) {
    const auto brdf = parse_merl("m", numbered().data(), numbered().size());
    std::mt19937_64 random(1);
    int compared = 0;
    for (int i = 0; i < 200000; ++i) {
        const Direction wo = random_direction(random);
        // Half of them near the mirror direction, where the rows of theta_h are narrow.
        Direction wi = i % 2 ? random_direction(random) : Direction{-wo[0], -wo[1], wo[2]};
        if (i % 2 == 0) {
            const Direction off = random_direction(random);
            double length = 0.0;
            for (std::size_t k = 0; k < 3; ++k) wi[k] += 0.05 * off[k], length += wi[k] * wi[k];
            for (double& x : wi) x /= std::sqrt(length);
        }
        const auto index = slow_indices(wi, wo);
        const bool at_border =
            std::any_of(index.begin(), index.end(), [](double x) { return std::abs(x - std::round(x)) < 1e-5; });
        if (at_border) continue;
        const int expected = number_of(int(index[0]), int(index[1]), int(index[2]));
        const Rgb value = rho(*brdf, wo, wi);
        ASSERT_EQ(value[0], double(expected)) << index[0] << ' ' << index[1] << ' ' << index[2];
        ASSERT_NEAR(value[1], 2.0 * expected, 1e-6 * expected);
        ASSERT_NEAR(value[2], 0.5 * expected, 1e-6 * expected);
        ++compared;
    }
    EXPECT_GT(compared, 190000);
}

TEST(InputBrdfMerl, DirectionsByHand) {
    const auto brdf = parse_merl("m", numbered().data(), numbered().size());
    const auto entry = [&](const Direction& wo, const Direction& wi) { return rho(*brdf, wo, wi)[0]; };
    const double degree = kPi / 180.0;
    EXPECT_EQ(entry({0, 0, 1}, {0, 0, 1}), number_of(0, 0, 0));
    // Mirror pairs in the plane x z, exactly: h is the normal, and wi lies at 0 or 180 degrees from it.
    const double sine = std::sin(30.5 * degree), cosine = std::cos(30.5 * degree);
    EXPECT_EQ(entry({-sine, 0.0, cosine}, {sine, 0.0, cosine}), number_of(0, 30, 0));
    EXPECT_EQ(entry({sine, 0.0, cosine}, {-sine, 0.0, cosine}), number_of(0, 30, 179));
    // A mirror pair across the plane: phi_d = 90 degrees; half a degree more turns both.
    EXPECT_EQ(entry(at_angles(60.5 * degree, 270.5 * degree), at_angles(60.5 * degree, 90.5 * degree)),
              number_of(0, 60, 90));
    // wo = wi, tilted by 10.1 degrees: row sqrt(10.1 * 90) = 30.15.
    const Direction tilted = at_angles(10.1 * degree, 0.3);
    const double same = entry(tilted, tilted);
    EXPECT_EQ(int(same) / (90 * 180), 30);
    EXPECT_EQ(int(same) / 180 % 90, 0);
    // wi 40.5 degrees further than h, which is tilted by 20, in the plane of incidence: phi_d = 0.
    EXPECT_EQ(entry(at_angles(-20.5 * degree, 0.0), at_angles(60.5 * degree, 0.0)),
              number_of(int(std::sqrt(20.0 * 90.0)), 40, 0));
}

TEST(InputBrdfMerl, NothingBelowTheHorizon) {
    const auto brdf = parse_merl("m", numbered().data(), numbered().size());
    const Direction up = at_angles(0.5, 0.2), level = {1.0, 0.0, 0.0}, down = {0.0, 0.6, -0.8};
    for (const Direction& below : {level, down}) {
        EXPECT_EQ(rho(*brdf, up, below), (Rgb{0.0, 0.0, 0.0}));
        EXPECT_EQ(rho(*brdf, below, up), (Rgb{0.0, 0.0, 0.0}));
    }
}

TEST(InputBrdfMerl, IsotropicAndReciprocal) {
    const auto brdf = parse_merl("m", numbered().data(), numbered().size());
    EXPECT_TRUE(brdf->isotropic);
    std::mt19937_64 random(2);
    for (int i = 0; i < 20000; ++i) {
        const Direction wo = random_direction(random), wi = random_direction(random);
        const auto index = slow_indices(wi, wo);
        if (std::any_of(index.begin(), index.end(), [](double x) { return std::abs(x - std::round(x)) < 1e-5; }))
            continue;
        const Rgb value = rho(*brdf, wo, wi);
        EXPECT_EQ(value, rho(*brdf, turned(wo, 1.234), turned(wi, 1.234)));
        EXPECT_EQ(value, rho(*brdf, wi, wo));
    }
}

TEST(InputBrdfMerl, NegativeEntriesAreZeroAndCounted) {
    const Bytes file = merl_file([](int, int, int d, int p) { return d == 89 ? -1.0 : p < 90 ? 1500.0 : 750.0; });
    const auto brdf = parse_merl("m", file.data(), file.size());
    ASSERT_EQ(brdf->notes.size(), 1u);
    EXPECT_EQ(brdf->notes[0].rfind(std::to_string(3 * 90 * 180) + " of 4374000 entries are negative", 0), 0u);
    EXPECT_EQ(rho(*brdf, at_angles(1.565, 0.0), at_angles(1.565, kPi - 1e-3)), (Rgb{0.0, 0.0, 0.0}));
    EXPECT_FALSE(brdf->mirror);
    EXPECT_NEAR(brdf->asymmetry, 0.5 / 0.75, 1e-6); // 1 against 1/2 everywhere
}

TEST(InputBrdfMerl, MirroredTablesAreKnown) {
    const Bytes file = merl_file([](int c, int h, int d, int p) { return 1.0 + c + h + d + std::abs(p - 89.5); });
    EXPECT_TRUE(parse_merl("m", file.data(), file.size())->mirror);
}

TEST(InputBrdfMerl, DamagedFilesAreRefused) {
    const Bytes& good = numbered();
    const auto parse = [](const Bytes& file) { return parse_merl("m", file.data(), file.size()); };
    const auto patched = [&](std::size_t at, auto value) {
        Bytes file = good;
        std::memcpy(&file[at], &value, sizeof value);
        return file;
    };
    EXPECT_REFUSED(parse_merl("m", good.data(), 0), "too short");
    EXPECT_REFUSED(parse_merl("m", good.data(), 11), "too short");
    EXPECT_REFUSED(parse_merl("m", good.data(), 12), "12 bytes");
    EXPECT_REFUSED(parse_merl("m", good.data(), good.size() - 1), "34992011 bytes");
    Bytes longer = good;
    longer.push_back(0);
    EXPECT_REFUSED(parse(longer), "34992013 bytes");
    EXPECT_REFUSED(parse(patched(0, std::int32_t{-90})), "-90 x 90 x 180");
    EXPECT_REFUSED(parse(patched(4, std::int32_t{180})), "90 x 180 x 180");
    EXPECT_REFUSED(parse(patched(8, std::int32_t{0x7FFFFFFF})), "2147483647");
    EXPECT_REFUSED(parse(patched(12 + 8 * 12345, std::nan(""))), "1 of its entries");
    EXPECT_REFUSED(parse(patched(12, HUGE_VAL)), "NaN or infinite");
    EXPECT_REFUSED(parse(patched(12, 1e300)), "NaN or infinite in single precision");
    EXPECT_REFUSED(parse(patched(12 + 8 * 777, 1.6e21)), "1 of its entries are 1e18 sr^-1 or more");
    Bytes dark = good;
    std::fill(dark.begin() + MerlLayout::header, dark.end(), std::uint8_t{0});
    EXPECT_REFUSED(parse(dark), "none of its entries is above 0");
    for (std::size_t at = MerlLayout::header; at < dark.size(); at += sizeof(double))
        dark[at + 7] = 0xBF; // below 0
    EXPECT_REFUSED(parse(dark), "none of its entries is above 0");
}

} // namespace
