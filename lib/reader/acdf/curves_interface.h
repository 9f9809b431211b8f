/* How files with chunk TREE are read, of the fits `cdf`, `pdf` and `uniform`: by functions of a library beside
 * the reader (acdf/curves/curves.h). A program hands them over when it opens a file, and the reader knows no more
 * of them than this table. Views of such files have no tree of halvings: their functions call the table's. */
#ifndef ACDF_CURVES_INTERFACE_H
#define ACDF_CURVES_INTERFACE_H

#include <acdf/grid.h>

#ifdef __cplusplus
extern "C" {
#endif

struct AcdfBrdf;
struct AcdfBrdfPosition;
struct AcdfBrdfView;
struct AcdfEnvironment;
struct AcdfLocal;
struct AcdfLocalPoint;
struct AcdfNormalBins;
struct AcdfUncheckedFile;

typedef struct AcdfCurves {
    /* Puts a TREE of `tree_size` bytes together from `size` bytes of codec 2. Returns 0, or the rule that is broken
     * and, at `wrong`, what is wrong. */
    int (*inflate)(const uint8_t* bytes, uint64_t size, uint8_t* tree, uint64_t tree_size, const char** wrong);
    /* Checks what a file without HALV has beside DESC and META. */
    void (*check)(const struct AcdfUncheckedFile* file);

    /* As acdf_environment_sample, _pdf and _invert. */
    AcdfDirectionSample (*sample)(const struct AcdfEnvironment* env, double u0, double u1);
    float (*pdf)(const struct AcdfEnvironment* env, const float direction[3]);
    int (*invert)(const struct AcdfEnvironment* env, const float direction[3], double u[2]);
    /* The cell that holds a grid square, and the random numbers that lead there. Returns its probability. */
    double (*find)(const struct AcdfEnvironment* env, const uint32_t square[2], AcdfRange range[2],
                   AcdfStratum strata[2]);

    /* As acdf_local_bins, _at and _irradiance. */
    int (*local_bins)(const struct AcdfLocal* local, const float normal[3], struct AcdfNormalBins* out);
    void (*local_at)(const struct AcdfLocal* local, const float normal[3], struct AcdfLocalPoint* out);
    double (*local_irradiance)(const struct AcdfLocal* local, const float normal[3]);

    /* As acdf_brdf_view, acdf_brdf_find, acdf_brdf_view_sample, _view_pdf and acdf_brdf_invert. */
    int (*brdf_view)(const struct AcdfBrdf* brdf, const float wo[3], struct AcdfBrdfView* view);
    double (*brdf_find)(const struct AcdfBrdf* brdf, const struct AcdfBrdfView* view,
                        const struct AcdfBrdfPosition* place, AcdfRange range[2], AcdfStratum* strata);
    AcdfDirectionSample (*brdf_sample)(const struct AcdfBrdf* brdf, const struct AcdfBrdfView* view, double u0,
                                       double u1);
    float (*brdf_pdf)(const struct AcdfBrdf* brdf, const struct AcdfBrdfView* view, const float wi[3]);
    int (*brdf_invert)(const struct AcdfBrdf* brdf, const float wo[3], const float wi[3], double u[2]);
} AcdfCurves;

/* Returns what curves do, where a view has them. Kernels call no pointers: they take views of halvings alone. */
#ifdef ACDF_ON_GPU
#define ACDF_RETURN_CURVES(view, call)
#else
#define ACDF_RETURN_CURVES(view, call)                                                                             \
    if (!(view)->halved) return (view)->curves->call
#endif

#ifdef __cplusplus
}
#endif
#endif
