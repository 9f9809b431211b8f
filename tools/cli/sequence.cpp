#include "tools/cli/sequence.h"

#include "input/sha256.h"
#include "tools/commands.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <system_error>

namespace acdf::tools {
namespace {

namespace fs = std::filesystem;

/// The number of a frame: what stands in the place of the #, all digits.
bool number_of(const std::string& name, const std::string& before, const std::string& after, std::size_t digits,
               long long& number) {
    if (name.size() < before.size() + after.size() + digits || name.rfind(before, 0) != 0 ||
        name.compare(name.size() - after.size(), after.size(), after) != 0)
        return false;
    const std::string text = name.substr(before.size(), name.size() - before.size() - after.size());
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size() && text[0] != '-' &&
           (text.size() == digits || text[0] != '0');
}

} // namespace

bool is_sequence(const std::string& source) {
    std::error_code ignored;
    return fs::path(source).filename().string().find('#') != std::string::npos && !fs::exists(source, ignored);
}

std::vector<Frame> frames_of(const std::string& sequence) {
    const fs::path path(sequence);
    const std::string name = path.filename().string();
    const std::size_t first = name.find('#'), last = name.find_last_of('#');
    const std::string before = name.substr(0, first), after = name.substr(last + 1);
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    std::vector<Frame> frames;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        long long number = 0;
        const std::string found = entry.path().filename().string();
        if (number_of(found, before, after, last - first + 1, number))
            frames.push_back({number, path.has_parent_path() ? (folder / found).string() : found});
    }
    if (frames.empty()) throw Failure(sequence + ": there are no such files; a # stands for a digit");
    std::sort(frames.begin(), frames.end(), [](const Frame& a, const Frame& b) { return a.number < b.number; });
    return frames;
}

std::string sha256_of_maps(const std::vector<std::string>& digests, const std::string& path) {
    std::string text;
    for (const std::string& digest : digests) text += digest + "\n";
    return input::text_sha256(text, path);
}

} // namespace acdf::tools
