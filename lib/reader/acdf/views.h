// What a renderer holds of an open file: a pdf over directions or points, a few words by value. C++17,
// freestanding over acdf/sample.h, local.h, brdf.h and table.h. For kernels define ACDF_FN and
// ACDF_METHOD, for example as `static inline __host__ __device__` and __host__ __device__.
//
// Views come from acdf::File (acdf/reader.h). One that is made by default is empty, to be a member until it is
// assigned to: nothing but empty() may be asked of it.
#pragma once

#include <acdf/brdf.h>
#include <acdf/environment_view.h>
#include <acdf/local.h>
#include <acdf/table.h>

#include <cstdint>

namespace acdf {

/// For each normal a probability density over the sphere that follows the light above its horizon, times the
/// cosine. Normals are of any length > 0, in the frame of directions.
class LocalEnvironmentView : public ViewOf<AcdfLocal> {
public:
    using ViewOf<AcdfLocal>::ViewOf;
    ACDF_METHOD bool empty() const noexcept { return data_.environment.columns == 0; }

    /// Samples a direction for a normal; u0 (azimuth) and u1 (elevation) in [0, 1]. pdf in sr^-1, finite and > 0.
    /// It is 0 where the normal is zero or NaN or no light can reach it. A direction may lie below the horizon: it
    /// counts as 0.
    ACDF_METHOD DirectionSample sample(const float normal[3], double u0, double u1) const noexcept {
        return acdf_local_sample(&data_, normal, u0, u1);
    }
    /// The pdf in sr^-1 of a unit direction for a normal; exactly that of `sample` for what it returned, but for
    /// rounding where cells are tilted (`--fit pdf`; SPEC.md §14.1).
    ACDF_METHOD float pdf(const float normal[3], const float direction[3]) const noexcept {
        return acdf_local_pdf(&data_, normal, direction);
    }
    /// A shading point: its normal is looked up once for all calls of sample and pdf that take the point. 120 bytes
    /// at most by value; valid while the File lives.
    ACDF_METHOD AcdfLocalPoint at(const float normal[3]) const noexcept {
        AcdfLocalPoint point;
        acdf_local_at(&data_, normal, &point);
        return point;
    }
    ACDF_METHOD DirectionSample sample(const AcdfLocalPoint& point, double u0, double u1) const noexcept {
        return acdf_local_sample_at(&data_, &point, u0, u1);
    }
    ACDF_METHOD float pdf(const AcdfLocalPoint& point, const float direction[3]) const noexcept {
        return acdf_local_pdf_at(&data_, &point, direction);
    }
    /// Integral of the light above the horizon times the cosine (luminance times sr), about: for light selection.
    /// Where bins have rows of codes, it is the root mean square of an estimate from their samples, interpolated.
    /// That is more by a few per cent or by as much as the samples are noisy. Else it is the integral of the bin.
    /// Where a normal's bins are not stored, that of all light, which is more; 0 for a normal that is zero or NaN.
    ACDF_METHOD double irradiance(const float normal[3]) const noexcept {
        return acdf_local_irradiance(&data_, normal);
    }
    /// Whether pdfs are 0 where another sampler is to cover the light: used alone they are biased.
    ACDF_METHOD bool requires_mis() const noexcept { return data_.partner != nullptr; }
    /// Of the samples of both at a normal, in (0, 1]: how many to take from this view; 1 where it is to be used
    /// alone.
    ACDF_METHOD float recommended_light_share(const float normal[3]) const noexcept {
        return acdf_local_recommended_share(&data_, normal);
    }
    /// Whether a normal has a pdf of its own; else it is served by that of the whole environment.
    ACDF_METHOD bool stored(const float normal[3]) const noexcept { return acdf_local_stored(&data_, normal) != 0; }
    /// The pdf of the whole environment, whatever the normal.
    ACDF_METHOD EnvironmentView environment() const noexcept { return EnvironmentView(data_.environment); }
};

/// For each view a probability density over the directions of light that a surface reflects to it, times the
/// cosine. Unit vectors wo (towards the viewer) and wi (towards the light) are in the surface's frame: z is its
/// normal.
class BrdfView : public ViewOf<AcdfBrdf> {
public:
    using ViewOf<AcdfBrdf>::ViewOf;
    ACDF_METHOD bool empty() const noexcept { return data_.columns == 0; }

    /// Samples wi for wo; u0 (azimuth of the half-vector) and u1 (its elevation) in [0, 1]. pdf in sr^-1 of wi,
    /// finite and > 0. It is 0 where wo is not a unit vector above the surface. wi may lie below it: it counts as
    /// 0.
    ACDF_METHOD DirectionSample sample(const float wo[3], double u0, double u1) const noexcept {
        return acdf_brdf_sample(&data_, wo, u0, u1);
    }
    /// The pdf in sr^-1 of wi for wo. For a result of `sample` it is exactly the pdf there, but where wo and wi are
    /// so nearly opposite that their half-vector is lost in rounding.
    ACDF_METHOD float pdf(const float wo[3], const float wi[3]) const noexcept {
        return acdf_brdf_pdf(&data_, wo, wi);
    }
    /// The random numbers that sample wi for wo, but for rounding (acdf_brdf_invert); false where the table's pdf
    /// is 0.
    ACDF_METHOD bool invert(const float wo[3], const float wi[3], double u[2]) const noexcept {
        return acdf_brdf_invert(&data_, wo, wi, u) != 0;
    }
    /// Share of light that is reflected to wo, about: stored views are interpolated. To choose between lobes or
    /// layers.
    ACDF_METHOD double albedo(const float wo[3]) const noexcept { return acdf_brdf_albedo(&data_, wo); }
};

/// A probability density over the sampled axes of a table, one for each bin of its indexed axes. `index` has
/// one number an indexed axis, in [0, resolution), and may be null where there is none; u and x have one number a
/// sampled axis.
class TableView : public ViewOf<AcdfTable> {
public:
    using ViewOf<AcdfTable>::ViewOf;
    ACDF_METHOD bool empty() const noexcept { return data_.axis_count == 0; }

    /// How many axes are chosen by `index`, and how many are sampled.
    ACDF_METHOD std::uint32_t indexed_count() const noexcept { return data_.indexed_count; }
    ACDF_METHOD std::uint32_t sampled_count() const noexcept { return acdf_table_sampled_count(&data_); }
    /// Sampled axis i: its name, range and steps.
    ACDF_METHOD const AcdfAxis& sampled_axis(std::uint32_t i) const noexcept {
        return data_.axes[data_.indexed_count + i];
    }

    /// Samples x, in the units of the axes; u in [0, 1]. Returns the pdf there, per product of those units,
    /// finite and > 0; 0 (and x unset) where the bin has no energy or an index is out of range.
    ACDF_METHOD double sample(const std::uint32_t* index, const double* u, double* x) const noexcept {
        return acdf_table_sample(&data_, index, u, x);
    }
    /// The pdf of x; exactly that of `sample` for what it returned. 0 where none falls, outside the axes' ranges
    /// and for NaN.
    ACDF_METHOD double pdf(const std::uint32_t* index, const double* x) const noexcept {
        return acdf_table_pdf(&data_, index, x);
    }
    /// The random numbers that sample x; false where the pdf is 0.
    ACDF_METHOD bool invert(const std::uint32_t* index, const double* x, double* u) const noexcept {
        return acdf_table_invert(&data_, index, x, u) != 0;
    }
    /// Sum over the bins of the integral of the table over its sampled axes.
    ACDF_METHOD double total() const noexcept { return data_.total; }
    /// Whether pdfs are 0 where another sampler is to cover the table: used alone they are biased.
    ACDF_METHOD bool requires_mis() const noexcept { return data_.partner != nullptr; }
    /// Of the samples of both in a bin, in (0, 1]: how many to take from this view. 1 where it is to be used alone,
    /// or an index is out of range.
    ACDF_METHOD float recommended_light_share(const std::uint32_t* index) const noexcept {
        const AcdfBin* bin = acdf_table_bin(&data_, index);
        return bin ? acdf_partner_bin_share(data_.partner, static_cast<std::uint32_t>(bin - data_.bins)) : 1.0f;
    }
    /// What part of `total` a bin holds: to choose a bin by its energy. 0 where an index is out of range.
    ACDF_METHOD double share(const std::uint32_t* index) const noexcept {
        const AcdfBin* bin = acdf_table_bin(&data_, index);
        return bin ? static_cast<double>(bin->share) : 0.0;
    }
};

} // namespace acdf
