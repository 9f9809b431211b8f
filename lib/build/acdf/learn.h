// Visibility cells from the shadow rays that a renderer traces anyway: no mesh, no rays of its own. C++17.
//
//     acdf::builder::LearnOptions options;
//     scene.bounds(options.low, options.high); // of the positions that light is sampled at
//     acdf::builder::LearnedVisibility learned;
//     acdf::builder::Status status = acdf::builder::LearnedVisibility::make(bytes, size, options, learned);
//     for (int pass = 0; status.ok() && pass < passes; ++pass) {
//         const std::shared_ptr<const acdf::File> file = learned.file(); // keeps the view valid
//         acdf::VisibleLocalView sky; // of acdf/visibility/visibility.h
//         acdf::VisibleLocalView::of(*file, sky);
//         // all threads, at each vertex:
//         const AcdfVisiblePoint point = sky.at(position, normal);
//         const acdf::DirectionSample s = sky.sample(point, u0, u1);
//         learned.add(position, normal, s.direction, !occluded(position, s.direction));
//         // then, once:
//         if (pass < 4) status = learned.update();
//     }
//     status = learned.save("scene.acdf"); // the same kind of file as `acdf local --visibility`
//
// Samples stay unbiased whatever was learned: each direction that the normal can sample keeps a positive pdf, and
// the pdf is exact.
#pragma once

#include <acdf/builder.h>

#include <cstddef>
#include <cstdint>
#include <memory>

namespace acdf::builder {

/// What is learned.
struct LearnOptions {
    /// The box of positions that count, in the coordinates of the renderer's positions: of what the camera sees,
    /// as cells divide it. low < high in one axis at least. Elsewhere the normal alone counts.
    float low[3] = {}, high[3] = {};
    std::uint64_t bytes = 3 << 20; ///< of visibility cells, at most, but for a single one
    /// Rows for what samples of the BSDF, as many as those of light and about cosine, leave over. They stay
    /// positive everywhere: such a file may be used alone, too, with more noise.
    bool beside_cosine = false;
};

/// Counts what shadow rays meet, and makes visibility cells of it. Takes up to 64 MiB, beside files.
class LearnedVisibility {
public:
    /// For the light of a local environment file, whose bytes are copied: made without an MIS partner
    /// (`acdf local`). Visibility cells that it has serve until the first update.
    /// ErrorCode::bad_source: it is none; invalid_argument: options are out of range.
    static Status make(const void* file, std::size_t size, const LearnOptions& options,
                       LearnedVisibility& result) noexcept;

    /// Adds one shadow ray: whether it met nothing. `direction` is of unit length, `normal` of any. Both are in the
    /// frame of directions. By any number of threads at once. What is outside of the box, below the horizon of the
    /// normal, or no number, is ignored.
    void add(const float position[3], const float normal[3], const float direction[3], bool visible) noexcept;
    /// Makes a file of all rays so far. The same rays give the same bytes, in any order and by any number of
    /// threads. Rays may be added meanwhile, of which some count. After an error the last file stays.
    Status update(const Control& control = {}) noexcept;

    /// The last file that was made: that given to make() before the first update. It stays valid as long as the
    /// pointer is kept. Null only where empty().
    std::shared_ptr<const File> file() const noexcept;
    /// Writes the last file; replaces one that is there only once it is whole. ErrorCode::bad_source where that
    /// fails.
    Status save(const char* path) const noexcept;

    /// Whether make() has not filled it: then only this and file() may be asked.
    bool empty() const noexcept { return data_ == nullptr; }

    /// Empty until make() fills it. Movable, not copyable.
    LearnedVisibility() noexcept;
    ~LearnedVisibility();
    LearnedVisibility(LearnedVisibility&& other) noexcept;
    LearnedVisibility& operator=(LearnedVisibility&& other) noexcept;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace acdf::builder
