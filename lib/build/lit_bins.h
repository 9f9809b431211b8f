// Bins of a local environment file, and what is known of them whatever its size.
#pragma once

#include "build/local_size.h"
#include "compress/local/light.h"
#include "compress/local/normals.h"
#include "compress/target.h"

#include <optional>
#include <utility>

namespace acdf::build {

/// Bins, and their light once it is asked for: files of many sizes have the same.
class LitBins {
public:
    LitBins(const compress::Target& target, compress::NormalBins bins) : target_(target), bins_(std::move(bins)) {}
    LitBins(const LitBins&) = delete;
    LitBins& operator=(const LitBins&) = delete;

    const compress::NormalBins& bins() const { return bins_; }
    const compress::BinLight& light() {
        if (!light_) light_.emplace(target_, bins_);
        return *light_;
    }

private:
    const compress::Target& target_;
    const compress::NormalBins bins_;
    std::optional<compress::BinLight> light_;
};

/// The bins of the size that was tried last.
using LastBins = std::optional<LitBins>;

inline LitBins& bins_for(const LocalOptions& options, double bytes, const compress::Target& target,
                         LastBins& last) {
    compress::NormalBins bins = bins_for(options, bytes);
    if (!last || last->bins().normals != bins.normals) last.emplace(target, std::move(bins));
    return *last;
}

} // namespace acdf::build
