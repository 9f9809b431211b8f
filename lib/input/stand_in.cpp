#include "input/stand_in.h"

#include "input/error.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string_view>

namespace acdf::input {
namespace {

bool begins_with(std::string_view text, std::string_view beginning) {
    return text.substr(0, beginning.size()) == beginning;
}

std::string beginning_of(const std::string& path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return {}; // reading a pipe would consume it
    std::string out(512, '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(out.data(), static_cast<std::streamsize>(out.size()));
    out.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
    return out;
}

/// Whether a text begins with a tag, behind a byte order mark and blanks.
bool is_markup(std::string_view text) {
    if (begins_with(text, "\xEF\xBB\xBF")) text.remove_prefix(3);
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    if (text.size() < 2 || text[0] != '<') return false;
    const char c = text[1];
    return c == '!' || c == '?' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

std::string stand_in(std::string_view text) {
    if (begins_with(text, "version https://git-lfs") || begins_with(text, "version https://hawser"))
        return "it is a Git LFS pointer, not the file itself; fetch that (git lfs pull)";
    if (begins_with(text, "/annex/objects/"))
        return "it is a git-annex pointer, not the file itself; fetch that (git annex get)";
    if (is_markup(text))
        return "it is a web page (HTML or XML), as servers send in place of a file; download the file itself";
    return {};
}

} // namespace

void refuse_stand_in(const std::string& path) {
    if (const std::string what = stand_in(beginning_of(path)); !what.empty()) throw input_error(path, what);
}

} // namespace acdf::input
