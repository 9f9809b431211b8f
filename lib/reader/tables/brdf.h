// Makes the runtime tables of acdf/brdf_tables.h.
#pragma once

#include <acdf/allocator.h>
#include <acdf/brdf.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

/// Whether a BRDF can have tables: it is isotropic, without a diffuse floor, and its bins share cells.
bool can_have_tables(const AcdfBrdf& brdf) noexcept;

/// Whether AcdfBrdfTables::inverse is exact.
bool has_exact_inverses(const AcdfBrdf& brdf) noexcept;

/// The tables of such a BRDF, in `block`, which the caller gives back, of at most `most_bytes`; null where they
/// would take more, and where memory fails. Guesses are left out where there is no room for them, and unless asked
/// for.
AcdfBrdfTables* make_brdf_tables(const AcdfBrdf& brdf, std::size_t most_bytes, bool guesses,
                                 const AcdfAllocator& allocator, AcdfBlock& block) noexcept;

/// Fills the guesses of all views, 2^(2 bits) each, with the numbers of cells.
void guess_brdf_cells(const AcdfBrdf& brdf, std::uint32_t bits, std::uint16_t* out) noexcept;

} // namespace acdf
