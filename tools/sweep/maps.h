// Several maps in one file, beside a file for each of them, at several sizes.
#pragma once

#include "tools/cli/probe_source.h"
#include "tools/sweep/sweep.h"

#include <acdf/maps.h>

#include <string>
#include <vector>

namespace acdf::tools {

/// All maps at one size.
struct MapRow {
    bool together = true;                ///< in one file; else in a file for each map, of equal sizes
    std::uint64_t budget = 0;            ///< of all files together
    std::uint64_t bytes = 0;             ///< the same, as made
    double relative_variance = kUnknown; ///< of one sample, geometric mean over maps
    double worst = kUnknown;             ///< of the worst map
    SweepTimes times; ///< of one file half way between maps; of a file for each map that of the first
};

struct MapSweep {
    std::vector<std::string> sources; ///< as the user named them
    std::string input;                ///< in the words of the command line: sources and options
    std::string output;               ///< what the file's name begins with
    std::size_t maps = 0;
    VisibleNoise visible;
    bool timed = true;
    std::vector<MapRow> rows;
    std::vector<std::string> notes; ///< sizes that are out of reach
};

/// `one`: its goal does not count. Fills in rows and notes; of `options` budgets and timing count. Throws
/// std::invalid_argument where maps do not fit together or no size can be made.
void sweep_maps(const std::vector<builder::IndexedMap>& maps, const builder::IndexedOptions& one,
                const SweepOptions& options, const build::Progress& progress, MapSweep& sweep);

/// Which file to make: of the sizes of one file the smallest whose noise cannot be seen, or the largest.
struct MapAdvice {
    std::size_t row = 0;
    bool reached = false; ///< whether its noise cannot be seen
    std::string sentence, command;
};
MapAdvice advise(const MapSweep& sweep);

/// The contents of sweep.csv and sweep.json.
std::string maps_csv(const MapSweep& sweep);
std::string maps_json(const MapSweep& sweep);

} // namespace acdf::tools
