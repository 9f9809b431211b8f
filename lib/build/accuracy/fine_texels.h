// Maps of few texels in more of them: what is summed with the cosine in the middle of each is then near what a
// surface gathers.
#pragma once

#include "compress/target.h"

#include <acdf/curves/tree.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace acdf::build {

enum class Texels { divided, own };

/// A target, each texel of which is divided evenly where a map has fewer than 256 columns or 128 rows.
class FineTexels {
public:
    explicit FineTexels(const compress::Target& coarse, Texels texels_of = Texels::divided) : coarse_(coarse) {
        if (texels_of == Texels::own) return;
        const std::uint64_t texels = std::uint64_t{coarse.columns} * coarse.rows;
        parts_[0] = parts_of(coarse.columns, 256, texels);
        parts_[1] = parts_of(coarse.rows, 128, texels * parts_[0]);
        if (parts_[0] * parts_[1] == 1) return;
        fine_ =
            compress::empty_target(coarse.columns * parts_[0], coarse.rows * parts_[1], coarse.parameterization);
        fine_.total = coarse.total;
        fine_.mean_square = coarse.mean_square;
        fine_.values = divided(coarse.values);
        fine_.peaks = divided(coarse.peaks);
        for (const std::vector<float>& channel : coarse.means) fine_.means.push_back(divided(channel));
    }
    FineTexels(const FineTexels&) = delete;
    FineTexels& operator=(const FineTexels&) = delete;

    const compress::Target& target() const { return fine_.values.empty() ? coarse_ : fine_; }
    /// A box of the map's texels in those of target().
    std::array<AcdfTiltedRange, 2> box(const AcdfTiltedRange* range) const {
        std::array<AcdfTiltedRange, 2> out{range[0], range[1]};
        for (std::size_t k = 0; k < 2; ++k) {
            out[k].low *= parts_[k];
            out[k].high *= parts_[k];
        }
        return out;
    }

private:
    /// No more than makes half a million texels of `texels`.
    static std::uint32_t parts_of(std::uint32_t steps, std::uint32_t enough, std::uint64_t texels) {
        const std::uint64_t most = std::max<std::uint64_t>(1, (std::uint64_t{1} << 19) / texels);
        return static_cast<std::uint32_t>(std::min<std::uint64_t>((enough + steps - 1) / steps, most));
    }
    std::vector<float> divided(const std::vector<float>& coarse) const {
        std::vector<float> out;
        if (coarse.empty()) return out;
        for (std::uint32_t r = 0; r < fine_.rows; ++r)
            for (std::uint32_t c = 0; c < fine_.columns; ++c)
                out.push_back(coarse[std::size_t{r / parts_[1]} * coarse_.columns + c / parts_[0]]);
        return out;
    }

    const compress::Target& coarse_;
    compress::Target fine_;
    std::uint32_t parts_[2] = {1, 1};
};

} // namespace acdf::build
