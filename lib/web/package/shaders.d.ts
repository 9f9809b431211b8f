/** acdf_sample and acdf_pdf in GLSL ES 3.00, to be put after the #version and the precisions. */
export const glsl: string;
/** The same in WGSL; the tables are binding 0 of group 0. */
export const wgsl: string;
/**
 * For the words of shaderTables({ walk: true }), in GLSL ES 3.00: acdf_at, acdf_sample and acdf_pdf; of a BRDF acdf_view,
 * acdf_sample_brdf and acdf_pdf_brdf.
 */
export const glslWalk: string;
/** The same in WGSL. */
export const wgslWalk: string;
