#include "build/builder/target.h"

#include "build/builder/options.h"
#include "build/builder/pixels.h"
#include "build/builder/sources.h"
#include "build/errors.h"
#include "build/probe/repeated_rows.h"

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

namespace acdf::builder {
namespace {

/// Fills `rgb` with rows of a lat-long map.
using ReadRows = std::function<void(std::uint32_t first, std::uint32_t count, float* rgb)>;

/// Rows that are read at once: a few MiB, for parallel loops to be worth their while.
constexpr std::uint32_t kBandTexels = 1 << 18;

void for_each_band(std::uint32_t width, std::uint32_t height, const ReadRows& read,
                   const std::function<void(std::uint32_t first, std::uint32_t count, float* rgb)>& use) {
    const std::uint32_t rows = std::clamp(kBandTexels / width, 1u, height);
    std::vector<float> band(std::size_t{3} * width * rows);
    for (std::uint32_t first = 0; first < height; first += rows) {
        const std::uint32_t count = std::min(rows, height - first);
        read(first, count, band.data());
        use(first, count, band.data());
    }
}

build::Channels largest_of_all(std::uint32_t width, std::uint32_t height, const ReadRows& read, int threads) {
    build::Channels out{0.0f, 0.0f, 0.0f};
    for_each_band(width, height, read, [&](std::uint32_t, std::uint32_t count, float* rgb) {
        const build::Channels found = build::largest_radiance(rgb, std::size_t{width} * count, threads);
        for (std::size_t k = 0; k < 3; ++k) out[k] = std::max(out[k], found[k]);
    });
    return out;
}

void take_latlong(std::uint32_t width, std::uint32_t height, const ReadRows& read, const TargetOptions& options,
                  int threads, bool half, build::RepairedRows& repaired) {
    build::Channels largest = build::largest_half;
    const bool clamp = options.bad_texels == BadTexelPolicy::clamp;
    if (clamp && !half) largest = largest_of_all(width, height, read, threads);
    repaired.begin(static_cast<int>(width), static_cast<int>(height));
    for_each_band(width, height, read, [&](std::uint32_t first, std::uint32_t count, float* rgb) {
        repaired.take(static_cast<int>(first), static_cast<int>(count), rgb, clamp ? &largest : nullptr);
    });
}

void take_projection(const Pixels& pixels, build::RepairedRows& repaired) {
    std::vector<float> rgb(std::size_t{3} * pixels.width * pixels.height);
    read_rows(pixels, 0, pixels.height, rgb.data());
    const auto width = static_cast<int>(pixels.width), height = static_cast<int>(pixels.height);
    repaired.repair_whole(width, height, rgb.data(),
                          pixels.number == Number::float16 ? &build::largest_half : nullptr);
    repaired.take_whole({pixels.projection, width, height}, std::move(rgb));
}

/// What TargetRows, or IndexedMapRows, make of rows that `take` passes on.
template <class RowsOf>
auto make(const TargetOptions& options, int threads, const build::Progress& progress, const std::string& projection,
          const std::function<void(build::RepairedRows&)>& take) {
    RowsOf rows(options, progress);
    build::RepairedRows repaired({options.bad_texels, options.uniform_if_black, threads}, rows);
    take(repaired);
    if (options.bad_texels == BadTexelPolicy::error && repaired.bad().count() > 0)
        throw std::invalid_argument("it has " + build::text(repaired.bad()) +
                                    "; repair them, or choose to zero or clamp them");
    repaired.light_if_black();
    return rows.finish(repaired.bad(), projection);
}

template <class RowsOf>
auto make_of_pixels(const Pixels& pixels, const TargetOptions& options, int threads,
                    const build::Progress& progress) {
    check(pixels);
    check(options);
    const auto read = [&](std::uint32_t first, std::uint32_t count, float* rgb) {
        read_rows(pixels, first, count, rgb);
    };
    return make<RowsOf>(options, threads, progress, name_of(pixels.projection), [&](build::RepairedRows& repaired) {
        if (pixels.projection != Projection::latlong) return take_projection(pixels, repaired);
        take_latlong(pixels.width, pixels.height, read, options, threads, pixels.number == Number::float16,
                     repaired);
    });
}

template <class Image>
Status target_from(const Image& image, const TargetOptions& options, Target& target,
                   const Control& control) noexcept {
    return make_into(target, control,
                     [&](Gate& gate) { return make_target(image, options, control.threads, gate.part(0.0, 1.0)); });
}

} // namespace

Target make_target(const Pixels& pixels, const TargetOptions& options, int threads,
                   const build::Progress& progress) {
    return make_of_pixels<TargetRows>(pixels, options, threads, progress);
}

IndexedMap make_indexed_map(const Pixels& pixels, const TargetOptions& options, int threads,
                            const build::Progress& progress) {
    return make_of_pixels<IndexedMapRows>(pixels, options, threads, progress);
}

Target make_target(const Rows& rows, const TargetOptions& options, int threads, const build::Progress& progress) {
    check(rows);
    check(options);
    const auto read = [&](std::uint32_t first, std::uint32_t count, float* rgb) {
        bool going_on = false;
        try {
            going_on = rows.read(first, count, rgb);
        } catch (...) {
            throw build::CallbackFailed();
        }
        if (!going_on) throw build::CallbackFailed();
    };
    return make<TargetRows>(options, threads, progress, name_of(Projection::latlong),
                            [&](build::RepairedRows& repaired) {
                                take_latlong(rows.width, rows.height, read, options, threads, false, repaired);
                            });
}

const compress::Target& grid_of(const Target& target) { return target.data()->grid; }

namespace {

Target held(Target::Data data) {
    if (!compress::has_energy(data.grid))
        throw build::NoEnergy("the map is black in the channels asked for, so there is nothing to sample");
    data.options.parameterization = data.grid.parameterization;
    return Target(std::make_shared<const Target::Data>(std::move(data)));
}

} // namespace

Target target_of(compress::Target grid, const TargetOptions& options) {
    Target::Data data;
    data.options = internal(options);
    data.map = {grid.parameterization == ACDF_PARAM_OCTAHEDRAL ? Projection::octahedral : Projection::latlong,
                static_cast<int>(grid.columns), static_cast<int>(grid.rows), repeats(options)};
    data.grid = std::move(grid);
    return held(std::move(data));
}

bool TargetRows::resamples(const build::Map& map) const {
    const auto grid = grid_of(map), own = build::own_domain(map);
    return !grid || !own || !(*grid == *own);
}

void TargetRows::set_luminance(const ChannelWeights& weights) {
    const ChannelWeights usual;
    ChannelWeights& asked = options_.channels.weights;
    if (options_.channels.mode == ACDF_CHANNELS_WEIGHTED && asked.r == usual.r && asked.g == usual.g &&
        asked.b == usual.b)
        asked = weights;
}

bool TargetRows::take_map(const build::Map& map, const std::vector<float>& rgb) {
    map_ = map;
    map_.repeats = repeats(options_);
    made_ = target_of(map_, rgb.data());
    if (progress_) progress_(0.9, "resampling");
    return true;
}

void TargetRows::begin(int width, int height) {
    map_ = {Projection::latlong, width, height, repeats(options_)};
    if (resamples(map_)) {
        rgb_.resize(row() * static_cast<std::size_t>(height));
        return;
    }
    compress::TargetOptions options = internal(options_);
    options.parameterization = ACDF_PARAM_LATLONG;
    own_.emplace(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), options);
}

void TargetRows::take(int first, int count, const float* rgb) {
    if (own_) {
        own_->take(static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count), rgb);
        keep_borders(first, count, rgb);
    } else
        std::copy_n(rgb, row() * static_cast<std::size_t>(count),
                    rgb_.begin() + static_cast<std::ptrdiff_t>(row() * static_cast<std::size_t>(first)));
    if (progress_) progress_(0.9 * (first + count) / map_.height, "reading pixels");
}

void TargetRows::keep_borders(int first, int count, const float* rgb) {
    if (!map_.repeats) return;
    if (first == 0) borders_[0].assign(rgb, rgb + row());
    if (first + count < map_.height) return;
    const float* last = rgb + row() * static_cast<std::size_t>(count - 1);
    borders_[1].assign(last, last + row());
}

build::SourceTarget TargetRows::own_target() {
    build::SourceTarget out{own_->finish(), 0.0};
    if (map_.repeats) build::repeat_rows(out.target, borders_[0].data(), borders_[1].data(), internal(options_));
    return out;
}

Target TargetRows::finish(const BadTexels& bad, const std::string& projection) {
    if (own_) made_ = own_target();
    else if (!rgb_.empty()) made_ = target_of(map_, rgb_.data());
    return held({std::move(made_.target), internal(options_), bad, projection, map_, made_.error});
}

/// The grid, where it does not depend on what would be lost.
std::optional<build::Domain> TargetRows::grid_of(const build::Map& map) const {
    if (grid_) return grid_;
    switch (options_.domain) {
    case Domain::latlong:
        return build::domain_for(map, ACDF_PARAM_LATLONG);
    case Domain::octahedral:
        return build::domain_for(map, ACDF_PARAM_OCTAHEDRAL);
    default:
        return build::own_domain(map);
    }
}

build::SourceTarget TargetRows::target_of(const build::Map& map, const float* rgb) const {
    const auto grid = grid_of(map);
    return grid ? build::source_target(map, rgb, *grid, internal(options_))
                : build::source_target_losing_least(map, rgb, internal(options_));
}

Status Target::from(const Pixels& pixels, const TargetOptions& options, Target& target,
                    const Control& control) noexcept {
    return target_from(pixels, options, target, control);
}

Status Target::from(const Rows& rows, const TargetOptions& options, Target& target,
                    const Control& control) noexcept {
    return target_from(rows, options, target, control);
}

std::uint32_t Target::columns() const noexcept { return data_->grid.columns; }
std::uint32_t Target::rows() const noexcept { return data_->grid.rows; }
double Target::total() const noexcept { return data_->grid.total; }
const BadTexels& Target::bad_texels() const noexcept { return data_->bad; }

} // namespace acdf::builder
