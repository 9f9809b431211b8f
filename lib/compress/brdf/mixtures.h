// Which of the views of a BRDF are stored, how those between them are mixed, and what each stored view is to serve.
#pragma once

#include "compress/brdf/row_mixtures.h"
#include "compress/brdf/views.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace acdf::compress {

/// The stored views of one candidate: indices in BrdfViews.
struct StoredViews {
    std::vector<std::size_t> x;   ///< increasing
    std::vector<std::size_t> phi; ///< equally spaced, the first is phi = -pi

    std::uint32_t bins() const { return static_cast<std::uint32_t>(x.size() * phi.size()); }
};

/// The mixtures of stored views from which all views are sampled. `views` must outlive it.
class ViewMixtures {
public:
    ViewMixtures(const BrdfViews& views, StoredViews stored);

    const StoredViews& stored() const { return stored_; }
    /// One a bin. Where all of these are black they count alike, for the views between them.
    const std::vector<double>& albedos() const { return albedos_; }
    double total() const { return total_; } ///< of albedos
    /// One a view, without moments.
    const std::vector<SharedMixture>& mixtures() const { return mixtures_; }
    /// One a bin: the mean over the views that it is mixed into. Positive exactly in squares of which some
    /// half-vector is seen from a view that the bin may be mixed into.
    std::vector<SharedTarget> targets() const;

private:
    std::vector<double> stored_albedos() const;
    std::vector<SharedMixture> mix() const;
    std::pair<View, View> views_around(std::size_t bin) const;

    const BrdfViews& views_;
    StoredViews stored_;
    std::vector<double> albedos_;
    double total_;
    std::vector<SharedMixture> mixtures_;
};

} // namespace acdf::compress
