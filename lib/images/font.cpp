#include "images/font.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <vector>

namespace acdf::images {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> font_folders() {
    std::vector<fs::path> folders;
    if (const char* home = std::getenv("HOME"); home && *home)
        for (const char* folder : {"fonts", "Fonts", ".local/share/fonts"})
            folders.push_back(fs::path(home) / folder);
    for (const char* folder : {"/usr/share/fonts", "/usr/local/share/fonts", "/opt/local/share/fonts"})
        folders.emplace_back(folder);
    return folders;
}

bool is_font(const fs::directory_entry& entry, const std::string& name) {
    const fs::path file = entry.path().filename();
    std::error_code error;
    return file.stem() == name &&
           (file.extension() == ".ttf" || file.extension() == ".pfa" || file.extension() == ".pfb") &&
           entry.is_regular_file(error);
}

/// The first by its path, since folders have no order.
std::string font_below(const fs::path& folder, const std::string& name) {
    std::string first;
    std::error_code error;
    fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied, error);
    for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error))
        if (is_font(*entry, name))
            first = first.empty() ? entry->path().string() : std::min(first, entry->path().string());
    return first;
}

} // namespace

std::string find_font_file(const std::string& name) {
    for (const fs::path& folder : font_folders())
        if (std::string found = font_below(folder, name); !found.empty()) return found;
    return {};
}

} // namespace acdf::images
