// From several maps of one layout to the bytes of one file.
#pragma once

#include "build/environment.h"
#include "build/indexed/accuracy.h"
#include "build/indexed/sun.h"

#include <cstdint>
#include <string>
#include <vector>

namespace acdf::build {

/// An axis of maps, whose coordinates rise.
struct MapAxis {
    std::string name;
    std::vector<double> coordinates;
};

struct IndexedOptions {
    compress::TargetOptions target;
    std::uint64_t budget = 64 << 10;
    AcdfCodec codec = ACDF_CODEC_NONE;
    std::vector<MapAxis> axes;      ///< the last one fastest
    bool sun = true;                ///< looked for, where `suns` is empty
    std::vector<SunDirection> suns; ///< one a map
    std::string reading;            ///< options of reading, in one spelling
};

struct IndexedEnvironmentFile {
    std::vector<std::uint8_t> bytes;
    std::vector<IndexedAccuracy> accuracy; ///< of each map at its own coordinates
    double mean_variance = 0.0;            ///< geometric
    std::size_t splits = 0, cells = 0;     ///< splits: with codes of each map
    std::size_t suns = 0;                  ///< maps that have one
};

/// `name` and `sha256` of all maps together. Throws std::invalid_argument where maps do not fit together, NoEnergy
/// where one has no light, std::runtime_error where the budget is out of reach.
IndexedEnvironmentFile build_indexed(const std::vector<SunMap>& maps, const Source& source,
                                     const IndexedOptions& options, const Progress& progress = {});

/// All options that shape the file, in one spelling.
std::string option_text(const IndexedOptions& options);

} // namespace acdf::build
