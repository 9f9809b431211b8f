#include "images/openexr_header.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>

namespace acdf::images {
namespace {

constexpr std::size_t kBegin = 8; // its number, the version, flags

bool is_openexr(const std::array<unsigned char, kBegin>& begin) {
    return begin[0] == 0x76 && begin[1] == 0x2F && begin[2] == 0x31 && begin[3] == 0x01 && begin[4] == 2;
}

std::array<unsigned char, kBegin> read_begin(std::istream& in) {
    std::array<unsigned char, kBegin> begin{};
    in.read(reinterpret_cast<char*>(begin.data()), kBegin);
    return begin;
}

/// A name or a type, at most 255 bytes long; nothing after the last attribute of a header.
std::string read_name(std::istream& in) {
    std::array<char, 256> name{};
    in.getline(name.data(), name.size(), '\0');
    return name.data();
}

std::int64_t read_size(std::istream& in) {
    std::array<unsigned char, 4> bytes{};
    in.read(reinterpret_cast<char*>(bytes.data()), bytes.size());
    return std::int64_t{bytes[0]} | std::int64_t{bytes[1]} << 8 | std::int64_t{bytes[2]} << 16 |
           std::int64_t{bytes[3]} << 24;
}

} // namespace

bool is_usual_openexr(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    const auto begin = read_begin(in);
    constexpr unsigned kTilesDeepOrParts = 0x1A;
    return is_openexr(begin) && (begin[5] & kTilesDeepOrParts) == 0;
}

std::string openexr_claims_too_much(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    const auto begin = read_begin(in);
    if (!in || !is_openexr(begin)) return {};
    std::error_code error;
    const std::uintmax_t file_bytes = std::filesystem::file_size(path, error);
    if (error) return {};
    constexpr unsigned kParts = 0x10;
    const bool has_parts = begin[5] & kParts;
    bool after_header = false;
    for (;;) {
        if (read_name(in).empty()) {
            if (!in || !has_parts || after_header) return {}; // no header is empty
            after_header = true;
            continue;
        }
        after_header = false;
        read_name(in); // its type
        const std::streamoff at = in.tellg();
        const std::int64_t size = read_size(in);
        if (!in) return {};
        constexpr std::int64_t kMost = INT32_MAX; // of what is above that, or negative, libraries ask nothing
        const std::uintmax_t left = file_bytes - static_cast<std::uintmax_t>(in.tellg());
        if (size <= kMost && static_cast<std::uintmax_t>(size) > left)
            return "at byte " + std::to_string(at) + " an attribute of its header claims " + std::to_string(size) +
                   " bytes, where " + std::to_string(left) + " follow";
        in.seekg(size, std::ios::cur);
    }
}

} // namespace acdf::images
