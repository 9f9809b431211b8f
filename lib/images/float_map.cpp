#include "images/float_map.h"

#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string_view>

namespace acdf::images {
namespace {

constexpr int kMostOnASide = 1 << 16;
constexpr std::size_t kLongestHeader = 64, kTexel = 3 * sizeof(float);

struct Layout {
    int width = 0, height = 0;
    std::size_t header = 0; ///< bytes; rows follow, the lowest first
};

struct FloatMap {
    std::ifstream file;
    Layout layout;
};

bool little_endian() {
    const std::uint16_t one = 1;
    unsigned char first;
    std::memcpy(&first, &one, 1);
    return first == 1;
}

/// What a text begins with, taken off it.
bool take(std::string_view& text, std::string_view beginning) {
    if (text.substr(0, beginning.size()) != beginning) return false;
    text.remove_prefix(beginning.size());
    return true;
}
/// The end of a line, as Windows writes it, too: OpenImageIO takes what follows the first blank for numbers. The
/// size of the file says who is right.
bool take_line_end(std::string_view& text) {
    while (take(text, " ") || take(text, "\r")) {
    }
    return take(text, "\n");
}
bool take(std::string_view& text, int& side) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), side);
    if (error != std::errc() || side < 1 || side > kMostOnASide) return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return true;
}

std::optional<Layout> parse(std::string_view header) {
    Layout layout;
    std::string_view rest = header;
    if (!(take(rest, "PF") && take_line_end(rest) && take(rest, layout.width) && take(rest, " ") &&
          take(rest, layout.height) && take_line_end(rest) && take(rest, "-1")))
        return std::nullopt;
    if (take(rest, "."))
        while (take(rest, "0")) {
        }
    if (!take_line_end(rest)) return std::nullopt;
    layout.header = header.size() - rest.size();
    return layout;
}

std::optional<Layout> layout_of(std::ifstream& file, std::uintmax_t bytes) {
    char begin[kLongestHeader];
    file.read(begin, sizeof begin);
    const auto layout = parse({begin, static_cast<std::size_t>(file.gcount())});
    file.clear(); // a map of one texel is shorter
    if (!layout) return std::nullopt;
    const std::uintmax_t texels =
        static_cast<std::uintmax_t>(layout->width) * static_cast<std::uintmax_t>(layout->height);
    return bytes == layout->header + texels * kTexel ? layout : std::nullopt;
}

/// Null where it is none.
std::unique_ptr<FloatMap> open_map(const std::string& path) {
    std::error_code error; // a pipe is not looked into
    if (!little_endian() || !std::filesystem::is_regular_file(path, error)) return nullptr;
    const std::uintmax_t bytes = std::filesystem::file_size(path, error);
    if (error) return nullptr;
    auto map = std::make_unique<FloatMap>();
    map->file.open(path, std::ios::binary);
    const auto layout = layout_of(map->file, bytes);
    if (!layout) return nullptr;
    map->layout = *layout;
    return map;
}

void* open(const std::string& path, int, Header& header, std::string&) {
    std::unique_ptr<FloatMap> map = open_map(path);
    if (!map) return nullptr;
    header = {};
    header.format = "pnm";
    header.data = header.display = {0, 0, map->layout.width, map->layout.height};
    header.channel_count = 3;
    header.channels = {"R", "G", "B"};
    header.floating = true;
    header.sample_bytes = sizeof(float);
    return map.release();
}

void close(void* image) { std::unique_ptr<FloatMap>(static_cast<FloatMap*>(image)); }

bool seek(void*, int part, Header&) { return part == 0; }

bool read_row(FloatMap& map, int row, float* rgb) {
    const auto width = static_cast<std::size_t>(map.layout.width),
               below = static_cast<std::size_t>(map.layout.height - 1 - row);
    map.file.seekg(static_cast<std::streamoff>(map.layout.header + below * width * kTexel));
    map.file.read(reinterpret_cast<char*>(rgb), static_cast<std::streamsize>(width * kTexel));
    return static_cast<bool>(map.file);
}

bool read(void* image, const Rows& rows, float* to, std::string& error) {
    FloatMap& map = *static_cast<FloatMap*>(image);
    std::vector<float> rgb(static_cast<std::size_t>(map.layout.width) * 3);
    auto* line = reinterpret_cast<unsigned char*>(to);
    for (int row = rows.first_row; row < rows.last_row; ++row, line += rows.row_stride) {
        if (!read_row(map, row, rgb.data())) {
            error = "it ends too early";
            return false;
        }
        unsigned char* pixel = line;
        const std::size_t size = static_cast<std::size_t>(rows.last_channel - rows.first_channel) * sizeof(float);
        for (std::size_t x = 0; x < rgb.size(); x += 3, pixel += rows.pixel_stride)
            std::memcpy(pixel, &rgb[x + static_cast<std::size_t>(rows.first_channel)], size);
    }
    return true;
}

// It has no attributes.
std::string text(const void*, const char*) { return ""; }
int integer(const void*, const char*, int otherwise) { return otherwise; }
float real(const void*, const char*, float otherwise) { return otherwise; }

} // namespace

const ImageReader& float_map_reader() {
    static const ImageReader functions = {open, close, seek, read, text, integer, real};
    return functions;
}

} // namespace acdf::images
