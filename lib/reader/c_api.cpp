// The C interface: acdf::File behind an opaque pointer. malloc and not new, so that a C program that links the
// reader needs no C++ runtime library.
#include <acdf/acdf.h>
#include <acdf/reader.h>

#include <cstdlib>
#include <cstring>
#include <new>
#include <utility>

struct AcdfFile {
    acdf::File file;
};

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

AcdfFile* keep(const acdf::Status& status, acdf::File& file, AcdfError* error) {
    report(status, error);
    if (!status.ok()) return nullptr;
    if (void* place = std::malloc(sizeof(AcdfFile))) return new (place) AcdfFile{std::move(file)};
    acdf::Status failure;
    failure.code = acdf::ErrorCode::out_of_memory;
    std::memcpy(failure.message, "out of memory", sizeof("out of memory"));
    report(failure, error);
    return nullptr;
}

acdf::LoadOptions plain() {
    acdf::LoadOptions options;
    options.tables = false;
    return options;
}

AcdfFile* open(const char* path, const acdf::LoadOptions& options, AcdfError* error) {
    acdf::File file;
    const acdf::Status status = acdf::File::open(path, file, options);
    return keep(status, file, error);
}

AcdfFile* from_memory(const void* data, size_t size, const acdf::LoadOptions& options, AcdfError* error) {
    acdf::File file;
    const acdf::Status status = acdf::File::from_memory(data, size, file, options);
    return keep(status, file, error);
}

} // namespace

AcdfFile* acdf_open(const char* path, AcdfError* error) { return open(path, {}, error); }
AcdfFile* acdf_open_plain(const char* path, AcdfError* error) { return open(path, plain(), error); }

AcdfFile* acdf_from_memory(const void* data, size_t size, AcdfError* error) {
    return from_memory(data, size, {}, error);
}
AcdfFile* acdf_from_memory_plain(const void* data, size_t size, AcdfError* error) {
    return from_memory(data, size, plain(), error);
}

void acdf_close(AcdfFile* file) {
    if (!file) return;
    file->~AcdfFile();
    std::free(file);
}

int acdf_environment(const AcdfFile* file, AcdfEnvironment* out) {
    if (file->file.kind() != ACDF_KIND_ENVIRONMENT) return 0;
    *out = file->file.environment().data();
    return 1;
}

int acdf_local(const AcdfFile* file, AcdfLocal* out) {
    if (file->file.kind() != ACDF_KIND_LOCAL) return 0;
    *out = file->file.local().data();
    return 1;
}

int acdf_brdf(const AcdfFile* file, AcdfBrdf* out) {
    if (file->file.kind() != ACDF_KIND_BRDF) return 0;
    *out = file->file.brdf().data();
    return 1;
}

int acdf_table(const AcdfFile* file, AcdfTable* out) {
    if (file->file.kind() != ACDF_KIND_TABLE) return 0;
    *out = file->file.table().data();
    return 1;
}

AcdfKind acdf_kind(const AcdfFile* file) { return file->file.kind(); }
uint64_t acdf_table_bytes(const AcdfFile* file) { return file->file.table_bytes(); }
uint64_t acdf_size(const AcdfFile* file) { return file->file.size(); }
const AcdfHeader* acdf_header(const AcdfFile* file) { return &file->file.header(); }
const AcdfDescription* acdf_description(const AcdfFile* file) { return &file->file.description(); }

const AcdfAxis* acdf_axis(const AcdfFile* file, uint32_t axis) {
    return axis < file->file.description().axis_count ? &file->file.axis(axis) : nullptr;
}

const AcdfBin* acdf_bin(const AcdfFile* file, uint32_t bin) {
    return bin < file->file.description().bin_count ? &file->file.bin(bin) : nullptr;
}

uint32_t acdf_metadata_count(const AcdfFile* file) { return file->file.metadata_count(); }

int acdf_metadata_pair(const AcdfFile* file, uint32_t i, AcdfText* key, AcdfText* value) {
    if (i >= file->file.metadata_count()) return 0;
    acdf::Text k, v;
    file->file.metadata(i, k, v);
    *key = {k.data, k.size};
    *value = {v.data, v.size};
    return 1;
}

AcdfText acdf_metadata_value(const AcdfFile* file, const char* key) {
    const acdf::Text value = file->file.metadata(key);
    return {value.data, value.size};
}
