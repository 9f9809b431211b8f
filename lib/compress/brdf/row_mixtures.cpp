#include "compress/brdf/row_mixtures.h"

#include "compress/parallel.h"

#include <algorithm>
#include <cmath>

namespace acdf::compress {
namespace {

// A share of all cells that may be needed together. The known part of a cell at the border of what a row sees may
// be less than what is there: a floor bounds the weights, at the price of this share of the samples at most.
constexpr double kLeastShares = 2e-4;

} // namespace

double second_moment(const RowProbabilities& rows, const std::vector<SharedMixture>& mixtures) {
    std::vector<double> moment(mixtures.size(), 0.0);
    parallel_for(std::size_t{0}, mixtures.size(), [&](std::size_t m) {
        const SharedMixture& mix = mixtures[m];
        for (std::size_t c = 0; c < mix.moment.size(); ++c) {
            double q = 0.0;
            for (int i = 0; i < mix.count; ++i) q += mix.share[i] * rows[mix.bin[i]][c];
            if (mix.moment[c] > 0.0) moment[m] += mix.moment[c] / q;
        }
    });
    double sum = 0.0, weight = 0.0;
    for (std::size_t m = 0; m < mixtures.size(); ++m) {
        sum += mixtures[m].weight * moment[m];
        weight += mixtures[m].weight;
    }
    return sum / weight;
}

void optimise_rows(RowProbabilities& rows, const std::vector<SharedMixture>& mixtures, int steps) {
    const std::size_t cells = rows.front().size();
    constexpr std::size_t block = 64; // cells a task
    const double least = kLeastShares / double(cells);
    for (int step = 0; step < steps; ++step) {
        // At the minimum the derivatives by the probabilities of a row are equal wherever these are positive.
        parallel_for(std::size_t{0}, (cells + block - 1) / block, [&](std::size_t task) {
            std::vector<double> slope(rows.size());
            for (std::size_t c = task * block; c < std::min(cells, (task + 1) * block); ++c) {
                std::fill(slope.begin(), slope.end(), 0.0);
                for (const SharedMixture& mix : mixtures) {
                    double q = 0.0;
                    for (int i = 0; i < mix.count; ++i) q += mix.share[i] * rows[mix.bin[i]][c];
                    if (!(q > 0.0)) continue;
                    const double g = mix.weight * mix.moment[c] / (q * q);
                    for (int i = 0; i < mix.count; ++i) slope[mix.bin[i]] += mix.share[i] * g;
                }
                for (std::size_t b = 0; b < rows.size(); ++b)
                    if (rows[b][c] > 0.0) rows[b][c] = std::max(rows[b][c] * std::sqrt(slope[b]), least * 1e-9);
            }
        });
        parallel_for(std::size_t{0}, rows.size(), [&](std::size_t b) {
            double sum = 0.0;
            for (const double p : rows[b]) sum += p;
            for (double& p : rows[b])
                if (p > 0.0) p = std::max(p / sum, least);
        });
    }
}

} // namespace acdf::compress
