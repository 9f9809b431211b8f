// Many samples or pdfs at once, for renderers that work in batches. Results are those of single calls of the
// reader, bit for bit, in a third of the time, about.
//
//   acdf::sample_batch(file.environment(), u, count, directions, pdfs);
//
// Descents take turns, so that they wait for memory together. What is computed before and after takes the widest
// vectors that the processor has: AVX-512, AVX2, SSE4, NEON and others of Google Highway. Where it has none, a
// batch is the loop over single calls. All functions are thread-safe, allocate and throw nothing. They take up to
// 50 KiB of the stack. Arrays may not overlap.
#pragma once

#include <acdf/views.h>

#include <cstddef>

namespace acdf {

// ---- environments ----

/// EnvironmentView::sample of u[i] into directions[i] and pdfs[i], i < count.
void sample_batch(const EnvironmentView& view, const double (*u)[2], std::size_t count, float (*directions)[3],
                  float* pdfs) noexcept;
/// EnvironmentView::pdf of directions[i] into pdfs[i], i < count.
void pdf_batch(const EnvironmentView& view, const float (*directions)[3], std::size_t count, float* pdfs) noexcept;

// ---- local environments: a normal serves `each` calls that follow one another, at least 1 ----

/// LocalEnvironmentView::sample of normals[i / each] and u[i] into directions[i] and pdfs[i], i < count. Directions
/// are 0 where their pdf is.
void sample_batch(const LocalEnvironmentView& view, const float (*normals)[3], std::size_t each,
                  const double (*u)[2], std::size_t count, float (*directions)[3], float* pdfs) noexcept;
/// LocalEnvironmentView::pdf of normals[i / each] and directions[i] into pdfs[i], i < count.
void pdf_batch(const LocalEnvironmentView& view, const float (*normals)[3], std::size_t each,
               const float (*directions)[3], std::size_t count, float* pdfs) noexcept;

// ---- BRDFs: a view serves `each` calls that follow one another, at least 1 ----

/// BrdfView::sample of wo[i / each] and u[i] into wi[i] and pdfs[i], i < count.
void sample_batch(const BrdfView& view, const float (*wo)[3], std::size_t each, const double (*u)[2],
                  std::size_t count, float (*wi)[3], float* pdfs) noexcept;
/// BrdfView::pdf of wo[i / each] and wi[i] into pdfs[i], i < count.
void pdf_batch(const BrdfView& view, const float (*wo)[3], std::size_t each, const float (*wi)[3],
               std::size_t count, float* pdfs) noexcept;

} // namespace acdf
