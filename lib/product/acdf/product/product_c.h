/* Product sampling (acdf/product/product.h) from C: light times cosine times BRDF at a shading point, with its
 * exact pdf. Linked, not inline. Nothing is allocated; all functions are thread-safe.
 *
 *   AcdfProductPoint point;
 *   acdf_product_at(&local, &brdf, 64, frame, wo, &point);
 *   s = acdf_product_sample(&local, &brdf, &point, u0, u1);
 *   p = acdf_product_pdf(&local, &brdf, &point, direction);
 */
#ifndef ACDF_PRODUCT_C_H
#define ACDF_PRODUCT_C_H

#include <acdf/brdf.h>
#include <acdf/local.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A shading point, ready to be sampled from: plain bytes that may be copied. */
typedef union AcdfProductPoint {
    unsigned char bytes[9240];
    double align;
} AcdfProductPoint;

/* Prepares a shading point. `parts` as in acdf::ProductOptions, 1 to 96. `frame`: the surface's tangent, bitangent
 * and normal, three unit vectors; wo: towards the viewer; both in the frame of directions. */
void acdf_product_at(const AcdfLocal* light, const AcdfBrdf* brdf, int parts, const float frame[9],
                     const float wo[3], AcdfProductPoint* point);
/* Samples a direction with the light and BRDF that the point was made with; u0 and u1 in [0, 1]. The pdf is
 * in sr^-1; it is 0 where nothing is sampled: the sample counts as 0, as do directions below the surface. */
AcdfDirectionSample acdf_product_sample(const AcdfLocal* light, const AcdfBrdf* brdf, const AcdfProductPoint* point,
                                        double u0, double u1);
/* The pdf in sr^-1 of a unit direction; exactly that of the sample for what it returned. */
float acdf_product_pdf(const AcdfLocal* light, const AcdfBrdf* brdf, const AcdfProductPoint* point,
                       const float direction[3]);

/* A renderer's own BRDF, as acdf::Lobe: of unit vectors in the surface's frame, wo above the surface. `data` is
 * handed to each function. */
typedef struct AcdfLobe {
    const void* data;
    float (*value)(const void* data, const float wo[3], const float wi[3]); /* the BRDF, up to a factor */
    AcdfDirectionSample (*sample)(const void* data, const float wo[3], double u0, double u1);
    float (*pdf)(const void* data, const float wo[3], const float wi[3]); /* of `sample`, sr^-1 */
} AcdfLobe;

/* The three functions above with a renderer's own BRDF. */
void acdf_product_lobe_at(const AcdfLocal* light, const AcdfLobe* lobe, int parts, const float frame[9],
                          const float wo[3], AcdfProductPoint* point);
AcdfDirectionSample acdf_product_lobe_sample(const AcdfLocal* light, const AcdfLobe* lobe,
                                             const AcdfProductPoint* point, double u0, double u1);
float acdf_product_lobe_pdf(const AcdfLocal* light, const AcdfLobe* lobe, const AcdfProductPoint* point,
                            const float direction[3]);

#ifdef __cplusplus
}
#endif
#endif
