#include "compress/brdf/weights.h"
#include "compress/parallel.h"

#include <acdf/sample.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace acdf::compress {
namespace {

/// Where a view's reflections are evaluated, as a pdf over half-vectors.
class Reflections {
public:
    Reflections(const Reflected& reflected, const View& view, double albedo)
        : reflected_(reflected), phi_(view.phi), scale_(4.0 / albedo) {
        view.direction(wo_);
    }

    /// A half-vector and the direction into which it reflects the view.
    struct Reflection {
        double dot;
        double wi[3];
        bool above() const { return dot > 0.0 && wi[2] > 0.0; }
    };

    Reflection at(const Latitude& half, const double azimuth[2]) const {
        const double h[3] = {half.radius * azimuth[0], half.radius * azimuth[1], half.z};
        const double dot = wo_[0] * h[0] + wo_[1] * h[1] + wo_[2] * h[2];
        return {dot, {2.0 * dot * h[0] - wo_[0], 2.0 * dot * h[1] - wo_[1], 2.0 * dot * h[2] - wo_[2]}};
    }

    double density(const Reflection& r) const { return r.above() ? reflected_(wo_, r.wi) * r.dot * scale_ : 0.0; }

    /// Of the azimuths from `begin` to `end` that which is nearest to the view's.
    double nearest(double begin, double end) const {
        const auto distance = [&](double phi) { return std::abs(std::remainder(phi - phi_, 2.0 * ACDF_PI)); };
        for (const double turn : {-2.0 * ACDF_PI, 0.0, 2.0 * ACDF_PI})
            if (phi_ + turn >= begin && phi_ + turn <= end) return phi_;
        return distance(begin) < distance(end) ? begin : end;
    }

private:
    const Reflected& reflected_;
    double wo_[3] = {};
    double phi_, scale_;
};

struct Azimuth {
    explicit Azimuth(double phi) : of{std::cos(phi), std::sin(phi)} {}
    double of[2];
};

/// The mean over a square of the square of the pdf.
double mean_square(const Reflections& reflections, const HalfGrid& grid, std::uint32_t r, std::uint32_t c) {
    constexpr int kPoints = 4; // each way
    double sum = 0.0;
    for (int i = 0; i < kPoints; ++i)
        for (int k = 0; k < kPoints; ++k) {
            const double row =
                grid.row_knots[r] + (grid.row_knots[r + 1] - grid.row_knots[r]) * (i + 0.5) / kPoints;
            const double column =
                grid.column_knots[c] + (grid.column_knots[c + 1] - grid.column_knots[c]) * (k + 0.5) / kPoints;
            const Azimuth azimuth(grid.phi(column));
            const double density = reflections.density(reflections.at(grid.latitude(row), azimuth.of));
            sum += density * density;
        }
    return sum / (kPoints * kPoints);
}

} // namespace

std::vector<HorizonSquare> horizon_squares(const Reflected& reflected, const HalfGrid& grid, const View& view,
                                           double albedo) {
    const Reflections reflections(reflected, view, albedo);
    std::vector<HorizonSquare> out;
    for (std::uint32_t c = 0; c < grid.columns(); ++c) {
        const double begin = grid.phi(grid.column_knots[c]), end = grid.phi(grid.column_knots[c + 1]);
        const Azimuth first(reflections.nearest(begin, end)), middle(0.5 * (begin + end));
        for (std::uint32_t r = 0; r < grid.rows(); ++r) {
            const auto edge = reflections.at(grid.edges[r], first.of);
            if (!edge.above()) break;
            if (reflections.at(grid.middles[r], middle.of).above()) continue;
            out.push_back({r * grid.columns() + c, static_cast<float>(reflections.density(edge)),
                           static_cast<float>(mean_square(reflections, grid, r, c))});
        }
    }
    return out;
}

HorizonSquares look_at_horizon(const Reflected& reflected, BrdfViews& views) {
    HorizonSquares out(views.targets.size());
    parallel_for(std::size_t{0}, out.size(), [&](std::size_t v) {
        ViewTarget& target = views.targets[v];
        if (!(target.albedo > 0.0)) return;
        out[v] = horizon_squares(reflected, views.grid, target.view, target.albedo);
        for (const HorizonSquare& s : out[v]) target.square[s.square] += s.mean_square;
    });
    return out;
}

WeightBound::WeightBound(const BrdfViews& views, const HorizonSquares& horizon,
                         const std::vector<std::uint32_t>& cell, const std::vector<TileCell>& cells,
                         std::size_t tiles, double max_weight)
    : least_(views.targets.size()) {
    const std::size_t turns = views.phi.size();
    std::vector<double> scale(cells.size(), 0.0); // from the largest pdf in a cell to what its tile needs
    for (std::uint32_t r = 0, i = 0; r < views.grid.rows(); ++r)
        for (std::uint32_t c = 0; c < views.grid.columns(); ++c, ++i)
            scale[cell[i]] += views.grid.row_measure[r] * views.grid.column_measure[c];
    for (std::size_t c = 0; c < cells.size(); ++c) // dark cells have no share
        scale[c] = cells[c].share > 0.0 ? scale[c] / (max_weight * cells[c].share) : 0.0;
    std::vector<std::vector<double>> own(least_.size());
    parallel_for(std::size_t{0}, own.size(), [&](std::size_t v) {
        own[v].assign(tiles, 0.0);
        if (!(views.targets[v].albedo > 0.0)) return;
        std::vector<double> peaks(cells.size(), 0.0);
        for (std::size_t i = 0; i < cell.size(); ++i)
            peaks[cell[i]] = std::max(peaks[cell[i]], double{views.targets[v].square[i]});
        for (double& peak : peaks) peak = std::sqrt(peak);
        for (const HorizonSquare& s : horizon[v])
            peaks[cell[s.square]] = std::max(peaks[cell[s.square]], double{s.peak});
        for (std::size_t c = 0; c < cells.size(); ++c) {
            double& least = own[v][cells[c].tile];
            least = std::max(least, peaks[c] * scale[c]);
        }
    });
    parallel_for(std::size_t{0}, own.size(), [&](std::size_t v) {
        const std::size_t ix = v / turns, k = v % turns;
        least_[v] = own[v];
        const auto add = [&](std::size_t x, std::size_t turn) {
            const std::vector<double>& other = own[x * turns + turn];
            for (std::size_t t = 0; t < tiles; ++t) least_[v][t] = std::max(least_[v][t], other[t]);
        };
        if (ix > 0) add(ix - 1, k);
        if (ix + 1 < views.x.size()) add(ix + 1, k);
        add(ix, (k + 1) % turns);
        add(ix, (k + turns - 1) % turns);
    });
}

bool WeightBound::raise(const RowProbabilities& rows, const std::vector<SharedMixture>& mixtures,
                        RowProbabilities& wanted) const {
    constexpr double kNear = 0.99;
    const std::size_t cells = rows.front().size(), block = 64; // cells a task
    std::atomic<bool> any{false};
    parallel_for(std::size_t{0}, (cells + block - 1) / block, [&](std::size_t task) {
        std::vector<double> factor(rows.size());
        for (std::size_t c = task * block; c < std::min(cells, (task + 1) * block); ++c) {
            std::fill(factor.begin(), factor.end(), 1.0);
            for (std::size_t m = 0; m < mixtures.size(); ++m) {
                const SharedMixture& mix = mixtures[m];
                double q = 0.0;
                for (int i = 0; i < mix.count; ++i) q += mix.share[i] * rows[mix.bin[i]][c];
                if (!(q > 0.0) || q >= kNear * least_[m][c]) continue;
                any = true;
                for (int i = 0; i < mix.count; ++i)
                    factor[mix.bin[i]] = std::max(factor[mix.bin[i]], least_[m][c] / q);
            }
            for (std::size_t b = 0; b < rows.size(); ++b) wanted[b][c] *= factor[b];
        }
    });
    return any;
}

} // namespace acdf::compress
