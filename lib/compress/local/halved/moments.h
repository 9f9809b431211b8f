// What light of blocks shines on surfaces of any normal: second moments of its direction.
#pragma once

#include "compress/local/halved/blocks.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace acdf::compress {

/// Integrals of light h over a box: of h d d^T, so that those of h cos^2 are known for all normals, and of h.
struct BlockMoment {
    float quad[6] = {}; ///< xx, yy, zz, 2 xy, 2 xz, 2 yz
    float sum = 0.0f;
    float unused = 0.0f;
};

inline BlockMoment operator+(const BlockMoment& a, const BlockMoment& b) {
    BlockMoment out;
    for (std::size_t k = 0; k < 6; ++k) out.quad[k] = a.quad[k] + b.quad[k];
    out.sum = a.sum + b.sum;
    return out;
}

/// Of light of so much from about one direction.
BlockMoment moment_of(const Direction& direction, double light);

/// Directions in arrays, for loops that are vectors.
struct Normals {
    std::vector<float> x, y, z;

    std::size_t size() const { return x.size(); }
    void add(const Direction& n) {
        x.push_back(static_cast<float>(n[0]));
        y.push_back(static_cast<float>(n[1]));
        z.push_back(static_cast<float>(n[2]));
    }
};

/// Of all boxes of blocks.
class BlockMoments {
public:
    /// `blocks` must outlive it.
    explicit BlockMoments(const Blocks& blocks) : blocks_(blocks), of_(blocks.size()) {}

    /// A row of texels of h, from this number on: where it stands, or in `scratch`, which has room for it.
    using Row = std::function<const float*(std::uint32_t row, float* scratch)>;
    /// Adds all texels, and sums up boxes of blocks.
    void integrate(const Row& row);

    BlockMoment& operator[](HalvedBox box) { return of_[blocks_.index(box)]; }
    const BlockMoment& operator[](HalvedBox box) const { return of_[blocks_.index(box)]; }
    /// Sums up boxes of blocks.
    void add_up();

    /// The integral of h cos^2 over the part of a box above the horizon of each of the normals: positive wherever
    /// any light is.
    void seen(HalvedBox box, const Normals& normals, float* out) const;

private:
    float seen(HalvedBox box, const float n[3]) const;

    const Blocks& blocks_;
    std::vector<BlockMoment> of_;
};

} // namespace acdf::compress
