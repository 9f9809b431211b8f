// A slow decoder that follows format/SPEC.md word by word, for environment files: it shares nothing with
// lib/reader, so that a misreading in one of the two shows. It expects valid files.
#pragma once

#include <zlib.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace acdf_reference {

using Bytes = std::vector<std::uint8_t>;

inline std::uint64_t number(const Bytes& b, std::size_t at, int size) {
    std::uint64_t v = 0;
    for (int i = size - 1; i >= 0; --i) v = v << 8 | b.at(at + static_cast<std::size_t>(i));
    return v;
}
inline double f32(const Bytes& b, std::size_t at) {
    const auto bits = static_cast<std::uint32_t>(number(b, at, 4));
    float v;
    std::memcpy(&v, &bits, 4);
    return static_cast<double>(v);
}
inline double f64(const Bytes& b, std::size_t at) {
    const std::uint64_t bits = number(b, at, 8);
    double v;
    std::memcpy(&v, &bits, 8);
    return v;
}

struct Cell {
    double low[2] = {0, 0}, high[2] = {0, 0}; // positions on axis 0 and 1
    double tilt[2] = {0, 0};
    double p = 1.0;
};

struct Sample {
    Cell cell;
    double direction[3];
    double pdf;
};

// SPEC.md §7.2
struct Curve {
    std::size_t axis;
    double maximum;
    std::vector<double> cumulative;    // n + 1, ends included
    bool relative;                     // positions count from the low end of the inherited range
    std::vector<double> positions;     // n + 1, the ends unset
    std::vector<std::size_t> children; // where they start, in units of two bytes; 0: ends
    std::vector<double> tilts;         // empty if not tilted

    std::size_t n() const { return children.size(); }
};

// SPEC.md §6.2: the share of a node's random numbers that leads to its lower half, in steps of 2^-31.
inline std::uint64_t halving_share(std::uint64_t code, std::uint64_t code_bits) {
    const double q = static_cast<double>((std::uint64_t{1} << code_bits) - 1),
                 j = 2.0 * static_cast<double>(code) - q;
    const double a = 14 * q * q * q + j * (11 * q * q + 3 * j * j),
                 b = 14 * q * q * q - j * (11 * q * q + 3 * j * j);
    return static_cast<std::uint64_t>(std::floor(a * a / (a * a + b * b) * 2147483648.0 + 0.5));
}

// A node of halvings on the way: its box and the steps of random numbers that lead to it, low and high on each
// axis.
struct Halved {
    std::uint64_t box[2][2], steps[2][2];
};

class Environment {
public:
    explicit Environment(const Bytes& file) {
        const std::size_t chunks = number(file, 36, 4);
        for (std::size_t i = 0; i < chunks; ++i) read_chunk(file, 64 + 48 * i);
        columns = static_cast<double>(number(description_, 64 + 24, 4));
        rows = static_cast<double>(number(description_, 64 + 48 + 24, 4));
        total = f64(description_, 56);
        octahedral = number(description_, 0, 4) == 4;
        if (halvings_.empty()) root = number(bins_, 0, 4);
    }

    double columns, rows, total;
    bool octahedral;
    std::size_t root = 0; // of the tree, in units of two bytes

    bool is_halved() const { return !halvings_.empty(); }

    /// Every leaf of a tree of halvings, in preorder: `enter(axis, upper, node)` says whether a half is visited.
    void each_leaf(const std::function<bool(std::size_t axis, bool upper, const Halved& half)>& enter,
                   const std::function<void(const Halved&)>& visit) const {
        const std::size_t count = number(halvings_, 0, 4);
        std::size_t bit = 8 * 16, code = 8 * (16 + (3 * count + 1 + 31) / 32 * 4);
        const std::uint64_t all = std::uint64_t{1} << 31;
        const Halved whole = {{{0, static_cast<std::uint64_t>(columns)}, {0, static_cast<std::uint64_t>(rows)}},
                              {{0, all}, {0, all}}};
        descend(whole, true, bit, code, enter, visit);
    }
    Cell cell_of(const Halved& leaf) const {
        Cell cell;
        for (int axis = 0; axis < 2; ++axis) {
            cell.low[axis] = static_cast<double>(leaf.box[axis][0]);
            cell.high[axis] = static_cast<double>(leaf.box[axis][1]);
            cell.p *= static_cast<double>(leaf.steps[axis][1] - leaf.steps[axis][0]) / 2147483648.0;
        }
        return cell;
    }
    Cell halved_at(const std::function<bool(std::size_t axis, bool upper, const Halved& half)>& enter,
                   Halved* leaf = nullptr) const {
        Cell cell;
        each_leaf(enter, [&](const Halved& found) {
            cell = cell_of(found);
            if (leaf) *leaf = found;
        });
        return cell;
    }

    Curve curve(std::size_t unit) const {
        std::size_t at = 2 * unit;
        const auto next = [&](int size) {
            at += static_cast<std::size_t>(size);
            return number(tree_, at - static_cast<std::size_t>(size), size);
        };
        const auto align = [&](int size) { // of an array in TREE, an empty one too
            while (at % static_cast<std::size_t>(size) != 0) ++at;
        };
        const std::size_t header = next(2);
        std::size_t n = header >> 10;
        if (n == 0) {
            n = next(2);
            n += next(2) << 16;
        }
        static const int bytes[] = {1, 2, 4}, link_bytes[] = {0, 1, 2, 4};
        const int c = bytes[header >> 3 & 3], p = bytes[header >> 5 & 3], l = link_bytes[header >> 7 & 3];
        Curve out;
        out.axis = header & 7;
        out.maximum = std::ldexp(1.0, 8 * c) - 1.0;
        out.relative = p == 1;
        align(c);
        out.cumulative.push_back(0.0);
        for (std::size_t i = 1; i < n; ++i) out.cumulative.push_back(static_cast<double>(next(c)));
        out.cumulative.push_back(out.maximum);
        align(p);
        out.positions.push_back(0.0);
        for (std::size_t i = 1; i < n; ++i) out.positions.push_back(static_cast<double>(next(p)));
        out.positions.push_back(0.0);
        if (l != 0) align(l);
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t link = l != 0 ? next(l) : 0;
            out.children.push_back(link != 0 ? unit + link : 0);
        }
        align(2);
        for (std::size_t i = 0; i < n && (header >> 9 & 1); ++i)
            out.tilts.push_back(static_cast<std::int16_t>(next(2)) / 32768.0);
        return out;
    }

    // SPEC.md §7.3: `choose` finds the segment of a curve whose positions are those on the axis.
    Cell walk(const std::function<std::size_t(const Curve&)>& choose) const {
        Cell cell;
        cell.high[0] = columns;
        cell.high[1] = rows;
        walk_from(root, cell, choose);
        cell.p = std::max(cell.p, cell.p > 0.0 ? std::ldexp(1.0, -1000) : 0.0);
        return cell;
    }

    /// On from `cell`; its p becomes 0 where no sample can fall.
    void walk_from(std::size_t unit, Cell& cell, const std::function<std::size_t(const Curve&)>& choose) const {
        for (;;) {
            const Curve c = inherit(curve(unit), cell);
            const std::size_t i = choose(c);
            enter(c, i, cell);
            if (cell.p == 0.0 || c.children[i] == 0) return;
            unit = c.children[i];
        }
    }

    Sample sample(double u0, double u1) const {
        double u[2] = {u0, u1};
        for (double& v : u) v = v > 0.0 ? std::min(v, 1.0) : 0.0;
        Sample s;
        if (is_halved()) {
            Halved leaf;
            std::uint64_t step[2];
            for (int axis = 0; axis < 2; ++axis)
                step[axis] = static_cast<std::uint64_t>(std::min(std::floor(u[axis] * 2147483648.0), 2147483647.0));
            s.cell = halved_at(
                [&](std::size_t axis, bool, const Halved& half) {
                    return half.steps[axis][0] <= step[axis] && step[axis] < half.steps[axis][1];
                },
                &leaf);
            for (int axis = 0; axis < 2; ++axis)
                u[axis] = (u[axis] * 2147483648.0 - static_cast<double>(leaf.steps[axis][0])) /
                          static_cast<double>(leaf.steps[axis][1] - leaf.steps[axis][0]);
            place(s, u);
            return s;
        }
        s.cell = walk([&](const Curve& c) { return draw(c, u); });
        place(s, u);
        return s;
    }

    /// Steps 1 to 3.
    static std::size_t draw(const Curve& c, double (&u)[2]) {
        double v = u[c.axis] * c.maximum;
        if (v >= c.maximum) v = c.maximum * (1.0 - std::ldexp(1.0, -53));
        std::size_t i = 0;
        while (!(c.cumulative[i] <= v && v < c.cumulative[i + 1])) ++i;
        u[c.axis] = (v - c.cumulative[i]) / (c.cumulative[i + 1] - c.cumulative[i]);
        return i;
    }

    /// Direction and pdf in s.cell.
    void place(Sample& s, const double (&u)[2]) const {
        const double t0 = solve(s.cell.tilt[0], u[0]), t1 = solve(s.cell.tilt[1], u[1]);
        const double beta = std::ldexp(1.0, -22), x0 = s.cell.low[0], x1 = s.cell.high[0];
        if (octahedral) {
            const double y0 = s.cell.low[1], y1 = s.cell.high[1];
            const double across =
                std::min(std::max(x0 + t0 * (x1 - x0), x0 + beta * columns / 2), x1 - beta * columns / 2);
            const double down = std::min(std::max(y0 + t1 * (y1 - y0), y0 + beta * rows / 2), y1 - beta * rows / 2);
            square_direction(across / columns, down / rows, s.direction);
            s.pdf = density(s.cell, t0, t1);
            return;
        }
        const double z0 = z_of(s.cell.low[1]), z1 = z_of(s.cell.high[1]);
        double x = x0 + t0 * (x1 - x0), z = z0 + t1 * (z1 - z0);
        const double bx = beta * columns / (2 * M_PI), bz = beta * std::sqrt(1 - z * z);
        x = std::min(std::max(x, x0 + bx), x1 - bx);
        z = std::min(std::max(z, z1 + bz), z0 - bz);
        z = std::min(std::max(z, -1 + beta * beta / 2), 1 - beta * beta / 2);
        const double phi = M_PI - 2 * M_PI * x / columns, sine = std::sqrt(1 - z * z);
        s.direction[0] = sine * std::cos(phi);
        s.direction[1] = sine * std::sin(phi);
        s.direction[2] = z;
        s.pdf = density(s.cell, t0, t1);
    }

    // SPEC.md §6.4 and §7.3
    double pdf(const double (&d)[3], Cell* found = nullptr) const {
        double square[2];
        if (!square_of(d, square)) return 0.0;
        const Cell cell = find(square);
        if (found) *found = cell;
        return pdf_in_cell(cell, d);
    }

    // SPEC.md §6.6
    static void square_direction(double u, double v, double (&d)[3]) {
        const double a = std::fabs(2 * u - 1), b = std::fabs(2 * v - 1), e = a + b - 1, r = 1 - std::fabs(e);
        const double phi = r == 0 ? 0 : M_PI / 4 * ((b - a) / r + 1), sine = r * std::sqrt(2 - r * r);
        d[0] = sine * std::cos(phi) * (u > 0.5 ? -1 : 1);
        d[1] = sine * std::sin(phi) * (v < 0.5 ? -1 : 1);
        d[2] = -e * (1 + r);
    }
    static void square_point(const double (&d)[3], double& u, double& v) {
        const double x = std::fabs(d[0]), y = std::fabs(d[1]), z = std::fabs(d[2]);
        const double length = std::sqrt(x * x + y * y + z * z);
        const double r = std::sqrt((x * x + y * y) / (length * (length + z)));
        double b = 2 * r * std::atan2(y, x) / M_PI, a = r - b;
        if (d[2] < 0) {
            const double inner = a;
            a = 1 - b;
            b = 1 - inner;
        }
        u = (d[0] > 0 ? 1 - a : 1 + a) / 2;
        v = (d[1] < 0 ? 1 - b : 1 + b) / 2;
    }

    /// Where a direction lies on both axes, in steps, and the grid square of it; false where its length is wrong.
    void position_of(const double (&d)[3], double (&position)[2]) const {
        if (octahedral) {
            square_point(d, position[0], position[1]);
            position[0] *= columns;
            position[1] *= rows;
        } else {
            position[0] = column_of(d, columns);
            position[1] = rows * std::atan2(std::hypot(d[0], d[1]), d[2]) / M_PI;
        }
    }
    bool square_of(const double (&d)[3], double (&square)[2]) const {
        if (!octahedral) return square_of(d, columns, rows, square);
        const double length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        if (!(std::fabs(length - 1.0) < 0.0005)) return false;
        position_of(d, square);
        square[0] = std::min(std::floor(square[0]), columns - 1);
        square[1] = std::min(std::floor(square[1]), rows - 1);
        return true;
    }
    /// The direction at fractions of a cell in the measures of the axes.
    void direction_in(const Cell& cell, double t0, double t1, double (&d)[3]) const {
        const double x = cell.low[0] + t0 * (cell.high[0] - cell.low[0]);
        if (octahedral) {
            square_direction(x / columns, (cell.low[1] + t1 * (cell.high[1] - cell.low[1])) / rows, d);
            return;
        }
        const double z0 = z_of(cell.low[1]), z = z0 + t1 * (z_of(cell.high[1]) - z0), sine = std::sqrt(1 - z * z);
        d[0] = sine * std::cos(M_PI - 2 * M_PI * x / columns);
        d[1] = sine * std::sin(M_PI - 2 * M_PI * x / columns);
        d[2] = z;
    }

    /// The grid square of a direction on a lat-long grid; false where its length is wrong.
    static bool square_of(const double (&d)[3], double columns, double rows, double (&square)[2]) {
        const double length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        if (!(std::fabs(length - 1.0) < 0.0005)) return false;
        square[0] = std::floor(column_of(d, columns));
        square[1] = std::min(std::floor(rows * std::atan2(std::hypot(d[0], d[1]), d[2]) / M_PI), rows - 1);
        return true;
    }
    static double column_of(const double (&d)[3], double columns) {
        const double sine = std::hypot(d[0], d[1]);
        const double column = columns * (0.5 - (sine > 0 ? std::atan2(d[1], d[0]) : 0.0) / (2 * M_PI));
        return column >= columns ? 0.0 : column;
    }

    double pdf_in_cell(const Cell& cell, const double (&d)[3]) const {
        if (cell.p == 0.0) return 0.0;
        double t[2];
        fractions(cell, d, t);
        return density(cell, t[0], t[1]);
    }
    void fractions(const Cell& cell, const double (&d)[3], double (&t)[2]) const {
        if (octahedral) {
            position_of(d, t);
            for (int axis = 0; axis < 2; ++axis)
                t[axis] =
                    std::min(std::max((t[axis] - cell.low[axis]) / (cell.high[axis] - cell.low[axis]), 0.0), 1.0);
            return;
        }
        const double sine = std::hypot(d[0], d[1]), column = column_of(d, columns);
        const double t0 = (column - cell.low[0]) / (cell.high[0] - cell.low[0]);
        const double z0 = z_of(cell.low[1]), z1 = z_of(cell.high[1]);
        const double t1 = (z0 - std::cos(std::atan2(sine, d[2]))) / (z0 - z1);
        t[0] = std::min(std::max(t0, 0.0), 1.0);
        t[1] = std::min(std::max(t1, 0.0), 1.0);
    }

    Cell find(const double (&square)[2]) const {
        if (is_halved())
            return halved_at([&](std::size_t axis, bool, const Halved& half) {
                return static_cast<double>(half.box[axis][0]) <= square[axis] &&
                       square[axis] < static_cast<double>(half.box[axis][1]);
            });
        return walk([&](const Curve& c) { return segment_of(c, square); });
    }
    static std::size_t segment_of(const Curve& c, const double (&square)[2]) {
        std::size_t i = 0;
        while (i + 1 < c.n() && square[c.axis] >= c.positions[i + 1]) ++i;
        return i;
    }

    /// Every cell, those of probability 0 included.
    void each_cell(const std::function<void(const Cell&)>& visit) const {
        if (is_halved())
            return each_leaf([](std::size_t, bool, const Halved&) { return true; },
                             [&](const Halved& leaf) { visit(cell_of(leaf)); });
        Cell whole;
        whole.high[0] = columns;
        whole.high[1] = rows;
        each_cell(root, whole, visit);
    }

    double z_of(double row) const { return std::cos(M_PI * row / rows); }
    double solid_angle(const Cell& c) const {
        if (octahedral) return 4 * M_PI * (c.high[0] - c.low[0]) * (c.high[1] - c.low[1]) / (columns * rows);
        return 2 * M_PI * (c.high[0] - c.low[0]) / columns * (z_of(c.low[1]) - z_of(c.high[1]));
    }
    double density(const Cell& c, double t0, double t1) const {
        return c.p / solid_angle(c) * (1 + c.tilt[0] * (2 * t0 - 1)) * (1 + c.tilt[1] * (2 * t1 - 1));
    }
    static double solve(double s, double u) {
        return s == 0 ? u : 2 * u / ((1 - s) + std::sqrt((1 - s) * (1 - s) + 4 * s * u));
    }

private:
    void read_chunk(const Bytes& file, std::size_t at) {
        const std::string type(file.begin() + static_cast<std::ptrdiff_t>(at),
                               file.begin() + static_cast<std::ptrdiff_t>(at) + 4);
        const auto begin = file.begin() + static_cast<std::ptrdiff_t>(number(file, at + 16, 8));
        Bytes bytes(begin, begin + static_cast<std::ptrdiff_t>(number(file, at + 24, 8)));
        if (number(file, at + 8, 4) == 1) {
            Bytes raw(number(file, at + 32, 8));
            uLongf size = static_cast<uLongf>(raw.size());
            if (uncompress(raw.data(), &size, bytes.data(), static_cast<uLong>(bytes.size())) != Z_OK ||
                size != raw.size())
                throw std::runtime_error("zlib");
            bytes = raw;
        }
        if (type == "DESC") description_ = bytes;
        if (type == "BINS") bins_ = bytes;
        if (type == "TREE") tree_ = bytes;
        if (type == "LOCL") local_ = bytes;
        if (type == "HALV") halvings_ = bytes;
    }

    std::uint64_t bits_at(std::size_t& bit, std::size_t count) const {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < count; ++i, ++bit)
            value |= static_cast<std::uint64_t>(halvings_.at(bit / 8) >> bit % 8 & 1) << i;
        return value;
    }

    void descend(const Halved& node, bool entered, std::size_t& bit, std::size_t& code,
                 const std::function<bool(std::size_t, bool, const Halved&)>& enter,
                 const std::function<void(const Halved&)>& visit) const {
        if (bits_at(bit, 1) == 0) {
            if (entered) visit(node);
            return;
        }
        const std::size_t axis = bits_at(bit, 1);
        const std::uint64_t code_bits = number(halvings_, 4, 4), k = bits_at(code, code_bits);
        const std::uint64_t low = node.steps[axis][0], wide = node.steps[axis][1] - low;
        std::uint64_t lower = wide * halving_share(k, code_bits) / (std::uint64_t{1} << 31);
        if (k == 0) lower = 0;
        else if (k == (std::uint64_t{1} << code_bits) - 1) lower = wide;
        else lower = std::min(std::max<std::uint64_t>(lower, 1), wide - 1);
        Halved half[2] = {node, node};
        half[0].steps[axis][1] = half[1].steps[axis][0] = low + lower;
        half[0].box[axis][1] = half[1].box[axis][0] = (node.box[axis][0] + node.box[axis][1]) / 2;
        for (int upper = 0; upper < 2; ++upper)
            descend(half[upper], entered && enter(axis, upper == 1, half[upper]), bit, code, enter, visit);
    }

    // Positions on the axis: the ends are those of the range so far.
    static Curve inherit(Curve c, const Cell& cell) {
        for (std::size_t i = 1; c.relative && i < c.n(); ++i) c.positions[i] += cell.low[c.axis];
        c.positions.front() = cell.low[c.axis];
        c.positions.back() = cell.high[c.axis];
        return c;
    }

    static void enter(const Curve& c, std::size_t i, Cell& cell) {
        cell.p = cell.p * ((c.cumulative[i + 1] - c.cumulative[i]) / c.maximum);
        cell.low[c.axis] = c.positions[i];
        cell.high[c.axis] = c.positions[i + 1];
        if (!c.tilts.empty()) cell.tilt[c.axis] = c.tilts[i];
    }

    void each_cell(std::size_t unit, const Cell& cell, const std::function<void(const Cell&)>& visit) const {
        const Curve c = inherit(curve(unit), cell);
        for (std::size_t i = 0; i < c.n(); ++i) {
            Cell inner = cell;
            enter(c, i, inner);
            if (c.children[i] != 0) each_cell(c.children[i], inner, visit);
            else visit(inner);
        }
    }

protected:
    Bytes description_, bins_, tree_, local_, halvings_;
};

} // namespace acdf_reference
