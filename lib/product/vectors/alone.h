// Single calls of cuts, for what vectors leave to them: compiled once, and not into the loops of each kind of
// instructions.
#pragma once

#include <acdf/product/cut_sample.h>
#include <acdf/product/fast_cut.h>

/// Those of the same names in acdf/product/cut_sample.h and acdf/product/fast_cut.h.
namespace acdf::alone {

AcdfDirectionSample cut_sample(const AcdfLocal&, const AcdfLocalPoint&, const AcdfCut&, const double u[2]) noexcept;
AcdfDirectionSample cut_sample(const AcdfLocal&, const AcdfLocalPoint&, const AcdfFastCut&,
                               const double u[2]) noexcept;
float cut_pdf(const AcdfLocal&, const AcdfLocalPoint&, const AcdfCut&, const float w[3]) noexcept;
float cut_pdf(const AcdfLocal&, const AcdfLocalPoint&, const AcdfFastCut&, const float w[3]) noexcept;

} // namespace acdf::alone
