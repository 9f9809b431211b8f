// What an open file holds.
#include "check/check.h"
#include "opened_file.h"

#include <cstring>

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

int acdf_memory(const AcdfFile* file, AcdfMove* moves) {
    int count = 0;
    moves[count++] = {file->bytes, static_cast<size_t>(file->size), nullptr};
    for (int i = 1; i < ACDF_MAX_MOVES; ++i)
        if (file->memory[i].data) moves[count++] = {file->memory[i].data, file->memory[i].bytes, nullptr};
    return count;
}
#endif

const AcdfPartner* acdf_partner(const AcdfFile* file) { return file->partner; }

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
