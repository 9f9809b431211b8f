// `File`: reading, ownership and access. What is right and wrong is decided in check*.cpp.
#include "check.h"
#include "make_cells.h"
#include "make_local_tables.h"

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace acdf {

namespace {

using u8 = std::uint8_t;
using u32 = std::uint32_t;
using u64 = std::uint64_t;
using ull = unsigned long long;

// One line of whole characters: paths may hold anything, and the buffer may have cut the last sequence.
void tidy(char* message) {
    std::size_t size = std::strlen(message), tail = size;
    while (tail > 0 && size - tail < 3 && (message[tail - 1] & 0xC0) == 0x80) --tail;
    if (tail > 0 && (message[tail - 1] & 0x80)) { // the first byte of the last sequence
        const u8 first = static_cast<u8>(message[tail - 1]);
        const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
        if (size - (tail - 1) < length) message[tail - 1] = 0;
    }
    for (char* c = message; *c; ++c)
        if (static_cast<u8>(*c) < 0x20 || *c == 0x7F) *c = '?';
}

Status failure(const Finding& finding) {
    Status status;
    status.code = finding.rule->code;
    status.rule = finding.rule->number;
    status.offset = finding.offset;
    std::snprintf(status.message, sizeof status.message, "%s (rule %d at byte %llu: %s)", finding.detail,
                  finding.rule->number, static_cast<ull>(finding.offset), finding.rule->sentence);
    tidy(status.message);
    return status;
}

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
Status
failure(int rule, const char* format, ...) {
    Finding finding;
    char detail[160];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(detail, sizeof detail, format, arguments);
    va_end(arguments);
    finding.rule = find_rule(rule);
    finding.detail = detail;
    return failure(finding);
}

// Puts the path in front; of a long one the end, which tells files apart.
void name_file(Status& status, const char* path) {
    constexpr std::size_t longest = 100;
    const std::size_t length = std::strlen(path);
    const char* shown = length > longest ? path + (length - longest) : path;
    while (shown > path && (*shown & 0xC0) == 0x80) ++shown;
    Status whole = status;
    std::snprintf(whole.message, sizeof whole.message, "%s%s: %.200s", shown > path ? "..." : "", shown,
                  status.message);
    tidy(whole.message);
    status = whole;
}

bool first_error(const Finding& finding, void* status) {
    if (finding.rule->severity == Severity::warning) return true;
    *static_cast<Status*>(status) = failure(finding);
    return false;
}

struct Bytes {
    void* data = nullptr;
    u64 size = 0;
};

Status allocate(u64 size, Bytes& bytes) {
    bytes.size = size;
    bytes.data = std::aligned_alloc(ACDF_ALIGNMENT, (size / ACDF_ALIGNMENT + 1) * ACDF_ALIGNMENT);
    return bytes.data ? Status{} : failure(1003, "%llu bytes", static_cast<ull>(size));
}

Status check_limit(u64 size, const Limits& limits) {
    if (size <= limits.max_file_bytes) return {};
    return failure(1004, "%llu bytes, the limit is %llu", static_cast<ull>(size),
                   static_cast<ull>(limits.max_file_bytes));
}

Status read_all(int descriptor, const Bytes& bytes) {
    for (u64 done = 0; done < bytes.size;) {
        constexpr u64 step = u64{1} << 30;
        const u64 left = bytes.size - done;
        const ssize_t n = ::read(descriptor, static_cast<u8*>(bytes.data) + done, left < step ? left : step);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return failure(1002, "%s", std::strerror(errno));
        if (n == 0) return failure(1002, "it shrank to %llu bytes while being read", static_cast<ull>(done));
        done += static_cast<u64>(n);
    }
    return {};
}

Status read_descriptor(int descriptor, const Limits& limits, Bytes& bytes) {
    struct stat info;
    if (::fstat(descriptor, &info) != 0) return failure(1002, "%s", std::strerror(errno));
    if (S_ISDIR(info.st_mode)) return failure(1002, "it is a directory");
    if (!S_ISREG(info.st_mode)) return failure(1002, "it is a pipe or a device");
    const u64 size = static_cast<u64>(info.st_size);
    if (Status status = check_limit(size, limits); !status.ok()) return status;
    if (Status status = allocate(size, bytes); !status.ok()) return status;
    return read_all(descriptor, bytes);
}

Status read_path(const char* path, const Limits& limits, Bytes& bytes) {
    const int descriptor = ::open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC); // nonblocking: a pipe is refused
    if (descriptor < 0) return failure(1001, "%s", std::strerror(errno));
    const Status status = read_descriptor(descriptor, limits, bytes);
    ::close(descriptor);
    return status;
}

u32 load_u32(const u8* bytes) {
    u32 value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

// Reads a length and its text, and moves behind them.
Text next_text(const u8*& at) {
    const Text text{reinterpret_cast<const char*>(at) + 4, load_u32(at)};
    at += 4 + text.size;
    return text;
}

} // namespace

File::~File() {
    for (void* block : owned_) std::free(block);
}

File::File(File&& other) noexcept { *this = std::move(other); }

File& File::operator=(File&& other) noexcept {
    if (this == &other) return *this;
    for (void* block : owned_) std::free(block);
    bytes_ = std::exchange(other.bytes_, nullptr);
    size_ = std::exchange(other.size_, 0);
    description_ = std::exchange(other.description_, nullptr);
    axes_ = std::exchange(other.axes_, nullptr);
    bins_ = std::exchange(other.bins_, nullptr);
    tree_ = std::exchange(other.tree_, nullptr);
    tree_units_ = std::exchange(other.tree_units_, 0);
    blend_ = std::exchange(other.blend_, AcdfBlend{});
    local_ = std::exchange(other.local_, nullptr);
    lights_ = std::exchange(other.lights_, nullptr);
    company_ = std::exchange(other.company_, nullptr);
    views_ = std::exchange(other.views_, nullptr);
    nodes_ = std::exchange(other.nodes_, nullptr);
    metadata_ = std::exchange(other.metadata_, nullptr);
    metadata_count_ = std::exchange(other.metadata_count_, 0);
    cells_ = std::exchange(other.cells_, nullptr);
    local_tables_ = std::exchange(other.local_tables_, nullptr);
    for (int i = 0; i < 3; ++i) owned_[i] = std::exchange(other.owned_[i], nullptr);
    return *this;
}

Status File::open(const char* path, File& file, const LoadOptions& options) noexcept {
    Bytes bytes;
    file = File();
    if (!path) return failure(1001, "no path is given");
    Status status = read_path(path, options.limits, bytes);
    if (status.ok()) status = from_memory(bytes.data, bytes.size, file, options);
    if (status.ok()) {
        file.owned_[0] = bytes.data;
        return status;
    }
    std::free(bytes.data);
    name_file(status, path);
    return status;
}

Status File::from_memory(const void* data, std::size_t size, File& file, const LoadOptions& options) noexcept {
    File loaded;
    file = File();
    if (Status status = check_limit(size, options.limits); !status.ok()) return status;
    if (reinterpret_cast<std::uintptr_t>(data) % alignof(AcdfHeader) != 0) {
        Bytes copy;
        if (Status status = allocate(size, copy); !status.ok()) return status;
        loaded.owned_[0] = std::memcpy(copy.data, data, size);
        data = copy.data;
    }
    Status status;
    Parts parts;
    check(static_cast<const u8*>(data), size, options.limits, first_error, &status, parts);
    loaded.owned_[1] = parts.inflated;
    if (!status.ok()) return status;
    loaded.bytes_ = static_cast<const u8*>(data);
    loaded.size_ = size;
    loaded.description_ = parts.description;
    loaded.axes_ = parts.axes;
    loaded.bins_ = parts.bins;
    loaded.tree_ = parts.tree;
    loaded.tree_units_ = parts.tree_units;
    loaded.blend_ = {parts.tiles, parts.splits, parts.tile_roots, parts.rows, parts.tree};
    loaded.local_ = parts.local;
    loaded.lights_ = parts.lights;
    loaded.company_ = parts.company;
    loaded.views_ = parts.views;
    loaded.nodes_ = parts.nodes;
    loaded.metadata_ = parts.metadata;
    loaded.metadata_count_ = parts.metadata_count;
    if (options.tables) loaded.make_tables();
    file = std::move(loaded);
    return status;
}

// They are only for speed: where there is no memory for them, the file is as good without.
void File::make_tables() noexcept {
    const u64 most = 8 * size_ + (u64{1} << 20);
    // On the octahedral square a walk needs no trigonometry; its cells are not pieces of azimuth and height.
    if (description_->parameterization != ACDF_PARAM_LATLONG) return;
    if (kind() == ACDF_KIND_ENVIRONMENT) owned_[2] = cells_ = make_cells(environment().data(), tree_units_, most);
    if (kind() == ACDF_KIND_LOCAL && blend_.tiles)
        owned_[2] = local_tables_ = make_local_tables(local().data(), tree_units_, most);
}

void File::metadata(u32 i, Text& key, Text& value) const noexcept {
    key = value = Text();
    if (i >= metadata_count_) return;
    const u8* at = metadata_;
    for (u32 pair = 0; pair <= i; ++pair) {
        key = next_text(at);
        value = next_text(at);
    }
}

Text File::metadata(const char* key) const noexcept {
    const std::size_t size = std::strlen(key);
    const u8* at = metadata_;
    for (u32 pair = 0; pair < metadata_count_; ++pair) {
        const Text found = next_text(at), value = next_text(at);
        if (found.size == size && std::memcmp(found.data, key, size) == 0) return value;
    }
    return {};
}

EnvironmentView File::environment() const noexcept {
    return EnvironmentView({tree_, bins_[0].root, axes_[ACDF_AXIS_PHI].resolution,
                            axes_[ACDF_AXIS_THETA].resolution, description_->total, description_->parameterization,
                            cells_, company_});
}

LocalEnvironmentView File::local() const noexcept {
    AcdfLocal local = {};
    local.blend = blend_;
    local.environment = {tree_,
                         0,
                         axes_[ACDF_AXIS_PHI].resolution,
                         axes_[ACDF_AXIS_THETA].resolution,
                         description_->total,
                         description_->parameterization,
                         nullptr,
                         company_};
    local.company = company_;
    local.bins = bins_;
    local.lights = lights_;
    local.light_count = local_->light_count;
    local.cosine_share = static_cast<double>(local_->cosine_share);
    local.tables = local_tables_;
    if (description_->axis_count == 3) { // an octahedron's 4 n^2 + 2 corners
        while (4 * local.subdivisions * local.subdivisions + 2 < axes_[2].resolution) ++local.subdivisions;
    } else {
        local.rows = axes_[2].resolution;
        local.columns = axes_[3].resolution;
    }
    return LocalEnvironmentView(local);
}

BrdfView File::brdf() const noexcept {
    return BrdfView(
        {blend_, tree_, bins_, views_, nodes_, axes_[0].resolution, axes_[1].resolution, description_->total});
}

TableView File::table() const noexcept {
    u32 indexed = 0;
    while (axes_[indexed].role == ACDF_AXIS_INDEXED) ++indexed; // rule 5012: one axis at least is sampled
    return TableView({tree_, bins_, axes_, description_->axis_count, indexed, description_->total, company_});
}

} // namespace acdf
