#include "parts.h"
#include "quiet.h"

#include <OpenImageIO/imageio.h>

#include <cstring>
#include <memory>

namespace acdf::images {
namespace {

OIIO::ImageInput& input_of(void* image) { return *static_cast<OIIO::ImageInput*>(image); }

const OIIO::ImageSpec& spec_of(const void* image) { return static_cast<const OIIO::ImageInput*>(image)->spec(); }

Header header_of(const OIIO::ImageInput& input) {
    const OIIO::ImageSpec& s = input.spec();
    Header header;
    header.format = input.format_name();
    header.data = {s.x, s.y, s.width, s.height};
    header.display = {s.full_x, s.full_y, s.full_width, s.full_height};
    header.depth = s.depth;
    header.tile_height = s.tile_width > 0 ? s.tile_height : 0;
    header.channel_count = s.nchannels;
    header.channels = s.channelnames;
    header.deep = s.deep;
    header.floating = s.format.basetype == OIIO::TypeDesc::HALF || s.format.basetype == OIIO::TypeDesc::FLOAT ||
                      s.format.basetype == OIIO::TypeDesc::DOUBLE;
    header.sample_bytes = static_cast<int>(s.format.basesize());
    for (const OIIO::TypeDesc& format : s.channelformats)
        header.channel_bytes.push_back(static_cast<int>(format.basesize()));
    constexpr int kNumbers = 8;
    header.chromaticities.resize(kNumbers);
    if (!s.getattribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, kNumbers),
                        header.chromaticities.data()))
        header.chromaticities.clear();
    return header;
}

// Of the current part. OpenImageIO would convert by way of 64 MiB, however small the image is.
bool read_scanlines(OIIO::ImageInput& input, const Rows& rows, int begin, int end, float* to) {
    const OIIO::ImageSpec& s = input.spec();
    const int part = input.current_subimage(), channels = rows.last_channel - rows.first_channel;
    if (!s.channelformats.empty())
        return input.read_scanlines(part, 0, begin, end, s.z, rows.first_channel, rows.last_channel,
                                    OIIO::TypeDesc::FLOAT, to, rows.pixel_stride, rows.row_stride);
    const std::size_t samples = static_cast<std::size_t>(end - begin) * static_cast<std::size_t>(s.width) *
                                static_cast<std::size_t>(channels);
    const std::unique_ptr<unsigned char[]> stored(new unsigned char[samples * s.format.size()]);
    const OIIO::TypeDesc format = s.format; // the image may be opened anew while it is read
    const int width = s.width;
    return input.read_native_scanlines(part, 0, begin, end, s.z, rows.first_channel, rows.last_channel,
                                       stored.get()) &&
           OIIO::parallel_convert_image(channels, width, end - begin, 1, stored.get(), format, OIIO::AutoStride,
                                        OIIO::AutoStride, OIIO::AutoStride, to, OIIO::TypeDesc::FLOAT,
                                        rows.pixel_stride, rows.row_stride, OIIO::AutoStride, input.threads());
}

} // namespace

void* open_image(const std::string& path, int threads, Header& header, std::string& error) {
    const Quiet quiet;
    OIIO::ImageSpec asked; // colours as they are: not multiplied by an alpha that nobody reads
    asked.attribute("oiio:UnassociatedAlpha", 1);
    std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path, &asked);
    error = OIIO::geterror();
    if (!input) return nullptr;
    input->threads(threads);
    header = header_of(*input);
    return input.release();
}

void close_image(void* image) { std::unique_ptr<OIIO::ImageInput>(static_cast<OIIO::ImageInput*>(image)); }

bool seek_part(void* image, int part, Header& header) {
    const Quiet quiet;
    OIIO::ImageInput& input = input_of(image);
    if (!input.seek_subimage(part, 0)) {
        input.geterror(); // there being no such part is no error
        return false;
    }
    header = header_of(input);
    return true;
}

bool read_rows(void* image, const Rows& rows, float* to, std::string& error) {
    const Quiet quiet;
    OIIO::ImageInput& input = input_of(image);
    const OIIO::ImageSpec& s = input.spec();
    const int part = input.current_subimage(), begin = s.y + rows.first_row, end = s.y + rows.last_row;
    const bool done =
        s.tile_width > 0
            ? input.read_tiles(part, 0, s.x, s.x + s.width, begin, end, s.z, s.z + 1, rows.first_channel,
                               rows.last_channel, OIIO::TypeDesc::FLOAT, to, rows.pixel_stride, rows.row_stride)
            : read_scanlines(input, rows, begin, end, to);
    // Some readers report what is missing, but say they succeeded.
    if (done && !input.has_error()) return true;
    error = input.geterror();
    return false;
}

std::string text_of(const void* image, const char* name) { return spec_of(image).get_string_attribute(name); }

/// Of Radiance pictures, OpenImageIO 2.4 exchanges the two that are turned by a quarter: the first row of
/// "+X 32 +Y 16" is the left side from below (8), that of "-X 32 -Y 16" the right side from above (6).
int radiance_orientation(int said) { return said == 6 ? 8 : said == 8 ? 6 : said; }

int integer_of(const void* image, const char* name, int otherwise) {
    const int value = spec_of(image).get_int_attribute(name, otherwise);
    const bool radiance = std::strcmp(static_cast<const OIIO::ImageInput*>(image)->format_name(), "hdr") == 0;
    return radiance && std::strcmp(name, "Orientation") == 0 ? radiance_orientation(value) : value;
}

float real_of(const void* image, const char* name, float otherwise) {
    return spec_of(image).get_float_attribute(name, otherwise);
}

} // namespace acdf::images
