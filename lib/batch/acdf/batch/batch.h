// Samples a local environment many times at once: for renderers that work in batches.
//
//   const acdf::LocalBatch batch(file.local());
//   batch.sample(normals, u, count, out);
#pragma once

#include <acdf/reader.h>
#include <acdf/views.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

/// What instructions serve; with `none` it is the loop over LocalEnvironmentView.
enum class Instructions : int { none = 0, avx2 = 1, avx512 = 2 };

/// The directions and pdfs of a LocalEnvironmentView, bit for bit in a fraction of the
/// time. A few words by value, no memory of its own; valid while the File lives. All functions are const,
/// thread-safe, allocate and throw nothing.
class LocalBatch {
public:
    LocalBatch() noexcept = default;
    /// Uses the best instructions that the processor has, up to `most`. The loop, without vector
    /// instructions, serves files without runtime tables, with a share of the cosine, with bins on a lat-long grid
    /// or of more than 32 subdivisions. The gain with such files is, at most, that samples at several normals wait
    /// for memory together.
    explicit LocalBatch(const LocalEnvironmentView& view, Instructions most = Instructions::avx512) noexcept;

    /// LocalEnvironmentView::sample of normals[i] and u[i] into out[i], i < count.
    void sample(const float (*normals)[3], const double (*u)[2], std::size_t count,
                DirectionSample* out) const noexcept;
    /// LocalEnvironmentView::sample of a shading point and u[i] into out[i], i < count.
    void sample(const AcdfLocalPoint& point, const double (*u)[2], std::size_t count,
                DirectionSample* out) const noexcept;
    /// LocalEnvironmentView::pdf of normals[i] and directions[i] into out[i], i < count.
    void pdf(const float (*normals)[3], const float (*directions)[3], std::size_t count, float* out) const noexcept;
    /// LocalEnvironmentView::pdf of a shading point and directions[i] into out[i], i < count.
    void pdf(const AcdfLocalPoint& point, const float (*directions)[3], std::size_t count,
             float* out) const noexcept;

    /// The instructions in use.
    Instructions instructions() const noexcept { return instructions_; }

private:
    AcdfLocal local_ = {};
    Instructions instructions_ = Instructions::none;
};

} // namespace acdf
