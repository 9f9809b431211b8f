#include "input/probe/image.h"

#include "images/image_file.h"
#include "input/error.h"
#include "input/file_name.h"
#include "input/line_ends.h"
#include "input/other_kind.h"
#include "input/probe/gain_map.h"
#include "input/probe/layers.h"
#include "input/probe/orientation.h"
#include "input/probe/primaries.h"
#include "input/probe/transfer.h"
#include "input/stand_in.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <new>

namespace acdf::input {
namespace {

constexpr std::int64_t max_pixels = std::int64_t{1} << 30;
constexpr int max_side = 1 << 16; // of a file's axis of directions

// No codec packs more than this many pixels into a byte (deflate reaches 1032 bytes a byte), so a header that
// claims more is damaged or hostile: refused before memory is asked for. Small images pass.
constexpr std::int64_t max_pixels_per_byte = 10'000;
constexpr std::int64_t small_image_pixels = std::int64_t{1} << 24;

std::string shape(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

// ---- windows ----------------------------------------------------------------------------------------

using images::Window;

bool contains(const Window& w, const Window& o) {
    return o.x >= w.x && o.y >= w.y && std::int64_t{o.x} + o.width <= std::int64_t{w.x} + w.width &&
           std::int64_t{o.y} + o.height <= std::int64_t{w.y} + w.height;
}

Window display_window(const images::Header& header) {
    return header.display.width > 0 && header.display.height > 0 ? header.display : header.data;
}

bool overlap(const Window& a, const Window& b) {
    return std::int64_t{a.x} < std::int64_t{b.x} + b.width && std::int64_t{b.x} < std::int64_t{a.x} + a.width &&
           std::int64_t{a.y} < std::int64_t{b.y} + b.height && std::int64_t{b.y} < std::int64_t{a.y} + a.height;
}

// ---- reading ----------------------------------------------------------------------------------------

std::string text_of(const builder::ChannelWeights& luminance) {
    char text[120];
    std::snprintf(text, sizeof text,
                  "its primaries are not those of Rec. 709: luminance is %.3g R + %.3g G + %.3g B", luminance.r,
                  luminance.g, luminance.b);
    return text;
}

class Reader {
public:
    Reader(const std::string& path, int threads) : path_(path), file_(path_of_image(), threads) {
        if (!file_.is_open()) refuse_converted_line_ends(path_, 1);
        if (!file_.is_open())
            fail("no image that can be read (" + file_.error() + "); give an .exr, .hdr, .tif or .tx");
    }

    Image read(const std::function<TakeRows(const Image& image)>& stream) {
        choose_channels();
        check_spec();
        const Window data = header().data, display = image_window();
        const int orientation = orientation_of(file_);
        Image image;
        image.half = is_half();
        image.luminance = luminance_of(header().chromaticities);
        image.tag = environment_tag();
        image.width = display.width;
        image.height = display.height;
        turn_upright(image, orientation); // its sides, for whoever takes rows
        const TakeRows take = stream ? stream(image) : TakeRows{};
        if (take && data == display && orientation == 1) {
            read_bands(take, image);
        } else {
            image.width = display.width;
            image.height = display.height;
            read_windows(data, display, image);
            linearize(image, file_);
            turn_upright(image, orientation);
        }
        add_warnings(image);
        if (orientation != 1)
            image.warnings.push_back("its rows are stored turned or mirrored (orientation " +
                                     std::to_string(orientation) +
                                     " of TIFF); it is read upright, as the file says");
        if (take && !image.rgb.empty()) {
            take(0, image.height, image.rgb.data());
            image.rgb = {};
        }
        return image;
    }

private:
    /// OpenImageIO reads large files of other kinds to the end before it finds that they are none of its own.
    const std::string& path_of_image() const {
        if (const std::string kind = kind_of_no_image(path_); !kind.empty()) fail(kind);
        refuse_stand_in(path_);
        refuse_converted_line_ends(path_);
        if (has_gain_map(path_))
            fail("it is an Ultra HDR JPEG: its pixels are clipped at the white of a display, and brighter light is "
                 "in its gain map, which acdf does not read; convert it to .exr or .hdr with a program that "
                 "applies the "
                 "map");
        return path_;
    }

    const images::Header& header() const { return file_.header(); }

    [[noreturn]] void fail(const std::string& what) const { throw input_error(path_, what); }

    void check_size(const Window& window) const {
        const std::int64_t pixels = std::int64_t{window.width} * window.height;
        const std::string size = shape(window.width, window.height);
        if (window.width <= 0 || window.height <= 0)
            fail("its size " + size + " is not a size; the file is damaged");
        if (pixels > max_pixels)
            fail("it has " + size + " pixels, more than 2^30; resize it, or the file is damaged");
        if (window.width > max_side || window.height > max_side)
            fail("it has " + size + " pixels, more than 65536 on a side; resize it");
        std::error_code ignored;
        const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(path_, ignored));
        if (!ignored && pixels > small_image_pixels && pixels / max_pixels_per_byte > bytes)
            fail("its header claims " + size + " pixels in a file of " + std::to_string(bytes) +
                 " bytes; the file is damaged");
    }

    /// Goes to the part that is the light. Most formats name no channels: of their first part the first three are
    /// taken, or with one or two the first, as grey.
    void choose_channels() {
        if (!has_names()) {
            if (header().channel_count < 1) fail("it has no channels; the file is damaged");
            if (header().channel_count >= 3) channels_ = {{0, 1, 2}};
            return;
        }
        const Choice choice = choose_layer(parts());
        if (!choice.error.empty()) fail(choice.error);
        file_.seek(choice.part);
        channels_ = choice.channels;
        remark_ = choice.remark;
    }

    bool has_names() const {
        return header().format == "openexr" &&
               header().channels.size() == static_cast<std::size_t>(header().channel_count);
    }

    /// Those that are deep count where there are no others.
    std::vector<PartNames> parts() {
        std::vector<PartNames> flat, deep;
        for (int part = 0; file_.seek(part); ++part)
            (header().deep ? deep : flat)
                .push_back(
                    {part, file_.text("oiio:subimagename"), header().channels, are_xyz(header().chromaticities)});
        return flat.empty() ? deep : flat;
    }

    bool is_half() const {
        const std::vector<int>& bytes = header().channel_bytes;
        const auto of = [&](int channel) {
            return bytes.empty() ? header().sample_bytes : bytes[static_cast<std::size_t>(channel)];
        };
        return header().floating && std::all_of(std::begin(channels_.index), std::end(channels_.index),
                                                [&](int channel) { return of(channel) == 2; });
    }

    void check_spec() {
        const images::Header& s = header();
        if (s.deep) fail("it is a deep image; flatten it (oiiotool IN --flatten -o OUT)");
        if (s.depth > 1) fail("it is a volume, not an image; give a lat-long or another projection");
        check_size(s.data);
        check_size(image_window());
        if (!overlap(s.data, image_window()))
            fail("its data window lies outside its display window; crop it (oiiotool IN --fullpixels -o OUT)");
    }

    EnvironmentTag environment_tag() const {
        const std::string format = lower(file_.text("textureformat"));
        if (format.find("latlong") != std::string::npos) return EnvironmentTag::latlong;
        if (format.find("cubeface") != std::string::npos) return EnvironmentTag::cube;
        return EnvironmentTag::none;
    }

    /// Where the image is that is meant. Of cube maps OpenImageIO makes the display window one face if they are
    /// mip-mapped: their six faces are the data window (OpenEXR, ImfEnvmap.h).
    Window image_window() const {
        return environment_tag() == EnvironmentTag::cube ? header().data : display_window(header());
    }

    void read_windows(const Window& data, const Window& display, Image& image) {
        const std::size_t display_floats =
            std::size_t{3} * static_cast<std::size_t>(display.width) * static_cast<std::size_t>(display.height);
        if (contains(display, data)) {
            // Straight into the result. OpenEXR: pixels of the display window without data are black.
            image.rgb.assign(display_floats, 0.0f);
            read_channels(image.rgb.data() + offset(data.x - display.x, data.y - display.y, display.width),
                          display.width);
            if (!(data == display)) warn_of_black(data.width, data.height, image);
            return;
        }
        std::vector<float> all(std::size_t{3} * static_cast<std::size_t>(data.width) *
                               static_cast<std::size_t>(data.height));
        read_channels(all.data(), data.width);
        image.rgb.assign(display_floats, 0.0f);
        const int x0 = std::max(data.x, display.x), x1 = std::min(data.x + data.width, display.x + display.width);
        const int y0 = std::max(data.y, display.y), y1 = std::min(data.y + data.height, display.y + display.height);
        for (int y = y0; y < y1; ++y)
            std::copy_n(all.data() + offset(x0 - data.x, y - data.y, data.width), 3 * (x1 - x0),
                        image.rgb.data() + offset(x0 - display.x, y - display.y, display.width));
        image.warnings.push_back("the file holds pixels outside its display window; they are not used");
        if (!contains(data, display)) warn_of_black(x1 - x0, y1 - y0, image);
    }

    static void warn_of_black(int width, int height, Image& image) {
        image.warnings.push_back("the file holds " + shape(width, height) + " of " +
                                 shape(image.width, image.height) + " pixels; the rest is black");
    }

    static std::size_t offset(int x, int y, int width) {
        return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    }

    // Rows that are read at once: a multiple of what any codec packs together.
    static constexpr int band_rows = 256;

    // Reads rows [y0, y1) of the data window, counted from its top, of channels [begin, end).
    void read_rows(int y0, int y1, int begin, int end, float* at, std::ptrdiff_t pixel, std::ptrdiff_t row) {
        if (file_.read({y0, y1, begin, end, pixel, row}, at)) return;
        refuse_converted_line_ends(path_, 1);
        fail("its pixels cannot be read" + (file_.error().empty() ? "" : " (" + file_.error() + ")") +
             "; the file is cut short or damaged" + maybe_converted_line_ends(path_));
    }

    // The same of the channels that are wanted, as RGB texels with rows of `row_pixels`.
    void read_channels(int y0, int y1, float* first, int row_pixels) {
        const std::ptrdiff_t pixel = 3 * sizeof(float), row = pixel * row_pixels;
        if (channels_.in_order())
            return read_rows(y0, y1, channels_.index[0], channels_.index[0] + 3, first, pixel, row);
        const int count = channels_.grey() ? 1 : 3;
        for (int c = 0; c < count; ++c)
            read_rows(y0, y1, channels_.index[c], channels_.index[c] + 1, first + c, pixel, row);
        if (!channels_.grey()) return;
        for (int y = 0; y < y1 - y0; ++y) {
            float* at = first + offset(0, y, row_pixels);
            for (int x = 0; x < header().data.width; ++x) at[3 * x + 1] = at[3 * x + 2] = at[3 * x];
        }
    }

    // Calls read(y0, y1) for bands of the data window that end where tiles do.
    template <class Read>
    void for_each_band(const Read& read) {
        const int tile = std::max(header().tile_height, 1), height = header().data.height;
        const int rows = (std::max(band_rows, tile) + tile - 1) / tile * tile;
        for (int y = 0; y < height; y += rows) read(y, std::min(y + rows, height));
    }

    void read_bands(const TakeRows& take, Image& image) {
        Image band;
        band.width = image.width;
        for_each_band([&](int y0, int y1) {
            band.height = y1 - y0;
            band.rgb.assign(offset(0, band.height, band.width), 0.0f);
            read_channels(y0, y1, band.rgb.data(), band.width);
            band.warnings.clear();
            linearize(band, file_);
            if (y0 == 0) image.warnings = band.warnings;
            take(y0, band.height, band.rgb.data());
        });
    }

    // Reads the data window into RGB pixels with rows of `row_pixels`, at `first`.
    void read_channels(float* first, int row_pixels) {
        for_each_band(
            [&](int y0, int y1) { read_channels(y0, y1, first + offset(0, y0, row_pixels), row_pixels); });
    }

    void add_warnings(Image& image) {
        if (image.tag == EnvironmentTag::latlong && file_.integer("oiio:sampleborder", 0) != 0)
            image.warnings.push_back(
                "OpenEXR puts texel centres on the poles and the seam; texels are read as areas, "
                "at most half a texel off");
        if (image.luminance) image.warnings.push_back(text_of(*image.luminance));
        if (!remark_.empty()) image.warnings.push_back(remark_);
        if (!has_names() && file_.seek(1))
            image.warnings.push_back("the file has several parts; the first is used");
    }

    std::string path_;
    images::ImageFile file_;
    Channels channels_;
    std::string remark_; ///< on how they were chosen
};

} // namespace

std::string shape(const Image& image) { return shape(image.width, image.height); }

Image read_image(const std::string& path, int threads, const std::function<TakeRows(const Image& image)>& stream) {
    try {
        return Reader(path, threads).read(stream);
    } catch (const std::bad_alloc&) {
        throw input_error(path, "there is not enough memory for its pixels; resize it");
    }
}

} // namespace acdf::input
