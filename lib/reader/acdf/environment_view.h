// The view of an environment file. C++17, freestanding over acdf/sample.h. For kernels define ACDF_FN and
// ACDF_METHOD, for example as `static inline __host__ __device__` and __host__ __device__. acdf/views.h has those
// of other kinds.
#pragma once

#include <acdf/method.h>
#include <acdf/sample.h>

namespace acdf {

using DirectionSample = AcdfDirectionSample;

/// What a renderer holds of an open file: a few words by value, valid while its File (and, for `from_memory`, the
/// bytes) lives. All functions of views are const, thread-safe, allocate and throw nothing.
template <class Data>
class ViewOf {
public:
    ViewOf() noexcept = default;
    ACDF_METHOD explicit ViewOf(const Data& data) noexcept : data_(data) {}

    /// The plain data, for the headers in C: in another language or on a GPU.
    ACDF_METHOD const Data& data() const noexcept { return data_; }

protected:
    Data data_ = {};
};

/// A probability density over the sphere.
class EnvironmentView : public ViewOf<AcdfEnvironment> {
public:
    using ViewOf<AcdfEnvironment>::ViewOf;
    ACDF_METHOD bool empty() const noexcept { return data_.columns == 0; }

    /// Samples a direction; u0 (azimuth) and u1 (elevation) in [0, 1]. pdf in sr^-1, finite, > 0.
    ACDF_INLINE_METHOD DirectionSample sample(double u0, double u1) const noexcept {
        return acdf_environment_sample(&data_, u0, u1);
    }
    /// The pdf in sr^-1 of a unit direction; 0 where none falls, for NaN and for non-unit directions.
    ACDF_INLINE_METHOD float pdf(const float direction[3]) const noexcept {
        return acdf_environment_pdf(&data_, direction);
    }
    /// The random numbers that sample `direction`; false where the pdf is 0.
    ACDF_METHOD bool invert(const float direction[3], double u[2]) const noexcept {
        return acdf_environment_invert(&data_, direction, u) != 0;
    }
    /// Integral of the sampled function over the sphere (luminance times sr): for light selection.
    ACDF_METHOD double total() const noexcept { return data_.total; }
    /// Whether the pdf is 0 where another sampler is to cover the light: used alone it is biased.
    ACDF_METHOD bool requires_mis() const noexcept { return data_.partner != nullptr; }
    /// Of the samples of both, in (0, 1]: how many to take from this view; 1 where it is to be used alone.
    ACDF_METHOD float recommended_light_share() const noexcept { return acdf_partner_share(data_.partner); }
};

} // namespace acdf
