/* Environments that change while a renderer runs, in C99: the calls of acdf/rebuild.h, whose comments say what they
 * do. A part of the builder's library.
 *
 *     AcdfRebuildOptions options = {1024, 512, 16 << 10};
 *     options.bilinear = 1;
 *     AcdfRebuilder* sky = acdf_rebuilder_make(&options);
 *     AcdfFramePixels frame = {pixels, 3};
 *     while (next_frame(pixels)) {
 *         if (acdf_rebuilder_rebuild(sky, &frame, 1) != 0) puts(acdf_rebuilder_message(sky));
 *         AcdfEnvironment view = acdf_rebuilder_view(sky);
 *         AcdfDirectionSample s = acdf_environment_sample(&view, u0, u1);
 *         ...
 *     }
 *     acdf_rebuilder_free(sky);
 */
#ifndef ACDF_REBUILD_C_H
#define ACDF_REBUILD_C_H

#include <acdf/sample.h>

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What a rebuilder is made for. All that is 0 stands for its default. */
typedef struct AcdfRebuildOptions {
    uint32_t width, height; /* of the map */
    uint64_t budget;        /* bytes of a file; 0: 64 KiB */
    int octahedral;         /* the map's layout; 0: lat-long */
    int bilinear;           /* how the renderer looks the map up; 0: nearest */
    int repeats;            /* whether bilinear lookups find the last row beyond the first one */
    int best;               /* quality best; 0: quality fast */
    int uniform_if_black;   /* whether a black map becomes the faintest even light; 0: it is refused */
} AcdfRebuildOptions;

/* A map in memory. Strides in bytes, of any sign; 0: packed. */
typedef struct AcdfFramePixels {
    const void* data;  /* of the top left pixel */
    uint32_t channels; /* 1, 3 or 4 */
    int half;          /* half floats; 0: floats */
    ptrdiff_t channel_stride, pixel_stride, row_stride;
} AcdfFramePixels;

/* A rectangle of pixels. */
typedef struct AcdfFrameRegion {
    uint32_t x, y, width, height;
} AcdfFrameRegion;

/* Makes and keeps the files and views of one map. */
typedef struct AcdfRebuilder AcdfRebuilder;

/* Null where there is no memory. Where the options are wrong, all calls fail, and acdf_rebuilder_message says why.
 */
AcdfRebuilder* acdf_rebuilder_make(const AcdfRebuildOptions* options);
/* Frees it; null is fine. */
void acdf_rebuilder_free(AcdfRebuilder* rebuilder);

/* Called with the share that is done; returns 0 to cancel. Null: none. Stays set. */
void acdf_rebuilder_on_progress(AcdfRebuilder* rebuilder, int (*progress)(void* context, double share),
                                void* context);

/* EnvironmentRebuilder::rebuild and update. `threads`: at most so many; 0: all cores. Return 0, or the number of an
 * acdf::builder::ErrorCode. */
int acdf_rebuilder_rebuild(AcdfRebuilder* rebuilder, const AcdfFramePixels* pixels, int threads);
int acdf_rebuilder_update(AcdfRebuilder* rebuilder, const AcdfFramePixels* pixels, const AcdfFrameRegion* region,
                          int threads);

/* What was wrong with the last call; empty where nothing was. */
const char* acdf_rebuilder_message(const AcdfRebuilder* rebuilder);
/* The last frame: its view, file and relative variance. Without any an empty view (`columns` is 0), null and 0. */
AcdfEnvironment acdf_rebuilder_view(const AcdfRebuilder* rebuilder);
const uint8_t* acdf_rebuilder_file(const AcdfRebuilder* rebuilder, size_t* size);
double acdf_rebuilder_relative_variance(const AcdfRebuilder* rebuilder);

#ifdef __cplusplus
}
#endif
#endif
