// Time of what `acdf export --target c` writes. `tables`: its words, on the device.
#pragma once

#include "timing.h"

#include <cstdint>

namespace acdf_cuda {

Timed time_exported_sample(const std::uint32_t* tables, const Asked& asked);
Timed time_exported_pdf(const std::uint32_t* tables, const Asked& asked);
Timed time_exported_brdf_sample(const std::uint32_t* tables, const Asked& asked);
Timed time_exported_brdf_pdf(const std::uint32_t* tables, const Asked& asked);

} // namespace acdf_cuda
