// Samples a local environment or a BRDF many times at once: for renderers that work in batches.
//
//   acdf::BrdfBatch batch;
//   if (acdf::Status status = acdf::BrdfBatch::prepare(file.brdf(), batch); !status.ok()) { ... }
//   batch.sample(wo, u, count, out);
#pragma once

#include <acdf/reader.h>
#include <acdf/views.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

struct BatchTable;

/// What instructions serve; with `none` it is the loop over BrdfView.
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

/// The directions and pdfs of a BrdfView, bit for bit, in a fraction of the time. Valid while its File lives.
/// `prepare` allocates; all else is const, thread-safe, allocates and throws nothing.
class BrdfBatch {
public:
    BrdfBatch() noexcept = default;
    BrdfBatch(BrdfBatch&& other) noexcept;
    BrdfBatch& operator=(BrdfBatch&& other) noexcept;
    ~BrdfBatch();

    /// Makes tables: 4 bytes a cell and view, and some more a cell. That is about four times the file; twelve times
    /// where the file was opened without runtime tables, or has none. Uses the best instructions that the processor
    /// has, up to `most`. The loop, without tables, serves files that are not isotropic, or that have a diffuse
    /// floor or trees of their own for each bin. It also serves files whose views share so few rows that tables
    /// would be out of proportion to the file. Fails where memory does; `out` then stays what it was.
    static Status prepare(const BrdfView& view, BrdfBatch& out, Instructions most = Instructions::avx512) noexcept;

    /// BrdfView::sample of wo[i] and u[i] into out[i], i < count.
    void sample(const float (*wo)[3], const double (*u)[2], std::size_t count, DirectionSample* out) const noexcept;
    /// BrdfView::pdf of wo[i] and wi[i] into out[i], i < count.
    void pdf(const float (*wo)[3], const float (*wi)[3], std::size_t count, float* out) const noexcept;

    /// Bytes of tables of its own; 0 where there are none.
    std::size_t bytes() const noexcept;
    /// The instructions in use.
    Instructions instructions() const noexcept { return instructions_; }

private:
    AcdfBrdf brdf_ = {};
    BatchTable* table_ = nullptr;
    AcdfBlock own_[2] = {}; // its arrays; runtime tables, where the file has none
    Instructions instructions_ = Instructions::none;
};

/// BrdfView::pdf of a view that was looked up (acdf_brdf_view) and wi[i] into out[i], i < count, bit for bit.
/// Without tables of its own; by vectors where the file has runtime tables with a grid.
void brdf_pdf_batch(const AcdfBrdf& brdf, const AcdfBrdfView& view, const float (*wi)[3], std::size_t count,
                    float* out, Instructions most = Instructions::avx512) noexcept;

/// BrdfView::sample of a view that was looked up and u[i] into out[i], i < count, bit for bit.
void brdf_sample_batch(const AcdfBrdf& brdf, const AcdfBrdfView& view, const double (*u)[2], std::size_t count,
                       DirectionSample* out, Instructions most = Instructions::avx512) noexcept;

} // namespace acdf
