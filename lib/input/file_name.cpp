#include "input/file_name.h"

#include "input/error.h"
#include "input/stand_in.h"
#include "reader/utf8.h"

#include <cstdint>
#include <filesystem>
#include <system_error>

namespace acdf::input {

std::string file_name(const std::string& path) {
    const std::string name = std::filesystem::path(path).filename().string();
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(name.data());
    std::string out;
    for (std::size_t i = 0; i < name.size();) {
        const std::size_t length = utf8_sequence(bytes + i, name.size() - i);
        out += length > 0 ? name.substr(i, length) : "\xEF\xBF\xBD";
        i += length > 0 ? length : 1;
    }
    return out;
}

std::string lower(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

std::string lower_extension(const std::string& path) {
    return lower(std::filesystem::path(path).extension().string());
}

void require_regular_file(const std::string& path, const char* give) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) // an error that says only so is none to status()
        throw input_error(
            path, "it cannot be opened: " +
                      (error ? error : std::make_error_code(std::errc::no_such_file_or_directory)).message());
    if (std::filesystem::is_directory(status)) throw input_error(path, std::string("it is a folder; give ") + give);
    if (!std::filesystem::is_regular_file(status))
        throw input_error(path, std::string("it is a pipe or a device; give ") + give);
    refuse_stand_in(path);
}

} // namespace acdf::input
