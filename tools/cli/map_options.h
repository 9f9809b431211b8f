// Several maps in one file: what `acdf env --axis` does.
#pragma once

#include "build/builder/sources.h"
#include "tools/cli/conversion.h"
#include "tools/cli/probe_source.h"

#include <acdf/builder.h>
#include <acdf/maps.h>

#include <CLI/CLI.hpp>

#include <array>
#include <string>
#include <vector>

namespace acdf::tools {

/// Maps for one file, and what they are together.
struct LoadedMaps {
    std::vector<builder::IndexedMap> maps;
    builder::Source source;
};

/// The options of several maps.
class MapOptions {
public:
    void add(CLI::App& command);
    /// Whether sources become one file: there are axes, or a source is a sequence (tools/cli/sequence.h).
    bool given(const std::vector<std::string>& sources) const;
    /// Takes the sources over. Sequences become the files that they stand for, and an axis `frame`. Throws
    /// CLI::ValidationError where they do not fit the axes, and Failure where a sequence has no files.
    void take(const std::vector<std::string>& sources);

    std::vector<std::string>& files() { return files_; }
    std::size_t count() const { return files_.size(); }
    bool any() const { return !axes_.empty(); }
    /// Of those of an environment only target, budget and codec count.
    builder::IndexedOptions options(const input::ProbeOptions& reading,
                                    const builder::EnvironmentOptions& environment) const;
    /// Reads all maps, and says of each what is noted, once. Throws as load_map.
    LoadedMaps load(const input::ProbeOptions& reading, const builder::TargetOptions& target, const Note& note,
                    const build::Progress& progress) const;
    Converted convert(const input::ProbeOptions& reading, const builder::EnvironmentOptions& environment,
                      const Listener& listener) const;

private:
    void parse_axes();
    void add_frames(const std::string& sequence);

    std::vector<std::string> axis_texts_, sun_texts_;
    bool no_sun_ = false;
    std::vector<builder::MapAxis> axes_;
    std::vector<std::array<double, 3>> suns_;
    std::vector<std::string> files_;
};

} // namespace acdf::tools
