// Single calls, for what vectors leave to them: compiled once, and not into the loops of each kind of instructions.
#pragma once

#include <acdf/cut_sample.h>
#include <acdf/fast_cut.h>
#include <acdf/local.h>

/// Those of the same names in acdf/sample.h, acdf/local.h, acdf/cut_sample.h and acdf/fast_cut.h.
namespace acdf::alone {

AcdfDirectionSample local_sample(const AcdfLocal&, const float normal[3], const double u[2]) noexcept;
AcdfDirectionSample local_sample(const AcdfLocal&, const AcdfLocalPoint&, const double u[2]) noexcept;
float local_pdf(const AcdfLocal&, const float normal[3], const float w[3]) noexcept;
float local_pdf(const AcdfLocal&, const AcdfLocalPoint&, const float w[3]) noexcept;

AcdfDirectionSample cut_sample(const AcdfLocal&, const AcdfLocalPoint&, const AcdfCut&, const double u[2]) noexcept;
AcdfDirectionSample cut_sample(const AcdfLocal&, const AcdfLocalPoint&, const AcdfFastCut&,
                               const double u[2]) noexcept;
float cut_pdf(const AcdfLocal&, const AcdfLocalPoint&, const AcdfCut&, const float w[3]) noexcept;
float cut_pdf(const AcdfLocal&, const AcdfLocalPoint&, const AcdfFastCut&, const float w[3]) noexcept;

} // namespace acdf::alone
