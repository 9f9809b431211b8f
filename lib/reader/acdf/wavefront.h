// Draws from a BRDF for many views at once with the vector instructions of the processor: for renderers that work
// in waves.
//
//   acdf::BrdfWavefront wavefront;
//   if (acdf::Status status = acdf::BrdfWavefront::prepare(file.brdf(), wavefront); !status.ok()) { ... }
//   wavefront.sample(wo, u, count, out);
#pragma once

#include <acdf/reader.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

struct WavefrontTable;

/// What instructions serve; with `none` it is the loop over BrdfView.
enum class Instructions : int { none = 0, avx2 = 1, avx512 = 2 };

/// The directions and densities of a BrdfView, bit for bit, in a fraction of the time. Valid while its File lives.
/// `prepare` allocates; all else is const, thread-safe, allocates and throws nothing.
class BrdfWavefront {
public:
    BrdfWavefront() noexcept = default;
    BrdfWavefront(BrdfWavefront&& other) noexcept;
    BrdfWavefront& operator=(BrdfWavefront&& other) noexcept;
    ~BrdfWavefront();

    /// Makes the tables: 12 bytes a cell and view, and some more a cell, which is about twelve times the file. Uses
    /// the best instructions that the processor has, up to `most`. Served by the loop, without tables, are files
    /// that are not isotropic, have a diffuse floor or trees of their own for each bin, or whose views share so few
    /// rows that tables would be out of proportion to the file. Fails where memory does; `out` then stays what it
    /// was.
    static Status prepare(const BrdfView& view, BrdfWavefront& out,
                          Instructions most = Instructions::avx512) noexcept;

    /// BrdfView::sample of wo[i] and u[i] into out[i], i < count.
    void sample(const float (*wo)[3], const double (*u)[2], std::size_t count, DirectionSample* out) const noexcept;
    /// BrdfView::pdf of wo[i] and wi[i] into out[i], i < count.
    void pdf(const float (*wo)[3], const float (*wi)[3], std::size_t count, float* out) const noexcept;

    /// Bytes of the tables; 0 where there are none.
    std::size_t bytes() const noexcept { return bytes_; }
    Instructions instructions() const noexcept { return instructions_; }

private:
    AcdfBrdf brdf_ = {};
    WavefrontTable* table_ = nullptr;
    std::size_t bytes_ = 0;
    Instructions instructions_ = Instructions::none;
};

} // namespace acdf
