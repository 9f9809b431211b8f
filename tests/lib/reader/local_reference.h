// A slow decoder of local environments that follows format/SPEC.md §9 and §10 word by word.
// It shares nothing with lib/reader. It expects valid files.
#pragma once

#include "tests/lib/reader/reference.h"

#include <algorithm>
#include <array>

namespace acdf_reference {

class Local : public Environment {
public:
    explicit Local(const Bytes& file) : Environment(file) {
        root = 0;
        axes_ = number(description_, 20, 4);
        sigma = f32(local_, 0);
        tile_count = tiles_.empty() ? 0 : number(tiles_, 0, 4);
    }

    double sigma;
    std::size_t tile_count; // 0: no TILE

    using Vector = std::array<double, 3>;

    struct Served {
        std::vector<std::size_t> bins;
        std::vector<double> m; // their weights
        Vector n{};            // n'
    };

    /// Empty where the normal is not valid.
    Served bins_of(const Vector& n) const {
        const double norm = std::fabs(n[0]) + std::fabs(n[1]) + std::fabs(n[2]);
        Served out;
        if (!(norm > 0.0) || std::isinf(norm)) return out;
        if (axes_ == 3) return octahedral(n, norm);
        const double rows = double(number(description_, 64 + 2 * 48 + 24, 4)),
                     columns = double(number(description_, 64 + 3 * 48 + 24, 4));
        const double length = std::hypot(n[0], n[1], n[2]);
        for (std::size_t i = 0; i < 3; ++i) out.n[i] = n[i] / length;
        double square[2] = {0, 0};
        square_of({out.n[0], out.n[1], out.n[2]}, columns, rows, square);
        out.bins = {static_cast<std::size_t>(square[1] * columns + square[0])};
        out.m = {1.0};
        return out;
    }

    static double corner(double big_n, double x, double y, double z) {
        const double r = big_n - std::fabs(z);
        double before = 4 * big_n * big_n + 1 - 2 * r * (r + 1);
        if (z >= 0) before = r > 0 ? 1 + 2 * r * (r - 1) : 0;
        if (r == 0) return before;
        if (x > 0 && y >= 0) return before + y;
        if (y > 0) return before + r - x;
        if (x < 0) return before + 2 * r - y;
        return before + 3 * r + x;
    }

    /// What a normal samples from.
    struct Source {
        enum { nothing, tree, blend } what = nothing;
        std::size_t root = 0;
        std::vector<std::size_t> row; // of the mixture
        std::vector<double> w;
        std::vector<double> light; // weights
        double bright_tiles = 0.0, sum = 0.0, length = 1.0;
    };

    Source source(const Vector& n) const {
        const Served served = bins_of(n);
        Source out;
        if (served.bins.empty()) return out;
        out.what = Source::tree;
        if (tile_count == 0) {
            const std::size_t largest =
                std::size_t(std::max_element(served.m.begin(), served.m.end()) - served.m.begin());
            const std::size_t bin = served.bins[largest];
            if (!stored(bin)) return out;
            if (share(bin) == 0.0) out.what = Source::nothing;
            out.root = number(bins_, 8 * bin, 4);
            return out;
        }
        for (const std::size_t bin : served.bins)
            if (!stored(bin)) return out;
        out.what = Source::blend;
        for (std::size_t i = 0; i < served.bins.size(); ++i) {
            const double w = served.m[i] * share(served.bins[i]);
            if (w == 0.0) continue;
            out.row.push_back(number(bins_, 8 * served.bins[i], 4));
            out.w.push_back(w);
        }
        out.length = std::hypot(served.n[0], served.n[1], served.n[2]);
        for (std::size_t k = 0; k < bright_tile_count(); ++k)
            out.light.push_back(light_weight(k, served.n, out.length));
        for (const double v : out.light) out.bright_tiles += v;
        out.sum = out.bright_tiles + total_of(out.w);
        if (out.sum == 0.0) out.what = Source::nothing;
        return out;
    }

    /// The light's part alone, of random numbers in [0, 1].
    Sample sample_light(const Source& source, double u0, double u1) const {
        double u[2] = {u0, u1};
        Sample s;
        s.cell.high[0] = columns;
        s.cell.high[1] = rows;
        if (source.what == Source::tree) {
            walk_from(source.root, s.cell, [&](const Curve& c) { return draw(c, u); });
            s.cell.p = std::max(s.cell.p, std::ldexp(1.0, -1000));
        } else {
            sample_blend(source, u, s.cell);
        }
        place(s, u);
        return s;
    }

    double light_pdf(const Source& source, const double (&d)[3]) const {
        double square[2];
        if (source.what == Source::nothing || !square_of(d, square)) return 0.0;
        Cell cell;
        cell.high[0] = columns;
        cell.high[1] = rows;
        if (source.what == Source::tree)
            walk_from(source.root, cell, [&](const Curve& c) { return segment_of(c, square); });
        else find_blend(source, square, cell);
        return pdf_in_cell(cell, d);
    }

    /// SPEC.md §10.2
    double pdf(const Vector& n, const double (&d)[3]) const {
        const Source from = source(n);
        if (from.what == Source::nothing) return 0.0;
        const double light = light_pdf(from, d);
        const double dot = n[0] * d[0] + n[1] * d[1] + n[2] * d[2];
        return sigma == 0.0
                   ? light
                   : (1 - sigma) * light + sigma * std::max(0.0, dot) / (M_PI * std::hypot(n[0], n[1], n[2]));
    }

private:
    Served octahedral(const Vector& n, double norm) const {
        const double resolution = double(number(description_, 64 + 2 * 48 + 24, 4));
        const double big_n = std::sqrt((resolution - 2) / 4);
        Served out;
        Vector a, f, sign;
        for (std::size_t i = 0; i < 3; ++i) {
            out.n[i] = n[i] * big_n / norm;
            sign[i] = n[i] < 0 ? -1 : 1;
            a[i] = std::fabs(out.n[i]);
            f[i] = a[i] - std::floor(a[i]);
        }
        const double all = std::round(f[0] + f[1] + f[2]);
        for (std::size_t i = 0; i < 3; ++i) {
            Vector c{};
            for (std::size_t k = 0; k < 3; ++k)
                c[k] = all == 0   ? std::round(a[k])
                       : all == 3 ? std::floor(a[k]) + 1 // rounded down from a corner
                       : all == 1 ? std::floor(a[k]) + (k == i ? 1 : 0)
                                  : std::floor(a[k]) + (k == i ? 0 : 1);
            const bool one = all == 0 || all == 3;
            const double b = one ? (i == 0 ? 1 : 0) : all == 1 ? f[i] : 1 - f[i];
            if (b == 0.0) continue;
            out.bins.push_back(std::size_t(corner(big_n, sign[0] * c[0], sign[1] * c[1], sign[2] * c[2])));
            out.m.push_back(b * std::hypot(c[0], c[1], c[2]));
        }
        return out;
    }

    bool stored(std::size_t bin) const { return number(bins_, 8 * bin, 4) != 0xFFFFFFFF; }
    double share(std::size_t bin) const { return f32(bins_, 8 * bin + 4); }
    std::size_t bright_tile_count() const { return number(local_, 4, 4); }
    static std::size_t light_at(std::size_t k) { return 8 + 40 * k; }

    static double total_of(const std::vector<double>& w) {
        double sum = 0.0;
        for (const double v : w) sum += v;
        return sum;
    }

    double light_weight(std::size_t k, const Vector& n, double length) const {
        double h = 0.0;
        for (std::size_t i = 0; i < 3; ++i) h += n[i] * f32(local_, light_at(k) + 4 * i);
        const double r = f32(local_, light_at(k) + 12) * length, s = f32(local_, light_at(k) + 16);
        if (h >= r) return s * h;
        return h <= -r ? 0.0 : s * ((h + r) * (h + r) / (4 * r));
    }

    Cell light_box(std::size_t k) const {
        Cell cell;
        for (std::size_t a = 0; a < 2; ++a) {
            cell.low[a] = double(number(local_, light_at(k) + 24 + 4 * a, 4));
            cell.high[a] = double(number(local_, light_at(k) + 32 + 4 * a, 4));
        }
        return cell;
    }

    /// 0 where the tile is a cell; unit 0 is never a tile's in the files of these tests.
    std::size_t tile_root(std::size_t tile) const {
        if (number(tiles_, 4, 4) == 0) return 0;
        const std::size_t unit = number(tiles_, 520 + 8 * tile_count + 4 * tile, 4);
        return unit == 0xFFFFFFFF ? 0 : unit;
    }

    // p times that of the cell within the tile.
    void sample_in_tile(std::size_t tile, double (&u)[2], Cell& cell) const {
        const double least = std::ldexp(1.0, -1000), p = std::max(cell.p, least);
        cell.p = 1.0;
        if (tile_root(tile) != 0) {
            walk_from(tile_root(tile), cell, [&](const Curve& c) { return draw(c, u); });
            cell.p = std::max(p * std::max(cell.p, least), least);
        } else {
            cell.p = p;
        }
    }

    struct Split {
        std::size_t axis;
        double position;
        std::size_t child[2];
    };
    Split split(std::size_t i) const {
        const std::size_t at = 528 + 8 * i, place = number(tiles_, at, 4);
        return {place & 7, double(place >> 3), {number(tiles_, at + 4, 2), number(tiles_, at + 6, 2)}};
    }
    double code(std::size_t row, std::size_t i) const {
        return double(number(tiles_, 16 + 2 * number(rows_, row * (tile_count - 1) + i, 1), 2));
    }

    // Weights in the lower and the upper part of a split.
    std::array<std::vector<double>, 2> parts(const Source& source, const std::vector<double>& w,
                                             std::size_t node) const {
        std::array<std::vector<double>, 2> out;
        for (std::size_t k = 0; k < w.size(); ++k) {
            const double c = code(source.row[k], node);
            out[0].push_back(w[k] * (c * (1.0 / 65535)));
            out[1].push_back(w[k] * ((65535 - c) * (1.0 / 65535)));
        }
        return out;
    }

    void sample_blend(const Source& source, double (&u)[2], Cell& cell) const {
        double x = u[0] * source.sum;
        if (x < source.bright_tiles || source.w.empty()) {
            std::size_t k = 0;
            double before = 0.0;
            for (std::size_t i = 0; i < source.light.size(); ++i) {
                if (source.light[i] == 0.0) continue;
                k = i;
                if (x < before + source.light[i]) break;
                before += source.light[i];
            }
            if (x >= before + source.light[k]) before -= source.light[k]; // past the last one by rounding
            u[0] = std::min(std::max((x - before) / source.light[k], 0.0), 1.0);
            cell = light_box(k);
            cell.p = source.light[k] / source.sum;
            sample_in_tile(number(local_, light_at(k) + 20, 4), u, cell);
            return;
        }
        u[0] = std::min(std::max((x - source.bright_tiles) / (source.sum - source.bright_tiles), 0.0), 1.0);
        std::vector<double> w = source.w;
        const double whole = total_of(w);
        double p = whole;
        std::size_t node = tile_count > 1 ? 0 : 0x8000;
        while (node < 0x8000) {
            const Split s = split(node);
            const auto part = parts(source, w, node);
            const double lower = total_of(part[0]), upper = total_of(part[1]);
            x = u[s.axis] * (lower + upper);
            const bool up = x >= lower && upper > 0;
            u[s.axis] = up ? std::min((x - lower) / upper, 1.0) : x < lower ? x / lower : 1.0;
            (up ? cell.low : cell.high)[s.axis] = s.position;
            p = up ? upper : lower;
            w = part[up];
            node = s.child[up];
        }
        cell.p = std::max(p / whole, std::ldexp(1.0, -1000));
        sample_in_tile(node - 0x8000, u, cell);
        cell.p = std::max(whole / source.sum * cell.p, std::ldexp(1.0, -1000));
    }

    void find_blend(const Source& source, const double (&square)[2], Cell& cell) const {
        const double least = std::ldexp(1.0, -1000);
        const auto in_tile = [&](std::size_t tile) { // of its own tree
            if (tile_root(tile) == 0) return 1.0;
            cell.p = 1.0;
            walk_from(tile_root(tile), cell, [&](const Curve& c) { return segment_of(c, square); });
            return cell.p > 0.0 ? std::max(cell.p, least) : 0.0;
        };
        for (std::size_t k = 0; k < source.light.size(); ++k) {
            const Cell box = light_box(k);
            bool inside = true;
            for (std::size_t a = 0; a < 2; ++a)
                inside = inside && square[a] >= box.low[a] && square[a] < box.high[a];
            if (!inside) continue;
            const double p = source.light[k] / source.sum;
            cell = box;
            cell.p = p * in_tile(number(local_, light_at(k) + 20, 4));
            if (p > 0.0 && cell.p > 0.0) cell.p = std::max(cell.p, least);
            return;
        }
        std::vector<double> w = source.w;
        const double whole = total_of(w);
        double p = whole;
        std::size_t node = tile_count > 1 ? 0 : 0x8000;
        while (node < 0x8000 && p > 0.0) {
            const Split s = split(node);
            const bool up = square[s.axis] >= s.position;
            w = parts(source, w, node)[up];
            p = total_of(w);
            (up ? cell.low : cell.high)[s.axis] = s.position;
            node = s.child[up];
        }
        const double inside = p > 0.0 ? in_tile(node - 0x8000) : 0.0;
        cell.p = inside == 0.0 ? 0.0 : std::max(whole / source.sum * std::max(p / whole * inside, least), least);
    }

    std::size_t axes_;
};

} // namespace acdf_reference
