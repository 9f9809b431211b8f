// What local environment files of both forms have in common: what they say of themselves, and their accuracy.
#pragma once

#include "build/local.h"
#include "build/local_bins.h"
#include "compress/store/store.h"

#include <acdf/reader.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace acdf::build {

constexpr std::uint64_t kSlack = 256; ///< bytes by which files of nearly the same size differ

/// A size is too small.
struct OutOfReach : std::runtime_error {
    std::uint64_t least;

    OutOfReach(std::uint64_t budget, std::uint64_t least_bytes);
};

compress::Description description_of(const compress::Target& target, const Source& source,
                                     const LocalOptions& options, const compress::NormalBins& bins,
                                     const LocalAccuracy& accuracy);

/// What chunk COMP says of all normals.
compress::Chunk partner_chunk(const compress::Partner& partner, const std::vector<AcdfPartnerRecord>& records,
                              const compress::NormalBins& bins);

/// Opens a file that was just made.
File opened(const std::vector<std::uint8_t>& bytes);

/// Stores a description with the accuracy that the file has. `store(description, codec)` makes its bytes.
using Store = std::function<std::vector<std::uint8_t>(const compress::Description&, AcdfCodec)>;
Local finish(compress::Description description, const Store& store, const compress::Target& target,
             const Source& source, const LocalOptions& options, const compress::NormalBins& bins);

/// The largest compressed file of at most `budget` bytes; `build(bytes)` takes at most so many before compression.
/// Throws OutOfReach.
Local compressed_local(std::uint64_t budget, const std::function<Local(std::uint64_t bytes)>& build);

/// The smallest file whose measured variance is at most that of the goal. `at(bytes)` makes one of at most so many;
/// nothing: there is none.
Local smallest_of_variance(double variance, const std::function<std::optional<Local>(double bytes)>& at,
                           const std::function<void(double share)>& progress);

} // namespace acdf::build
