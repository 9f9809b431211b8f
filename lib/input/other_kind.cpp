#include "input/other_kind.h"

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace acdf::input {
namespace {

struct Beginning {
    const char* bytes;
    std::size_t size;
    const char* text;
};

constexpr char acdf_magic[] = "\xab\x41\x43\x44\x46";

constexpr Beginning of_no_image[] = {
    {acdf_magic, 5, "it is an .acdf file; give the image that it was made from"},
    {"tensor_file", 11, "it is a BRDF of the RGL database, which acdf brdf takes"},
    {"\x93NUMPY", 6, "it is a NumPy array, which acdf table takes"},
    {"\x5a\0\0\0\x5a\0\0\0\xb4\0\0\0", 12, "it is a MERL BRDF, which acdf brdf takes"}, // 90, 90, 180 bins
};

constexpr Beginning of_no_brdf[] = {
    {acdf_magic, 5, "it is an .acdf file; give the BRDF that it was made from"},
    {"\x76\x2f\x31\x01", 4, "it is an OpenEXR image, which acdf env takes"},
    {"#?", 2, "it is a Radiance image, which acdf env takes"},
};

template <std::size_t N>
std::string told_by_beginning(const std::string& path, const Beginning (&known)[N]) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return {}; // reading a pipe would consume it
    char first[12] = {};
    std::ifstream(path, std::ios::binary).read(first, sizeof first);
    for (const Beginning& beginning : known)
        if (std::memcmp(first, beginning.bytes, beginning.size) == 0) return beginning.text;
    return {};
}

/// Whether a file of the RGL database holds Mueller matrices, by the names of its fields.
bool is_polarised(const std::string& path) {
    constexpr std::size_t begin = 18, most = 4096; // behind magic, version and count; the names come first
    std::string first(most, '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(first.data(), static_cast<std::streamsize>(first.size()));
    if (first.compare(0, 11, "tensor_file") != 0) return false;
    bool matrices = false;
    for (std::size_t at = begin; at + 2 <= most;) {
        const auto byte = [&](std::size_t i) {
            return i < most ? std::size_t{static_cast<std::uint8_t>(first[i])} : 0;
        };
        const std::size_t length = byte(at) | byte(at + 1) << 8;
        if (length == 0 || at + 2 + length + 11 > most) break;
        const std::string name = first.substr(at + 2, length);
        if (name == "vndf") return false;
        matrices |= name == "M";
        const std::size_t dimensions = byte(at + 2 + length) | byte(at + 3 + length) << 8;
        at += 2 + length + 2 + 1 + 8 + 8 * dimensions;
    }
    return matrices;
}

} // namespace

std::string kind_of_no_brdf(const std::string& path) { return told_by_beginning(path, of_no_brdf); }

std::string kind_of_no_image(const std::string& path) {
    std::string kind = told_by_beginning(path, of_no_image);
    return !kind.empty() && is_polarised(path)
               ? "it is a polarised BRDF of the RGL database, which acdf does not read"
               : kind;
}

} // namespace acdf::input
