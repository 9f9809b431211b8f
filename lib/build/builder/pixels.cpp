#include "build/builder/pixels.h"

#include "build/builder/guard.h"
#include "build/builder/strides.h"
#include "build/probe/projection.h"
#include "compress/parallel.h"

#include <cstring>
#include <iterator>
#include <type_traits>

namespace acdf::builder {
namespace {

constexpr std::uint64_t max_pixels = std::uint64_t{1} << 30;
constexpr std::uint32_t max_steps = 1 << 16; // of a file's axis of directions, also once they are resampled

struct Strides {
    std::ptrdiff_t channel, pixel, row;
};

Strides strides_of(const Pixels& pixels) {
    const auto item = static_cast<std::ptrdiff_t>(size_of(pixels.number));
    Strides out{pixels.channel_stride, pixels.pixel_stride, pixels.row_stride};
    if (out.channel == 0) out.channel = item;
    if (out.pixel == 0) out.pixel = item * static_cast<std::ptrdiff_t>(pixels.channels);
    if (out.row == 0) {
        require(out.pixel >= -(std::ptrdiff_t{1} << 32) && out.pixel <= std::ptrdiff_t{1} << 32,
                "the strides reach farther than memory does");
        out.row = out.pixel * static_cast<std::ptrdiff_t>(pixels.width);
    }
    return out;
}

void check_size(std::uint32_t width, std::uint32_t height) {
    require(width > 0 && height > 0, "a map has no pixels: its width or height is 0");
    require(std::uint64_t{width} * height <= max_pixels, "a map has more than 2^30 pixels");
    require(width <= max_steps && height <= max_steps, "a map has more than 65536 columns or rows");
}

} // namespace

void check(const Pixels& pixels) {
    require(pixels.data != nullptr, "pixels.data is null");
    check_size(pixels.width, pixels.height);
    require(pixels.channels == 1 || pixels.channels == 3 || pixels.channels == 4,
            "pixels.channels is none of 1, 3 and 4");
    require(size_of(pixels.number) > 0, "pixels.number is not a Number");
    require(pixels.projection >= Projection::latlong && pixels.projection <= Projection::octahedral,
            "pixels.projection is not a Projection");
    const Strides strides = strides_of(pixels);
    const std::uint32_t used = pixels.channels == 1 ? 1 : 3;
    StridedAxis axes[] = {{pixels.height, strides.row}, {pixels.width, strides.pixel}, {used, strides.channel}};
    check_strides(axes, std::size(axes), size_of(pixels.number));
    const build::Map map{pixels.projection, static_cast<int>(pixels.width), static_cast<int>(pixels.height)};
    require(build::has_shape(map),
            "pixels do not have the shape of their projection: discs and octahedral maps are square, cubes 3:4 "
            "(vertical cross), 4:3 (horizontal cross) or 1:6 (stacked)");
}

void check(const Rows& rows) {
    check_size(rows.width, rows.height);
    require(static_cast<bool>(rows.read), "rows.read is empty");
}

namespace {

template <class T>
float number_of(const unsigned char* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    if constexpr (std::is_same_v<T, std::uint16_t>) return half_to_float(value);
    else return static_cast<float>(value);
}

template <class T>
void read_as(const unsigned char* pixel, const Strides& strides, std::uint32_t channels, std::uint32_t count,
             float* rgb) {
    const std::ptrdiff_t next = channels == 1 ? 0 : strides.channel; // grey: the same three times
    if (next == sizeof(T) && strides.pixel == 3 * sizeof(T)) {
        if constexpr (std::is_same_v<T, float>) std::memcpy(rgb, pixel, std::size_t{3} * count * sizeof(T));
        else
            for (std::size_t i = 0; i < std::size_t{3} * count; ++i) rgb[i] = number_of<T>(pixel + i * sizeof(T));
        return;
    }
    for (std::uint32_t x = 0; x < count; ++x, pixel += strides.pixel, rgb += 3) {
        rgb[0] = number_of<T>(pixel);
        rgb[1] = number_of<T>(pixel + next);
        rgb[2] = number_of<T>(pixel + 2 * next);
    }
}

} // namespace

void read_texels(const Pixels& pixels, std::uint32_t x, std::uint32_t y, std::uint32_t count, float* rgb) {
    const Strides strides = strides_of(pixels);
    const auto* first = static_cast<const unsigned char*>(pixels.data) + std::ptrdiff_t{y} * strides.row +
                        std::ptrdiff_t{x} * strides.pixel;
    const auto read = pixels.number == Number::float32   ? read_as<float>
                      : pixels.number == Number::float16 ? read_as<std::uint16_t>
                                                         : read_as<double>;
    read(first, strides, pixels.channels, count, rgb);
}

const float* packed_texels(const Pixels& pixels, std::uint32_t x, std::uint32_t y) {
    const Strides strides = strides_of(pixels);
    if (pixels.number != Number::float32 || pixels.channels == 1 || strides.channel != sizeof(float) ||
        strides.pixel != 3 * sizeof(float))
        return nullptr;
    const auto* first = static_cast<const unsigned char*>(pixels.data) + std::ptrdiff_t{y} * strides.row +
                        std::ptrdiff_t{x} * strides.pixel;
    if (reinterpret_cast<std::uintptr_t>(first) % alignof(float) != 0) return nullptr;
    return reinterpret_cast<const float*>(first);
}

void read_rows(const Pixels& pixels, std::uint32_t first, std::uint32_t count, float* rgb) {
    compress::parallel_for(std::uint32_t{0}, count, [&](std::uint32_t r) {
        read_texels(pixels, 0, first + r, pixels.width, rgb + std::size_t{3} * r * pixels.width);
    });
}

const char* name_of(Projection projection) {
    switch (projection) {
    case Projection::latlong:
        return "latlong";
    case Projection::angular:
        return "angular";
    case Projection::mirrorball:
        return "mirrorball";
    case Projection::octahedral:
        return "octahedral";
    default:
        return "cube-cross";
    }
}

} // namespace acdf::builder
