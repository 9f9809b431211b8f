// The file as a container: header, chunk table, payloads.
#include "check/chunk_table.h"
#include "inflate.h"
#include "memory.h"
#ifndef ACDF_ENVIRONMENT_ONLY
#include "check/kinds.h"
#include "message.h"

#include <acdf/curves_interface.h>
#endif

#include <cstdarg>
#include <cstring>

namespace acdf {

AcdfErrorCode code_of(int rule) noexcept {
    constexpr short unsupported[] = {2003, 2006, 2007, 3002, 3005, 5001, 5002, 5003, 5004, 5005, 5019, 5021};
    for (const int known : unsupported)
        if (rule == known) return ACDF_UNSUPPORTED;
    if (rule == 1001) return ACDF_CANNOT_OPEN;
    if (rule == 1002) return ACDF_CANNOT_READ;
    if (rule == 1003) return ACDF_OUT_OF_MEMORY;
    if (rule == 1004 || rule == 3012) return ACDF_LIMIT_EXCEEDED;
    return rule == 6012 ? ACDF_OK : ACDF_MALFORMED;
}

void Report::pass(const Finding& finding) noexcept {
    if (stopped_) return;
    ++(code_of(finding.number) == ACDF_OK ? verdict_.warnings : verdict_.errors);
    if (!sink_(finding, context_)) stopped_ = true;
}

#ifdef ACDF_ENVIRONMENT_ONLY
void Report::add(int rule, u64 offset) noexcept { pass({rule, offset}); }
#else
void Report::add(int rule, u64 offset, const char* format, ...) noexcept {
    char detail[160];
    va_list arguments;
    va_start(arguments, format);
    write_message(detail, sizeof detail, format, arguments);
    va_end(arguments);
    pass({rule, offset, detail});
}
#endif

namespace {

constexpr u8 magic[ACDF_MAGIC_SIZE] = ACDF_MAGIC_BYTES;

// ---- header ---------------------------------------------------------------------------------------------

// False where the rest cannot be read with any meaning.
bool check_start(const u8* bytes, u64 size, Report& report) {
    if (size != 0 && std::memcmp(bytes, magic, size < sizeof magic ? size : sizeof magic) != 0) {
        report.add(2002, 0, "this is not an .acdf file, or its first bytes are damaged");
        return false;
    }
    if (size < sizeof(AcdfHeader)) {
        report.add(2001, size, "the file has %llu bytes", static_cast<ull>(size));
        return false;
    }
    const AcdfHeader& header = *reinterpret_cast<const AcdfHeader*>(bytes);
    if (header.version_major != ACDF_VERSION_MAJOR) {
        report.add(2003, offsetof(AcdfHeader, version_major), "version %u.%u needs a %s reader",
                   header.version_major, header.version_minor,
                   header.version_major > ACDF_VERSION_MAJOR ? "newer" : "pre-release");
        return false;
    }
    return true;
}

void check_file_length(const AcdfHeader& header, u64 size, Report& report) {
    const u64 length = header.file_length;
    if (length == size) return;
    if (length > size)
        report.add(2005, offsetof(AcdfHeader, file_length), "truncated: %llu bytes of %llu are there",
                   static_cast<ull>(size), static_cast<ull>(length));
    else
        report.add(2005, offsetof(AcdfHeader, file_length), "%llu extra bytes after the %llu of the file",
                   static_cast<ull>(size - length), static_cast<ull>(length));
}

bool check_header(const u8* bytes, u64 size, Report& report) {
    if (!check_start(bytes, size, report)) return false;
    const AcdfHeader& header = *reinterpret_cast<const AcdfHeader*>(bytes);
    const u64 table_end = sizeof(AcdfHeader) + u64{header.chunk_count} * sizeof(AcdfChunk);
    const bool count_ok = header.chunk_count >= 1 && header.chunk_count <= ACDF_MAX_CHUNKS;
    const bool table_ok = count_ok && table_end <= size;
    if (table_ok) {
        const u32 expected = crc32_of(crc32_of(0, bytes, offsetof(AcdfHeader, header_crc)),
                                      bytes + sizeof(AcdfHeader), table_end - sizeof(AcdfHeader));
        if (expected != header.header_crc)
            report.add(2004, offsetof(AcdfHeader, header_crc),
                       "%08x is stored, %08x is right: header or chunk table are damaged", header.header_crc,
                       expected);
    }
    check_file_length(header, size, report);
    if (header.kind < ACDF_KIND_ENVIRONMENT || header.kind > ACDF_KIND_INDEXED)
        report.add(2006, offsetof(AcdfHeader, kind), "kind %u is unknown", header.kind);
#ifdef ACDF_ENVIRONMENT_ONLY
    else if (header.kind != ACDF_KIND_ENVIRONMENT) report.add(2006, offsetof(AcdfHeader, kind));
#endif
    for (u32 bit = 0; bit < 32; ++bit)
        if (header.required_features >> bit & 1)
            report.add(2007, offsetof(AcdfHeader, required_features),
                       "feature bit %u is unknown: a newer reader is needed", bit);
    for (u32 i = 0; i < 5; ++i)
        if (header.reserved[i] != 0)
            report.add(2008, offsetof(AcdfHeader, reserved) + 4 * i, "reserved bytes of the header are not zero");
    if (!table_ok)
        report.add(3001, offsetof(AcdfHeader, chunk_count),
                   count_ok ? "the table of %u chunks ends after the file" : "there are %u chunks, not 1 to 64",
                   header.chunk_count);
    return table_ok;
}

// ---- chunk table ----------------------------------------------------------------------------------------

bool is_of(u8 kinds, u32 kind) { return kind - 1 > 4 || (kinds >> kind & 1); }
bool belongs(int known, u32 kind) { return is_of(known_rules[known].may, kind); }

bool is_all_printable(u32 type) {
    return is_printable(type, 0) && is_printable(type, 1) && is_printable(type, 2) && is_printable(type, 3);
}

void check_type_and_flags(const ChunkTable& table, u32 i, u32 kind, Report& report) {
    const AcdfChunk& chunk = table.chunks[i];
    const int known = known_chunk(chunk.type);
    const u64 at = table.offset_of(i);
    const ChunkName name(chunk.type);
    const bool critical = chunk.flags & ACDF_CHUNK_FLAG_CRITICAL;
    if (!is_all_printable(chunk.type))
        report.add(3014, at, "the type of chunk %u is not four printable characters", i);
    else if (known < 0 && critical)
        report.add(3002, at, "the critical chunk '%s' (%08x) is unknown: a newer reader is needed", name.text,
                   chunk.type);
    if (known >= 0 && !belongs(known, kind))
        report.add(3013, at, "'%s' is no chunk of files of kind %u", name.text, kind);
    for (u32 j = 0; j < i; ++j)
        if (table.chunks[j].type == chunk.type) {
            report.add(3003, at, "chunks %u and %u are both '%s'", j, i, name.text);
            break;
        }
    const u32 last_codec = chunk.type == ACDF_CHUNK_TREE ? ACDF_CODEC_PLANES : ACDF_CODEC_ZLIB;
    if (chunk.codec > last_codec)
        report.add(3005, at + offsetof(AcdfChunk, codec), "codec %u of '%s' is unknown", chunk.codec, name.text);
    if ((chunk.flags & ~ACDF_CHUNK_FLAG_CRITICAL) != 0)
        report.add(3009, at + offsetof(AcdfChunk, flags), "unknown flags of '%s'", name.text);
    else if (known >= 0 && critical != known_rules[known].critical)
        report.add(3009, at + offsetof(AcdfChunk, flags), "'%s' is marked %s", name.text,
                   critical ? "critical" : "ancillary");
    if (chunk.reserved != 0)
        report.add(3009, at + offsetof(AcdfChunk, reserved), "`reserved` of '%s' is not zero", name.text);
}

// Returns the end of the payload; `expected` is where it must start.
u64 check_place(ChunkTable& table, u32 i, u64 expected, u64 size, Report& report) {
    const AcdfChunk& chunk = table.chunks[i];
    const u64 at = table.offset_of(i);
    const ChunkName name(chunk.type);
    table.inside[i] = true;
    if (chunk.offset != expected) {
        report.add(3006, at + offsetof(AcdfChunk, offset), "'%s' starts at byte %llu instead of %llu", name.text,
                   static_cast<ull>(chunk.offset), static_cast<ull>(expected));
        table.inside[i] = false;
    }
    if (chunk.offset > size || chunk.stored_length > size - chunk.offset) {
        report.add(3007, at + offsetof(AcdfChunk, stored_length),
                   "'%s' has %llu bytes from byte %llu, the file %llu", name.text,
                   static_cast<ull>(chunk.stored_length), static_cast<ull>(chunk.offset), static_cast<ull>(size));
        table.inside[i] = false;
        table.legal = false;
        return expected;
    }
    if (!table.inside[i]) table.legal = false;
    return chunk.offset + chunk.stored_length;
}

void check_lengths(const ChunkTable& table, u32 i, Report& report) {
    const AcdfChunk& chunk = table.chunks[i];
    const u64 at = table.offset_of(i) + offsetof(AcdfChunk, raw_length);
    const ChunkName name(chunk.type);
    if (chunk.codec == ACDF_CODEC_NONE && chunk.raw_length != chunk.stored_length)
        report.add(3010, at, "'%s' is not deflated, but `raw_length` is not `stored_length`", name.text);
    // Division, so that nothing overflows. The longest match of deflate makes 258 bytes of 2 bits.
    if (chunk.codec != ACDF_CODEC_NONE && chunk.raw_length / 1032 > chunk.stored_length)
        report.add(3011, at, "'%s' cannot inflate to as much as `raw_length`", name.text);
}

bool has_chunk(const ChunkTable& table, u32 type) {
    for (u32 i = 0; i < table.count; ++i)
        if (table.chunks[i].type == type) return true;
    return false;
}

void check_required(const ChunkTable& table, u32 kind, Report& report) {
    const bool halved = has_chunk(table, ACDF_CHUNK_HALVINGS);
    for (int i = 0; i < known_chunks && kind - 1 < 5; ++i)
        if (is_of(halved ? known_rules[i].must_halved : known_rules[i].must_curved, kind) &&
            !has_chunk(table, known_rules[i].type))
            report.add(3004, table.offset_of(0), "'%s' is missing", ChunkName(known_rules[i].type).text);
}

void check_table(ChunkTable& table, const AcdfHeader& header, u64 size, Report& report) {
    u64 end = table.end();
    table.legal = true;
    for (u32 i = 0; i < table.count && !report.stopped(); ++i) {
        check_type_and_flags(table, i, header.kind, report);
        end = check_place(table, i, round_up(end, ACDF_ALIGNMENT), size, report);
        check_lengths(table, i, report);
    }
    check_required(table, header.kind, report);
    end = round_up(end, ACDF_ALIGNMENT);
    if (table.legal && header.file_length != end)
        report.add(3008, offsetof(AcdfHeader, file_length), "`file_length` is %llu, the chunks end at %llu",
                   static_cast<ull>(header.file_length), static_cast<ull>(end));
}

// ---- payloads -------------------------------------------------------------------------------------------

void check_padding(const ChunkTable& table, const u8* bytes, u64 size, Report& report) {
    u64 begin = table.end();
    for (u32 i = 0; i <= table.count && !report.stopped(); ++i) {
        const u64 rounded = round_up(begin, ACDF_ALIGNMENT);
        const u64 end = rounded < size ? rounded : size;
        for (u64 at = begin; at < end; ++at)
            if (bytes[at] != 0) {
                report.add(4002, at, "padding is not zero");
                break;
            }
        if (i < table.count) begin = table.chunks[i].offset + table.chunks[i].stored_length;
    }
}

void check_crcs(const ChunkTable& table, const u8* bytes, Report& report) {
    for (u32 i = 0; i < table.count && !report.stopped(); ++i) {
        const AcdfChunk& chunk = table.chunks[i];
        if (!table.inside[i]) continue;
        const u32 right = crc32_of(0, bytes + chunk.offset, chunk.stored_length);
        if (right != chunk.crc)
            report.add(4001, chunk.offset, "'%s' is damaged: %08x is stored, %08x is right",
                       ChunkName(chunk.type).text, chunk.crc, right);
    }
}

// Another chunk that a tree of halvings does without; null: there is none.
const char* beside_halvings(const ChunkTable& table, u32 kind) {
    const bool has_bins = kind != ACDF_KIND_ENVIRONMENT && kind != ACDF_KIND_INDEXED;
    if (has_chunk(table, ACDF_CHUNK_TREE)) return "TREE";
    return has_chunk(table, ACDF_CHUNK_BINS) && !has_bins ? "BINS" : nullptr;
}

// What is sampled by halvings: an environment or several, rows of normals or views, or bins of a table.
void check_halved(const ChunkTable& table, const Payloads& payloads, u32 kind, const AcdfAllocator& allocator,
                  Report& report, Parts& parts) {
    const Payload& halvings = payloads.of[chunk_halvings];
    if (const char* other = kind == ACDF_KIND_TABLE ? nullptr : beside_halvings(table, kind)) // else rule 3013
        report.add(6035, halvings.at(0), "%s is there beside HALV", other);
    if (parts.description->fit != ACDF_FIT_VARIANCE)
        report.add(6035, halvings.at(0), "HALV with fit %u", parts.description->fit);
    if (report.stopped()) return;
#ifndef ACDF_ENVIRONMENT_ONLY
    if (kind == ACDF_KIND_TABLE) return check_table_kind(payloads, report, allocator, parts);
#endif
    check_halvings(halvings, nullptr, report, allocator, parts);
    if (report.stopped()) return;
#ifndef ACDF_ENVIRONMENT_ONLY
    if (kind == ACDF_KIND_INDEXED) { // else rule 7020, of lib/indexed as all of its maps
        if (parts.description->axis_count >= 2)
            check_environment_axes(payloads.of[chunk_description], report, parts);
        return;
    }
    if (kind == ACDF_KIND_LOCAL) return check_normals(payloads, report, parts);
    if (kind == ACDF_KIND_BRDF) return check_halved_brdf(payloads, report, parts);
#endif
    check_environment(payloads.of[chunk_description], payloads.of[chunk_bins], report, parts);
}

// What has curves: a library beside the reader checks it.
void check_curves(const ChunkTable& table, u32 kind, const AcdfCurves* curves, Report& report, Parts& parts) {
    const AcdfUncheckedFile file = {parts.payloads, kind, report, parts};
    if (curves) curves->check(&file);
    else if (has_chunk(table, ACDF_CHUNK_TREE))
        report.add(
            5002, parts.payloads.of[chunk_description].at(offsetof(AcdfDescription, fit)),
            "it has curves (chunk TREE), and the reader was opened without: pass acdf_curves() of acdf::curves, "
            "or make the file with `--fit variance`");
}

} // namespace

Parts::~Parts() { give_block(allocator, halvings_block); }

Verdict check(const u8* bytes, u64 size, const LoadOptions& options, FindingSink sink, void* context,
              Parts& parts) noexcept {
    Report report(sink, context);
    parts.allocator = options.allocator;
    if (!check_header(bytes, size, report) || report.stopped()) return report.verdict();
    const AcdfHeader& header = *reinterpret_cast<const AcdfHeader*>(bytes);
    ChunkTable table = {};
    table.chunks = reinterpret_cast<const AcdfChunk*>(bytes + sizeof(AcdfHeader));
    table.count = header.chunk_count;
    check_table(table, header, size, report);
    if (table.legal && !report.stopped()) check_padding(table, bytes, size, report);
    if (!report.stopped()) check_crcs(table, bytes, report);
    Payloads& payloads = parts.payloads;
    if (!report.stopped()) read_payloads(table, bytes, options, report, parts, payloads);
    const Payload& description = payloads.of[chunk_description];
    if (description.data && !report.stopped()) check_description(description, header.kind, report, parts);
    if (payloads.of[chunk_metadata].data && !report.stopped())
        check_metadata(payloads.of[chunk_metadata], report, parts);
    if (!parts.description || report.stopped()) return report.verdict();
    if (payloads.of[chunk_halvings].data && belongs(chunk_halvings, header.kind))
        check_halved(table, payloads, header.kind, options.allocator, report, parts);
    else if (header.kind != ACDF_KIND_INDEXED && header.kind != ACDF_KIND_TABLE) // else rule 3004
        check_curves(table, header.kind, options.curves, report, parts);
    if (payloads.of[chunk_partner].data && belongs(chunk_partner, header.kind) && !report.stopped())
        check_partner(payloads.of[chunk_partner], header.kind, report, parts);
    return report.verdict();
}

} // namespace acdf
