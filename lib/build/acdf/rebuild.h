// Environments that change while a renderer runs: made once for a size, rebuilt for each frame. C++17.
//
//     acdf::builder::EnvironmentOptions options;
//     options.goal = acdf::builder::Goal::of_budget(16 << 10); // at most 16 KiB
//     options.target.filter = ACDF_FILTER_BILINEAR;            // as the renderer looks the map up
//     acdf::builder::EnvironmentRebuilder sky;
//     acdf::builder::Status status = acdf::builder::EnvironmentRebuilder::make(1024, 512, options, sky);
//     acdf::builder::Control control;
//     control.threads = 1; // this thread alone; 0: the arena of oneTBB that it is in
//     while (status.ok() && next_frame(pixels)) {
//         status = sky.rebuild(pixels, control); // or, where less has changed, sky.update(pixels, region, control)
//         render(sky.view());
//     }
//
// Two changes need no rebuild:
// - Scale. Where all light gets brighter by a factor, no pdf changes. Multiply total() by the factor where you
//   choose between lights:
//
//       const double power = factor * sky.view().total();
//
// - Rotation. Turn directions instead: those that are sampled from the map to the scene, and those that pdf() gets
//   from the scene to the map, by the inverse rotation. A pdf per steradian does not change:
//
//       const acdf::DirectionSample s = sky.view().sample(u0, u1);
//       const Vector to_light = rotate(s.direction);                 // its pdf is s.pdf
//       const float p = sky.view().pdf(rotate_back(to_light).data()); // the same pdf
//
// acdf/rebuild_c.h has the same calls for C.
#pragma once

#include <acdf/builder.h>

namespace acdf::builder {

/// How much work a frame gets.
enum class Quality {
    fast, ///< no memory is taken once the first frame is made; files store no accuracy
    best  ///< the bytes that environment() makes, in its time
};

/// A rectangle of pixels.
struct Region {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;
};

/// Makes the files and views of one environment map that changes. Quality fast takes 13 bytes a texel of maps of
/// more than 2^20 texels, else 25. Sides that are no powers of two take up to twice that. An object serves one call
/// at a time; its views may be used meanwhile.
class EnvironmentRebuilder {
public:
    /// For lat-long maps of width x height pixels, or octahedral ones. Quality fast takes goals of cells and
    /// budget, and the variance fit without a bound on weights. It fits a map on its own grid, without a partner
    /// and a codec. Bad texels become zero or are refused. ErrorCode::invalid_argument names what it does not take.
    static Status make(std::uint32_t width, std::uint32_t height, const EnvironmentOptions& options,
                       EnvironmentRebuilder& result, Quality quality = Quality::fast,
                       Projection projection = Projection::latlong) noexcept;

    /// Makes the file and the view of a frame. Each pixel is read once, row by row, so that memory that the GPU
    /// shares will do. `pixels` has the size and projection that were given to make. Where the call fails or is
    /// cancelled, the last view and file stay.
    Status rebuild(const Pixels& pixels, const Control& control = {}) noexcept;
    /// The same where, since the last call, only the pixels of a region have changed. Only those are read, and file
    /// and view are those of rebuild(), byte for byte. Reads all pixels where the last call failed, or where
    /// quality is best.
    Status update(const Pixels& pixels, const Region& region, const Control& control = {}) noexcept;

    /// Whether make() has filled it.
    bool ready() const noexcept { return data_ != nullptr; }
    /// Whether there is no file yet: then nothing below may be asked.
    bool empty() const noexcept;
    /// The view of the last frame. It stays valid, as do the file's bytes, while the next frame is made and until
    /// the one after that is begun.
    EnvironmentView view() const noexcept;
    /// The last frame's file.
    const std::uint8_t* data() const noexcept;
    std::size_t size() const noexcept;
    /// Relative variance of one sample.
    double relative_variance() const noexcept;
    /// What was mended in the last frame.
    const BadTexels& bad_texels() const noexcept;

    /// Empty until make() fills it. Movable, not copyable.
    EnvironmentRebuilder() noexcept;
    ~EnvironmentRebuilder();
    EnvironmentRebuilder(EnvironmentRebuilder&& other) noexcept;
    EnvironmentRebuilder& operator=(EnvironmentRebuilder&& other) noexcept;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace acdf::builder
