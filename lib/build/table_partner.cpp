#include "build/table_partner.h"

#include "build/accuracy/cells.h"
#include "build/accuracy/combination.h"
#include "compress/parallel.h"
#include "compress/sum.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace acdf::build {
namespace {

using compress::Grid;

std::size_t count_of(const Grid& grid) {
    std::size_t count = 1;
    for (const std::uint32_t length : grid.shape) count *= length;
    return count;
}

/// Numbers over their mean: a pdf with the whole bin as unit of volume. Empty without energy.
std::vector<double> pdf_of(const Grid& grid) {
    std::vector<double> out(grid.values, grid.values + count_of(grid));
    compress::Sum sum;
    for (const double value : out) sum.add(value);
    const double mean = sum.value() / double(out.size());
    if (!(mean > 0.0)) return {};
    for (double& value : out) value /= mean;
    return out;
}

/// nu n_b at which the shares of all boxes come to nu n_l; f and b are pdfs, b may be empty.
double solve_threshold(const std::vector<double>& f, const std::vector<double>& b, const compress::Filling& filling,
                       double ratio) {
    if (b.empty()) return 0.0;
    double low = 1.0 / (ratio + 1.0) / 64.0, high = 1.0 / ratio;
    for (int step = 0; step < 40; ++step) {
        const double nu = std::sqrt(low * high);
        double sum = 0.0;
        for (std::size_t i = 0; i < f.size(); ++i) {
            const double at = nu * b[i];
            sum += at > 0.0 ? filling.above(f[i] / at) * at : f[i];
        }
        (sum > nu * ratio * double(f.size()) ? low : high) = nu;
    }
    return high;
}

/// Writes p to all boxes of a cell.
void fill(const Grid& grid, const TableCell& cell, std::size_t axis, std::size_t offset, double p,
          std::vector<double>& out) {
    const AcdfSpan& span = cell.box[axis];
    for (std::uint32_t i = span.end[0]; i < span.end[1]; ++i) {
        const std::size_t at = offset * grid.shape[axis] + i;
        if (axis + 1 == grid.dimensions()) out[at] = p;
        else fill(grid, cell, axis + 1, at, p, out);
    }
}

/// A bin: f, the file's pdf p and its partner's b in each box of the grid, with the bin as unit of volume.
struct BinPdfs {
    std::vector<double> f, p, b;
    std::uint64_t cells = 0;

    BinPdfs(const File& file, std::uint32_t bin, const Grid& grid, const Grid& other)
        : f(pdf_of(grid)), p(f.size(), 0.0), b(pdf_of(other)) {
        if (b.empty()) b.assign(f.size(), 0.0);
        if (f.empty() || !(file.bin(bin).share > 0.0f)) return;
        for_each_table_cell(file, bin, [&](const TableCell& cell) {
            double volume = 1.0;
            for (std::size_t axis = 0; axis < grid.dimensions(); ++axis)
                volume *= double(cell.box[axis].end[1] - cell.box[axis].end[0]) / grid.shape[axis];
            fill(grid, cell, 0, 0, cell.probability / volume, p);
            ++cells;
        });
    }

    double second_moment(double share) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < f.size(); ++i)
            if (f[i] > 0.0) sum += f[i] / (share * p[i] + (1.0 - share) * b[i]) * f[i];
        return sum;
    }
};

BinAccuracy measure_bin(const File& file, std::uint32_t bin, const Grid& grid, const Grid& other) {
    const BinPdfs at(file, bin, grid, other);
    BinAccuracy out;
    out.lit = !at.f.empty();
    if (!out.lit) return out;
    const AcdfPartner& partner = *file.partner();
    Combination sum(double{partner.share}, static_cast<AcdfHeuristic>(partner.heuristic));
    for (std::size_t i = 0; i < at.f.size(); ++i) sum.add(at.f[i], 1.0 / double(at.f.size()), at.p[i], at.b[i]);
    out.cells = at.cells;
    out.support_violations = sum.violations();
    out.relative_variance = sum.relative_variance();
    out.max_weight = sum.violations() > 0 ? std::numeric_limits<double>::infinity() : sum.max_weight();
    return out;
}

void check_partner(const File& file, const std::vector<Grid>& bins, const std::vector<Grid>& others) {
    if (!file.partner() || file.partner()->kind != ACDF_PARTNER_TABLE)
        throw std::invalid_argument("the file has no table for an MIS partner");
    if (bins.size() != others.size() || bins.front().shape != others.front().shape)
        throw std::invalid_argument("the partner has another shape");
}

} // namespace

TablePartner::TablePartner(const std::vector<Grid>& bins, const std::vector<Grid>& others,
                           const compress::Partner& partner)
    : bins_(bins), left_(bins.size()), least_(bins.size()),
      filling_(std::make_shared<const compress::Filling>(partner.heuristic)) {
    if (!partner) return;
    compress::parallel_for(std::size_t{0}, bins.size(), [&](std::size_t k) {
        const std::vector<double> f = pdf_of(bins[k]), b = pdf_of(others[k]);
        if (f.empty()) return;
        const double nu = solve_threshold(f, b, *filling_, partner.light / partner.other);
        const double mean = compress::integral(bins[k]);
        left_[k].resize(f.size());
        least_[k].resize(f.size());
        for (std::size_t i = 0; i < f.size(); ++i) {
            const compress::Left left =
                compress::left_to_partner(bins[k].values[i], b.empty() ? 0.0 : nu * b[i] * mean);
            left_[k][i] = left.left;
            least_[k][i] = left.least;
        }
        bins_[k].left = left_[k].data();
        bins_[k].least = least_[k].data();
        bins_[k].filling = filling_.get();
    });
}

std::vector<BinAccuracy> measure_bins_beside(const File& file, const std::vector<Grid>& bins,
                                             const std::vector<Grid>& others) {
    check_shapes(file, bins);
    check_partner(file, bins, others);
    std::vector<BinAccuracy> out(bins.size());
    compress::parallel_for(std::size_t{0}, bins.size(), [&](std::size_t k) {
        out[k] = measure_bin(file, static_cast<std::uint32_t>(k), bins[k], others[k]);
    });
    if (std::none_of(out.begin(), out.end(), [](const BinAccuracy& a) { return a.lit; }))
        throw std::invalid_argument("a table without energy");
    return out;
}

std::vector<float> recommended_light_shares(const File& file, const std::vector<Grid>& bins,
                                            const std::vector<Grid>& others) {
    std::vector<float> out(bins.size(), 1.0f);
    compress::parallel_for(std::size_t{0}, bins.size(), [&](std::size_t k) {
        const BinPdfs at(file, static_cast<std::uint32_t>(k), bins[k], others[k]);
        if (at.f.empty()) return;
        std::size_t low = 0, high = recommendable_shares - 1; // the moment is convex
        while (low < high) {
            const std::size_t middle = (low + high) / 2;
            if (at.second_moment(recommendable_share(middle)) <= at.second_moment(recommendable_share(middle + 1)))
                high = middle;
            else low = middle + 1;
        }
        out[k] = static_cast<float>(recommendable_share(low));
    });
    return out;
}

} // namespace acdf::build
