#include "tools/cli/source_check.h"

#include "tools/cli/messages.h"
#include "tools/commands.h"

namespace acdf::tools {

bool made_from_another(const File& file, const std::string& sha256, const char* key) {
    const Text hash = file.metadata(key);
    return hash.size > 0 && std::string(hash.data, hash.size) != sha256;
}

void note_another(const std::string& path, const File& file, const std::string& source, const std::string& sha256,
                  const char* key) {
    if (made_from_another(file, sha256, key))
        say(path + ": made from another file than " + source + " (its SHA-256 differs)");
}

void require_support(const std::string& path, const File& file, const std::string& source,
                     const std::string& sha256, std::uint64_t violations) {
    if (violations == 0 || !made_from_another(file, sha256)) return;
    throw Failure(path + ": is not a file of " + source +
                  ": it was made from another source, and its pdf is 0 at " + std::to_string(violations) +
                  " points where this one has light; measure against its own source");
}

} // namespace acdf::tools
