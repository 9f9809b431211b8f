/**
 * acdf_at, acdf_anywhere, acdf_sample and acdf_pdf in GLSL ES 3.00, to be put after the #version and the precisions; of a BRDF
 * acdf_view, acdf_sample_brdf and acdf_pdf_brdf.
 */
export const glsl: string;
/** The same in WGSL; the tables are binding 0 of group 0. */
export const wgsl: string;
