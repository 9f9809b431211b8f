// The way of a probe's texels, mended and resampled, to whoever takes them as rows of a lat-long map.
#pragma once

#include "build/probe/bad_texels.h"
#include "build/probe/projection.h"

#include <vector>

namespace acdf::build {

/// Takes a lat-long probe in bands of rows, or a map of another layout.
class ProbeRows {
public:
    virtual ~ProbeRows() = default;
    /// What luminance is by the source's own primaries, before anything else; not called where it is Rec. 709's.
    virtual void set_luminance(const builder::ChannelWeights&) {}
    /// A map that is not lat-long, as it is: map.height x map.width x 3, finite and >= 0. False, and nothing is
    /// kept, where it is wanted as rows of a lat-long map.
    virtual bool take_map(const Map&, const std::vector<float>& /*rgb*/) { return false; }
    virtual void begin(int width, int height) = 0;
    /// `count` rows of RGB, finite and >= 0, from row `first` on. Rows that were there before are replaced.
    virtual void take(int first, int count, const float* rgb) = 0;
};

struct RepairOptions {
    BadPixels bad_pixels = BadPixels::zero;
    /// A probe without any light counts as one of the faintest constant light, so that it can be sampled.
    bool uniform_if_black = false;
    int threads = 0; ///< 0: all cores
};

/// Sees to it that rows are radiance before `rows` takes them. Bad texels are replaced also where they are to be
/// refused: that is the caller's part, once all are counted.
class RepairedRows {
public:
    RepairedRows(const RepairOptions& options, ProbeRows& rows) : options_(options), rows_(rows) {}

    void set_luminance(const builder::ChannelWeights& weights) { rows_.set_luminance(weights); }

    /// A lat-long probe, whose bands follow from the top to the bottom.
    void begin(int width, int height);
    /// `largest`: of all bands, needed with BadPixels::clamp where a band is not all there is. `rgb` is mended.
    void take(int first, int count, float* rgb, const Channels* largest = nullptr);

    /// Mends an image of any layout as a whole. `largest`: what is clamped to, where that is not what it holds.
    void repair_whole(int width, int height, float* rgb, const Channels* largest = nullptr);
    /// An image that was mended as a whole; it is used up. It has the shape that its layout needs.
    void take_whole(const Map& map, std::vector<float> rgb);

    /// Call once, behind all rows. Whether the probe was black and is so no more.
    bool light_if_black();

    int width() const { return width_; } ///< of the lat-long map, or the one that was taken as it is
    int height() const { return height_; }
    const BadTexels& bad() const { return bad_; }

private:
    bool pass_on(const Map& map, const std::vector<float>& rgb);
    void pass_on(int first, int count, const float* rgb);

    RepairOptions options_;
    ProbeRows& rows_;
    int width_ = 0, height_ = 0;
    bool black_ = true, has_rows_ = false, lit_ = false;
    BadTexels bad_;
};

} // namespace acdf::build
