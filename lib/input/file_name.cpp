#include "input/file_name.h"

#include "input/image.h"
#include "reader/utf8.h"

#include <cstdint>
#include <filesystem>

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

void require_regular_file(const std::string& path, const char* give) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status))
        throw input_error(path, status.type() == std::filesystem::file_type::not_found
                                    ? "it cannot be opened: there is no such file"
                                    : "it cannot be opened: " + error.message());
    if (std::filesystem::is_directory(status)) throw input_error(path, std::string("it is a folder; give ") + give);
    if (!std::filesystem::is_regular_file(status))
        throw input_error(path, std::string("it is a pipe or a device; give ") + give);
}

} // namespace acdf::input
