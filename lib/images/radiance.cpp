#include "images/radiance.h"

#include "images/one_part.h"

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

constexpr int kFewestColumns = 8, kMostColumns = 32767, kMostPictureRows = 1 << 16;
constexpr std::size_t kLongestLine = 2000, kMostLines = 100; // Radiance's own commands are long

struct Radiance {
    std::ifstream file;
    int width = 0, height = 0;
    std::streamoff pixels = 0; ///< where they begin
    bool whole_pixels = false; ///< rows are not divided into components
    int next = 0;              ///< the row that the file stands at
    std::vector<unsigned char> row;
};

/// A line without its end; none where there is none, or a long one.
std::optional<std::string> line_of(std::istream& file) {
    std::string line;
    for (int c; line.size() < kLongestLine && (c = file.get()) != std::char_traits<char>::eof();) {
        if (c == '\n') return line;
        line.push_back(static_cast<char>(c));
    }
    return std::nullopt;
}

bool begins_with(std::string_view line, std::string_view beginning) {
    return line.substr(0, beginning.size()) == beginning;
}

/// Whether a line tells a command that made the picture, as Radiance's programs add one each.
bool is_command(std::string_view line) {
    const bool begins = line[0] == '\t' || (line[0] >= 'a' && line[0] <= 'z');
    const std::size_t end = line.find_first_of(" \t=", 1);
    return begins && (end == std::string_view::npos || line[end] != '=');
}

/// Whether a line of the header changes nothing of how pixels are taken.
bool is_harmless(std::string_view line) {
    return is_command(line) || begins_with(line, "VIEW=") || begins_with(line, "SOFTWARE=") ||
           begins_with(line, "#") || begins_with(line, "EXPOSURE=") || begins_with(line, "PRIMARIES=") ||
           line == "GAMMA=1" || line == "GAMMA=1.0";
}

bool take_number(std::string_view& text, std::string_view before, int& number) {
    if (!begins_with(text, before)) return false;
    text.remove_prefix(before.size());
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return error == std::errc();
}

bool read_header(Radiance& picture) {
    if (line_of(picture.file) != "#?RADIANCE") return false;
    bool encoded = false;
    for (std::size_t i = 0; i < kMostLines; ++i) {
        const auto line = line_of(picture.file);
        if (!line) return false;
        if (line->empty()) break;
        if (*line == "FORMAT=32-bit_rle_rgbe") encoded = true;
        else if (!is_harmless(*line)) return false;
    }
    const auto line = line_of(picture.file);
    std::string_view size = line ? *line : std::string_view{};
    picture.pixels = picture.file.tellg();
    return encoded && take_number(size, "-Y ", picture.height) && take_number(size, " +X ", picture.width) &&
           size.empty() && picture.height >= 1 && picture.height <= kMostPictureRows &&
           picture.width >= kFewestColumns && picture.width <= kMostColumns;
}

/// What a row begins with whose components are encoded one after the other.
std::array<int, 4> row_mark(const Radiance& picture) { return {2, 2, picture.width >> 8, picture.width & 255}; }

/// Looks at how rows are encoded. False where they are not at all: OpenImageIO reads all pixels of such pictures.
bool find_encoding(Radiance& picture) {
    std::streambuf& bytes = *picture.file.rdbuf();
    for (const int expected : row_mark(picture)) picture.whole_pixels |= bytes.sbumpc() != expected;
    picture.file.seekg(0, std::ios::end);
    const std::streamoff size = picture.file.tellg() - picture.pixels;
    picture.file.seekg(picture.pixels);
    return !picture.whole_pixels || size < 4 * std::streamoff{picture.width} * picture.height;
}

void* open_radiance(const std::string& path, int, Header& header, std::string&) {
    auto picture = std::make_unique<Radiance>();
    picture->file.open(path, std::ios::binary);
    if (!read_header(*picture) || !find_encoding(*picture)) return nullptr;
    picture->row.resize(4 * static_cast<std::size_t>(picture->width));
    header = {};
    header.format = "hdr";
    header.data = header.display = {0, 0, picture->width, picture->height};
    header.channel_count = 3;
    header.channels = {"R", "G", "B"};
    header.floating = true;
    header.sample_bytes = sizeof(float);
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
    for (const int expected : row_mark(picture))
        if (bytes.sbumpc() != expected) return false;
    for (std::size_t component = 0; component < 4; ++component)
        if (!read_component(bytes, picture.row.data() + component * width,
                            picture.row.data() + (component + 1) * width))
            return false;
    return true;
}

/// The older code: pixels, of which 1 1 1 n stands for n more of the one before, times 256 right after another
/// such.
bool read_whole_pixels(Radiance& picture) {
    std::streambuf& bytes = *picture.file.rdbuf();
    const auto width = static_cast<std::size_t>(picture.width);
    unsigned shift = 0;
    for (std::size_t x = 0; x < width;) {
        unsigned char pixel[4];
        if (bytes.sgetn(reinterpret_cast<char*>(pixel), 4) != 4) return false;
        const bool run = pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1;
        if (run && (x == 0 || shift > 8)) return false; // no row is as long as that
        const std::size_t count = run ? std::size_t{pixel[3]} << shift : 1;
        if (count > width - x) return false;
        for (std::size_t component = 0; component < 4; ++component) {
            unsigned char* const at = picture.row.data() + component * width + x;
            std::memset(at, run ? at[-1] : pixel[component], count);
        }
        x += count;
        shift = run ? shift + 8 : 0;
    }
    return true;
}

bool next_row(Radiance& picture) {
    if (!(picture.whole_pixels ? read_whole_pixels(picture) : read_components(picture))) return false;
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
    if (rows.first_row < picture.next) {
        picture.file.clear();
        picture.file.seekg(picture.pixels);
        picture.next = 0;
    }
    auto* line = reinterpret_cast<unsigned char*>(to);
    while (picture.next < rows.last_row) {
        if (!next_row(picture)) {
            error = "a row is damaged, or encoded in another way";
            return false;
        }
        if (picture.next <= rows.first_row) continue;
        decode(picture, rows, line);
        line += rows.row_stride;
    }
    return true;
}

} // namespace

const ImageReader& radiance_reader() {
    // It is upright and linear: nothing has to be said.
    static const ImageReader functions = {open_radiance, close_radiance, seek_one_part, read_radiance,
                                          no_text,       no_integer,     no_real};
    return functions;
}

} // namespace acdf::images
