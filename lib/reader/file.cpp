// Opening and closing. The rules are checked in check/*.cpp; c_api.cpp says what an open file holds.
#include "check/check.h"
#include "halved_tree.h"
#include "input_file.h"
#include "memory.h"
#include "message.h"
#include "opened_file.h"
#ifndef ACDF_ENVIRONMENT_ONLY
#include "tables/normals.h"
#endif

#include <acdf/environment_view.h>

#include <cstdarg>
#include <cstring>
#include <new>
#include <utility>

namespace acdf {

namespace {

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

// `detail` may be empty. Statuses are written in place: copies of their messages would be half of what opens files.
void fail_at(AcdfError& status, int rule, u64 offset, const char* detail) {
    status.code = code_of(rule);
    status.rule = rule;
    status.offset = offset;
    write_message(status.message, sizeof status.message, "%s (rule %u of SPEC.md at byte %llu)",
                  *detail ? detail : "the file is not valid", static_cast<u32>(rule), static_cast<ull>(offset));
    tidy(status.message);
}

#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
bool
fail(AcdfError& status, int rule, const char* format, ...) {
    char detail[160];
    va_list arguments;
    va_start(arguments, format);
    write_message(detail, sizeof detail, format, arguments);
    va_end(arguments);
    fail_at(status, rule, 0, detail);
    return false;
}

// Puts the path in front; of a long one the end, which distinguishes files.
void name_file(AcdfError& status, const char* path) {
    constexpr std::size_t longest = 100;
    const std::size_t length = std::strlen(path);
    const char* shown = length > longest ? path + (length - longest) : path;
    while (shown > path && (*shown & 0xC0) == 0x80) ++shown;
    char whole[sizeof status.message];
    write_message(whole, sizeof whole, "%s%s: %s", shown > path ? "..." : "", shown, status.message);
    tidy(whole);
    std::memcpy(status.message, whole, sizeof whole);
}

} // namespace

void set_grid(const Parts& parts, AcdfEnvironment& environment) noexcept {
    environment.columns = parts.axes[ACDF_AXIS_PHI].resolution;
    environment.rows = parts.axes[ACDF_AXIS_THETA].resolution;
    environment.total = parts.description->total;
    environment.parameterization = parts.description->parameterization;
}

bool first_error(const Finding& finding, void* status) {
    if (code_of(finding.number) == ACDF_OK) return true;
#ifdef ACDF_ENVIRONMENT_ONLY
    fail_at(*static_cast<AcdfError*>(status), finding.number, finding.offset, "");
#else
    fail_at(*static_cast<AcdfError*>(status), finding.number, finding.offset, finding.detail);
#endif
    return false;
}

namespace {

// What follows is false, and `status` says why, where it fails.

bool take(const AcdfAllocator& allocator, u64 size, AcdfBlock& block, AcdfError& status) {
    if (size < SIZE_MAX - ACDF_ALIGNMENT) block = take_block(allocator, static_cast<std::size_t>(size));
    return block.data || fail(status, 1003, "no memory for %llu bytes", static_cast<ull>(size));
}

bool is_within(u64 size, const Limits& limits, AcdfError& status) {
    return size <= limits.max_file_bytes || fail(status, 1004, "the file has %llu bytes, the limit is %llu",
                                                 static_cast<ull>(size), static_cast<ull>(limits.max_file_bytes));
}

bool read_path(const char* path, const LoadOptions& options, AcdfBlock& block, u64& size, AcdfError& status) {
    InputFile input;
    if (const char* wrong = input.open(path)) return fail(status, 1001, "%s", wrong);
    if (const char* wrong = input.measure(size)) return fail(status, 1002, "%s", wrong);
    if (!is_within(size, options.limits, status) || !take(options.allocator, size, block, status)) return false;
    u64 done = 0;
    if (const char* wrong = input.read(block.data, size, done)) return fail(status, 1002, "%s", wrong);
    return done == size || fail(status, 1002, "it shrank to %llu bytes while being read", static_cast<ull>(done));
}

// False where there is no memory.
bool make_halved(const Parts& parts, bool lookup, AcdfFile& file) noexcept {
    u32 resolution[ACDF_MAX_AXES], count = 0;
    for (u32 axis = 0; axis < parts.description->axis_count; ++axis)
        if (parts.axes[axis].role == ACDF_AXIS_SAMPLED) resolution[count++] = parts.axes[axis].resolution;
    const HalvedSource source = {
        parts.halvings, parts.halving_count, resolution, count, parts.description->parameterization, lookup};
    file.environment.halved = make_halved_tree(source, file.allocator, file.memory[2]);
    return file.environment.halved != nullptr;
}

#ifndef ACDF_ENVIRONMENT_ONLY
bool make_rows(const Parts& parts, bool lookup, AcdfFile& file) noexcept {
    const double* heights = acdf_halved_heights(file.environment.halved);
    file.rows = make_normal_rows(parts, lookup, heights, file.allocator, file.memory[3]);
    return file.rows != nullptr;
}
#endif

void give_memory(AcdfFile& file) noexcept {
    for (AcdfBlock& block : file.memory) give_block(file.allocator, block);
}

void take_parts(const Parts& parts, AcdfFile& file) noexcept {
    static_cast<Contents&>(file) = parts;
    if (file.kind() != ACDF_KIND_ENVIRONMENT) return;
    set_grid(parts, file.environment);
    file.environment.partner = parts.partner;
    if (parts.bins) file.environment.root = parts.bins[0].root;
}

// Checks the bytes of a file, and makes its view. On failure the caller gives its memory back.
bool load(const LoadOptions& options, AcdfFile& file, AcdfError& status) noexcept {
    Parts parts;
    check(file.bytes, file.size, options, first_error, &status, parts);
    file.memory[1] = parts.inflated;
    if (status.code != ACDF_OK) return false;
    take_parts(parts, file);
    if (file.curves()) {
        file.environment.curves = options.curves;
        file.environment.tree = parts.payloads.of[chunk_tree].data;
    }
#ifndef ACDF_ENVIRONMENT_ONLY
    if (file.kind() == ACDF_KIND_TABLE) {
        make_view(parts, file);
        file.memory[2] = std::exchange(parts.halvings_block, {});
        return true;
    }
#endif
    const bool lookup = options.tables && file.kind() != ACDF_KIND_INDEXED; // whose maps have one of their own
    if (parts.halvings && !make_halved(parts, lookup, file))
        return fail(status, 1003, "no memory for %llu halvings", ull{parts.halving_count});
#ifndef ACDF_ENVIRONMENT_ONLY
    if (parts.normals && !make_rows(parts, options.tables, file))
        return fail(status, 1003, "no memory for %llu rows", ull{parts.normals->row_count});
    if (file.kind() != ACDF_KIND_ENVIRONMENT) make_view(parts, file);
#endif
    return true;
}

// Of bytes that the file owns, if `owned` has them.
AcdfFile* load(const void* data, std::size_t size, const LoadOptions& options, AcdfBlock owned,
               AcdfError& status) noexcept {
    AcdfFile file = {};
    file.bytes = static_cast<const u8*>(data);
    file.size = size;
    file.allocator = options.allocator;
    file.memory[0] = owned;
    if (load(options, file, status) && take(options.allocator, sizeof file, file.own, status))
        return new (file.own.data) AcdfFile(file);
    give_memory(file);
    return nullptr;
}

LoadOptions given(const AcdfLoadOptions* from) {
    LoadOptions options;
    if (!from) return options;
    if (from->max_file_bytes > 0) options.limits.max_file_bytes = from->max_file_bytes;
    if (from->max_inflated_bytes > 0) options.limits.max_inflated_bytes = from->max_inflated_bytes;
    options.tables = !from->plain;
    options.allocator = from->allocator;
    options.curves = from->curves;
    return options;
}

// Where the outcome goes that a caller does not ask for.
AcdfError& cleared(AcdfError* error, AcdfError& own) { return *(error ? error : &own) = {}; }

} // namespace

EnvironmentView File::environment() const noexcept { return EnvironmentView(opened_->environment); }

} // namespace acdf

using namespace acdf;

AcdfFile* acdf_open_with(const char* path, const AcdfLoadOptions* from, AcdfError* error) {
    AcdfError own, &status = cleared(error, own);
    const LoadOptions options = given(from);
    AcdfBlock block = {};
    u64 size = 0;
    AcdfFile* file = nullptr;
    if (!path) return fail(status, 1001, "no path is given"), nullptr;
    if (read_path(path, options, block, size, status))
        file = load(block.data, static_cast<std::size_t>(size), options, block, status);
    else give_block(options.allocator, block);
    if (!file) name_file(status, path);
    return file;
}

AcdfFile* acdf_from_memory_with(const void* data, size_t size, const AcdfLoadOptions* from, AcdfError* error) {
    AcdfError own, &status = cleared(error, own);
    const LoadOptions options = given(from);
    AcdfBlock copy = {};
    if (!data) size = 0;
    if (!is_within(size, options.limits, status)) return nullptr;
    if (reinterpret_cast<std::uintptr_t>(data) % alignof(AcdfHeader) != 0) {
        if (!take(options.allocator, size, copy, status)) return nullptr;
        data = std::memcpy(copy.data, data, size);
    }
    return load(data, size, options, copy, status);
}

AcdfFile* acdf_open(const char* path, AcdfError* error) { return acdf_open_with(path, nullptr, error); }
AcdfFile* acdf_from_memory(const void* data, size_t size, AcdfError* error) {
    return acdf_from_memory_with(data, size, nullptr, error);
}

void acdf_close(AcdfFile* file) {
    if (!file) return;
    const AcdfAllocator allocator = file->allocator;
    AcdfBlock own = file->own;
    give_memory(*file);
    give_block(allocator, own);
}
