/* An .acdf file, opened and checked: what a file says of itself. No view of it is here (acdf/acdf.h,
 * acdf/reader.h).
 *
 * The safety contract is that of acdf/reader.h: any bytes may be passed in; a file that was accepted can be
 * sampled for ever without reading outside it. An open file is never changed: any number of threads may use
 * it at once. Functions take only open files, not null, but for acdf_close and acdf_environment, acdf_local,
 * acdf_brdf and acdf_table, which return 0. */
#ifndef ACDF_FILE_H
#define ACDF_FILE_H

#include <acdf/allocator.h>
#include <acdf/layout.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct AcdfFile AcdfFile;
struct AcdfEnvironment;
struct AcdfLocal;
struct AcdfBrdf;
struct AcdfTable;
struct AcdfMove;
struct AcdfCurves;

/* What kind of failure; the numbers are stable. */
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

/* The same with limits, and with the caller's memory. A number that is 0 stands for its default, as do options that
 * are null. */
typedef struct AcdfLoadOptions {
    uint64_t max_file_bytes;     /* 0: 4 GiB */
    uint64_t max_inflated_bytes; /* of compressed chunks together; 0: 1 GiB */
    int plain; /* 1: without runtime tables: nothing is allocated for them, each call descends from the root */
    const struct AcdfCurves*
        curves;              /* acdf_curves() reads files of curves; null: they are refused as unsupported */
    AcdfAllocator allocator; /* of what the open file keeps, itself too; all null: the C library's */
} AcdfLoadOptions;
AcdfFile* acdf_open_with(const char* path, const AcdfLoadOptions* options, AcdfError* error);
AcdfFile* acdf_from_memory_with(const void* data, size_t size, const AcdfLoadOptions* options, AcdfError* error);

/* Ends `file` and every view and pointer taken from it. Null is allowed. */
void acdf_close(AcdfFile* file);

/* The view of an environment file, to be used with acdf/sample.h. Returns 1, or 0 (and `out` unset)
 * where the file is of another kind or null. `out` may be null: whether it is of that kind. */
int acdf_environment(const AcdfFile* file, struct AcdfEnvironment* out);
/* The same for a local environment file, to be used with acdf/local.h. */
int acdf_local(const AcdfFile* file, struct AcdfLocal* out);
/* The same for a BRDF file, to be used with acdf/brdf.h. */
int acdf_brdf(const AcdfFile* file, struct AcdfBrdf* out);
/* The same for a table file, to be used with acdf/table.h. */
int acdf_table(const AcdfFile* file, struct AcdfTable* out);

/* The memory that views point into, to be copied: moves[ACDF_MAX_MOVES], `to` of which are null. Returns how many
 * there are (acdf/moved.h). */
int acdf_memory(const AcdfFile* file, struct AcdfMove* moves);

/* What a file says of itself, and its parts as they lie in it: valid until it is closed. `file` is not null. */
AcdfKind acdf_kind(const AcdfFile* file);
uint64_t acdf_size(const AcdfFile* file);        /* bytes of the whole file */
uint64_t acdf_table_bytes(const AcdfFile* file); /* of the runtime tables; 0: there are none */
const AcdfHeader* acdf_header(const AcdfFile* file);
const AcdfDescription* acdf_description(const AcdfFile* file);
const AcdfAxis* acdf_axis(const AcdfFile* file, uint32_t axis); /* null where axis >= axis_count */
const AcdfBin* acdf_bin(const AcdfFile* file, uint32_t bin);    /* null where bin >= bin_count */
/* What the file is to be combined with; null: it is to be used alone. */
const AcdfPartner* acdf_partner(const AcdfFile* file);

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
