#include "images/float_map.h"

#include "images/one_part.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string_view>

namespace acdf::images {
namespace {

constexpr int kMostOnASide = 1 << 16;
constexpr std::size_t kLongestHeader = 1024;

struct Layout {
    int width = 0, height = 0, channels = 0;
    float scale = 0;        ///< what numbers are multiplied with
    bool swapped = false;   ///< bytes are not in the order of this machine
    std::size_t header = 0; ///< bytes; rows follow, the lowest first

    std::size_t row() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(channels); }
    std::uintmax_t bytes() const {
        return header + std::uintmax_t{sizeof(float)} * row() * static_cast<unsigned>(height);
    }
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
bool take_blank(std::string_view& text) {
    return take(text, " ") || take(text, "\n") || take(text, "\r") || take(text, "\t");
}
/// Blanks, and comments to the ends of their lines.
bool take_gap(std::string_view& text) {
    if (!take_blank(text)) return false;
    while (take_blank(text) || take(text, "#"))
        if (text.data()[-1] == '#') text.remove_prefix(std::min(text.find('\n'), text.size()));
    return true;
}
template <class Number>
bool take_number(std::string_view& text, Number& number) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return error == std::errc();
}
bool is_side(int side) { return side >= 1 && side <= kMostOnASide; }

/// All but `header`, taken off a text up to the end of the last number.
std::optional<Layout> take_layout(std::string_view& text) {
    Layout layout;
    layout.channels = take(text, "PF4") ? 4 : take(text, "PF") ? 3 : take(text, "Pf") ? 1 : 0;
    if (!(layout.channels && take_gap(text) && take_number(text, layout.width) && take_gap(text) &&
          take_number(text, layout.height) && take_gap(text) && take_number(text, layout.scale)))
        return std::nullopt;
    if (!is_side(layout.width) || !is_side(layout.height) || !std::isfinite(layout.scale) || layout.scale == 0)
        return std::nullopt;
    layout.swapped = (layout.scale < 0) != little_endian();
    layout.scale = std::abs(layout.scale);
    return layout;
}

/// Numbers follow one blank, or a line's end as Windows writes it: the size of the file shows which of them.
/// OpenImageIO takes what follows the first blank for numbers.
std::optional<Layout> parse(std::string_view beginning, std::uintmax_t bytes) {
    std::string_view rest = beginning;
    std::optional<Layout> layout = take_layout(rest);
    while (layout && take_blank(rest)) {
        layout->header = beginning.size() - rest.size();
        if (layout->bytes() == bytes) return layout;
        if (rest.data()[-1] == '\n') break;
    }
    return std::nullopt;
}

std::optional<Layout> layout_of(std::ifstream& file, std::uintmax_t bytes) {
    char begin[kLongestHeader];
    file.read(begin, sizeof begin);
    const auto layout = parse({begin, static_cast<std::size_t>(file.gcount())}, bytes);
    file.clear(); // small maps are shorter
    return layout;
}

/// Null where it is none.
std::unique_ptr<FloatMap> open_map(const std::string& path) {
    std::error_code error;
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
    header.channel_count = map->layout.channels;
    header.channels = {"R", "G", "B", "A"};
    header.channels.resize(static_cast<std::size_t>(header.channel_count));
    if (header.channel_count == 1) header.channels = {"Y"};
    header.floating = true;
    header.sample_bytes = sizeof(float);
    return map.release();
}

void close(void* image) { std::unique_ptr<FloatMap>(static_cast<FloatMap*>(image)); }

void swap_bytes(std::vector<float>& numbers) {
    for (float& number : numbers) {
        unsigned char bytes[sizeof(float)];
        std::memcpy(bytes, &number, sizeof bytes);
        std::reverse(std::begin(bytes), std::end(bytes));
        std::memcpy(&number, bytes, sizeof bytes);
    }
}

bool read_row(FloatMap& map, int row, std::vector<float>& numbers) {
    const Layout& layout = map.layout;
    const std::size_t size = sizeof(float) * layout.row(),
                      below = static_cast<std::size_t>(layout.height - 1 - row);
    map.file.seekg(static_cast<std::streamoff>(layout.header + below * size));
    map.file.read(reinterpret_cast<char*>(numbers.data()), static_cast<std::streamsize>(size));
    if (layout.swapped) swap_bytes(numbers);
    if (layout.scale != 1)
        for (float& number : numbers) number *= layout.scale;
    return static_cast<bool>(map.file);
}

bool read(void* image, const Rows& rows, float* to, std::string& error) {
    FloatMap& map = *static_cast<FloatMap*>(image);
    std::vector<float> numbers(map.layout.row());
    const auto channels = static_cast<std::size_t>(map.layout.channels);
    auto* line = reinterpret_cast<unsigned char*>(to);
    for (int row = rows.first_row; row < rows.last_row; ++row, line += rows.row_stride) {
        if (!read_row(map, row, numbers)) {
            error = "it ends too early";
            return false;
        }
        unsigned char* pixel = line;
        const std::size_t size = static_cast<std::size_t>(rows.last_channel - rows.first_channel) * sizeof(float);
        for (std::size_t x = 0; x < numbers.size(); x += channels, pixel += rows.pixel_stride)
            std::memcpy(pixel, &numbers[x + static_cast<std::size_t>(rows.first_channel)], size);
    }
    return true;
}

} // namespace

const ImageReader& float_map_reader() {
    static const ImageReader functions = {open, close, seek_one_part, read, no_text, no_integer, no_real};
    return functions;
}

} // namespace acdf::images
