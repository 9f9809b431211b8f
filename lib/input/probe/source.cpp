#include "input/probe/source.h"

#include "input/file_name.h"
#include "input/sha256.h"

#include <algorithm>
#include <filesystem>

namespace acdf::input {
namespace {

constexpr std::ptrdiff_t kCommas = 5; // between six faces

} // namespace

std::vector<std::string> probe_files(const std::string& source) {
    std::error_code none;
    if (std::count(source.begin(), source.end(), ',') != kCommas || std::filesystem::exists(source, none))
        return {source};
    std::vector<std::string> files;
    std::size_t begin = 0;
    for (std::size_t comma; (comma = source.find(',', begin)) != std::string::npos; begin = comma + 1)
        files.push_back(source.substr(begin, comma - begin));
    files.push_back(source.substr(begin));
    return files;
}

std::string probe_name(const std::string& source) { return with_paths(source, file_name); }

std::string probe_sha256(const std::string& source) {
    const std::vector<std::string> files = probe_files(source);
    if (files.size() == 1) return file_sha256(source);
    std::string digests;
    for (const std::string& file : files) digests += file_sha256(file) + "\n";
    return text_sha256(digests, source);
}

std::string with_paths(const std::string& source, const std::function<std::string(const std::string&)>& change) {
    std::string out;
    for (const std::string& file : probe_files(source)) out += (out.empty() ? "" : ",") + change(file);
    return out;
}

} // namespace acdf::input
