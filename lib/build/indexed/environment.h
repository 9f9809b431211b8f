// From several maps of one layout to the bytes of one file.
#pragma once

#include "build/environment.h"
#include "build/indexed/accuracy.h"
#include "build/indexed/sun.h"

#include <acdf/maps.h>

#include <cstdint>
#include <string>
#include <vector>

namespace acdf::build {

using builder::MapAxis;

struct IndexedOptions {
    compress::TargetOptions target;
    std::uint64_t budget = 64 << 10;
    AcdfCodec codec = ACDF_CODEC_NONE;
    std::vector<MapAxis> axes;
    bool sun = true;
    std::vector<SunDirection> suns;
    std::string reading; ///< options of reading, in one spelling
};

/// Throws OptionError where options contradict each other, or do not make `maps` maps.
void check(const IndexedOptions& options, std::size_t maps);

struct IndexedEnvironmentFile {
    std::vector<std::uint8_t> bytes;
    std::vector<builder::MapAccuracy> accuracy;
    double mean_variance = 0.0;
    std::size_t splits = 0, cells = 0, suns = 0;
};

/// As builder::indexed; `name` and `sha256` of all maps together. Throws check()'s errors, std::invalid_argument
/// where maps do not fit together, NoEnergy where one has no light, std::runtime_error where the budget is out of
/// reach.
IndexedEnvironmentFile build_indexed(const std::vector<SunMap>& maps, const Source& source,
                                     const IndexedOptions& options, const Progress& progress = {});

/// All options that shape the file, in one spelling.
std::string option_text(const IndexedOptions& options);

} // namespace acdf::build
