#include "input/probe/gain_map.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <vector>

namespace acdf::input {
namespace {

/// The names of what says so: of namespaces in XMP, and of an application segment.
constexpr std::string_view kGainMapNames[] = {"http://ns.adobe.com/hdr-gain-map/",
                                              "urn:iso:std:iso:ts:21496:", "http://ns.apple.com/HDRGainMap/",
                                              "urn:com:apple:photo:2020:aux:hdrgainmap"};
constexpr std::size_t kLongestName = 64;

bool has_name(std::string_view text) {
    return std::any_of(std::begin(kGainMapNames), std::end(kGainMapNames),
                       [&](std::string_view name) { return text.find(name) != std::string_view::npos; });
}

} // namespace

// Anywhere: some say so in the first image alone, some in the second, behind the pixels of the first.
bool has_gain_map(const std::string& path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return false;
    std::ifstream file(path, std::ios::binary);
    char magic[3] = {};
    if (!file.read(magic, sizeof magic) || std::string_view(magic, sizeof magic) != "\xFF\xD8\xFF") return false;
    file.seekg(0);
    std::vector<char> block(kLongestName + (1 << 20)); // its first bytes are the last of the one before
    std::size_t kept = 0;
    while (file) {
        file.read(block.data() + kept, static_cast<std::streamsize>(block.size() - kept));
        const std::string_view text(block.data(), kept + static_cast<std::size_t>(file.gcount()));
        if (has_name(text)) return true;
        kept = std::min(kLongestName, text.size());
        std::copy(text.end() - static_cast<std::ptrdiff_t>(kept), text.end(), block.begin());
    }
    return false;
}

} // namespace acdf::input
