#include "compress/local/halved/moments.h"

#include "compress/boxes.h"
#include "compress/parallel.h"
#include "compress/widths.h"

#include <acdf/sample.h>

#include <algorithm>
#include <cmath>

namespace acdf::compress {
namespace {

/// A texel, or the part of one, that lies in a block of an axis.
struct Piece {
    std::uint32_t texel;
    double middle; ///< in texels
    double measure;
};

/// Of each block of an axis. `measure(low, high)` of a part of a texel.
template <class Measure>
std::vector<std::vector<Piece>> pieces_of(const std::vector<double>& borders, const Measure& measure) {
    std::vector<std::vector<Piece>> out(borders.size() - 1);
    for (std::size_t b = 0; b < out.size(); ++b)
        for (double low = borders[b]; low < borders[b + 1];) {
            const double high = std::min(borders[b + 1], std::floor(low) + 1.0);
            out[b].push_back({static_cast<std::uint32_t>(low), 0.5 * (low + high), measure(low, high)});
            low = high;
        }
    return out;
}

double height_at(double row, std::uint32_t rows) {
    double sine, cosine;
    acdf_sincospi(row / rows, &sine, &cosine);
    return cosine;
}

void add_to(BlockMoment& out, double x, double y, double z, double light) {
    const double quad[6] = {x * x, y * y, z * z, 2.0 * x * y, 2.0 * x * z, 2.0 * y * z};
    for (std::size_t k = 0; k < 6; ++k) out.quad[k] += static_cast<float>(light * quad[k]);
    out.sum += static_cast<float>(light);
}

/// Columns of a lat-long grid: moments of their light about the axis.
struct Azimuths {
    std::vector<float> cc, ss, cs, c, s, measure;
    std::vector<std::uint32_t> texel, begin;
};

Azimuths azimuths(const std::vector<std::vector<Piece>>& columns, std::uint32_t count) {
    Azimuths out;
    for (const std::vector<Piece>& block : columns) {
        out.begin.push_back(static_cast<std::uint32_t>(out.texel.size()));
        for (const Piece& p : block) {
            double sine, cosine;
            acdf_sincospi(1.0 - 2.0 * p.middle / count, &sine, &cosine);
            out.texel.push_back(p.texel);
            out.measure.push_back(static_cast<float>(p.measure));
            out.cc.push_back(static_cast<float>(p.measure * cosine * cosine));
            out.ss.push_back(static_cast<float>(p.measure * sine * sine));
            out.cs.push_back(static_cast<float>(p.measure * sine * cosine));
            out.c.push_back(static_cast<float>(p.measure * cosine));
            out.s.push_back(static_cast<float>(p.measure * sine));
        }
    }
    out.begin.push_back(static_cast<std::uint32_t>(out.texel.size()));
    return out;
}

void add_row(const Azimuths& of, const float* light, double z, double measure, BlockMoment* blocks) {
    const double radius = std::sqrt((1.0 - z) * (1.0 + z));
    const auto m = static_cast<float>(measure), rr = static_cast<float>(measure * radius * radius),
               rz = static_cast<float>(2.0 * measure * radius * z), zz = static_cast<float>(measure * z * z);
    for (std::size_t b = 0; b + 1 < of.begin.size(); ++b) {
        float cc = 0.0f, ss = 0.0f, cs = 0.0f, c = 0.0f, s = 0.0f, sum = 0.0f;
        for (std::size_t i = of.begin[b]; i < of.begin[b + 1]; ++i) {
            const float l = light[of.texel[i]];
            cc += l * of.cc[i];
            ss += l * of.ss[i];
            cs += l * of.cs[i];
            c += l * of.c[i];
            s += l * of.s[i];
            sum += l * of.measure[i];
        }
        BlockMoment& out = blocks[b];
        out.quad[0] += rr * cc;
        out.quad[1] += rr * ss;
        out.quad[2] += zz * sum;
        out.quad[3] += 2.0f * rr * cs;
        out.quad[4] += rz * c;
        out.quad[5] += rz * s;
        out.sum += m * sum;
    }
}

/// Of each normal: h cos^2 where it sees all of a box, 0 where it sees nothing, else -1.
ACDF_WIDTHS void look(const BlockMoment& moment, const BoxCone& cone, const float* x, const float* y,
                      const float* z, std::size_t count, float* out) {
    const float *q = moment.quad, *a = cone.axis, s = cone.sine;
    const float q0 = q[0], q1 = q[1], q2 = q[2], q3 = q[3], q4 = q[4], q5 = q[5], a0 = a[0], a1 = a[1], a2 = a[2];
    for (std::size_t i = 0; i < count; ++i) {
        const float nx = x[i], ny = y[i], nz = z[i], d = a0 * nx + a1 * ny + a2 * nz;
        const float all = q0 * nx * nx + q1 * ny * ny + q2 * nz * nz + q3 * nx * ny + q4 * nx * nz + q5 * ny * nz;
        const float some = d <= -s ? 0.0f : -1.0f;
        out[i] = d >= s ? all : some;
    }
}

} // namespace

BlockMoment moment_of(const Direction& direction, double light) {
    BlockMoment out;
    add_to(out, direction[0], direction[1], direction[2], light);
    return out;
}

void BlockMoments::integrate(const Row& row) {
    const Target& grid = blocks_.grid();
    const bool octahedral = is_octahedral(grid);
    const auto part = [](const std::vector<double>& measure) {
        return
            [&measure](double low, double high) { return measure[static_cast<std::size_t>(low)] * (high - low); };
    };
    const auto columns = pieces_of(blocks_.borders(1), part(grid.column_measure));
    const auto rows = octahedral ? pieces_of(blocks_.borders(0), part(grid.row_measure))
                                 : pieces_of(blocks_.borders(0), [&](double low, double high) {
                                       return height_at(low, grid.rows) - height_at(high, grid.rows);
                                   });
    const Azimuths around = octahedral ? Azimuths{} : azimuths(columns, grid.columns);
    parallel_parts(0, rows.size(), 1, [&](std::size_t first, std::size_t last) {
        std::vector<float> scratch(grid.columns);
        for (std::size_t r = first; r < last; ++r) {
            BlockMoment* blocks = &(*this)[{static_cast<std::uint32_t>(blocks_.rows() + r), blocks_.columns()}];
            std::fill_n(blocks, blocks_.columns(), BlockMoment{});
            for (const Piece& p : rows[r]) {
                const float* light = row(p.texel, scratch.data());
                if (!octahedral) {
                    add_row(around, light, height_at(p.middle, grid.rows), p.measure, blocks);
                    continue;
                }
                for (std::size_t c = 0; c < columns.size(); ++c)
                    for (const Piece& q : columns[c]) {
                        if (!(light[q.texel] > 0.0f)) continue;
                        const Direction d = octahedral_direction(grid, q.middle, p.middle);
                        add_to(blocks[c], d[0], d[1], d[2], double{light[q.texel]} * q.measure * p.measure);
                    }
            }
        }
    });
    add_up();
}

void BlockMoments::add_up() {
    const std::uint32_t rows = blocks_.rows(), columns = blocks_.columns();
    for (std::uint32_t r = 2 * rows; r-- > 1;)
        for (std::uint32_t c = 2 * columns; c-- > 1;) {
            const HalvedBox box{r, c};
            const int axis = c < columns ? 1 : 0;
            if (blocks_.can_halve(box, axis))
                (*this)[box] = (*this)[half(box, axis, 0)] + (*this)[half(box, axis, 1)];
        }
}

/// Of a block at the horizon: as if its light were even between the heights that it reaches to.
float BlockMoments::seen(HalvedBox box, const float n[3]) const {
    const BlockMoment& moment = (*this)[box];
    if (!(moment.sum > 0.0f)) return 0.0f;
    const BoxCone& cone = blocks_.cone(box);
    const float d = cone.axis[0] * n[0] + cone.axis[1] * n[1] + cone.axis[2] * n[2], s = cone.sine;
    if (d <= -s) return 0.0f;
    if (d >= s) {
        const float* q = moment.quad;
        return q[0] * n[0] * n[0] + q[1] * n[1] * n[1] + q[2] * n[2] * n[2] + q[3] * n[0] * n[1] +
               q[4] * n[0] * n[2] + q[5] * n[1] * n[2];
    }
    if (blocks_.is_block(box)) {
        const float height = d + s;
        return moment.sum * (height * height * height / (6.0f * s));
    }
    const int axis = blocks_.can_halve(box, cone.longer) ? cone.longer : 1 - cone.longer;
    return seen(half(box, axis, 0), n) + seen(half(box, axis, 1), n);
}

void BlockMoments::seen(HalvedBox box, const Normals& normals, float* out) const {
    const BlockMoment& moment = (*this)[box];
    if (!(moment.sum > 0.0f)) return std::fill_n(out, normals.size(), 0.0f), void();
    look(moment, blocks_.cone(box), normals.x.data(), normals.y.data(), normals.z.data(), normals.size(), out);
    for (std::size_t i = 0; i < normals.size(); ++i) {
        if (!(out[i] < 0.0f)) continue;
        const float n[3] = {normals.x[i], normals.y[i], normals.z[i]};
        out[i] = std::max(0.0f, seen(box, n));
    }
}

} // namespace acdf::compress
