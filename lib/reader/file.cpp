// `File`: ownership and access. What is right and wrong is decided in check*.cpp.
#include "check/check.h"
#include "halved_tree.h"
#include "input_file.h"
#include "memory.h"
#include "tables/brdf.h"
#include "tables/local.h"
#include "tables/table_entries.h"
#include "waves/brdf.h"
#include "waves/cut.h"

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

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

Status take(const AcdfAllocator& allocator, u64 size, AcdfBlock& block) {
    if (size < SIZE_MAX - ACDF_ALIGNMENT) block = take_block(allocator, static_cast<std::size_t>(size));
    return block.data ? Status{} : failure(1003, "%llu bytes", static_cast<ull>(size));
}

Status check_limit(u64 size, const Limits& limits) {
    if (size <= limits.max_file_bytes) return {};
    return failure(1004, "%llu bytes, the limit is %llu", static_cast<ull>(size),
                   static_cast<ull>(limits.max_file_bytes));
}

Status read_path(const char* path, const LoadOptions& options, AcdfBlock& block, u64& size) {
    InputFile input;
    if (const char* wrong = input.open(path)) return failure(1001, "%s", wrong);
    if (const char* wrong = input.measure(size)) return failure(1002, "%s", wrong);
    if (Status status = check_limit(size, options.limits); !status.ok()) return status;
    if (Status status = take(options.allocator, size, block); !status.ok()) return status;
    u64 done = 0;
    if (const char* wrong = input.read(block.data, size, done)) return failure(1002, "%s", wrong);
    if (done < size) return failure(1002, "it shrank to %llu bytes while being read", static_cast<ull>(done));
    return {};
}

// Reads a length and its text, and moves behind them.
Text next_text(const u8*& at) {
    const Text text{reinterpret_cast<const char*>(at) + 4, load_u32(at)};
    at += 4 + text.size;
    return text;
}

} // namespace

File::~File() { release(); }

void File::release() noexcept {
    for (AcdfBlock& block : owned_) give_block(allocator_, block);
}

File::File(File&& other) noexcept { *this = std::move(other); }

File& File::operator=(File&& other) noexcept {
    if (this == &other) return *this;
    release();
    bytes_ = std::exchange(other.bytes_, nullptr);
    size_ = std::exchange(other.size_, 0);
    description_ = std::exchange(other.description_, nullptr);
    axes_ = std::exchange(other.axes_, nullptr);
    bins_ = std::exchange(other.bins_, nullptr);
    tree_ = std::exchange(other.tree_, nullptr);
    tree_units_ = std::exchange(other.tree_units_, 0);
    blend_ = std::exchange(other.blend_, AcdfBlend{});
    fast_ = std::exchange(other.fast_, AcdfFast{});
    local_ = std::exchange(other.local_, nullptr);
    bright_tiles_ = std::exchange(other.bright_tiles_, nullptr);
    partner_ = std::exchange(other.partner_, nullptr);
    visibility_ = std::exchange(other.visibility_, AcdfVisibilityTable{});
    portals_ = std::exchange(other.portals_, AcdfPortalTable{});
    views_ = std::exchange(other.views_, nullptr);
    nodes_ = std::exchange(other.nodes_, nullptr);
    metadata_ = std::exchange(other.metadata_, nullptr);
    metadata_count_ = std::exchange(other.metadata_count_, 0);
    halved_ = std::exchange(other.halved_, nullptr);
    local_tables_ = std::exchange(other.local_tables_, nullptr);
    brdf_tables_ = std::exchange(other.brdf_tables_, nullptr);
    entries_ = std::exchange(other.entries_, nullptr);
    allocator_ = other.allocator_;
    for (int i = 0; i < 3; ++i) owned_[i] = std::exchange(other.owned_[i], AcdfBlock{});
    return *this;
}

Status File::open(const char* path, File& file, const LoadOptions& options) noexcept {
    AcdfBlock block = {};
    u64 size = 0;
    file = File();
    if (!path) return failure(1001, "no path is given");
    Status status = read_path(path, options, block, size);
    if (status.ok()) status = from_memory(block.data, static_cast<std::size_t>(size), file, options);
    if (status.ok()) {
        file.owned_[0] = block;
        return status;
    }
    give_block(options.allocator, block);
    name_file(status, path);
    return status;
}

Status File::from_memory(const void* data, std::size_t size, File& file, const LoadOptions& options) noexcept {
    File loaded;
    file = File();
    loaded.allocator_ = options.allocator;
    if (Status status = check_limit(size, options.limits); !status.ok()) return status;
    if (reinterpret_cast<std::uintptr_t>(data) % alignof(AcdfHeader) != 0) {
        if (Status status = take(options.allocator, size, loaded.owned_[0]); !status.ok()) return status;
        data = std::memcpy(loaded.owned_[0].data, data, size);
    }
    Status status;
    Parts parts;
    TreeSurvey survey;
    if (options.tables) parts.survey = &survey;
    check(static_cast<const u8*>(data), size, options.limits, first_error, &status, parts, options.allocator);
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
    loaded.fast_ = parts.fast;
    loaded.local_ = parts.local;
    loaded.bright_tiles_ = parts.bright_tiles;
    loaded.partner_ = parts.partner;
    loaded.visibility_ = parts.visibility;
    loaded.portals_ = parts.portals;
    loaded.views_ = parts.views;
    loaded.nodes_ = parts.nodes;
    loaded.metadata_ = parts.metadata;
    loaded.metadata_count_ = parts.metadata_count;
    if (parts.halvings && !loaded.make_halved(parts, options.tables))
        return failure(1003, "%llu halvings", ull{parts.halving_count});
    if (options.tables) loaded.make_tables(survey);
    file = std::move(loaded);
    return status;
}

// They are only for speed: where there is no memory for them, the file is as good without.
void File::make_tables(const TreeSurvey& survey) noexcept {
    const std::size_t most = 8 * static_cast<std::size_t>(size_) + (std::size_t{1} << 20);
    if (kind() == ACDF_KIND_BRDF && can_have_tables(brdf().data()))
        brdf_tables_ = make_brdf_tables(brdf().data(), most, true, allocator_, owned_[2]);
    if (kind() == ACDF_KIND_LOCAL && blend_.tiles)
        local_tables_ = make_local_tables(local().data(), tree_units_, most, allocator_, owned_[2]);
    if (kind() == ACDF_KIND_TABLE)
        entries_ = make_table_entries(table().data(), description_->bin_count, survey, most, allocator_, owned_[2]);
}

// False where there is no memory.
bool File::make_halved(const Parts& parts, bool lookup) noexcept {
    u32 resolution[ACDF_MAX_AXES], count = 0;
    for (u32 axis = 0; axis < description_->axis_count; ++axis)
        if (axes_[axis].role == ACDF_AXIS_SAMPLED) resolution[count++] = axes_[axis].resolution;
    const HalvedSource source = {
        parts.halvings, parts.halving_count, resolution, count, description_->parameterization, lookup};
    halved_ = make_halved_tree(source, allocator_, owned_[2]);
    return halved_ != nullptr;
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

int File::memory(AcdfMove* moves) const noexcept {
    int count = 0;
    moves[count++] = {bytes_, static_cast<std::size_t>(size_), nullptr};
    for (int i = 1; i < 3; ++i)
        if (owned_[i].data) moves[count++] = {owned_[i].data, owned_[i].bytes, nullptr};
    return count;
}

EnvironmentView File::environment() const noexcept {
    return EnvironmentView({tree_, bins_ ? bins_[0].root : 0, axes_[ACDF_AXIS_PHI].resolution,
                            axes_[ACDF_AXIS_THETA].resolution, description_->total, description_->parameterization,
                            halved_, partner_, tree_units_});
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
                         nullptr, // complete whatever the file is made for: to be used alone
                         tree_units_};
    local.partner = partner_;
    local.bins = bins_;
    local.bright_tiles = bright_tiles_;
    local.bright_tile_count = local_->bright_tile_count;
    local.cosine_share = static_cast<double>(local_->cosine_share);
    local.tables = local_tables_;
    local.visibility = visibility_;
    local.portals = portals_;
    local.fast = fast_;
    if (fast_.grid && local_tables_) acdf_local_use_upper(&local);
#if ACDF_WAVEFRONT_X86
    local.vectors = local_vectors();
#endif
    if (description_->axis_count == 3) { // an octahedron's 4 n^2 + 2 corners
        while (4 * local.subdivisions * local.subdivisions + 2 < axes_[2].resolution) ++local.subdivisions;
    } else {
        local.rows = axes_[2].resolution;
        local.columns = axes_[3].resolution;
    }
    return LocalEnvironmentView(local);
}

BrdfView File::brdf() const noexcept {
    const AcdfBrdfVectors* vectors = nullptr;
#if ACDF_WAVEFRONT_X86
    vectors = brdf_vectors();
#endif
    return BrdfView({blend_, tree_, bins_, views_, nodes_, axes_[0].resolution, axes_[1].resolution,
                     description_->total, brdf_tables_, vectors});
}

TableView File::table() const noexcept {
    u32 indexed = 0;
    while (axes_[indexed].role == ACDF_AXIS_INDEXED) ++indexed; // rule 5012: one axis at least is sampled
    return TableView({tree_, bins_, axes_, description_->axis_count, indexed, description_->total, partner_,
                      tree_units_, entries_});
}

} // namespace acdf
