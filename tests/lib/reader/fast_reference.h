// A slow decoder of the fast shape of local environments that follows format/SPEC.md §10.6 word by word.
// It shares nothing with lib/reader. It expects valid files.
#pragma once

#include "tests/lib/reader/reference.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace acdf_reference {

class FastShape {
public:
    using Rows = std::vector<std::size_t>;
    using Weights = std::vector<double>;

    FastShape(const Bytes& tile_chunk, const Bytes& sum_chunk, const Bytes& grid_chunk, std::size_t count,
              double width, double height)
        : tiles(tile_chunk), sums(sum_chunk), grid(grid_chunk), tile_count(count), columns(width), rows(height) {}

private:
    static double total_of(const Weights& w) {
        double sum = 0.0;
        for (const double v : w) sum += v;
        return sum;
    }
    struct Split {
        std::size_t axis;
        double position;
        std::size_t child[2];
    };
    Split split(std::size_t i) const {
        const std::size_t at = 528 + 8 * i, place = number(tiles, at, 4);
        return {place & 7, double(place >> 3), {number(tiles, at + 4, 2), number(tiles, at + 6, 2)}};
    }
    std::size_t groups() const { return (tile_count + 15) / 16; }
    std::size_t group_ends() const { return (groups() + 15) / 16 * 16; }
    std::size_t row_count() const { return number(tiles, 8, 4); }
    /// 32767 times the probability of a group, 255 times that of a tile in its group.
    double group_steps(std::size_t row, std::size_t g) const {
        const std::size_t at = 2 * (row * group_ends() + g);
        return double(number(sums, at, 2)) - (g > 0 ? double(number(sums, at - 2, 2)) : 0.0);
    }
    double tile_steps(std::size_t row, std::size_t tile) const {
        const std::size_t at = 2 * row_count() * group_ends() + row * 16 * groups() + tile;
        return double(number(sums, at, 1)) - (tile % 16 > 0 ? double(number(sums, at - 1, 1)) : 0.0);
    }

    struct Mixed {
        std::vector<double> a, b;
        double whole = 0.0; // A
    };
    static Mixed mixed(const Weights& weights) {
        Mixed out;
        const double scale = std::ldexp(1.0, 13 - std::ilogb(total_of(weights)));
        for (const double w : weights) out.a.push_back(std::floor(w * scale) + 1);
        out.whole = total_of(out.a);
        return out;
    }
    /// s of a group; b[k] become those of it.
    double enter(const Rows& row, Mixed& mix, std::size_t g) const {
        std::vector<double> s;
        for (std::size_t k = 0; k < mix.a.size(); ++k) s.push_back(mix.a[k] * group_steps(row[k], g));
        const double sum = total_of(s);
        mix.b.clear();
        double unit = 1.0;
        while (sum >= 16384 * unit) unit *= 2;
        for (const double x : s) mix.b.push_back(std::ceil(x / unit));
        return sum;
    }
    double tile_sum(const Rows& row, const Mixed& mix, std::size_t tile) const {
        double t = 0.0;
        for (std::size_t k = 0; k < mix.b.size(); ++k) t += mix.b[k] * tile_steps(row[k], tile);
        return t;
    }

    Cell tile_box(std::size_t tile) const {
        Cell cell;
        cell.high[0] = columns;
        cell.high[1] = rows;
        std::size_t counted = 0;
        find_box(tile_count > 1 ? 0 : 0x8000, tile, counted, cell);
        return cell;
    }
    // Counts tiles in the order of the traversal until the one is met; then its box is in `cell`.
    bool find_box(std::size_t node, std::size_t tile, std::size_t& counted, Cell& cell) const {
        if (node >= 0x8000) return counted++ == tile;
        const Split s = split(node);
        for (int up = 0; up < 2; ++up) {
            const Cell before = cell;
            (up ? cell.low : cell.high)[s.axis] = s.position;
            if (find_box(s.child[up], tile, counted, cell)) return true;
            cell = before;
        }
        return false;
    }

    // The first of some parts at which their sum is above x; what is left of x, of the part, as a share.
    template <class Part>
    static std::size_t sampled(double& u, double whole, std::size_t count, const Part& part) {
        const double x = std::min(u * whole, std::nextafter(whole, 0.0));
        double below = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
            const double next = below + part(i);
            if (next > x) {
                u = (x - below) / (next - below);
                return i;
            }
            below = next;
        }
        return count;
    }

public:
    /// Samples a tile of the mixture: its number; p of the cell becomes its part of it.
    std::size_t draw(const Rows& row, const Weights& w, double (&u)[2], Cell& cell) const {
        Mixed mix = mixed(w);
        const std::size_t g = sampled(u[0], 32767.0 * mix.whole, groups(), [&](std::size_t i) {
            double s = 0.0;
            for (std::size_t k = 0; k < mix.a.size(); ++k) s += mix.a[k] * group_steps(row[k], i);
            return s;
        });
        const double s = enter(row, mix, g);
        const std::size_t i = sampled(u[1], 255.0 * total_of(mix.b), 16,
                                      [&](std::size_t t) { return tile_sum(row, mix, 16 * g + t); });
        cell = tile_box(16 * g + i);
        cell.p = s * tile_sum(row, mix, 16 * g + i) / (32767.0 * 255.0 * mix.whole * total_of(mix.b));
        return 16 * g + i;
    }

    /// The part of the mixture that the cell of a square has.
    double find(const Rows& row, const Weights& w, const double (&square)[2], Cell& cell) const {
        std::size_t tile = 0;
        for (bool found = false; !found; tile += !found) {
            cell = tile_box(tile);
            found = true;
            for (std::size_t a = 0; a < 2; ++a)
                found = found && square[a] >= cell.low[a] && square[a] < cell.high[a];
        }
        const double inside = find_in_grid(tile, square, cell);
        if (w.empty()) return 0.0;
        Mixed mix = mixed(w);
        const double s = enter(row, mix, tile / 16), t = s > 0.0 ? tile_sum(row, mix, tile) : 0.0;
        return t > 0.0 ? s * t / (32767.0 * 255.0 * mix.whole * total_of(mix.b)) * inside : 0.0;
    }

private:
    struct Grid {
        std::size_t at, count[2];
        double step[2];
    };
    Grid grid_of(std::size_t tile, const Cell& box) const {
        Grid out{number(tiles, 520 + 8 * tile_count + 4 * tile, 4), {}, {}};
        for (std::size_t a = 0; a < 2; ++a) {
            out.step[a] = std::ldexp(1.0, int(number(grid, out.at + a, 1)));
            out.count[a] = std::size_t(std::ceil((box.high[a] - box.low[a]) / out.step[a]));
        }
        return out;
    }
    double end_steps(std::size_t list, std::size_t i) const {
        return double(number(grid, list + i, 1)) - (i > 0 ? double(number(grid, list + i - 1, 1)) : 0.0);
    }
    static void narrow(Cell& cell, std::size_t a, std::size_t i, double step) {
        cell.low[a] += double(i) * step;
        cell.high[a] = std::min(cell.high[a], cell.low[a] + step);
    }

public:
    /// Samples a cell in the tile whose box `cell` is, or finds that of a square: its probability there.
    double sample_in_grid(std::size_t tile, double (&u)[2], Cell& cell) const {
        const Grid grid = grid_of(tile, cell);
        const auto sample_end = [&](double& x, std::size_t list, std::size_t count) {
            return sampled(x, 255.0, count, [&](std::size_t i) { return end_steps(list, i); });
        };
        const std::size_t line = sample_end(u[1], grid.at + 2, grid.count[1]);
        const std::size_t list = grid.at + 2 + grid.count[1] + line * grid.count[0];
        const std::size_t column = sample_end(u[0], list, grid.count[0]);
        narrow(cell, 0, column, grid.step[0]);
        narrow(cell, 1, line, grid.step[1]);
        return end_steps(grid.at + 2, line) * end_steps(list, column) / 65025.0;
    }
    double find_in_grid(std::size_t tile, const double (&square)[2], Cell& cell) const {
        const Grid grid = grid_of(tile, cell);
        const auto line = std::size_t((square[1] - cell.low[1]) / grid.step[1]),
                   column = std::size_t((square[0] - cell.low[0]) / grid.step[0]);
        const std::size_t list = grid.at + 2 + grid.count[1] + line * grid.count[0];
        narrow(cell, 0, column, grid.step[0]);
        narrow(cell, 1, line, grid.step[1]);
        return end_steps(grid.at + 2, line) * end_steps(list, column) / 65025.0;
    }

private:
    const Bytes &tiles, &sums, &grid;
    std::size_t tile_count;
    double columns, rows;
};

} // namespace acdf_reference
