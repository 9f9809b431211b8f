/* The on-disk layout of .acdf files, version 1, as plain C (C99, C++17, CUDA). SPEC.md is the authority;
 * this header restates its tables so that a reader can map the bytes. All integers and IEEE-754 numbers
 * are little-endian. Offsets are counted from the start of what holds them; nothing is a pointer. */
#ifndef ACDF_LAYOUT_H
#define ACDF_LAYOUT_H

#include <stddef.h>
#include <stdint.h>

#if defined(__BYTE_ORDER__) && defined(__ORDER_BIG_ENDIAN__)
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
#error "acdf files are little-endian and are read in place"
#endif
#endif

#define ACDF_VERSION_MAJOR 1
#define ACDF_VERSION_MINOR 0

/* SPEC.md §2. A high bit (7-bit transports), CR LF and LF (text mode), SUB (DOS `type`). */
#define ACDF_MAGIC_BYTES                                                                                           \
    { 0xAB, 'A', 'C', 'D', 'F', ' ', ' ', 0xBB, 0x0D, 0x0A, 0x1A, 0x0A }

enum {
    ACDF_MAGIC_SIZE = 12,
    ACDF_ALIGNMENT = 64, /* every payload starts at a multiple of this */
    ACDF_MAX_CHUNKS = 64,
    ACDF_MAX_AXES = 8,
    ACDF_MAX_DEPTH = 64, /* curves on a path from a root to a cell */
    ACDF_MAX_SEGMENTS = 0xFFFFF
};

typedef enum AcdfKind {
    ACDF_KIND_ENVIRONMENT = 1,
    ACDF_KIND_LOCAL = 2,
    ACDF_KIND_BRDF = 3,
    ACDF_KIND_TABLE = 4,
    ACDF_KIND_INDEXED = 5 /* an environment of several maps */
} AcdfKind;

typedef enum AcdfCodec {
    ACDF_CODEC_NONE = 0,
    ACDF_CODEC_ZLIB = 1,
    ACDF_CODEC_PLANES = 2 /* zlib, and for TREE alone: its planes (SPEC.md §7.4) */
} AcdfCodec;

/* How sampled coordinates become directions (SPEC.md §2.1). */
typedef enum AcdfParameterization {
    ACDF_PARAM_LATLONG = 1,    /* columns in phi, rows in theta; density uniform in z = cos(theta) */
    ACDF_PARAM_HALF_ANGLE = 2, /* reserved for BRDFs */
    ACDF_PARAM_TABLE = 3,      /* points of N-dimensional tables */
    ACDF_PARAM_OCTAHEDRAL = 4  /* columns in u, rows in v of the equal-area octahedral square */
} AcdfParameterization;

typedef enum AcdfFit { ACDF_FIT_UNIFORM = 1, ACDF_FIT_CDF = 2, ACDF_FIT_PDF = 3, ACDF_FIT_VARIANCE = 4 } AcdfFit;

typedef enum AcdfFilter { ACDF_FILTER_NEAREST = 0, ACDF_FILTER_BILINEAR = 1 } AcdfFilter;
/* Which noise the fit minimised. */
typedef enum AcdfChannels {
    ACDF_CHANNELS_WEIGHTED = 0, /* that of the weighted sum of the channels */
    ACDF_CHANNELS_SEPARATE = 1, /* the sum of that of each channel */
    ACDF_CHANNELS_LARGEST = 2   /* that of the largest channel of each texel */
} AcdfChannels;
typedef enum AcdfUpAxis { ACDF_UP_Z = 2 } AcdfUpAxis;
typedef enum AcdfHandedness { ACDF_RIGHT_HANDED = 0 } AcdfHandedness;
typedef enum AcdfAxisRole { ACDF_AXIS_SAMPLED = 0, ACDF_AXIS_INDEXED = 1 } AcdfAxisRole;

/* How integer positions on an axis map to its coordinate (SPEC.md §5.2). */
typedef enum AcdfAxisMeasure {
    ACDF_MEASURE_LINEAR = 0, /* low + (high - low) * position / resolution */
    ACDF_MEASURE_COSINE = 1, /* cos of that: positions are equal steps of an angle */
    ACDF_MEASURE_HALF = 2    /* of half-vectors: fine near low (SPEC.md §11) */
} AcdfAxisMeasure;

/* What a file was made to be combined with, by multiple importance sampling (SPEC.md §5.4). */
typedef enum AcdfPartnerKind {
    ACDF_PARTNER_NONE = 0,
    ACDF_PARTNER_COSINE = 1, /* cos / pi around the normal */
    ACDF_PARTNER_BRDF = 2,   /* lobes as BRDFs have them: cosine, and GGX of several widths */
    ACDF_PARTNER_MEAN = 3,   /* as if it were the same everywhere: Karlik et al. 2019 */
    ACDF_PARTNER_TABLE = 4   /* of a table: another table over the same axes */
} AcdfPartnerKind;

typedef enum AcdfHeuristic {
    ACDF_HEURISTIC_BALANCE = 0, /* n_i p_i over their sum */
    ACDF_HEURISTIC_POWER = 1    /* of their squares */
} AcdfHeuristic;

#define ACDF_FOURCC(a, b, c, d) ((uint32_t)(a) | (uint32_t)(b) << 8 | (uint32_t)(c) << 16 | (uint32_t)(d) << 24)
#define ACDF_CHUNK_DESCRIPTION ACDF_FOURCC('D', 'E', 'S', 'C')
#define ACDF_CHUNK_BINS ACDF_FOURCC('B', 'I', 'N', 'S')
#define ACDF_CHUNK_TREE ACDF_FOURCC('T', 'R', 'E', 'E')
#define ACDF_CHUNK_METADATA ACDF_FOURCC('M', 'E', 'T', 'A')
#define ACDF_CHUNK_LOCAL ACDF_FOURCC('L', 'O', 'C', 'L')
#define ACDF_CHUNK_PARTNER ACDF_FOURCC('C', 'O', 'M', 'P')
#define ACDF_CHUNK_VIEWS ACDF_FOURCC('V', 'I', 'E', 'W')
#define ACDF_CHUNK_VISIBILITY ACDF_FOURCC('P', 'L', 'A', 'C')
#define ACDF_CHUNK_PORTALS ACDF_FOURCC('P', 'O', 'R', 'T')
#define ACDF_CHUNK_HALVINGS ACDF_FOURCC('H', 'A', 'L', 'V')
#define ACDF_CHUNK_MAPS ACDF_FOURCC('M', 'A', 'P', 'S')
#define ACDF_CHUNK_NORMALS ACDF_FOURCC('N', 'O', 'R', 'M')

#define ACDF_CHUNK_FLAG_CRITICAL 1u

/* Offset 0 of the file; the chunk table follows at once. */
typedef struct AcdfHeader {
    uint8_t magic[ACDF_MAGIC_SIZE];
    uint16_t version_major;
    uint16_t version_minor;
    uint64_t file_length;
    uint32_t kind;
    uint32_t required_features; /* version 1.0 defines none: a set bit is refused */
    uint32_t optional_features; /* unknown bits are ignored */
    uint32_t chunk_count;
    uint32_t reserved[5];
    uint32_t header_crc; /* CRC-32 of the 60 bytes before it, then of the chunk table */
} AcdfHeader;

typedef struct AcdfChunk {
    uint32_t type;
    uint32_t flags;
    uint32_t codec;
    uint32_t crc; /* CRC-32 of the stored bytes */
    uint64_t offset;
    uint64_t stored_length;
    uint64_t raw_length;
    uint64_t reserved;
} AcdfChunk;

/* Chunk DESC: this, then `axis_count` axis records. */
typedef struct AcdfDescription {
    uint32_t parameterization;
    uint32_t fit;
    uint32_t filter;
    uint32_t up_axis;
    uint32_t handedness;
    uint32_t axis_count;
    uint32_t bin_count;
    uint32_t channels;         /* AcdfChannels */
    double channel_weights[3]; /* target = weights . (r, g, b) */
    double total;              /* integral of the target: over the sphere in W/m^2-like units of L * sr */
} AcdfDescription;

typedef struct AcdfAxis {
    uint8_t name[16]; /* UTF-8, zero-padded */
    uint32_t role;
    uint32_t measure;
    uint32_t resolution; /* positions run from 0 to resolution */
    uint32_t reserved;
    double low; /* coordinate at position 0 */
    double high;
} AcdfAxis;

/* Chunk BINS: one record a bin. */
typedef struct AcdfBin {
    uint32_t root; /* offset of the bin's first curve in TREE, in units of two bytes */
    float share;   /* this bin's integral over `total` */
} AcdfBin;

/* Chunk TREE: curves, packed one after the other, each a whole number of 16-bit units (SPEC.md §7.2):
 *   uint16 header; [uint32 segments, as two uint16]; cumulative[n-1]; positions[n-1]; links[n] (if any);
 *   tilts[n] (if any); zero padding. Each array starts at the next multiple of its element's size. */
#define ACDF_CURVE_AXIS_MASK 0x0007u
#define ACDF_CURVE_CUMULATIVE_CODE(header) ((header) >> 3 & 3u) /* log2 of the bytes: 0, 1 or 2 */
#define ACDF_CURVE_POSITION_CODE(header) ((header) >> 5 & 3u)   /* the same; 0: counted from the range's low end */
#define ACDF_CURVE_LINK_CODE(header) ((header) >> 7 & 3u) /* 0: all segments end; else 1 + log2 of the bytes */
#define ACDF_CURVE_TILTED 0x0200u
#define ACDF_CURVE_SEGMENTS_SHIFT 10 /* 1 to 63 segments; 0: the count follows */
#define ACDF_CURVE_SHORT_SEGMENTS 63u

/* Chunk HALV: a tree of halvings (SPEC.md §6.2), instead of BINS and TREE. This, then two runs of bits, the lowest
 * of each byte first, each padded with zeros to a multiple of 32: the nodes in preorder, 0 for a leaf, else 1 and
 * the number of a sampled axis; then `code_bits` a halving, in the same order. */
typedef struct AcdfHalvingsHeader {
    uint32_t halving_count;
    uint32_t code_bits; /* ACDF_LEAST_CODE_BITS to ACDF_MOST_CODE_BITS */
    uint32_t reserved[2];
} AcdfHalvingsHeader;
#define ACDF_LEAST_CODE_BITS 2u
#define ACDF_MOST_CODE_BITS 12u
#define ACDF_MOST_HALVINGS 0x7FFFFFFu /* 2^27 - 1 */

#ifndef ACDF_ENVIRONMENT_ONLY
/* Chunk MAPS of an indexed environment, beside HALV: this, then for each indexed axis a double an index, its
 * coordinate, then an AcdfMap for each map, then a bit for each halving, 1 where each map has a code of its own,
 * then for each map the codes of these halvings. Runs of bits as in HALV. */
typedef struct AcdfMapsHeader {
    uint32_t map_count;
    uint32_t split_count; /* halvings with a code for each map: the top of the tree */
    uint32_t code_bits;   /* ACDF_LEAST_MAP_CODE_BITS to ACDF_MOST_CODE_BITS */
    uint32_t sun;         /* 0: none; else 1 to ACDF_MOST_SUN, the exponent of its profile is 2^(sun - 1) - 1 */
} AcdfMapsHeader;
#define ACDF_LEAST_MAP_CODE_BITS 4u
#define ACDF_MOST_SUN 4u
#define ACDF_MOST_INDEXED_AXES 3u

/* Chunk NORM of a local environment or a BRDF, beside HALV and BINS and instead of TREE (SPEC.md
 * §9 and §11): this, then a bit for each halving, 1 where each row has a code of its own, then row by row the
 * codes of these halvings, but for those that the row leads no random numbers to. Runs of bits as in HALV. */
typedef struct AcdfNormalsHeader {
    uint32_t row_count;
    uint32_t split_count; /* halvings with a code for each row: the top of the tree */
    uint32_t code_bits;   /* ACDF_LEAST_MAP_CODE_BITS to ACDF_MOST_ROW_CODE_BITS */
    uint32_t reserved;    /* 0 */
} AcdfNormalsHeader;
#define ACDF_MOST_ROW_CODE_BITS 8u
#define ACDF_MOST_NORMAL_RATIO 64u /* rows times splits, at most, over the bytes of NORM */

typedef struct AcdfMap {
    float share;     /* its integral over `total` */
    float sun_share; /* of its light in the cone of the sun, in [0, 1) */
    float radius;    /* of the cone, radians; 0 where the sun is not known */
    float sun[3];    /* unit, to its middle; zeros where it is not known */
} AcdfMap;
#endif

#ifndef ACDF_ENVIRONMENT_ONLY
/* The streams of codec 2 (SPEC.md §7.4). Where there are several sizes, the stream of the smallest is named. */
enum {
    ACDF_PLANE_HEADERS = 0,
    ACDF_PLANE_SEGMENTS = 1,
    ACDF_PLANE_CUMULATIVE = 2, /* and 3, 4: by their code */
    ACDF_PLANE_POSITIONS = 5,  /* and 6, 7 */
    ACDF_PLANE_CHILDREN = 8,   /* and 9: of curves of more than 255 segments */
    ACDF_PLANE_TILTS = 10,
    ACDF_PLANE_STREAMS = 11
};

/* Bytes of a value of a stream. */
#define ACDF_PLANE_VALUE_SIZES                                                                                     \
    { 2, 4, 1, 2, 4, 1, 2, 4, 1, 4, 2 }

/* What codec 2 inflates to: this, then the streams. */
typedef struct AcdfPlanes {
    uint32_t count[ACDF_PLANE_STREAMS]; /* of values in each stream */
} AcdfPlanes;

/* Chunk LOCL, of local environments. */
typedef struct AcdfLocalHeader {
    float cosine_share; /* in [0, 1): of samples taken around the normal with density cos / pi */
    uint32_t reserved;  /* 0 */
} AcdfLocalHeader;
#endif

/* Chunk COMP of a file that is not to be used alone: this, then `record_count` records (0, or one a bin). */
typedef struct AcdfPartner {
    uint32_t kind;                 /* AcdfPartnerKind, not 0 */
    uint32_t heuristic;            /* AcdfHeuristic */
    float share;                   /* of the samples, in (0, 1): the share of this file that the fit assumed */
    float recommended_light_share; /* in (0, 1]: of the samples that this file should sample, in the mean */
    uint32_t record_count;
    uint32_t reserved; /* 0 */
} AcdfPartner;

typedef struct AcdfPartnerRecord {
    float recommended_light_share; /* of the bin, in (0, 1] */
    float flux;                    /* of local environments: irradiance of the bin over `total`; else 0 */
} AcdfPartnerRecord;

#ifndef ACDF_ENVIRONMENT_ONLY
/* Chunk PLAC, of local environments: what of the light reaches a position (SPEC.md §12.1). This, then `split_count`
 * splits, then 1 + `further_sets` sets of `column_count` AcdfColumn, then, where there are further sets, a uint16
 * for each row, its set, then `row_count` rows of 1 + `column_count` bytes: a code of visibility of all light, and
 * a code of the odds of each column. */
typedef struct AcdfVisibility {
    uint32_t split_count;
    uint32_t row_count;
    uint32_t column_count; /* of each set */
    uint32_t further_sets; /* less than 65536 */
    float low[3];          /* the box of all cells */
    float high[3];         /* above `low` */
    float transform[3][4]; /* from positions in the scene to those of cells: x' = t[0] x + t[1] y + t[2] z + t[3] */
} AcdfVisibility;

/* A split of a cell in two. Splits stand in preorder: the lower part, if it is a split, follows at once. */
typedef struct AcdfVisibilitySplit {
    float position;
    uint32_t
        lower; /* bits 0-2: axis, of the position or (3 to 5) the normal; bits 3-31: the lower part, as `upper` */
    uint32_t upper; /* a later split, or ACDF_VISIBILITY_ROW | a row */
} AcdfVisibilitySplit;

/* Tiles that follow each other are parted at a column. Columns of a set stand in preorder: the lower part, if it is
 * parted, follows at once. */
typedef struct AcdfColumn {
    uint16_t tile;  /* the first one of the upper part */
    uint16_t parts; /* bits 0-14: the column of the upper part, 0: none; bit 15: the lower part has none */
} AcdfColumn;

#define ACDF_MAX_COLUMNS 0x8000u
#define ACDF_MAX_COLUMNS_DEEP 64u /* on a path */
#define ACDF_ODDS_BITS 8u         /* of a code of odds, one as HALV has them */
#define ACDF_VISIBILITY_ROW 0x10000000u
#define ACDF_MAX_VISIBILITY_DEPTH 64u /* on a path */

/* Chunk PORT, of local environments with PLAC: rectangles that light comes through (SPEC.md §13.1). This, then
 * `portal_count` portals, then `map_count` maps, then for each map (`size` + 1)^2 uint32, its light below and left
 * of each corner of its cells, then for each row of PLAC 1 + `portal_count` * `pieces`^2 bytes: the share of the
 * row itself, and codes of visibility of the pieces of each portal. */
typedef struct AcdfPortals {
    uint32_t portal_count; /* 1 to ACDF_MAX_PORTALS */
    uint32_t map_count;    /* 1 to `portal_count` */
    uint32_t size;         /* cells along each axis of a map, 1 to ACDF_MAX_PORTAL_CELLS */
    uint32_t pieces;       /* that a portal is divided into along each side, 1 to ACDF_MAX_PORTAL_PIECES */
} AcdfPortals;

/* A rectangle among the cells of visibility. */
typedef struct AcdfPortal {
    float corner[3];
    float sides[2]; /* lengths, along axes 0 and 1 of the map */
    uint32_t map;
} AcdfPortal;

/* The light of the hemisphere that portals face: all that have the same axes. */
typedef struct AcdfPortalMap {
    float axis[3]
              [3]; /* unit, at right angles: along the sides of a portal, and out of it, where light comes from */
    float unit;    /* > 0: of the light, what 1 in the map is; the same unit for all maps */
} AcdfPortalMap;

#define ACDF_MAX_PORTALS 8u
#define ACDF_MAX_PORTAL_CELLS 4096u
#define ACDF_MAX_PORTAL_PIECES 4u

#define ACDF_NO_ROOT 0xFFFFFFFFu /* of a bin: it is not stored */

/* Chunk VIEW of a BRDF (SPEC.md §11): this, then `theta_count` f32, sqrt(1 - cos(theta_o)) of the stored views. */
typedef struct AcdfViews {
    uint32_t theta_count;
    uint32_t phi_count;  /* 1: isotropic */
    uint32_t flags;      /* ACDF_VIEWS_MIRRORED or 0 */
    float diffuse_share; /* of a cosine lobe in the density */
} AcdfViews;
#define ACDF_VIEWS_MIRRORED 1u /* phi_h from 0 to pi stands for both sides */
#endif

#ifdef __cplusplus
#define ACDF_STATIC_ASSERT(condition) static_assert(condition, #condition)
#else
#define ACDF_STATIC_ASSERT(condition) _Static_assert(condition, #condition)
#endif
ACDF_STATIC_ASSERT(sizeof(AcdfHeader) == 64);
ACDF_STATIC_ASSERT(offsetof(AcdfHeader, file_length) == 16);
ACDF_STATIC_ASSERT(offsetof(AcdfHeader, chunk_count) == 36);
ACDF_STATIC_ASSERT(offsetof(AcdfHeader, header_crc) == 60);
ACDF_STATIC_ASSERT(sizeof(AcdfChunk) == 48);
ACDF_STATIC_ASSERT(sizeof(AcdfHalvingsHeader) == 16);
ACDF_STATIC_ASSERT(offsetof(AcdfChunk, offset) == 16);
ACDF_STATIC_ASSERT(sizeof(AcdfDescription) == 64);
ACDF_STATIC_ASSERT(offsetof(AcdfDescription, channel_weights) == 32);
ACDF_STATIC_ASSERT(offsetof(AcdfDescription, total) == 56);
ACDF_STATIC_ASSERT(sizeof(AcdfAxis) == 48);
ACDF_STATIC_ASSERT(offsetof(AcdfAxis, low) == 32);
ACDF_STATIC_ASSERT(sizeof(AcdfBin) == 8);
ACDF_STATIC_ASSERT(sizeof(AcdfPartner) == 24);
ACDF_STATIC_ASSERT(sizeof(AcdfPartnerRecord) == 8);
#ifndef ACDF_ENVIRONMENT_ONLY
ACDF_STATIC_ASSERT(sizeof(AcdfMapsHeader) == 16);
ACDF_STATIC_ASSERT(sizeof(AcdfNormalsHeader) == 16);
ACDF_STATIC_ASSERT(sizeof(AcdfMap) == 24);
ACDF_STATIC_ASSERT(sizeof(AcdfPlanes) == 44);
ACDF_STATIC_ASSERT(sizeof(AcdfLocalHeader) == 8);
ACDF_STATIC_ASSERT(sizeof(AcdfViews) == 16);
ACDF_STATIC_ASSERT(sizeof(AcdfVisibility) == 88);
ACDF_STATIC_ASSERT(sizeof(AcdfVisibilitySplit) == 12);
ACDF_STATIC_ASSERT(sizeof(AcdfPortals) == 16);
ACDF_STATIC_ASSERT(sizeof(AcdfPortal) == 24);
ACDF_STATIC_ASSERT(sizeof(AcdfPortalMap) == 40);
#endif

#endif
