// The cascade of fixed depth that minimises the variance, by joining cells
// bottom-up: docs/method.md.
//
// A cell of measure m that holds the integral E of f^2 costs C = sqrt(m E), and
// one sample has the relative variance (sum of C)^2 / (integral of f)^2 - 1
// when each cell's probability is its share of the sum. Joining neighbours
// never lowers the sum (Cauchy-Schwarz), so rows are joined into bands, then
// within all bands together columns into cells, always the pair that raises the
// sum least.
#include "compress/fit/fit.h"
#include "compress/fit/join.h"
#include "compress/parallel.h"
#include "compress/sum.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace acdf::compress {
namespace {

/// Rows or bands of rows; for each, the integral of f^2 over its rows at every
/// column.
struct Bands {
    std::vector<std::uint32_t> begin; ///< first row of each band
    std::vector<double> measure;
    std::vector<double> energy; ///< bands x columns
};

Bands bands_of(const Target& target, const std::vector<std::uint32_t>& begin) {
    Bands bands{begin, std::vector<double>(begin.size(), 0.0),
                std::vector<double>(begin.size() * target.columns, 0.0)};
    parallel_for(std::size_t{0}, begin.size(), [&](std::size_t b) {
        const std::uint32_t end = b + 1 < begin.size() ? begin[b + 1] : target.rows;
        double* energy = bands.energy.data() + b * target.columns;
        for (std::uint32_t r = begin[b]; r < end; ++r) {
            bands.measure[b] += target.row_measure[r];
            const float* row = target.row(r);
            for (std::uint32_t c = 0; c < target.columns; ++c)
                energy[c] += double{row[c]} * row[c] * target.row_measure[r];
        }
    });
    return bands;
}

/// The order in which borders between rows vanish, the cheapest join first: row
/// r joins the band above it.
std::vector<std::uint32_t> row_joins(const Target& target) {
    std::vector<std::uint32_t> rows(target.rows);
    for (std::uint32_t r = 0; r < target.rows; ++r) rows[r] = r;
    Bands bands = bands_of(target, rows);
    const std::uint32_t columns = target.columns;
    const auto cost = [&](std::size_t a,
                          std::size_t b) { // of a and b joined; of a alone where a == b
        const double* ea = bands.energy.data() + a * columns;
        const double* eb = bands.energy.data() + b * columns;
        double sum = 0.0;
        if (a == b) {
            for (std::uint32_t c = 0; c < columns; ++c) sum += target.column_measure[c] * std::sqrt(ea[c]);
            return sum * std::sqrt(bands.measure[a]);
        }
        for (std::uint32_t c = 0; c < columns; ++c) sum += target.column_measure[c] * std::sqrt(ea[c] + eb[c]);
        return sum * std::sqrt(bands.measure[a] + bands.measure[b]);
    };
    std::vector<double> alone(target.rows);
    parallel_for(std::uint32_t{0}, target.rows, [&](std::uint32_t r) { alone[r] = cost(r, r); });

    std::vector<std::uint32_t> order;
    join_neighbours(
        target.rows, target.rows - 1,
        [&](std::size_t a, std::size_t b) { return cost(a, b) - alone[a] - alone[b]; },
        [&](std::size_t a, std::size_t b, double) {
            double* ea = bands.energy.data() + a * columns;
            const double* eb = bands.energy.data() + b * columns;
            for (std::uint32_t c = 0; c < columns; ++c) ea[c] += eb[c];
            bands.measure[a] += bands.measure[b];
            alone[a] = cost(a, a);
            order.push_back(static_cast<std::uint32_t>(b));
        });
    return order;
}

/// One band, its columns joined step by step until one cell is left.
struct JoinHistory {
    double finest = 0.0;               ///< sum of C at full resolution
    std::vector<std::uint32_t> border; ///< the column before which a border vanishes, in order
    std::vector<double> raise;         ///< what each join adds to the sum of C
    std::vector<double> level;         ///< the largest raise so far: never falls
};

JoinHistory join_columns(const Target& target, const Bands& bands, std::size_t band) {
    const std::size_t columns = target.columns;
    std::vector<double> measure(columns), energy(columns), alone(columns);
    JoinHistory history;
    for (std::size_t c = 0; c < columns; ++c) {
        measure[c] = bands.measure[band] * target.column_measure[c];
        energy[c] = bands.energy[band * columns + c] * target.column_measure[c];
        alone[c] = std::sqrt(measure[c] * energy[c]);
        history.finest += alone[c];
    }
    const auto raise = [&](std::size_t a, std::size_t b) {
        return std::max(0.0, std::sqrt((measure[a] + measure[b]) * (energy[a] + energy[b])) - alone[a] - alone[b]);
    };
    join_neighbours(columns, columns - 1, raise, [&](std::size_t a, std::size_t b, double cost) {
        measure[a] += measure[b];
        energy[a] += energy[b];
        alone[a] = std::sqrt(measure[a] * energy[a]);
        history.border.push_back(static_cast<std::uint32_t>(b));
        history.raise.push_back(cost);
        history.level.push_back(history.level.empty() ? cost : std::max(cost, history.level.back()));
    });
    return history;
}

/// How far each band is joined, and what that costs.
struct Cells {
    Bands bands;
    std::vector<JoinHistory> history;
    std::vector<std::size_t> joins; ///< one a band: how many joins of its history are made
    double total = 0.0;             ///< sum of C
};

/// Joins within all bands together, the cheapest first, until `cells` are left:
/// what one heap over all bands would do, since each band's joins come in the
/// same order whatever happens in the others.
void join_until(Cells& cells, std::size_t columns, std::size_t count) {
    std::vector<double> levels;
    levels.reserve(cells.history.size() * (columns - 1));
    for (const JoinHistory& history : cells.history)
        levels.insert(levels.end(), history.level.begin(), history.level.end());
    const std::size_t all = cells.history.size() * columns;
    const std::size_t joins = std::min(levels.size(), all > count ? all - count : 0);
    double threshold = std::numeric_limits<double>::infinity();
    if (joins < levels.size()) {
        std::nth_element(levels.begin(), levels.begin() + static_cast<std::ptrdiff_t>(joins), levels.end());
        threshold = levels[joins];
    }
    std::size_t made = 0;
    cells.joins.clear();
    for (const JoinHistory& history : cells.history) {
        const auto below = std::lower_bound(history.level.begin(), history.level.end(), threshold);
        cells.joins.push_back(static_cast<std::size_t>(below - history.level.begin()));
        made += cells.joins.back();
    }
    // Joins that raise the sum by exactly the threshold: the first bands first.
    for (std::size_t b = 0; b < cells.history.size() && made < joins; ++b)
        for (; made < joins && cells.joins[b] < columns - 1 && cells.history[b].level[cells.joins[b]] <= threshold;
             ++made)
            ++cells.joins[b];
    cells.total = 0.0;
    for (std::size_t b = 0; b < cells.history.size(); ++b) {
        cells.total += cells.history[b].finest;
        for (std::size_t k = 0; k < cells.joins[b]; ++k) cells.total += cells.history[b].raise[k];
    }
}

Cells join_bands(const Target& target, Bands bands, std::size_t count) {
    Cells cells;
    cells.history.resize(bands.begin.size());
    parallel_for(std::size_t{0}, bands.begin.size(),
                 [&](std::size_t b) { cells.history[b] = join_columns(target, bands, b); });
    join_until(cells, target.columns, count);
    cells.bands = std::move(bands);
    return cells;
}

/// The bands that are left once `count` of them remain.
std::vector<std::uint32_t> band_starts(const std::vector<std::uint32_t>& joins, std::size_t count) {
    std::vector<std::uint32_t> begin{0};
    begin.insert(begin.end(), joins.end() - static_cast<std::ptrdiff_t>(count - 1), joins.end());
    std::sort(begin.begin(), begin.end());
    return begin;
}

/// Band counts worth trying, in steps of sqrt(2), as long as a band keeps two
/// cells on average.
std::vector<std::size_t> band_counts(std::size_t rows, std::size_t cells) {
    std::vector<std::size_t> counts;
    for (double count = 4.0; count <= double(rows) && count <= double(cells) / 2.0; count *= std::sqrt(2.0))
        counts.push_back(static_cast<std::size_t>(count));
    if (counts.empty()) counts.push_back(std::min(rows, cells));
    return counts;
}

/// First columns of the cells of a band.
std::vector<std::uint32_t> cell_starts(const Cells& cells, std::size_t band) {
    std::vector<std::uint32_t> begin{0};
    const JoinHistory& history = cells.history[band];
    begin.insert(begin.end(), history.border.begin() + static_cast<std::ptrdiff_t>(cells.joins[band]),
                 history.border.end());
    std::sort(begin.begin(), begin.end());
    return begin;
}

/// C of each cell of a band.
std::vector<double> cell_costs(const Target& target, const Cells& cells, std::size_t band,
                               const std::vector<std::uint32_t>& begin) {
    std::vector<double> costs;
    for (std::size_t i = 0; i < begin.size(); ++i) {
        const std::uint32_t end = i + 1 < begin.size() ? begin[i + 1] : target.columns;
        Sum measure, energy;
        for (std::uint32_t c = begin[i]; c < end; ++c) {
            measure.add(target.column_measure[c]);
            energy.add(cells.bands.energy[band * target.columns + c] * target.column_measure[c]);
        }
        costs.push_back(std::sqrt(cells.bands.measure[band] * measure.value() * energy.value()));
    }
    return costs;
}

/// Scales to a sum of 1.
void normalise(std::vector<double>& values) {
    Sum sum;
    for (double value : values) sum.add(value);
    for (double& value : values) value /= sum.value();
}

Cascade to_cascade(const Target& target, const Cells& cells) {
    Cascade cascade;
    cascade.roots = {0};
    cascade.curves.emplace_back();
    Curve root;
    root.axis = target.row_axis;
    root.knots.assign(cells.bands.begin.begin() + 1, cells.bands.begin.end());
    for (std::size_t b = 0; b < cells.history.size(); ++b) {
        const std::vector<std::uint32_t> begin = cell_starts(cells, b);
        Curve band;
        band.axis = target.column_axis;
        band.knots.assign(begin.begin() + 1, begin.end());
        band.probability = cell_costs(target, cells, b, begin);
        Sum sum;
        for (double cost : band.probability) sum.add(cost);
        root.probability.push_back(sum.value());
        const bool ends = !(sum.value() > 0.0) || begin.size() == 1;
        root.children.push_back(ends ? -1 : static_cast<std::int32_t>(cascade.curves.size()));
        if (ends) continue;
        normalise(band.probability);
        cascade.curves.push_back(std::move(band));
    }
    normalise(root.probability);
    cascade.curves.front() = std::move(root);
    return cascade;
}

} // namespace

Cascade fit_variance_cascade(const Target& target, const FitOptions& options) {
    const std::vector<std::uint32_t> joins = row_joins(target);
    if (options.progress) options.progress(0.3);
    const std::vector<std::size_t> counts = band_counts(target.rows, options.goal.cells);
    Cells best;
    std::size_t worse = 0; // the cost falls, then rises with the number of bands:
                           // two rises in a row are enough
    for (std::size_t i = 0; i < counts.size() && worse < 2; ++i) {
        Cells cells = join_bands(target, bands_of(target, band_starts(joins, counts[i])), options.goal.cells);
        worse = i == 0 || cells.total < best.total ? 0 : worse + 1;
        if (worse == 0) best = std::move(cells);
        if (options.progress) options.progress(0.3 + 0.7 * double(i + 1) / double(counts.size()));
    }
    return to_cascade(target, best);
}

} // namespace acdf::compress
