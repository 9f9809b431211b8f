#include "tools/cli/file_input.h"

#include "build/text/format_names.h"
#include "rules/signatures.h"
#include "tools/cli/sizes.h"
#include "tools/commands.h"

#include <acdf/curves/curves.h>
#include <acdf/layout.h>
#include <acdf/visibility/visibility.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include <sys/stat.h>

namespace acdf::tools {
namespace {

std::string shown(const std::string& path) { return path == "-" ? "stdin" : path; }

struct Close {
    void operator()(std::FILE* file) const {
        if (file != stdin) std::fclose(file);
    }
};

std::unique_ptr<std::FILE, Close> open_input(const std::string& path) {
    if (path == "-") return std::unique_ptr<std::FILE, Close>(stdin);
    std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "rb"));
    if (!file)
        throw Failure(path + ": cannot open: " + std::strerror(errno) +
                      (errno == ENOENT ? "; check the name and the folder" : ""));
    return file;
}

} // namespace

void refuse_endless(const std::string& path) {
    struct stat status = {};
    if (path == "-" || stat(path.c_str(), &status) != 0) return;
    if (S_ISDIR(status.st_mode)) throw Failure(path + ": is a folder; give the name of a file in it");
    if (!S_ISREG(status.st_mode))
        throw Failure(path + ": is a pipe or a device; give a file, or - and send it to stdin");
}

namespace {

/// All bytes, or the first few where `goes_on` says of them that the rest is not worth reading.
template <class GoesOn>
std::vector<std::uint8_t> read_while(const std::string& path, std::uint64_t most, GoesOn goes_on) {
    refuse_endless(path);
    const auto file = open_input(path);
    std::vector<std::uint8_t> bytes;
    std::uint8_t buffer[65536];
    while (const std::size_t n = std::fread(buffer, 1, sizeof(buffer), file.get())) {
        const bool first = bytes.empty();
        bytes.insert(bytes.end(), buffer, buffer + n);
        if (bytes.size() > most)
            throw Failure(shown(path) + ": it is longer than " + to_readable_size(most) + ", so no such file");
        if (first && !goes_on(bytes)) break;
    }
    if (std::ferror(file.get())) throw Failure(shown(path) + ": cannot read: " + std::strerror(errno));
    return bytes;
}

} // namespace

bool has_magic(const std::vector<std::uint8_t>& bytes) {
    constexpr std::uint8_t magic[] = ACDF_MAGIC_BYTES;
    return bytes.size() >= sizeof magic && std::memcmp(bytes.data(), magic, sizeof magic) == 0;
}

std::vector<std::uint8_t> read_bytes(const std::string& path, std::uint64_t most) {
    return read_while(path, most, [](const std::vector<std::uint8_t>&) { return true; });
}

std::vector<std::uint8_t> read_acdf_bytes(const std::string& path) {
    return read_while(path, Limits().max_file_bytes, has_magic);
}

namespace {

/// As File::from_memory, and checks what rooms beside the reader read of the file.
Status open_bytes(const std::uint8_t* data, std::size_t size, File& file, IndexedEnvironment& maps) {
    VisibleLocalView view;
    const Status status = File::from_memory(data, size, file, with_curves());
    if (!status.ok()) return status;
    if (file.kind() == ACDF_KIND_LOCAL) return VisibleLocalView::of(file, view);
    return file.kind() == ACDF_KIND_INDEXED ? IndexedEnvironment::open(file, maps) : status;
}

} // namespace

LoadedFile load_file(const std::string& path) {
    LoadedFile loaded;
    loaded.bytes = read_acdf_bytes(path);
    const Status status = open_bytes(loaded.bytes.data(), loaded.bytes.size(), loaded.file, loaded.maps);
    if (status.ok()) return loaded;
    if (status.rule == 2002)
        throw Failure(shown(path) + ": " + what_is_it(loaded.bytes.data(), loaded.bytes.size()));
    std::string text = shown(path) + ": " + status.message;
    if (status.code == ACDF_MALFORMED) text += "; `acdf validate` lists every fault";
    throw Failure(text);
}

void check_reads_back(const std::uint8_t* data, std::size_t size) {
    File file;
    IndexedEnvironment maps;
    if (const Status status = open_bytes(data, size, file, maps); !status.ok())
        throw Failure(std::string("cannot read back what was written: ") + status.message);
}

void fail_kind(const std::string& path, const File& file, const char* command, const char* wanted) {
    throw Failure(shown(path) + ": holds a file of kind '" + build::kind_name(file.kind()) + "'; acdf " + command +
                  " reads " + wanted);
}

LoadedFile load_environment(const std::string& path, const char* command) {
    LoadedFile loaded = load_file(path);
    if (loaded.file.kind() != ACDF_KIND_ENVIRONMENT)
        fail_kind(path, loaded.file, command, "environments, as `acdf env` makes them");
    return loaded;
}

LoadedFile load_environment_or_table(const std::string& path, const char* command) {
    LoadedFile loaded = load_file(path);
    if (loaded.file.kind() != ACDF_KIND_ENVIRONMENT && loaded.file.kind() != ACDF_KIND_TABLE)
        fail_kind(path, loaded.file, command, "environments and tables, as `acdf env` and `acdf table` make them");
    return loaded;
}

} // namespace acdf::tools
