#include "compress/visibility/part_runs.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace acdf::compress {

PartRuns::PartRuns(std::vector<Spread> edges) : edges_(std::move(edges)), first_(edges_.size()) {
    std::iota(first_.begin(), first_.end(), 0u);
}

void PartRuns::know(const std::vector<VisibilitySums>& cells, std::size_t part, std::uint32_t first,
                    const std::vector<double>& shares) {
    if (cells_ == 0) {
        cells_ = cells.size();
        all_.assign(edges_.size() * cells_, 0.0f);
        seen_ = all_;
        roots_.assign(edges_.size(), 0.0);
    }
    for (std::size_t i = 0; i < shares.size(); ++i)
        for (std::size_t c = 0; c < cells_; ++c) {
            const std::size_t at = (first + i) * cells_ + c;
            all_[at] = static_cast<float>(shares[i]) * cells[c].all[part];
            seen_[at] = static_cast<float>(shares[i]) * cells[c].seen[part];
            roots_[first + i] += std::sqrt(double{all_[at]} * double{seen_[at]});
        }
}

std::vector<std::uint32_t> PartRuns::join(std::size_t count) {
    std::vector<double> rises;
    for (std::size_t i = 0; i + 1 < first_.size(); ++i) rises.push_back(rise(i));
    while (first_.size() > count) {
        const auto least = static_cast<std::size_t>(std::min_element(rises.begin(), rises.end()) - rises.begin());
        const auto next = static_cast<std::ptrdiff_t>(least) + 1;
        merge(first_[least], first_[least + 1]);
        first_.erase(first_.begin() + next);
        rises.erase(rises.begin() + next - 1);
        if (least > 0) rises[least - 1] = rise(least - 1);
        if (least < rises.size()) rises[least] = rise(least);
    }
    return first_;
}

/// What it costs to join a run and the next: edges between them, and what cells have seen to differ.
double PartRuns::rise(std::size_t i) const {
    const std::uint32_t a = first_[i], b = first_[i + 1];
    Spread both = edges_[a];
    both.add(edges_[b]);
    const double edges = both.width() - edges_[a].width() - edges_[b].width();
    return cells_ == 0 ? edges : edges + root_of_both(a, b) - roots_[a] - roots_[b];
}

double PartRuns::root_of_both(std::size_t a, std::size_t b) const {
    const float *all = &all_[a * cells_], *more = &all_[b * cells_];
    const float *seen = &seen_[a * cells_], *more_seen = &seen_[b * cells_];
    float out = 0.0f;
    for (std::size_t c = 0; c < cells_; ++c) out += std::sqrt((all[c] + more[c]) * (seen[c] + more_seen[c]));
    return double{out};
}

void PartRuns::merge(std::size_t a, std::size_t b) {
    edges_[a].add(edges_[b]);
    if (cells_ == 0) return;
    roots_[a] = root_of_both(a, b);
    for (std::size_t c = 0; c < cells_; ++c) {
        all_[a * cells_ + c] += all_[b * cells_ + c];
        seen_[a * cells_ + c] += seen_[b * cells_ + c];
    }
}

} // namespace acdf::compress
