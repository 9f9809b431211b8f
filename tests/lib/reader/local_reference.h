// A slow decoder of local environments of curves that follows format/SPEC.md §10 word by word.
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
    }

    double sigma;

    using Vector = std::array<double, 3>;

    struct Served {
        std::vector<std::size_t> bins;
        std::vector<double> m; // their weights
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
        double square[2] = {0, 0};
        square_of({n[0] / length, n[1] / length, n[2] / length}, columns, rows, square);
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
        enum { nothing, tree } what = nothing;
        std::size_t root = 0;
    };

    Source source(const Vector& n) const {
        const Served served = bins_of(n);
        Source out;
        if (served.bins.empty()) return out;
        out.what = Source::tree;
        const std::size_t largest =
            std::size_t(std::max_element(served.m.begin(), served.m.end()) - served.m.begin());
        const std::size_t bin = served.bins[largest];
        if (!stored(bin)) return out;
        if (share(bin) == 0.0) out.what = Source::nothing;
        out.root = number(bins_, 8 * bin, 4);
        return out;
    }

    /// The light's part alone, of random numbers in [0, 1].
    Sample sample_light(const Source& source, double u0, double u1) const {
        double u[2] = {u0, u1};
        Sample s;
        s.cell.high[0] = columns;
        s.cell.high[1] = rows;
        walk_from(source.root, s.cell, [&](const Curve& c) { return draw(c, u); });
        s.cell.p = std::max(s.cell.p, std::ldexp(1.0, -1000));
        place(s, u);
        return s;
    }

    double light_pdf(const Source& source, const double (&d)[3]) const {
        double square[2];
        if (source.what == Source::nothing || !square_of(d, square)) return 0.0;
        Cell cell;
        cell.high[0] = columns;
        cell.high[1] = rows;
        walk_from(source.root, cell, [&](const Curve& c) { return segment_of(c, square); });
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
            sign[i] = n[i] < 0 ? -1 : 1;
            a[i] = std::fabs(n[i]) * big_n / norm;
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
    std::size_t axes_;
};

} // namespace acdf_reference
