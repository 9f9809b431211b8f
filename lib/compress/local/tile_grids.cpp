#include "compress/local/tile_grids.h"

#include "compress/local/light.h"
#include "compress/parallel.h"
#include "compress/store/quantize.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace acdf::compress {
namespace {

/// Sums of g^2 and of solid angle in the cells of a grid.
struct Energies {
    std::array<std::uint32_t, 2> shift{}, count{};
    std::vector<double> energy;                 ///< line by line
    std::array<std::vector<double>, 2> measure; ///< of the columns and lines
};

std::uint32_t cells_of(std::uint32_t length, std::uint32_t shift) {
    return static_cast<std::uint32_t>(((std::uint64_t{length} - 1) >> shift) + 1);
}

std::uint32_t least_shift(std::uint32_t length) {
    std::uint32_t shift = 0;
    while (cells_of(length, shift) > kMostGridCells) ++shift;
    return shift;
}

/// The finest grid that a tile may have.
Energies finest(const Target& target, const Box& box) {
    Energies out;
    for (std::size_t a = 0; a < 2; ++a) {
        out.shift[a] = least_shift(box.length(1 - a));
        out.count[a] = cells_of(box.length(1 - a), out.shift[a]);
        out.measure[a].resize(out.count[a]);
    }
    out.energy.resize(std::size_t{out.count[0]} * out.count[1]);
    for (std::uint32_t c = 0; c < box.length(1); ++c)
        out.measure[0][c >> out.shift[0]] += target.column_measure[box.begin[1] + c];
    for (std::uint32_t r = 0; r < box.length(0); ++r) {
        const float* values = target.row(box.begin[0] + r) + box.begin[1];
        const double height = target.row_measure[box.begin[0] + r];
        double* line = out.energy.data() + std::size_t{r >> out.shift[1]} * out.count[0];
        out.measure[1][r >> out.shift[1]] += height;
        for (std::uint32_t c = 0; c < box.length(1); ++c)
            line[c >> out.shift[0]] +=
                double{values[c]} * double{values[c]} * (height * target.column_measure[box.begin[1] + c]);
    }
    return out;
}

/// With cells twice as long along an axis.
Energies halved(const Energies& fine, std::size_t axis) {
    Energies out = fine;
    ++out.shift[axis];
    out.count[axis] = (fine.count[axis] + 1) / 2;
    out.energy.assign(std::size_t{out.count[0]} * out.count[1], 0.0);
    out.measure[axis].assign(out.count[axis], 0.0);
    for (std::uint32_t i = 0; i < fine.count[axis]; ++i) out.measure[axis][i / 2] += fine.measure[axis][i];
    for (std::uint32_t y = 0; y < fine.count[1]; ++y)
        for (std::uint32_t x = 0; x < fine.count[0]; ++x)
            out.energy[std::size_t{axis == 1 ? y / 2 : y} * out.count[0] + (axis == 0 ? x / 2 : x)] +=
                fine.energy[std::size_t{y} * fine.count[0] + x];
    return out;
}

/// Where the shifts are less than they can be, halves on.
Energies coarsened(Energies fine, const std::array<std::uint32_t, 2>& shift) {
    for (std::size_t a = 0; a < 2; ++a)
        while (fine.shift[a] < shift[a]) fine = halved(fine, a);
    return fine;
}

TileGrid steps_for(const Energies& e) {
    std::vector<double> cost(e.energy.size());
    for (std::uint32_t y = 0; y < e.count[1]; ++y)
        for (std::uint32_t x = 0; x < e.count[0]; ++x) {
            const std::size_t i = std::size_t{y} * e.count[0] + x;
            cost[i] = std::sqrt(e.measure[0][x] * e.measure[1][y] * e.energy[i]);
        }
    return stepped_grid(e.shift, e.count, std::move(cost));
}

/// Steps for the costs; `loss` becomes the root of the sum of cost^2 / probability.
std::vector<std::uint64_t> steps_of(const std::vector<double>& cost, double& loss) {
    const double largest = *std::max_element(cost.begin(), cost.end());
    loss = 0.0;
    if (!(largest > 0.0)) { // never sampled from: the first takes all
        std::vector<std::uint64_t> first(cost.size(), 0);
        first.front() = kGridSteps;
        return first;
    }
    std::vector<std::uint64_t> steps = apportion(cost, kGridSteps, 1);
    for (std::size_t i = 0; i < cost.size(); ++i)
        if (steps[i] > 0) loss += cost[i] / largest * (cost[i] / largest) * (double(kGridSteps) / double(steps[i]));
    loss = largest * std::sqrt(loss);
    return steps;
}

void append_ends(const std::uint64_t* steps, std::size_t count, std::vector<std::uint8_t>& out) {
    std::uint64_t end = 0;
    for (std::size_t i = 0; i < count; ++i) out.push_back(static_cast<std::uint8_t>(end += steps[i]));
}

} // namespace

TileGrid stepped_grid(std::array<std::uint32_t, 2> shift, std::array<std::uint32_t, 2> count,
                      std::vector<double> cost) {
    TileGrid out;
    out.shift = shift;
    out.count = count;
    std::vector<double> of_lines;
    for (std::size_t y = 0; y < count[1]; ++y) {
        const auto begin = cost.begin() + std::ptrdiff_t(y * count[0]);
        double loss = 0.0;
        for (const std::uint64_t s : steps_of({begin, begin + std::ptrdiff_t(count[0])}, loss))
            out.cells.push_back(s);
        of_lines.push_back(loss);
    }
    out.lines = steps_of(of_lines, out.whole);
    out.cost = std::move(cost);
    return out;
}

TileGrids::TileGrids(const Target& target, const std::vector<Box>& tiles, std::vector<double> worth)
    : target_(target), tiles_(tiles), worth_(std::move(worth)), total_(integral(target)), choices_(tiles.size()),
      chosen_(tiles.size()), grids_(tiles.size()) {
    parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t t) { look_at(t); });
}

/// All grids that a tile may have.
void TileGrids::look_at(std::size_t tile) {
    for (Energies lines = finest(target_, tiles_[tile]);; lines = halved(lines, 1)) {
        for (Energies e = lines;; e = halved(e, 0)) {
            const TileGrid grid = steps_for(e);
            choices_[tile].push_back({e.shift, grid.whole / total_, grid.bytes()});
            if (e.count[0] == 1) break;
        }
        if (lines.count[1] == 1) break;
    }
}

std::uint64_t TileGrids::choose_at(double price) {
    std::uint64_t bytes = 0;
    for (std::size_t t = 0; t < choices_.size(); ++t) {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < choices_[t].size(); ++i) {
            const Choice& choice = choices_[t][i];
            const double value = worth_[t] * total_ * choice.cost + price * double(choice.bytes);
            if (!(value < least)) continue;
            least = value;
            chosen_[t] = i;
        }
        bytes += choices_[t][chosen_[t]].bytes;
    }
    return bytes;
}

void TileGrids::choose(std::uint64_t bytes) {
    double low = 1e-16, high = 1e3; // of prices: of all that there is to gain by hardly any byte and by none
    if (choose_at(low) > bytes) {
        for (int step = 0; step < 60; ++step) {
            const double middle = std::sqrt(low * high);
            (choose_at(middle) > bytes ? low : high) = middle;
        }
        choose_at(high);
    }
    parallel_for(std::size_t{0}, tiles_.size(), [&](std::size_t t) {
        grids_[t] = steps_for(coarsened(finest(target_, tiles_[t]), choices_[t][chosen_[t]].shift));
    });
}

/// The box of cells from `begin` to `end` on both axes.
Box TileGrids::box_of(std::size_t tile, const TileGrid& grid, const std::array<std::uint32_t, 2>& begin,
                      const std::array<std::uint32_t, 2>& end) const {
    const Box& whole = tiles_[tile];
    Box out = whole;
    for (std::size_t a = 0; a < 2; ++a) {
        const auto at = [&](std::uint32_t cell) {
            const std::uint64_t steps = std::uint64_t{cell} << grid.shift[a];
            return whole.begin[1 - a] +
                   static_cast<std::uint32_t>(std::min<std::uint64_t>(steps, whole.length(1 - a)));
        };
        out.begin[1 - a] = at(begin[a]);
        out.end[1 - a] = at(end[a]);
    }
    return out;
}

/// Cells so close that one cosine serves them are visited together.
std::vector<LitCell> TileGrids::lit_cells(std::size_t tile) const {
    const TileGrid& grid = grids_[tile];
    const std::array<double, 2> texel = texel_radians(target_, tiles_[tile]);
    std::array<std::uint32_t, 2> step;
    for (std::size_t a = 0; a < 2; ++a) {
        const double cells = kPointStep / (texel[1 - a] * std::ldexp(1.0, static_cast<int>(grid.shift[a])));
        step[a] = static_cast<std::uint32_t>(std::clamp(cells, 1.0, double(kMostGridCells)));
    }
    std::vector<LitCell> out;
    for (std::uint32_t y = 0; y < grid.count[1]; y += step[1])
        for (std::uint32_t x = 0; x < grid.count[0]; x += step[0]) {
            const std::array<std::uint32_t, 2> end = {std::min(x + step[0], grid.count[0]),
                                                      std::min(y + step[1], grid.count[1])};
            double amount = 0.0;
            for (std::uint32_t j = y; j < end[1]; ++j)
                for (std::uint32_t i = x; i < end[0]; ++i) {
                    const double cost = grid.cost[std::size_t{j} * grid.count[0] + i] / total_;
                    if (cost > 0.0) amount += cost / grid.probability(j, i) * cost;
                }
            if (amount > 0.0) out.push_back({box_of(tile, grid, {x, y}, end), amount, 0.0});
        }
    return out;
}

std::vector<std::uint8_t> TileGrids::stored(std::vector<std::uint32_t>& offsets) const {
    std::vector<std::uint8_t> out;
    offsets.clear();
    for (const TileGrid& grid : grids_) {
        offsets.push_back(static_cast<std::uint32_t>(out.size()));
        for (const std::uint32_t shift : grid.shift) out.push_back(static_cast<std::uint8_t>(shift));
        append_ends(grid.lines.data(), grid.count[1], out);
        for (std::size_t y = 0; y < grid.count[1]; ++y)
            append_ends(&grid.cells[y * grid.count[0]], grid.count[0], out);
    }
    out.resize(out.size() + ACDF_FAST_CELLS, 0); // vectors read on
    return out;
}

} // namespace acdf::compress
