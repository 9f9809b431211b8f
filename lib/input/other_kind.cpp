#include "input/other_kind.h"

#include "input/merl.h"

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

constexpr Beginning beginnings[] = {
    {"\xab\x41\x43\x44\x46", 5, "it is an .acdf file; give the image that it was made from"},
    {"tensor_file", 11, "it is a BRDF of the RGL database, which acdf brdf takes"},
    {"\x93NUMPY", 6, "it is a NumPy array, which acdf table takes"},
};

} // namespace

std::string kind_of_no_image(const std::string& path) {
    char first[12] = {};
    std::ifstream(path, std::ios::binary).read(first, sizeof first);
    for (const Beginning& beginning : beginnings)
        if (std::memcmp(first, beginning.bytes, beginning.size) == 0) return beginning.text;
    std::error_code error;
    if (std::filesystem::file_size(path, error) == MerlLayout::bytes && !error)
        return "it is a MERL BRDF, which acdf brdf takes";
    return {};
}

} // namespace acdf::input
