#include "compress/brdf/views.h"
#include "compress/parallel.h"

#include <acdf/sample.h>

#include <algorithm>
#include <cmath>
#include <queue>

namespace acdf::compress {
namespace {

constexpr double kGrazing = 1e-3;   // cos(theta_o) of the last view
constexpr double kBaseWeight = 0.1; // of the mean over views: uniform in x, so that no view is without weight
constexpr double kWorst = 10.0;     // relative variance above which a mixture is simply bad

std::vector<double> view_positions(std::size_t count) {
    std::vector<double> x;
    for (std::size_t i = 0; i < count; ++i) x.push_back(std::sqrt(1.0 - kGrazing) * double(i) / double(count - 1));
    for (const double cosine : {0.003, 0.007}) x.push_back(std::sqrt(1.0 - cosine)); // the last steps are coarse
    std::sort(x.begin(), x.end());
    return x;
}

std::vector<double> position_weights(const std::vector<double>& x) {
    std::vector<double> weight;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double low = i > 0 ? 0.5 * (x[i - 1] + x[i]) : 0.0,
                     high = i + 1 < x.size() ? 0.5 * (x[i] + x[i + 1]) : 1.0;
        weight.push_back((high * high - low * low) * (1.0 - kBaseWeight) + (high - low) * kBaseWeight);
    }
    return weight;
}

/// What a mixture of two views would cost for those between them.
class Mixtures {
public:
    explicit Mixtures(const BrdfViews& views) : views_(views), values_(views.targets.size()) {
        for (const double row : views.measures.row_measure)
            for (const double column : views.measures.column_measure) measure_.push_back(row * column);
        parallel_for(std::size_t{0}, values_.size(), [&](std::size_t v) { values_[v] = probabilities(v); });
    }

    /// Weighted sum of the relative variances of the views between two nodes, each sampled from their mixture.
    double error(std::size_t a, std::size_t b) const {
        double sum = 0.0;
        for (std::size_t i = a + 1; i < b; ++i) {
            const double t = (views_.x[i] - views_.x[a]) / (views_.x[b] - views_.x[a]);
            for (std::size_t k = 0; k < views_.phi.size(); ++k) sum += views_.weight(i) * variance(i, a, b, t, k);
        }
        return sum;
    }

private:
    std::vector<double> probabilities(std::size_t v) const {
        std::vector<double> out(measure_.size());
        double sum = 0.0;
        for (std::size_t i = 0; i < out.size(); ++i)
            sum += out[i] = std::sqrt(double{views_.targets[v].square[i]}) * measure_[i];
        for (double& p : out) p /= sum;
        return out;
    }
    double variance(std::size_t i, std::size_t a, std::size_t b, double t, std::size_t k) const {
        const std::size_t columns = views_.phi.size();
        const auto &f = values_[i * columns + k], &low = values_[a * columns + k], &high = values_[b * columns + k];
        double wa = (1.0 - t) * views_.at(a, k).albedo, wb = t * views_.at(b, k).albedo;
        if (!(wa + wb > 0.0)) return views_.at(i, k).albedo > 0.0 ? kWorst : 0.0;
        wa /= wa + wb;
        wb = 1.0 - wa;
        double sum = 0.0;
        for (std::size_t c = 0; c < f.size(); ++c) {
            const double q = wa * low[c] + wb * high[c];
            if (f[c] > 0.0) sum += f[c] * f[c] / std::max(q, 1e-12);
        }
        return std::clamp(sum - 1.0, 0.0, kWorst);
    }

    const BrdfViews& views_;
    std::vector<double> measure_;
    std::vector<std::vector<double>> values_; ///< probabilities of the squares
};

struct Gap {
    double error;
    std::size_t a, b;
    bool operator<(const Gap& other) const { return error != other.error ? error < other.error : a > other.a; }
};

} // namespace

BrdfViews look_at(const Reflected& reflected, const HalfGrid& grid, const std::vector<double>& x,
                  const std::vector<double>& phi) {
    BrdfViews out{grid, {grid.row_measure, grid.column_measure}, x, phi, position_weights(x), {}};
    out.targets.resize(x.size() * phi.size());
    parallel_for(std::size_t{0}, out.targets.size(), [&](std::size_t i) {
        out.targets[i] = view_target(reflected, out.grid, {x[i / phi.size()], phi[i % phi.size()]});
    });
    return out;
}

std::vector<double> azimuths(std::size_t count) {
    std::vector<double> out;
    for (std::size_t k = 0; k < count; ++k)
        out.push_back(count == 1 ? 0.0 : ACDF_PI * (2.0 * double(k) / double(count) - 1.0));
    return out;
}

std::vector<double> choose_nodes(const Reflected& reflected, const BrdfSymmetry& symmetry, std::size_t count) {
    const HalfGrid grid(symmetry.mirrored ? 48 : 72, 96, symmetry.mirrored);
    const BrdfViews views = look_at(reflected, grid, view_positions(symmetry.isotropic ? 161 : 49),
                                    azimuths(symmetry.isotropic ? 1 : 8));
    const Mixtures mixtures(views);
    std::vector<std::size_t> nodes{0, views.x.size() - 1};
    std::priority_queue<Gap> gaps;
    gaps.push({mixtures.error(0, nodes[1]), 0, nodes[1]});
    while (nodes.size() < count && !gaps.empty()) {
        const Gap gap = gaps.top();
        gaps.pop();
        const std::size_t step = std::max<std::size_t>(1, (gap.b - gap.a) / 8);
        std::vector<std::size_t> tried;
        for (std::size_t c = gap.a + step; c < gap.b; c += step) tried.push_back(c);
        if (tried.empty()) continue;
        std::vector<std::pair<double, double>> error(tried.size());
        parallel_for(std::size_t{0}, tried.size(), [&](std::size_t i) {
            error[i] = {mixtures.error(gap.a, tried[i]), mixtures.error(tried[i], gap.b)};
        });
        std::size_t best = 0;
        for (std::size_t i = 1; i < tried.size(); ++i)
            if (error[i].first + error[i].second < error[best].first + error[best].second) best = i;
        nodes.push_back(tried[best]);
        gaps.push({error[best].first, gap.a, tried[best]});
        gaps.push({error[best].second, tried[best], gap.b});
    }
    std::vector<double> out;
    for (const std::size_t i : nodes) out.push_back(views.x[i]);
    return out;
}

std::vector<double> subdivided(const std::vector<double>& nodes, std::size_t parts) {
    std::vector<double> out;
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i)
        for (std::size_t k = 0; k < parts; ++k)
            out.push_back(nodes[i] + (nodes[i + 1] - nodes[i]) * double(k) / double(parts));
    out.push_back(nodes.back());
    return out;
}

} // namespace acdf::compress
