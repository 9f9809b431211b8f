// The C interface: acdf::File behind an opaque pointer. malloc and not new, so that a C program that links the
// reader needs no C++ runtime library.
#include "c_file.h"
#include "memory.h"

#include <cstring>
#include <new>
#include <utility>

static_assert(sizeof(AcdfError::message) == sizeof(acdf::Status::message));
static_assert(ACDF_UNSUPPORTED == static_cast<int>(acdf::ErrorCode::unsupported));

void acdf::report(const Status& status, AcdfError* error) {
    if (!error) return;
    error->code = static_cast<AcdfErrorCode>(status.code);
    error->rule = status.rule;
    error->offset = status.offset;
    std::memcpy(error->message, status.message, sizeof(status.message));
}

namespace {

using acdf::report;

AcdfFile* keep(const acdf::Status& status, acdf::File& file, const AcdfAllocator& allocator, AcdfError* error) {
    report(status, error);
    if (!status.ok()) return nullptr;
    const AcdfBlock block = acdf::take_block(allocator, sizeof(AcdfFile));
    if (block.data) return new (block.data) AcdfFile(std::move(file), allocator, block);
    acdf::Status failure;
    failure.code = acdf::ErrorCode::out_of_memory;
    std::memcpy(failure.message, "out of memory", sizeof("out of memory"));
    report(failure, error);
    return nullptr;
}

acdf::LoadOptions of(const AcdfLoadOptions& from) {
    acdf::LoadOptions options;
    if (from.max_file_bytes > 0) options.limits.max_file_bytes = from.max_file_bytes;
    if (from.max_inflated_bytes > 0) options.limits.max_inflated_bytes = from.max_inflated_bytes;
    options.tables = !from.plain;
    options.allocator = from.allocator;
    return options;
}

AcdfLoadOptions plain() {
    AcdfLoadOptions options = {};
    options.plain = 1;
    return options;
}

} // namespace

AcdfFile::AcdfFile(acdf::File&& from, const AcdfAllocator& memory, const AcdfBlock& place) noexcept
    : file(std::move(from)), allocator(memory), block(place) {
    if (file.kind() == ACDF_KIND_ENVIRONMENT) environment = file.environment().data();
    if (file.kind() == ACDF_KIND_LOCAL) local = file.local().data();
    if (file.kind() == ACDF_KIND_BRDF) brdf = file.brdf().data();
    if (file.kind() == ACDF_KIND_TABLE) table = file.table().data();
}

AcdfFile* acdf_open_with(const char* path, const AcdfLoadOptions* options, AcdfError* error) {
    if (!options) return acdf_open(path, error);
    acdf::File file;
    const acdf::Status status = acdf::File::open(path, file, of(*options));
    return keep(status, file, options->allocator, error);
}
AcdfFile* acdf_from_memory_with(const void* data, size_t size, const AcdfLoadOptions* options, AcdfError* error) {
    if (!options) return acdf_from_memory(data, size, error);
    acdf::File file;
    const acdf::Status status = acdf::File::from_memory(data, data ? size : 0, file, of(*options));
    return keep(status, file, options->allocator, error);
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

void acdf_close(AcdfFile* file) {
    if (!file) return;
    const AcdfAllocator allocator = file->allocator;
    AcdfBlock block = file->block;
    file->~AcdfFile();
    acdf::give_block(allocator, block);
}

int acdf_environment(const AcdfFile* file, AcdfEnvironment* out) {
    if (!file || file->file.kind() != ACDF_KIND_ENVIRONMENT) return 0;
    if (out) *out = file->environment;
    return 1;
}

int acdf_local(const AcdfFile* file, AcdfLocal* out) {
    if (!file || file->file.kind() != ACDF_KIND_LOCAL) return 0;
    if (out) *out = file->local;
    return 1;
}

int acdf_brdf(const AcdfFile* file, AcdfBrdf* out) {
    if (!file || file->file.kind() != ACDF_KIND_BRDF) return 0;
    if (out) *out = file->brdf;
    return 1;
}

int acdf_table(const AcdfFile* file, AcdfTable* out) {
    if (!file || file->file.kind() != ACDF_KIND_TABLE) return 0;
    if (out) *out = file->table;
    return 1;
}

AcdfKind acdf_kind(const AcdfFile* file) { return file->file.kind(); }
int acdf_memory(const AcdfFile* file, AcdfMove* moves) { return file->file.memory(moves); }
uint64_t acdf_table_bytes(const AcdfFile* file) { return file->file.table_bytes(); }
uint64_t acdf_size(const AcdfFile* file) { return file->file.size(); }
const AcdfHeader* acdf_header(const AcdfFile* file) { return &file->file.header(); }
const AcdfDescription* acdf_description(const AcdfFile* file) { return &file->file.description(); }

const AcdfAxis* acdf_axis(const AcdfFile* file, uint32_t axis) {
    return axis < file->file.description().axis_count ? &file->file.axis(axis) : nullptr;
}

const AcdfBin* acdf_bin(const AcdfFile* file, uint32_t bin) {
    return file->file.has_bins() && bin < file->file.description().bin_count ? &file->file.bin(bin) : nullptr;
}

uint32_t acdf_metadata_count(const AcdfFile* file) { return file->file.metadata_count(); }

int acdf_metadata_pair(const AcdfFile* file, uint32_t i, AcdfText* key, AcdfText* value) {
    if (i >= file->file.metadata_count()) return 0;
    acdf::Text k, v;
    file->file.metadata(i, k, v);
    if (key) *key = {k.data, k.size};
    if (value) *value = {v.data, v.size};
    return 1;
}

AcdfText acdf_metadata_value(const AcdfFile* file, const char* key) {
    if (!key) return {nullptr, 0};
    const acdf::Text value = file->file.metadata(key);
    return {value.data, value.size};
}
