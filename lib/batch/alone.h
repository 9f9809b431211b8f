// Single calls, for what vectors leave to them: compiled once, and not into the loops of each kind of instructions.
#pragma once

#include <acdf/local.h>

/// Those of the same names in acdf/local.h.
namespace acdf::alone {

AcdfDirectionSample local_sample(const AcdfLocal&, const float normal[3], const double u[2]) noexcept;
AcdfDirectionSample local_sample(const AcdfLocal&, const AcdfLocalPoint&, const double u[2]) noexcept;
float local_pdf(const AcdfLocal&, const float normal[3], const float w[3]) noexcept;
float local_pdf(const AcdfLocal&, const AcdfLocalPoint&, const float w[3]) noexcept;

} // namespace acdf::alone
