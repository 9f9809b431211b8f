/* The C interface of the reader: open a file here, then sample and evaluate with inline functions or linked ones.
 * acdf/sample.h, local.h, brdf.h, table.h and indexed.h are inlined. Languages without a C compiler can call
 * acdf/linked.h.
 *
 *   AcdfError error;
 *   AcdfFile* file = acdf_open("probe.acdf", &error);
 *   AcdfEnvironment sky;
 *   if (!file || !acdf_environment(file, &sky)) { ... error.message ... }
 *   AcdfDirectionSample s = acdf_environment_sample(&sky, u0, u1);   // s.direction, s.pdf in sr^-1
 *   float p = acdf_environment_pdf(&sky, s.direction);
 *   acdf_close(file);                                                // `sky` ends with it
 *
 * The safety contract is that of acdf/reader.h: any bytes may be passed in; a file that was accepted can be
 * sampled for ever without reading outside it. An open file is never changed: any number of threads may use
 * it at once. Functions take only open files, not null, but for acdf_close and acdf_environment, acdf_local,
 * acdf_brdf, acdf_table and acdf_indexed, which return 0. */
#ifndef ACDF_ACDF_H
#define ACDF_ACDF_H

#include <acdf/allocator.h>
#include <acdf/layout.h>
#include <acdf/sample.h>
#ifndef ACDF_ENVIRONMENT_ONLY
#include <acdf/brdf.h>
#include <acdf/indexed.h>
#include <acdf/linked.h>
#include <acdf/local.h>
#include <acdf/moved.h>
#include <acdf/table.h>
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef struct AcdfFile AcdfFile;

/* What kind of failure; the numbers are stable, and those of acdf::ErrorCode. */
typedef enum AcdfErrorCode {
    ACDF_OK = 0,
    ACDF_CANNOT_OPEN = 1,
    ACDF_CANNOT_READ = 2,
    ACDF_OUT_OF_MEMORY = 3,
    ACDF_LIMIT_EXCEEDED = 4,
    ACDF_MALFORMED = 5,  /* breaks the rule `rule` of SPEC.md */
    ACDF_UNSUPPORTED = 6 /* a newer or unknown version, kind, feature or critical chunk */
} AcdfErrorCode;

/* Why a file was not loaded, or not served. */
typedef struct AcdfError {
    AcdfErrorCode code;
    int rule;          /* number of the broken rule of SPEC.md, 0 if none */
    uint64_t offset;   /* byte in the file where it shows */
    char message[240]; /* one line, UTF-8, terminated: what is wrong and where */
} AcdfError;

/* Reads and checks the file at `path`. Null on failure. `error` may be null; it is written on success too. */
AcdfFile* acdf_open(const char* path, AcdfError* error);

/* Checks `size` bytes at `data`, which must stay as they are until acdf_close. They are used in place where they
 * are aligned to 8 bytes, and copied else. Compressed chunks are inflated into memory of the file's own. Null on
 * failure. */
AcdfFile* acdf_from_memory(const void* data, size_t size, AcdfError* error);

/* The same without runtime tables: nothing is allocated for them, and each call searches the trees from their
 * roots. */
AcdfFile* acdf_open_plain(const char* path, AcdfError* error);
AcdfFile* acdf_from_memory_plain(const void* data, size_t size, AcdfError* error);

/* The same with limits, and with the caller's memory. A number that is 0 stands for its default, as do options that
 * are null. */
typedef struct AcdfLoadOptions {
    uint64_t max_file_bytes;     /* 0: 4 GiB */
    uint64_t max_inflated_bytes; /* of compressed chunks together; 0: 1 GiB */
    int plain;                   /* 1: without runtime tables */
    AcdfAllocator allocator;     /* of what the open file keeps, itself too; all null: the C library's */
    const AcdfCurves* curves;    /* acdf_curves() reads files of curves; null: they are refused as unsupported */
} AcdfLoadOptions;
AcdfFile* acdf_open_with(const char* path, const AcdfLoadOptions* options, AcdfError* error);
AcdfFile* acdf_from_memory_with(const void* data, size_t size, const AcdfLoadOptions* options, AcdfError* error);

/* Ends `file` and every view and pointer taken from it. Null is allowed. */
void acdf_close(AcdfFile* file);

/* The view of an environment file. Returns 1, or 0 (and `out` unset) where the file is of another kind or null.
 * `out` may be null: whether it is of that kind. */
int acdf_environment(const AcdfFile* file, AcdfEnvironment* out);
#ifndef ACDF_ENVIRONMENT_ONLY
/* The same for a local environment file, to be used with acdf/local.h. */
int acdf_local(const AcdfFile* file, AcdfLocal* out);
/* The same for a BRDF file, to be used with acdf/brdf.h. */
int acdf_brdf(const AcdfFile* file, AcdfBrdf* out);
/* The same for a table file, to be used with acdf/table.h. */
int acdf_table(const AcdfFile* file, AcdfTable* out);
/* The same for an environment of several maps, to be used with acdf/indexed.h. */
int acdf_indexed(const AcdfFile* file, AcdfIndexed* out);

/* The memory that views point into, to be copied: moves[ACDF_MAX_MOVES], `to` of which are null. Returns how many
 * there are (acdf/moved.h). */
int acdf_memory(const AcdfFile* file, AcdfMove* moves);
#endif

/* What a file says of itself, and its parts as they lie in it: valid until it is closed. `file` is not null. */
AcdfKind acdf_kind(const AcdfFile* file);
uint64_t acdf_size(const AcdfFile* file);        /* bytes of the whole file */
uint64_t acdf_table_bytes(const AcdfFile* file); /* of the runtime tables; 0: there are none */
const AcdfHeader* acdf_header(const AcdfFile* file);
const AcdfDescription* acdf_description(const AcdfFile* file);
const AcdfAxis* acdf_axis(const AcdfFile* file, uint32_t axis); /* null where axis >= axis_count */
const AcdfBin* acdf_bin(const AcdfFile* file, uint32_t bin);    /* null where bin >= bin_count */

/* UTF-8, not terminated; `data` is null where there is none. */
typedef struct AcdfText {
    const char* data;
    size_t size;
} AcdfText;

/* How many pairs of metadata there are. */
uint32_t acdf_metadata_count(const AcdfFile* file);
/* Pair i. Returns 1, or 0 (and key, value unset) where i >= the count. Either may be null. */
int acdf_metadata_pair(const AcdfFile* file, uint32_t i, AcdfText* key, AcdfText* value);
/* The value of `key`; data is null where the file has no such key, or `key` is null. */
AcdfText acdf_metadata_value(const AcdfFile* file, const char* key);

#ifdef __cplusplus
}
#endif
#endif
