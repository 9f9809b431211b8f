#include "compress/brdf/mixtures.h"

#include "compress/parallel.h"

#include <acdf/sample.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace acdf::compress {
namespace {

constexpr float kSeen = 1e-16f; // 1 / sr^2: squares that no view looked at sees, but one between them

/// How much of a view comes from the node at its lower side, on one axis: nodes a and a + 1.
struct Between {
    std::size_t lower = 0, upper = 0;
    double t = 0.0; ///< of the upper one
};

Between between(const std::vector<std::size_t>& nodes, const std::vector<double>& positions, std::size_t i) {
    const auto above = std::upper_bound(nodes.begin(), nodes.end(), i);
    Between out;
    out.lower = static_cast<std::size_t>(above - nodes.begin()) - 1;
    out.upper = std::min(out.lower + 1, nodes.size() - 1);
    if (out.upper > out.lower)
        out.t = (positions[i] - positions[nodes[out.lower]]) /
                (positions[nodes[out.upper]] - positions[nodes[out.lower]]);
    return out;
}

/// The same on the circle, whose nodes divide the views evenly.
Between around(const std::vector<std::size_t>& nodes, std::size_t views, std::size_t k) {
    const std::size_t step = views / nodes.size();
    return {k / step, (k / step + 1) % nodes.size(), double(k % step) / double(step)};
}

} // namespace

ViewMixtures::ViewMixtures(const BrdfViews& views, StoredViews stored)
    : views_(views), stored_(std::move(stored)), albedos_(stored_albedos()),
      total_(std::accumulate(albedos_.begin(), albedos_.end(), 0.0)), mixtures_(mix()) {}

std::vector<double> ViewMixtures::stored_albedos() const {
    std::vector<double> out;
    for (const std::size_t x : stored_.x)
        for (const std::size_t phi : stored_.phi) out.push_back(views_.at(x, phi).albedo);
    if (std::any_of(out.begin(), out.end(), [](double a) { return a > 0.0; })) return out;
    double sum = 0.0;
    for (const ViewTarget& target : views_.targets) sum += target.albedo;
    std::fill(out.begin(), out.end(), sum / double(views_.targets.size()));
    return out;
}

std::vector<SharedMixture> ViewMixtures::mix() const {
    std::vector<SharedMixture> out(views_.targets.size());
    for (std::size_t v = 0; v < out.size(); ++v) {
        const std::size_t ix = v / views_.phi.size(), k = v % views_.phi.size();
        const Between x = between(stored_.x, views_.x, ix), phi = around(stored_.phi, views_.phi.size(), k);
        out[v].weight = views_.targets[v].albedo > 0.0 ? views_.weight(ix) : 0.0;
        const auto add = [&](std::size_t i, std::size_t j, double share) {
            const std::size_t bin = i * stored_.phi.size() + j;
            if (!(share > 0.0)) return;
            out[v].bin[out[v].count] = static_cast<std::uint32_t>(bin);
            out[v].share[out[v].count++] = share * std::max(albedos_[bin], kLeastShare * total_);
        };
        add(x.lower, phi.lower, (1.0 - x.t) * (1.0 - phi.t));
        add(x.lower, phi.upper, (1.0 - x.t) * phi.t);
        add(x.upper, phi.lower, x.t * (1.0 - phi.t));
        add(x.upper, phi.upper, x.t * phi.t);
        const double sum = std::accumulate(out[v].share, out[v].share + out[v].count, 0.0);
        for (int i = 0; i < out[v].count; ++i) out[v].share[i] /= sum;
    }
    return out;
}

std::vector<SharedTarget> ViewMixtures::targets() const {
    std::vector<SharedTarget> out(stored_.bins());
    std::vector<std::vector<std::pair<std::size_t, double>>> served(out.size());
    double all = 0.0;
    for (std::size_t v = 0; v < mixtures_.size(); ++v)
        for (int i = 0; i < mixtures_[v].count; ++i)
            if (const double share = mixtures_[v].share[i]; mixtures_[v].weight > 0.0 && share > 0.0) {
                served[mixtures_[v].bin[i]].push_back({v, share * share});
                all += mixtures_[v].weight * share;
            }
    parallel_for(std::size_t{0}, out.size(), [&](std::size_t b) {
        std::vector<float>& square = out[b].square;
        square.assign(views_.grid.size(), 0.0f);
        double sum = 0.0, weight = 0.0;
        for (const auto& [v, w] : served[b]) sum += w, weight += mixtures_[v].weight * std::sqrt(w);
        for (const auto& [v, w] : served[b]) {
            const float factor = static_cast<float>(w / sum);
            const float* from = views_.targets[v].square.data();
            for (std::size_t i = 0; i < square.size(); ++i) square[i] += factor * from[i];
        }
        out[b].weight = weight / all;
        const auto [low, high] = views_around(b);
        const std::vector<std::uint8_t> visible = visible_squares(views_.grid, low, high);
        for (std::size_t i = 0; i < square.size(); ++i) square[i] = visible[i] ? std::max(square[i], kSeen) : 0.0f;
    });
    return out;
}

/// Bounds of all views that a bin is mixed into.
std::pair<View, View> ViewMixtures::views_around(std::size_t bin) const {
    const std::size_t i = bin / stored_.phi.size(), k = bin % stored_.phi.size();
    View low, high;
    low.x = i > 0 ? views_.x[stored_.x[i - 1]] : 0.0;
    high.x = i + 1 < stored_.x.size() ? views_.x[stored_.x[i + 1]] : 1.0;
    if (stored_.phi.size() > 1) {
        const double step = 2.0 * ACDF_PI / double(stored_.phi.size()), phi = views_.phi[stored_.phi[k]];
        low.phi = phi - step;
        high.phi = phi + step;
    }
    return {low, high};
}

} // namespace acdf::compress
