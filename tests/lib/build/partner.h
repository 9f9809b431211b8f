// Files that are made for an MIS partner, of small probes, and slow references that share no code with the library.
#pragma once

#include "tests/inputs/nearest_lookup.h"
#include "tests/inputs/synthetic.h"

#include <acdf/builder.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace acdf::partner_test {

using acdf_test::kPi;
using Vector = std::array<float, 3>;

constexpr std::uint32_t kColumns = 64, kRows = 32;

inline double dot(const Vector& a, const float b[3]) {
    return double{a[0]} * b[0] + double{a[1]} * b[1] + double{a[2]} * b[2];
}

inline Vector random_normal(std::mt19937_64& random) {
    Vector n{};
    const double z = 2.0 * acdf_test::uniform(random) - 1.0;
    acdf_test::direction_of(kPi * (2.0 * acdf_test::uniform(random) - 1.0), z, n.data());
    return n;
}

/// The middles of texels, or of the nine parts of each one after the other, and their solid angles.
struct Directions {
    std::uint32_t parts;
    std::vector<Vector> direction;
    std::vector<double> omega;

    explicit Directions(std::uint32_t n) : parts(n) {
        for (std::uint32_t r = 0; r < kRows; ++r)
            for (std::uint32_t c = 0; c < kColumns; ++c)
                for (std::uint32_t k = 0; k < n * n; ++k) {
                    const std::uint32_t row = n * r + k / n, column = n * c + k % n;
                    Vector d{};
                    acdf_test::direction_of(acdf_test::centre_phi(column, n * kColumns),
                                            acdf_test::centre_z(row, n * kRows), d.data());
                    direction.push_back(d);
                    omega.push_back(
                        2.0 * kPi / (n * kColumns) *
                        (std::cos(kPi * row / (n * kRows)) - std::cos(kPi * (row + 1.0) / (n * kRows))));
                }
    }
};
inline const Directions& middles() {
    static const Directions all(1);
    return all;
}
inline const Directions& ninths() {
    static const Directions all(3);
    return all;
}

inline const Directions& sixteenths() {
    static const Directions all(4);
    return all;
}

/// The texel of a direction.
inline std::size_t texel_of(const float d[3]) {
    const double phi = std::atan2(double{d[1]}, double{d[0]}),
                 theta = std::acos(std::clamp(double{d[2]}, -1.0, 1.0));
    const auto c = std::min(static_cast<std::uint32_t>((kPi - phi) / (2.0 * kPi) * kColumns), kColumns - 1);
    const auto r = std::min(static_cast<std::uint32_t>(theta / kPi * kRows), kRows - 1);
    return std::size_t{r} * kColumns + c;
}

/// Grey radiance, and what it makes of a surface.
struct Probe {
    std::string name;
    std::vector<float> radiance;

    double at(const float d[3]) const { return double{radiance[texel_of(d)]}; }
    double irradiance(const Vector& n) const {
        const Directions& all = ninths();
        double sum = 0.0;
        for (std::size_t i = 0; i < all.direction.size(); ++i)
            sum += double{radiance[i / 9]} * std::max(0.0, dot(n, all.direction[i].data())) * all.omega[i];
        return sum;
    }
};

inline Probe probe(const std::string& name, double (*f)(std::uint32_t column, std::uint32_t row)) {
    Probe out{name, {}};
    for (std::uint32_t r = 0; r < kRows; ++r)
        for (std::uint32_t c = 0; c < kColumns; ++c) out.radiance.push_back(static_cast<float>(f(c, r)));
    return out;
}

inline std::vector<Probe> probes() {
    using u32 = std::uint32_t;
    return {
        probe("even", [](u32, u32) { return 1.0; }),
        probe("sun", [](u32 c, u32 r) { return c == 40 && r == 6 ? 4000.0
                                               : r < 16          ? 1.0
                                                                 : 0.2; }),
        probe("two suns", [](u32 c, u32 r) { return (c == 9 && r == 12) || (c == 50 && r == 3) ? 900.0 : 0.5; }),
        probe("gradient", [](u32 c, u32 r) { return 0.1 + r + 0.3 * ((c * 7 + r * 13) % 11); }),
        probe("dark ground", [](u32 c, u32 r) { return r < 16 ? 1.0 + (c % 8 == 0 ? 30.0 : 0.0) : 0.0; }),
        probe("windows", [](u32 c, u32 r) { return c % 16 < 3 && r > 8 && r < 14 ? 50.0 : 0.05; }),
        probe("noise", [](u32 c, u32 r) { return (c * 2654435761u ^ r * 40503u) % 97 < 4 ? 40.0 : 0.3; }),
        probe("one lamp", [](u32 c, u32 r) { return c == 20 && r == 20 ? 100.0 : 0.0; })};
}

/// A file, as what it samples at a normal.
struct Made {
    std::vector<std::uint8_t> bytes;
    File file;
    double variance = 0.0;

    bool local() const { return file.kind() == ACDF_KIND_LOCAL; }
    DirectionSample sample(const Vector& n, double u0, double u1) const {
        return local() ? file.local().sample(n.data(), u0, u1) : file.environment().sample(u0, u1);
    }
    double pdf(const Vector& n, const float d[3]) const {
        return static_cast<double>(local() ? file.local().pdf(n.data(), d) : file.environment().pdf(d));
    }
};

struct Kind {
    bool local;
    builder::Partner mis;
};
inline const std::vector<Kind> kinds{{false, {ACDF_PARTNER_COSINE, ACDF_HEURISTIC_BALANCE, 1.0, 1.0}},
                                     {false, {ACDF_PARTNER_COSINE, ACDF_HEURISTIC_POWER, 1.0, 1.0}},
                                     {false, {ACDF_PARTNER_BRDF, ACDF_HEURISTIC_BALANCE, 1.0, 1.0}},
                                     {false, {ACDF_PARTNER_MEAN, ACDF_HEURISTIC_BALANCE, 1.0, 1.0}},
                                     {true, {ACDF_PARTNER_COSINE, ACDF_HEURISTIC_BALANCE, 1.0, 1.0}},
                                     {true, {ACDF_PARTNER_COSINE, ACDF_HEURISTIC_BALANCE, 3.0, 1.0}},
                                     {true, {ACDF_PARTNER_COSINE, ACDF_HEURISTIC_POWER, 1.0, 1.0}}};

template <class Options, class Result, class Build>
void make_by(const Build& build, const Probe& probe, const Kind& kind, std::uint64_t budget, Made& out) {
    builder::Pixels pixels;
    pixels.data = probe.radiance.data();
    pixels.width = kColumns;
    pixels.height = kRows;
    pixels.channels = 1;
    Options options;
    options.target = acdf::test::nearest_lookup();
    options.goal = builder::Goal::of_budget(budget);
    options.mis = kind.mis;
    Result made;
    const builder::Status status = build(pixels, options, made);
    ASSERT_TRUE(status.ok()) << probe.name << ": " << status.message;
    out.bytes = std::move(made.bytes);
    out.variance = made.accuracy.relative_variance;
    ASSERT_LE(out.bytes.size(), budget) << probe.name;
    ASSERT_TRUE(File::from_memory(out.bytes.data(), out.bytes.size(), out.file).ok());
}

/// A file of 48 KiB with rows for normals, or of 4 KiB without.
inline void make(const Probe& probe, const Kind& kind, Made& out, std::uint64_t budget = 0) {
    if (budget == 0) budget = kind.local ? 48 << 10 : 4 << 10;
    if (kind.local)
        make_by<builder::LocalOptions, builder::Local>(
            [](const auto& from, const auto& options, auto& made) { return builder::local(from, options, made); },
            probe, kind, budget, out);
    else
        make_by<builder::EnvironmentOptions, builder::Environment>(
            [](const auto& from, const auto& options, auto& made) {
                return builder::environment(from, options, made);
            },
            probe, kind, budget, out);
}

inline double share_of(const builder::Partner& partner) { return partner.light / (partner.light + partner.other); }

/// Weight over number of samples and pdf, of a sample that was sampled with `own` beside `other`, both
/// pdfs times the share of their samples.
inline double weight(double own, double other, AcdfHeuristic heuristic) {
    return heuristic == ACDF_HEURISTIC_POWER ? own / (own * own + other * other) : 1.0 / (own + other);
}

/// N times the variance of N samples over the squared integral: for each sampler the variance of what one of its
/// samples adds, part of a texel by part of `all`. `density(texel)` is ours. -1: it sees no light.
template <class Density>
double slow_variance(const Probe& probe, const Vector& n, double share, AcdfHeuristic heuristic,
                     const Density& density, const Directions& all = middles()) {
    double mean[2] = {0.0, 0.0}, square[2] = {0.0, 0.0};
    double ours = 0.0;
    for (std::size_t part = 0, asked = all.direction.size(); part < all.direction.size(); ++part) {
        const std::size_t texel = part / (all.parts * all.parts);
        const double cosine = dot(n, all.direction[part].data()), f = double{probe.radiance[texel]} * cosine;
        if (!(f > 0.0)) continue;
        if (texel != asked) ours = density(asked = texel);
        const double p[2] = {ours, cosine / kPi}, a[2] = {share * p[0], (1.0 - share) * p[1]};
        for (int i = 0; i < 2; ++i) {
            if (!(p[i] > 0.0)) continue;
            const double x = f * weight(a[i], a[1 - i], heuristic);
            mean[i] += p[i] * all.omega[part] * x;
            square[i] += p[i] * all.omega[part] * x * x;
        }
    }
    const double e = share * mean[0] + (1.0 - share) * mean[1];
    if (!(e > 0.0)) return -1.0;
    return (share * (square[0] - mean[0] * mean[0]) + (1.0 - share) * (square[1] - mean[1] * mean[1])) / (e * e);
}

inline double slow_variance(const Probe& probe, const Vector& n, const builder::Partner& partner, const Made& made,
                            const Directions& all = middles()) {
    return slow_variance(
        probe, n, share_of(partner), partner.heuristic,
        [&](std::size_t texel) { return made.pdf(n, middles().direction[texel].data()); }, all);
}

} // namespace acdf::partner_test
