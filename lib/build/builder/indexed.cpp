// Files of several maps, of pixels and of maps that have been read.
#include "build/builder/guard.h"
#include "build/builder/options.h"
#include "build/builder/target.h"

#include <stdexcept>

namespace acdf::builder {
namespace {

TargetOptions nearest(TargetOptions options) {
    options.filter = ACDF_FILTER_NEAREST;
    return options;
}

IndexedFile make(const std::vector<IndexedMap>& maps, const IndexedOptions& options,
                 const build::Progress& progress) {
    std::vector<build::SunMap> views;
    IndexedFile out;
    for (const IndexedMap& map : maps) {
        views.push_back({&grid_of(map.fitted), &grid_of(map.texels), options.target.filter});
        out.bad_texels.push_back(map.fitted.data()->bad);
    }
    build::Source source = options.source;
    if (source.projection.empty()) source.projection = maps[0].fitted.data()->projection;
    build::IndexedEnvironmentFile made = build::build_indexed(views, source, internal(options), progress);
    out.bytes = std::move(made.bytes);
    out.accuracy = std::move(made.accuracy);
    out.mean_variance = made.mean_variance;
    out.suns = made.suns;
    out.splits = made.splits;
    out.cells = made.cells;
    return out;
}

} // namespace

IndexedMapRows::IndexedMapRows(const TargetOptions& options, const build::Progress& progress,
                               std::optional<build::Domain> grid)
    : has_grid_(grid.has_value()), fitted_(options, progress, grid) {
    if (options.filter != ACDF_FILTER_NEAREST) texels_.emplace(nearest(options), build::Progress(), grid);
}

void IndexedMapRows::set_luminance(const ChannelWeights& weights) {
    fitted_.set_luminance(weights);
    if (texels_) texels_->set_luminance(weights);
}

void IndexedMapRows::require_own_grid(const build::Map& map) const {
    if (!has_grid_ && fitted_.resamples(map))
        throw std::invalid_argument("several maps are stored on their own grid, lat-long or octahedral");
}

bool IndexedMapRows::take_map(const build::Map& map, const std::vector<float>& rgb) {
    require_own_grid(map);
    return (!texels_ || texels_->take_map(map, rgb)) && fitted_.take_map(map, rgb);
}

void IndexedMapRows::begin(int width, int height) {
    require_own_grid({Projection::latlong, width, height});
    fitted_.begin(width, height);
    if (texels_) texels_->begin(width, height);
}

void IndexedMapRows::take(int first, int count, const float* rgb) {
    fitted_.take(first, count, rgb);
    if (texels_) texels_->take(first, count, rgb);
}

IndexedMap IndexedMapRows::finish(const BadTexels& bad, const std::string& projection) {
    IndexedMap out;
    out.fitted = fitted_.finish(bad, projection);
    out.texels = texels_ ? texels_->finish() : out.fitted;
    return out;
}

Status indexed(const std::vector<IndexedMap>& maps, const IndexedOptions& options, IndexedFile& result,
               const Control& control) noexcept {
    return make_into(result, control, [&](Gate& gate) {
        check(options, maps.size());
        return make(maps, options, gate.part(0.0, 1.0));
    });
}

Status indexed(const std::vector<Pixels>& maps, const IndexedOptions& options, IndexedFile& result,
               const Control& control) noexcept {
    constexpr double reading = 0.2; // of the time, about
    return make_into(result, control, [&](Gate& gate) {
        check(options, maps.size());
        std::vector<IndexedMap> read;
        const double each = reading / double(maps.size());
        for (const Pixels& pixels : maps)
            read.push_back(make_indexed_map(pixels, options.target, control.threads,
                                            gate.part(each * double(read.size()), each)));
        return make(read, options, gate.part(reading, 1.0 - reading));
    });
}

} // namespace acdf::builder
