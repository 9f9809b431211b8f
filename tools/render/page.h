// One page of what `acdf render` found: pictures beside each other with zoom and difference, table, advice. It
// stands alone: no network, no scripts.
#pragma once

#include "tools/render/report.h"

#include <cstdint>
#include <string>
#include <vector>

namespace acdf::tools {

/// PNGs of one sampler.
struct SamplerPictures {
    std::vector<std::uint8_t> picture, variance, above, gain; ///< the baseline has no gain
};

struct PagePictures {
    int width = 0, height = 0; ///< of pictures, not of figures
    std::vector<std::uint8_t> reference;
    std::vector<SamplerPictures> samplers; ///< as in the first pass
};

/// UTF-8. The same for the same run; whatever names hold is shown as text.
std::string render_html(const LoadedScene& scene, const RenderRun& run, const PagePictures& pictures);

} // namespace acdf::tools
