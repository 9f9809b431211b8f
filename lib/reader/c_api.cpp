// The C interface: acdf::File behind an opaque pointer. malloc and not new, so that a C program that links the
// reader needs no C++ runtime library.
#include "check/check.h"
#include "opened_file.h"

#include <cstring>

static_assert(sizeof(AcdfError::message) == sizeof(acdf::Status::message));
static_assert(ACDF_UNSUPPORTED == static_cast<int>(acdf::ErrorCode::unsupported));

namespace {

void report(const acdf::Status& status, AcdfError* error) {
    if (!error) return;
    error->code = static_cast<AcdfErrorCode>(status.code);
    error->rule = status.rule;
    error->offset = status.offset;
    std::memcpy(error->message, status.message, sizeof(status.message));
}

acdf::LoadOptions of(const AcdfLoadOptions& from) {
    acdf::LoadOptions options;
    if (from.max_file_bytes > 0) options.limits.max_file_bytes = from.max_file_bytes;
    if (from.max_inflated_bytes > 0) options.limits.max_inflated_bytes = from.max_inflated_bytes;
    options.tables = !from.plain;
    options.allocator = from.allocator;
    options.curves = from.curves;
    return options;
}

AcdfLoadOptions plain() {
    AcdfLoadOptions options = {};
    options.plain = 1;
    return options;
}

} // namespace

AcdfFile* acdf_open_with(const char* path, const AcdfLoadOptions* options, AcdfError* error) {
    acdf::Status status;
    AcdfFile* const file = acdf::open_path(path, of(options ? *options : AcdfLoadOptions{}), status);
    report(status, error);
    return file;
}
AcdfFile* acdf_from_memory_with(const void* data, size_t size, const AcdfLoadOptions* options, AcdfError* error) {
    acdf::Status status;
    AcdfFile* const file =
        acdf::open_bytes(data, data ? size : 0, of(options ? *options : AcdfLoadOptions{}), status);
    report(status, error);
    return file;
}

AcdfFile* acdf_open(const char* path, AcdfError* error) {
    const AcdfLoadOptions options = {};
    return acdf_open_with(path, &options, error);
}
AcdfFile* acdf_open_plain(const char* path, AcdfError* error) {
    const AcdfLoadOptions options = plain();
    return acdf_open_with(path, &options, error);
}
AcdfFile* acdf_from_memory(const void* data, size_t size, AcdfError* error) {
    const AcdfLoadOptions options = {};
    return acdf_from_memory_with(data, size, &options, error);
}
AcdfFile* acdf_from_memory_plain(const void* data, size_t size, AcdfError* error) {
    const AcdfLoadOptions options = plain();
    return acdf_from_memory_with(data, size, &options, error);
}

void acdf_close(AcdfFile* file) { acdf::close_file(file); }

namespace {

// Whether `file` is of a kind; then `view` goes to `out`, which may be null.
template <class View>
int of_kind(const AcdfFile* file, AcdfKind kind, View AcdfFile::*view, View* out) {
    if (!file || file->kind() != kind) return 0;
    if (out) *out = file->*view;
    return 1;
}

} // namespace

int acdf_environment(const AcdfFile* file, AcdfEnvironment* out) {
    return of_kind(file, ACDF_KIND_ENVIRONMENT, &AcdfFile::environment, out);
}
#ifndef ACDF_ENVIRONMENT_ONLY
int acdf_local(const AcdfFile* file, AcdfLocal* out) {
    return of_kind(file, ACDF_KIND_LOCAL, &AcdfFile::local, out);
}
int acdf_brdf(const AcdfFile* file, AcdfBrdf* out) { return of_kind(file, ACDF_KIND_BRDF, &AcdfFile::brdf, out); }
int acdf_table(const AcdfFile* file, AcdfTable* out) {
    return of_kind(file, ACDF_KIND_TABLE, &AcdfFile::table, out);
}

int acdf_indexed(const AcdfFile* file, AcdfIndexed* out) {
    return of_kind(file, ACDF_KIND_INDEXED, &AcdfFile::indexed, out);
}

int acdf_memory(const AcdfFile* file, AcdfMove* moves) {
    int count = 0;
    moves[count++] = {file->bytes, static_cast<size_t>(file->size), nullptr};
    for (int i = 1; i < ACDF_MAX_MOVES; ++i)
        if (file->memory[i].data) moves[count++] = {file->memory[i].data, file->memory[i].bytes, nullptr};
    return count;
}
#endif

AcdfKind acdf_kind(const AcdfFile* file) { return file->kind(); }
uint64_t acdf_table_bytes(const AcdfFile* file) { return file->table_bytes(); }
uint64_t acdf_size(const AcdfFile* file) { return file->size; }
const AcdfHeader* acdf_header(const AcdfFile* file) { return reinterpret_cast<const AcdfHeader*>(file->bytes); }
const AcdfDescription* acdf_description(const AcdfFile* file) { return file->description; }

const AcdfAxis* acdf_axis(const AcdfFile* file, uint32_t axis) {
    return axis < file->description->axis_count ? &file->axes[axis] : nullptr;
}

const AcdfBin* acdf_bin(const AcdfFile* file, uint32_t bin) {
    return file->bins && bin < file->description->bin_count ? &file->bins[bin] : nullptr;
}

namespace {

// Reads a length and its text, and moves behind them.
AcdfText next_text(const std::uint8_t*& at) {
    const AcdfText text{reinterpret_cast<const char*>(at) + 4, acdf::load_u32(at)};
    at += 4 + text.size;
    return text;
}

} // namespace

uint32_t acdf_metadata_count(const AcdfFile* file) { return file->metadata_count; }

int acdf_metadata_pair(const AcdfFile* file, uint32_t i, AcdfText* key, AcdfText* value) {
    if (i >= file->metadata_count) return 0;
    const std::uint8_t* at = file->metadata;
    for (uint32_t pair = 0; pair < i; ++pair) next_text(at), next_text(at);
    const AcdfText first = next_text(at), second = next_text(at);
    if (key) *key = first;
    if (value) *value = second;
    return 1;
}

AcdfText acdf_metadata_value(const AcdfFile* file, const char* key) {
    const size_t size = key ? std::strlen(key) : 0;
    const std::uint8_t* at = file->metadata;
    for (uint32_t pair = 0; key && pair < file->metadata_count; ++pair) {
        const AcdfText found = next_text(at), value = next_text(at);
        if (found.size == size && std::memcmp(found.data, key, size) == 0) return value;
    }
    return {nullptr, 0};
}
