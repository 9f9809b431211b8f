// Which bins of normals a local environment file has.
#pragma once

#include "build/local.h"
#include "compress/local/normals.h"

#include <cstddef>
#include <cstdint>

namespace acdf::build {

/// Bins by the options; of so many subdivisions if those name none.
compress::NormalBins bins_of(const LocalOptions& options, std::uint32_t subdivisions);

/// The same; for the few normals of a scene so dense that as many are stored, of at most `most` bins.
compress::NormalBins bins_as_many(const LocalOptions& options, std::uint32_t subdivisions, std::size_t most);

} // namespace acdf::build
