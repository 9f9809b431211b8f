#include "images/radiance.h"

#include "images/one_part.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <memory>
#include <optional>
#include <string_view>

namespace acdf::images {
namespace {

constexpr int kMostRadianceSide = 1 << 16;
constexpr int kFewestColumns = 8, kMostColumns = 32767;             // of rows that are divided into components
constexpr std::size_t kLongestLine = 1 << 16, kMostLines = 1 << 10; // Radiance's own commands are long

struct Radiance {
    std::ifstream file;
    int width = 0, height = 0;
    bool has_format = false;           ///< the header names it
    std::streamoff size = 0;           ///< of the file
    std::streamoff pixels = 0;         ///< where they begin
    std::vector<float> chromaticities; ///< images::Header
    int orientation = 1;               ///< of TIFF
    bool flat = false;                 ///< no row is encoded
    bool marked = false;               ///< the first row is encoded by components
    bool mixed = false;                ///< rows that are encoded otherwise follow, and end where the file does
    int next = 0;                      ///< the row that the file stands at
    std::vector<unsigned char> row;
};

/// A line without its end and the blanks before it; none where there is none, or a long one.
std::optional<std::string> line_of(std::istream& file) {
    std::string line;
    for (int c; line.size() < kLongestLine && (c = file.get()) != std::char_traits<char>::eof();) {
        if (c == '\n') {
            line.resize(line.find_last_not_of(" \t\r") + 1); // 0 where there is nothing else
            return line;
        }
        line.push_back(static_cast<char>(c));
    }
    return std::nullopt;
}

bool begins_with(std::string_view line, std::string_view beginning) {
    return line.substr(0, beginning.size()) == beginning;
}

/// In which order pixels are stored: the axis and the direction of rows, then those of the pixels of a row.
struct Order {
    std::string_view rows, pixels;
    int orientation; ///< of TIFF
};
constexpr Order kOrders[] = {{"-Y ", " +X ", 1}, {"-Y ", " -X ", 2}, {"+Y ", " -X ", 3}, {"+Y ", " +X ", 4},
                             {"+X ", " -Y ", 5}, {"-X ", " -Y ", 6}, {"-X ", " +Y ", 7}, {"+X ", " +Y ", 8}};

bool take_number(std::string_view& text, std::string_view before, int& number) {
    if (!begins_with(text, before)) return false;
    text.remove_prefix(before.size());
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return error == std::errc();
}

/// "PRIMARIES= 0.64 0.33 0.29 0.6 0.15 0.06 0.333 0.333": as images::Header has them.
std::vector<float> numbers_of(std::string_view text) {
    std::vector<float> out;
    for (;;) {
        text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
        float number = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
        if (error != std::errc()) return out;
        out.push_back(number);
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    }
}

const std::vector<float> kXyz = {1, 0, 0, 1, 0, 0, 1.0f / 3, 1.0f / 3};

/// Takes what a line says of pixels: their format and primaries. What else it says, exposure, gamma and views among
/// it, renderers ignore. False where the format is none that we read.
bool take_line(std::string_view line, Radiance& picture) {
    constexpr std::string_view format = "FORMAT=", primaries = "PRIMARIES=";
    if (begins_with(line, primaries) && picture.chromaticities.empty())
        picture.chromaticities = numbers_of(line.substr(primaries.size()));
    if (!begins_with(line, format)) return true;
    const std::string_view name = line.substr(std::min(line.find_first_not_of(' ', format.size()), line.size()));
    if (name == "32-bit_rle_xyze") picture.chromaticities = kXyz;
    picture.has_format = name == "32-bit_rle_rgbe" || name == "32-bit_rle_xyze";
    return picture.has_format;
}

/// "-Y 16 +X 32": 16 rows of 32 pixels, stored from the top left corner on.
bool take_size(std::string_view line, Radiance& picture) {
    for (const Order& order : kOrders) {
        std::string_view size = line;
        if (!take_number(size, order.rows, picture.height) || !take_number(size, order.pixels, picture.width))
            continue;
        picture.orientation = order.orientation;
        return size.empty() && picture.height >= 1 && picture.height <= kMostRadianceSide && picture.width >= 1 &&
               picture.width <= kMostRadianceSide;
    }
    return false;
}

bool read_header(Radiance& picture) {
    const auto first = line_of(picture.file);
    if (!first || !begins_with(*first, "#?")) return false;
    for (std::size_t i = 0;; ++i) {
        const auto line = line_of(picture.file);
        if (!line || i == kMostLines) return false;
        if (line->empty()) break;
        if (!take_line(*line, picture)) return false;
    }
    const auto size = line_of(picture.file);
    picture.pixels = picture.file.tellg();
    return picture.has_format && size && take_size(*size, picture);
}

using Pixel = std::array<unsigned char, 4>;

bool take_pixel(std::streambuf& bytes, Pixel& pixel) {
    return bytes.sgetn(reinterpret_cast<char*>(pixel.data()), 4) == 4;
}

/// Whether a row begins as one whose components are encoded one after the other.
bool is_mark(const Radiance& picture, const Pixel& pixel) {
    return picture.width >= kFewestColumns && picture.width <= kMostColumns && pixel[0] == 2 && pixel[1] == 2 &&
           pixel[2] == picture.width >> 8 && pixel[3] == (picture.width & 255);
}

bool next_row(Radiance& picture);

void go_to(Radiance& picture, int row, std::streamoff position) {
    picture.file.clear();
    picture.file.seekg(position);
    picture.next = row;
}

void rewind(Radiance& picture) { go_to(picture, 0, picture.pixels); }

bool read_to_end(Radiance& picture) {
    while (picture.next < picture.height)
        if (!next_row(picture)) return false;
    return true;
}

/// Looks at whether rows are encoded. Those of a file that has bytes for all pixels are not, unless they end, read
/// as encoded, where the file does: its first pixel may look like the mark of a row. Behind a mark more may follow.
/// False where that is the mark of rows of another width, and damaged.
bool find_encoding(Radiance& picture) {
    Pixel first{};
    rewind(picture);
    picture.marked = take_pixel(*picture.file.rdbuf(), first) && is_mark(picture, first);
    rewind(picture);
    const std::streamoff flat = picture.pixels + 4 * std::streamoff{picture.width} * picture.height;
    if (picture.size < flat || (picture.size > flat && picture.marked)) return true;
    if (picture.size > flat && first[0] == 2 && first[1] == 2 && first[2] < 128) return false;
    picture.flat =
        (picture.size == flat && !picture.marked) || !read_to_end(picture) || picture.file.tellg() != picture.size;
    rewind(picture);
    return true;
}

void* open_radiance(const std::string& path, int, Header& header, std::string&) {
    auto picture = std::make_unique<Radiance>();
    picture->file.open(path, std::ios::binary);
    if (!read_header(*picture)) return nullptr;
    picture->file.seekg(0, std::ios::end);
    picture->size = picture->file.tellg();
    picture->row.resize(4 * static_cast<std::size_t>(picture->width));
    if (!find_encoding(*picture)) return nullptr;
    header = {};
    header.format = "hdr";
    header.data = header.display = {0, 0, picture->width, picture->height};
    header.channel_count = 3;
    header.channels = {"R", "G", "B"};
    header.floating = true;
    header.sample_bytes = sizeof(float);
    header.chromaticities = picture->chromaticities;
    return picture.release();
}

void close_radiance(void* image) { std::unique_ptr<Radiance>(static_cast<Radiance*>(image)); }

/// One of the four components of a row: runs of a byte, and bytes as they are.
bool read_component(std::streambuf& bytes, unsigned char* at, unsigned char* end) {
    while (at < end) {
        const int code = bytes.sbumpc();
        if (code < 1) return false; // the end, or a run of none
        const int count = code > 128 ? code - 128 : code;
        if (count > end - at) return false;
        if (code > 128) {
            const int value = bytes.sbumpc();
            if (value < 0) return false;
            std::memset(at, value, static_cast<std::size_t>(count));
        } else if (bytes.sgetn(reinterpret_cast<char*>(at), count) != count) {
            return false;
        }
        at += count;
    }
    return true;
}

bool read_components(Radiance& picture) {
    std::streambuf& bytes = *picture.file.rdbuf();
    const auto width = static_cast<std::size_t>(picture.width);
    for (std::size_t component = 0; component < 4; ++component)
        if (!read_component(bytes, picture.row.data() + component * width,
                            picture.row.data() + (component + 1) * width))
            return false;
    return true;
}

/// Whole pixels, of which the first is read already. In the older code 1 1 1 n stands for n more of the one before,
/// times 256 right after another such.
bool read_whole_pixels(Radiance& picture, Pixel pixel) {
    const auto width = static_cast<std::size_t>(picture.width);
    unsigned shift = 0;
    for (std::size_t x = 0;;) {
        const bool run = !picture.flat && pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1;
        if (run && (x == 0 || shift > 8)) return false; // no row is as long as that
        const std::size_t count = run ? std::size_t{pixel[3]} << shift : 1;
        if (count > width - x) return false;
        for (std::size_t component = 0; component < 4; ++component) {
            unsigned char* const at = picture.row.data() + component * width + x;
            std::memset(at, run ? at[-1] : pixel[component], count);
        }
        x += count;
        shift = run ? shift + 8 : 0;
        if (x == width) return true;
        if (!take_pixel(*picture.file.rdbuf(), pixel)) return false;
    }
}

/// Whether rows that are encoded in another way than the first end where the file does; else what looks like them
/// is damage.
bool ends_as_mixed(Radiance& picture) {
    const int row = picture.next;
    const std::streamoff position = picture.file.tellg();
    picture.mixed = true;
    picture.mixed = read_to_end(picture) && picture.file.tellg() == picture.size;
    go_to(picture, row, position);
    return picture.mixed;
}

/// Each row may be encoded in its own way.
bool next_row(Radiance& picture) {
    Pixel first;
    if (!take_pixel(*picture.file.rdbuf(), first)) return false;
    const bool components = !picture.flat && is_mark(picture, first);
    if (!picture.flat && components != picture.marked && !picture.mixed) {
        picture.file.seekg(-4, std::ios::cur);
        return ends_as_mixed(picture) && next_row(picture);
    }
    if (!(components ? read_components(picture) : read_whole_pixels(picture, first))) return false;
    ++picture.next;
    return true;
}

/// What a component is multiplied by, for each byte of the exponent.
std::array<float, 256> make_scales() {
    std::array<float, 256> scales{};
    for (int e = 1; e < 256; ++e) scales[static_cast<std::size_t>(e)] = std::ldexp(1.0f, e - (128 + 8));
    return scales;
}

void decode(const Radiance& picture, const Rows& rows, unsigned char* pixel) {
    static const std::array<float, 256> scales = make_scales();
    const auto width = static_cast<std::size_t>(picture.width);
    const unsigned char* const exponent = picture.row.data() + 3 * width;
    for (std::size_t x = 0; x < width; ++x, pixel += rows.pixel_stride)
        for (int channel = rows.first_channel; channel < rows.last_channel; ++channel) {
            const float value = static_cast<float>(picture.row[static_cast<std::size_t>(channel) * width + x]) *
                                scales[exponent[x]];
            std::memcpy(pixel + static_cast<std::size_t>(channel - rows.first_channel) * sizeof value, &value,
                        sizeof value);
        }
}

bool read_radiance(void* image, const Rows& rows, float* to, std::string& error) {
    Radiance& picture = *static_cast<Radiance*>(image);
    if (rows.first_row < picture.next) rewind(picture);
    auto* line = reinterpret_cast<unsigned char*>(to);
    while (picture.next < rows.last_row) {
        if (!next_row(picture)) {
            error = "a row is damaged or cut short";
            return false;
        }
        if (picture.next <= rows.first_row) continue;
        decode(picture, rows, line);
        line += rows.row_stride;
    }
    return true;
}

int integer_of(const void* image, const char* name, int otherwise) {
    return std::strcmp(name, "Orientation") == 0 ? static_cast<const Radiance*>(image)->orientation : otherwise;
}

} // namespace

const ImageReader& radiance_reader() {
    // Linear, whatever gamma it declares, as renderers take it: no colour space has to be named.
    static const ImageReader functions = {open_radiance, close_radiance, seek_one_part, read_radiance,
                                          no_text,       integer_of,     no_real};
    return functions;
}

} // namespace acdf::images
