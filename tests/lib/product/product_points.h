// Random lights of all shapes, lobes and shading points for tests of products.
#pragma once

#include "tests/inputs/directions.h"
#include "tests/lib/reader/local_loaded.h"
#include "tests/lib/reader/local_random.h"
#include "tests/lib/reader/normals_builder.h"

#include <acdf/product/product.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace acdf_test::products {

constexpr std::uint32_t file_count = 64; // every other one of halvings

// Small grids, so that pdfs can be summed over their squares.
inline RandomOptions small_grid(std::uint32_t seed) {
    RandomOptions options;
    options.columns = 17 + seed % 16;
    options.rows = 9 + seed % 13;
    options.depth = 3;
    options.tilts = false;
    options.long_curves = false;
    options.octahedral = seed % 2 == 1;
    return options;
}
inline LocalSpec random_local(std::uint32_t seed, bool tilts) {
    RandomOptions options = small_grid(seed);
    options.tilts = tilts;
    return RandomLocal(seed, options).make();
}
// On one tree of halvings, whose rows have light at each normal.
inline Bytes random_halved_local(std::uint32_t seed) {
    NormalsSpec spec = random_normals(seed, small_grid(seed));
    spec.cosine_share = 0.0f;
    for (BinSpec& bin : spec.bins) bin = {bin.root == no_root ? 0 : bin.root, bin.share + 0.1f};
    return spec.encode();
}
inline Bytes random_light(std::uint32_t seed, bool tilts) {
    return seed % 2 == 1 ? random_halved_local(seed) : random_local(seed, tilts).encode();
}

struct Vector {
    float v[3];
};

inline Vector unit_vector(double x, double y, double z) {
    const double length = std::sqrt(x * x + y * y + z * z);
    return {{static_cast<float>(x / length), static_cast<float>(y / length), static_cast<float>(z / length)}};
}

// Anywhere, and where bins of normals meet.
inline Vector random_normal(std::mt19937_64& rng) {
    if (rng() % 3 == 0) {
        const auto step = [&] { return static_cast<double>(rng() % 5) - 2.0; };
        const double x = step(), y = step(), z = step();
        return x == 0.0 && y == 0.0 && z == 0.0 ? unit_vector(0, 0, -1) : unit_vector(x, y, z);
    }
    const double z = 2 * uniform(rng) - 1, phi = 2 * M_PI * uniform(rng), sine = std::sqrt(1 - z * z);
    return unit_vector(sine * std::cos(phi), sine * std::sin(phi), z);
}

// Towards the viewer, often at grazing angles.
inline Vector random_view(std::mt19937_64& rng, const acdf::SurfaceFrame& frame) {
    const double z = rng() % 3 == 0 ? 1e-4 + 0.01 * uniform(rng) : uniform(rng), phi = 2 * M_PI * uniform(rng);
    const Vector local = unit_vector(std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi), z);
    Vector world;
    frame.to_world(local.v, world.v);
    return world;
}

// A lobe of half-vectors, sin^2 of whose angle is at most `width` and even below that, reflects directions that may
// lie below the surface; beside it a cosine, half of all.
struct TestLobe {
    double width;

    struct Point {
        float wo[3];
    };
    bool at(const float wo[3], Point& point) const {
        for (int k = 0; k < 3; ++k) point.wo[k] = wo[k];
        return wo[2] > 0.0f;
    }
    float pdf(const Point& point, const float wi[3]) const {
        double h[3], length = 0.0, dot = 0.0;
        for (int k = 0; k < 3; ++k) h[k] = double{point.wo[k]} + double{wi[k]};
        for (double x : h) length += x * x;
        length = std::sqrt(length);
        for (int k = 0; k < 3; ++k) dot += double{point.wo[k]} * h[k] / length;
        const double sin2 = (h[0] * h[0] + h[1] * h[1]) / (length * length), z = std::fabs(h[2]) / length;
        const double lobe = sin2 < width ? z / (M_PI * width * 4.0 * std::fabs(dot)) : 0.0;
        return static_cast<float>(0.5 * lobe + (wi[2] > 0.0f ? 0.5 * double{wi[2]} / M_PI : 0.0));
    }
    float value(const Point&, const float wi[3], float pdf) const { return pdf / std::max(0.02f, wi[2]); }
    acdf::ProductSample sample(const Point& point, double u0, double u1) const {
        const bool cosine = u0 < 0.5;
        const double inside = std::min(u1, 1.0 - 1e-5); // not on the border, where rounding leaves the lobe
        const double r = std::sqrt(inside * (cosine ? 1.0 : width)), z = std::sqrt(1.0 - r * r);
        double s, c;
        acdf_sincospi(cosine ? 4.0 * u0 - 1.0 : 4.0 * u0 - 3.0, &s, &c);
        const double h[3] = {r * c, r * s, z};
        acdf::ProductSample out;
        double dot = 0.0;
        for (int k = 0; k < 3; ++k) dot += 2.0 * h[k] * double{point.wo[k]};
        for (int k = 0; k < 3; ++k)
            out.direction[k] = static_cast<float>(cosine ? h[k] : dot * h[k] - double{point.wo[k]});
        out.pdf = pdf(point, out.direction);
        return out;
    }
};

constexpr double widths[] = {1.0, 0.1, 1e-3};
using Sampler = acdf::ProductSampler<TestLobe>;

inline bool has_cut(const Sampler::Point& point) {
    return point.light.local.what == ACDF_LOCAL_ROWS && point.cut.count > 0;
}

// visit(file, lobe, sampler, point, name, random): of many files, with any number of parts.
template <class Visit>
void each_point(bool tilts, const Visit& visit) {
    for (std::uint32_t seed = 0; seed < file_count; ++seed) {
        const LoadedLocal loaded(random_light(seed, tilts));
        const AcdfLocal light = loaded.light();
        std::mt19937_64 rng(seed);
        for (int i = 0; i < 6; ++i) {
            acdf::ProductOptions options;
            options.parts = 1 + static_cast<int>(rng() % ACDF_CUT_MAX_PARTS);
            const TestLobe lobe{widths[i % 3]};
            const bool all = rng() % 6 == 0; // of the light, whatever the normal
            const Sampler sampler = all ? Sampler(light.environment, lobe, options) : Sampler(light, lobe, options);
            const acdf::SurfaceFrame frame = acdf::surface_frame(random_normal(rng).v);
            const Vector wo = random_view(rng, frame);
            visit(loaded, lobe, sampler, sampler.at(frame, wo.v),
                  "seed " + std::to_string(seed) + ", point " + std::to_string(i), rng);
        }
    }
}

} // namespace acdf_test::products
