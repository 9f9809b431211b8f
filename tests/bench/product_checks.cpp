// Checks acdf/product/product.h at many shading points of real files, and prints a row of a table:
// product_checks LOCAL.acdf (BRDF.acdf | ALPHA_X ALPHA_Y)
//
// Normals and views are random, one view in four grazing, one normal in four where bins of normals meet. Light is
// what the file's environment says, the BRDF its own sampler's pdf over the cosine. Columns: pairs; how far the
// pdf of the cut is from integrating to 1, by summation over the squares of the grid, for a few pairs; samples
// whose pdf differs from pdf(); samples and random directions with light and BRDF but without pdf; pairs
// whose mean is farther than 4 standard errors, and 0.3 % for lobes that change within a square, from summation
// over the squares of the light's grid.
#include "measure/samplers/ggx_lobe.h"

#include <acdf/product/product.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

namespace {

using namespace acdf;

struct Random {
    std::mt19937_64 bits{1};

    double operator()() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
    void direction(double z, float out[3]) {
        const double phi = 2.0 * (*this)() - 1.0, r = std::sqrt(std::max(0.0, 1.0 - z * z));
        double sine, cosine;
        acdf_sincospi(phi, &sine, &cosine);
        const double d[3] = {r * cosine, r * sine, z};
        for (int k = 0; k < 3; ++k) out[k] = static_cast<float>(d[k]);
    }
    void normal(int i, float out[3]) {
        double d[3], length = 0.0;
        if (i % 4 != 1) return direction(2.0 * (*this)() - 1.0, out);
        while (!(length > 0.0)) {
            for (double& x : d) x = static_cast<double>(bits() % 5) - 2.0;
            length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        }
        for (int k = 0; k < 3; ++k) out[k] = static_cast<float>(d[k] / length);
    }
};

struct Mean {
    double sum = 0.0, squares = 0.0, count = 0.0;

    void add(double x) {
        sum += x;
        squares += x * x;
        count += 1.0;
    }
    double value() const { return sum / count; }
    double error2() const { return std::max(0.0, squares / count - value() * value()) / (count - 1.0); }
};

struct Counts {
    double worst_integral = 0.0;
    int disagree = 0, violations = 0, beyond = 0;
};

/// Of the pdf by which parts are sampled.
template <class Point>
double cut_integral(const AcdfVisibleLocal& light, const Point& point) {
    const AcdfGrid grid = acdf_environment_grid(&light.local.environment);
    const double middle[2] = {0.5, 0.5};
    double sum = 0.0;
    for (std::uint32_t y = 0; y < grid.rows; ++y)
        for (std::uint32_t x = 0; x < grid.columns; ++x) {
            const AcdfRange square[2] = {{x, x + 1}, {y, y + 1}};
            const AcdfDirectionSample at = acdf_grid_position(&grid, square, middle, 1.0);
            const float pdf = acdf_cut_pdf(&light, &point.light, &point.cut, at.direction);
            sum += double{pdf} * acdf_grid_solid_angle(&grid, square);
        }
    return sum;
}

/// Whether a point's light is sampled by parts.
template <class Point>
bool has_parts(const Point& point) {
    return point.light.local.what == ACDF_LOCAL_ROWS && point.cut.count > 0;
}

/// The light's grid: of each square that has light its middle.
struct Squares {
    struct Square {
        std::uint32_t at[2];
        float direction[3], light; ///< what is in it
    };
    AcdfGrid grid;
    std::vector<Square> lit;

    explicit Squares(const AcdfLocal& local) : grid(acdf_environment_grid(&local.environment)) {
        for (std::uint32_t y = 0; y < grid.rows; ++y)
            for (std::uint32_t x = 0; x < grid.columns; ++x) {
                Square square = {{x, y}, {}, 0.0f};
                const AcdfRange range[2] = {{x, x + 1}, {y, y + 1}};
                place(square, 0.5, 0.5, square.direction);
                square.light =
                    static_cast<float>(double{acdf_environment_pdf(&local.environment, square.direction)} *
                                       acdf_grid_solid_angle(&grid, range));
                if (square.light > 0.0f) lit.push_back(square);
            }
    }
    /// A direction in a square, at fractions of it of equal solid angle.
    void place(const Square& square, double u, double v, float out[3]) const {
        const AcdfRange range[2] = {{square.at[0], square.at[0] + 1}, {square.at[1], square.at[1] + 1}};
        const double fractions[2] = {u, v};
        const AcdfDirectionSample at = acdf_grid_position(&grid, range, fractions, 1.0);
        std::copy_n(at.direction, 3, out);
    }
};

/// Light times the lobe's pdf, by summation: finer where the lobe is narrow, at the horizon, and where much of
/// the light is.
template <class AnyLobe>
double summed(const Squares& squares, const AnyLobe& lobe, const typename AnyLobe::Point& point,
              const SurfaceFrame& frame) {
    constexpr float much = 1e-3f; // of all light, where borders of the lobe's cells matter
    constexpr std::size_t block = 256;
    constexpr float horizon = 0.02f, narrow = 1.0f;
    const Squares::Square* square[block];
    float wi[block][3], pdf[block];
    std::size_t count = 0;
    double sum = 0.0;
    const auto finer = [&](const Squares::Square& of) {
        const int fine = of.light > much ? 32 : 4;
        double mean = 0.0;
        for (int k = 0; k < fine * fine; ++k) {
            float world[3], at[3];
            squares.place(of, (k % fine + 0.5) / fine, (k / fine + 0.5) / fine, world);
            frame.to_local(world, at);
            if (at[2] > 0.0f) mean += double{lobe.pdf(point, at)} / (fine * fine);
        }
        return mean;
    };
    const auto add_block = [&] {
        for (std::size_t i = 0; i < count; ++i) pdf[i] = lobe.pdf(point, wi[i]);
        for (std::size_t i = 0; i < count; ++i) {
            const bool coarse = wi[i][2] > horizon && pdf[i] < narrow && square[i]->light < much;
            sum += double{square[i]->light} * (coarse ? double{pdf[i]} : finer(*square[i]));
        }
        count = 0;
    };
    for (const Squares::Square& one : squares.lit) {
        frame.to_local(one.direction, wi[count]);
        square[count] = &one;
        count += wi[count][2] > -horizon;
        if (count == block) add_block();
    }
    add_block();
    return sum;
}

template <class AnyLobe>
Counts check(const AcdfLocal& light, const AnyLobe& lobe, int pairs) {
    constexpr int draws = 4000, sums = 4;
    const Squares squares(light);
    Random random;
    Counts out;
    for (int i = 0; i < pairs; ++i) {
        const ProductSampler<AnyLobe> sampler(light, lobe, ProductOptions{i % 2 ? 64 : 8});
        float normal[3], local_wo[3], wo[3], wi[3];
        random.normal(i, normal);
        const SurfaceFrame frame = surface_frame(normal);
        random.direction(i % 4 == 2 ? 0.001 + 0.02 * random() : 0.02 + 0.98 * random(), local_wo);
        frame.to_world(local_wo, wo);
        const auto point = sampler.at(frame, wo);
        if (!(point.share >= 0.0)) continue;
        const auto reflected = [&](const float d[3]) { // light times BRDF times cosine
            frame.to_local(d, wi);
            return wi[2] > 0.0f
                       ? double{acdf_environment_pdf(&light.environment, d)} * double{lobe.pdf(point.lobe, wi)}
                       : 0.0;
        };
        Mean ours;
        const auto draw = [&](Mean& mean) {
            const ProductSample s = sampler.sample(point, random(), random());
            out.disagree += s.pdf > 0.0f && sampler.pdf(point, s.direction) != s.pdf;
            mean.add(s.pdf > 0.0f ? reflected(s.direction) / double{s.pdf} : 0.0);
        };
        for (int k = 0; k < draws; ++k) {
            draw(ours);
            float any[3];
            random.direction(2.0 * random() - 1.0, any);
            out.violations += reflected(any) > 0.0 && !(sampler.pdf(point, any) > 0.0f);
            const bool first = random.bits() % 2 != 0; // what the light or the lobe alone sample
            ProductSample t = first ? acdf_local_sample_at(&light, &point.light.local, random(), random())
                                    : lobe.sample(point.lobe, random(), random());
            if (!(t.pdf > 0.0f)) continue;
            if (!first) {
                float world[3];
                frame.to_world(t.direction, world);
                std::copy_n(world, 3, t.direction);
            }
            out.violations += reflected(t.direction) > 0.0 && !(sampler.pdf(point, t.direction) > 0.0f);
        }
        const double exact = summed(squares, lobe, point.lobe, frame);
        const auto is_beyond = [&](const Mean& mean) {
            return std::fabs(mean.value() - exact) > 4.0 * std::sqrt(mean.error2()) + 0.003 * exact;
        };
        if (is_beyond(ours)) { // by chance once in 16,000, and more often where few samples are most of the mean
            Mean again;
            for (int k = 0; k < 20 * draws; ++k) draw(again);
            out.beyond += is_beyond(again);
        }
        if (i < sums && has_parts(point))
            out.worst_integral =
                std::max(out.worst_integral, std::fabs(cut_integral(acdf_visible_everywhere(&light), point) - 1.0));
    }
    return out;
}

} // namespace

int main(int argc, char** argv) {
    File light, brdf;
    const bool lobe = argc >= 4;
    if (argc < 3 || !File::open(argv[1], light).ok() || light.kind() != ACDF_KIND_LOCAL ||
        (!lobe && (!File::open(argv[2], brdf).ok() || brdf.kind() != ACDF_KIND_BRDF))) {
        std::fprintf(stderr, "usage: product_checks LOCAL.acdf (BRDF.acdf | ALPHA_X ALPHA_Y)\n");
        return 1;
    }
    constexpr int pairs = 200;
    const AcdfLocal data = light.local().data();
    const Counts c = lobe ? check(data, measure::GgxLobe(std::atof(argv[2]), std::atof(argv[3])), pairs)
                          : check(data, BrdfLobe(brdf.brdf().data()), pairs);
    std::printf("| %d | %.1g | %d | %d | %d |\n", pairs, c.worst_integral, c.disagree, c.violations, c.beyond);
    return c.worst_integral > 1e-4 || c.disagree > 0 || c.violations > 0 || c.beyond > 1 ? 1 : 0;
}
