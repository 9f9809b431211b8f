// Environments that are made again and again: the public object.
#include "build/builder/fast_rebuild.h"
#include "build/builder/options.h"
#include "build/builder/pixels.h"

#include <optional>

namespace acdf::builder {

struct EnvironmentRebuilder::Data {
    std::uint32_t width, height;
    Projection projection;
    EnvironmentOptions options;
    std::optional<FastRebuild> fast; ///< none: quality best
    Frame frames[2];
    int last = -1; ///< of the frames
};

EnvironmentRebuilder::EnvironmentRebuilder() noexcept = default;
EnvironmentRebuilder::~EnvironmentRebuilder() = default;
EnvironmentRebuilder::EnvironmentRebuilder(EnvironmentRebuilder&&) noexcept = default;
EnvironmentRebuilder& EnvironmentRebuilder::operator=(EnvironmentRebuilder&&) noexcept = default;

namespace {

/// On the calling thread alone, without an arena.
template <class Work>
Status guarded_alone(const Control& control, const Work& work) noexcept {
    try {
        Gate gate(control.progress);
        gate.tell(0.0, "starting");
        work(gate);
        gate.tell(1.0, "done");
        return {};
    } catch (...) {
        return current_status();
    }
}

} // namespace

Status EnvironmentRebuilder::make(std::uint32_t width, std::uint32_t height, const EnvironmentOptions& options,
                                  EnvironmentRebuilder& result, Quality quality, Projection projection) noexcept {
    result = {};
    return guarded_alone({}, [&](Gate&) {
        require(quality == Quality::fast || quality == Quality::best, "quality is not a Quality");
        require(projection == Projection::latlong || projection == Projection::octahedral,
                "a rebuilder takes lat-long and octahedral maps");
        const float pixel[3] = {};
        Pixels pixels{pixel, width, height};
        pixels.projection = projection;
        check(pixels);
        check(options);
        auto data = std::make_unique<Data>();
        data->width = width;
        data->height = height;
        data->projection = projection;
        data->options = options;
        if (quality == Quality::fast) {
            require_fast(options, projection);
            data->fast.emplace(width, height, options, projection);
            for (Frame& frame : data->frames) data->fast->reserve(frame);
        }
        result.data_ = std::move(data);
    });
}

Status EnvironmentRebuilder::rebuild(const Pixels& pixels, const Control& control) noexcept {
    if (data_ && data_->fast) data_->fast->forget();
    return update(pixels, {0, 0, pixels.width, pixels.height}, control);
}

Status EnvironmentRebuilder::update(const Pixels& pixels, const Region& region, const Control& control) noexcept {
    const auto work = [&](Gate& gate) {
        require(data_ != nullptr, "the rebuilder is empty; make it first");
        Data& data = *data_;
        check(pixels);
        require(pixels.width == data.width && pixels.height == data.height && pixels.projection == data.projection,
                "pixels have another size or projection than the rebuilder was made for");
        require(region.width > 0 && region.height > 0 && region.x < data.width && region.y < data.height &&
                    region.width <= data.width - region.x && region.height <= data.height - region.y,
                "the region is empty, or reaches beyond the map");
        const int next = data.last == 0 ? 1 : 0;
        Frame& frame = data.frames[next];
        if (data.fast) data.fast->make(pixels, region, control.threads == 1, gate, frame);
        else {
            Environment made;
            const Status status = environment(pixels, data.options, made, control);
            if (!status.ok()) throw status;
            frame.file = File();
            frame.bytes = std::move(made.bytes);
            frame.relative_variance = made.accuracy.relative_variance;
            frame.bad = made.bad_texels;
            open(frame, {});
        }
        data.last = next;
    };
    const auto served = [&]() noexcept {
        static const Control silent; // environment() reports itself
        if (data_ && !data_->fast) return guarded_alone(silent, work);
        if (control.threads == 1) return guarded_alone(control, work);
        return guarded(control, work, []() noexcept {});
    };
    const Status status = served();
    if (!status.ok() && data_ && data_->fast) data_->fast->forget(); // what has changed since is not said
    return status;
}

bool EnvironmentRebuilder::empty() const noexcept { return !data_ || data_->last < 0; }
EnvironmentView EnvironmentRebuilder::view() const noexcept {
    return data_->frames[data_->last].file.environment();
}
const std::uint8_t* EnvironmentRebuilder::data() const noexcept { return data_->frames[data_->last].bytes.data(); }
std::size_t EnvironmentRebuilder::size() const noexcept { return data_->frames[data_->last].bytes.size(); }
double EnvironmentRebuilder::relative_variance() const noexcept {
    return data_->frames[data_->last].relative_variance;
}
const BadTexels& EnvironmentRebuilder::bad_texels() const noexcept { return data_->frames[data_->last].bad; }

} // namespace acdf::builder
