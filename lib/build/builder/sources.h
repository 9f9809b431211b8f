// Sources that are in the library's own terms already: what programs that link all of lib/ build from.
#pragma once

#include "build/array.h"
#include "build/own_terms.h"
#include "build/probe/rows.h"
#include "build/probe/source_target.h"
#include "build/progress.h"

#include <optional>
#include <string>
#include <utility>

namespace acdf::builder {

/// What a Target holds.
struct Target::Data {
    compress::Target grid;
    compress::TargetOptions options;
    BadTexels bad;
    std::string projection; ///< its name, where the pixels had it
    build::Map map;         ///< of the source, as it is looked up
    double error = 0.0;     ///< build::SourceTarget

    build::Domain grid_of() const { return {grid.parameterization, grid.columns, grid.rows}; }
    /// Whether the grid is not the source's own.
    bool resampled() const {
        const auto own = build::own_domain(map);
        return !own || !(*own == grid_of());
    }
};

compress::TargetOptions internal(const TargetOptions& options);

/// Whether lookups meet the opposite border, and what `fit.options` says then: "--wrap repeat ", or nothing.
bool repeats(const TargetOptions& options);
std::string wrap_text(bool repeats);

/// A probe on its way into a target, on the grid of the options, or on one chosen for it.
class TargetRows : public build::ProbeRows {
public:
    explicit TargetRows(const TargetOptions& options, build::Progress progress = {},
                        std::optional<build::Domain> grid = {})
        : options_(options), progress_(std::move(progress)), grid_(grid) {}

    /// Whether a map is fitted on another grid than its own.
    bool resamples(const build::Map& map) const;

    /// Whoever asked for luminance gets it by these.
    void set_luminance(const ChannelWeights& weights) override;
    bool take_map(const build::Map& map, const std::vector<float>& rgb) override;
    void begin(int width, int height) override;
    void take(int first, int count, const float* rgb) override;
    /// Once, after all rows. Throws build::NoEnergy.
    Target finish(const BadTexels& bad = {}, const std::string& projection = {});

private:
    std::size_t row() const { return std::size_t{3} * static_cast<std::size_t>(map_.width); }
    std::optional<build::Domain> grid_of(const build::Map& map) const;
    build::SourceTarget target_of(const build::Map& map, const float* rgb) const;
    void keep_borders(int first, int count, const float* rgb);
    build::SourceTarget own_target();

    TargetOptions options_;
    build::Progress progress_;
    std::optional<build::Domain> grid_;
    build::Map map_;
    std::vector<float> rgb_;                         ///< of a map that is fitted on another grid
    std::vector<float> borders_[2];                  ///< first and last row of a map on its own, where rows repeat
    std::optional<compress::EnvironmentTarget> own_; ///< of a lat-long map on its own
    build::SourceTarget made_;
};

/// One of several maps: what is fitted of it, and its own texels.
struct IndexedMap {
    Target fitted, texels;
};

/// Such a map on its way: all of it is read once. Where no grid is given it has to be its own: begin() and
/// take_map() throw std::invalid_argument.
class IndexedMapRows : public build::ProbeRows {
public:
    explicit IndexedMapRows(const TargetOptions& options, const build::Progress& progress = {},
                            std::optional<build::Domain> grid = {});

    void set_luminance(const ChannelWeights& weights) override;
    bool take_map(const build::Map& map, const std::vector<float>& rgb) override;
    void begin(int width, int height) override;
    void take(int first, int count, const float* rgb) override;
    /// As TargetRows.
    IndexedMap finish(const BadTexels& bad = {}, const std::string& projection = {});

private:
    void require_own_grid(const build::Map& map) const;

    bool has_grid_;
    TargetRows fitted_;
    std::optional<TargetRows> texels_; ///< of a lookup that is not by the nearest one
};

/// The file of maps that have been read.
Status indexed(const std::vector<IndexedMap>& maps, const IndexedOptions& options, IndexedFile& result,
               const Control& control = {}) noexcept;

/// The table of numbers that are floats already; `bad` says what they were.
Status table(const build::Array& array, const BadNumbers& bad, const TableOptions& options, Table& result,
             const Control& control = {}) noexcept;

} // namespace acdf::builder
