/** acdf_sample and acdf_pdf in GLSL ES 3.00, to be put after the #version and the precisions. */
export const glsl: string;
/** The same in WGSL; the tables are binding 0 of group 0. */
export const wgsl: string;
/** acdf_at, acdf_sample and acdf_pdf in GLSL ES 3.00, for the words of shaderTables({ walk: true }). */
export const glslWalk: string;
/** The same in WGSL. */
export const wgslWalk: string;
