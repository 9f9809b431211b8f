// acdf/shader.h ("cells"), and acdf/shader_walk.h and acdf/shader_brdf.h ("walk") in the languages of shaders, with
// what declares the tables and the functions `acdf_sample` and `acdf_pdf`. Made by the build from these headers;
// head.txt and what to call, cells.txt and walk.txt of each language, are written by hand.
#pragma once

namespace acdf {

extern const char shader_cells_c[];
extern const char shader_cells_glsl[];
extern const char shader_cells_hlsl[];
extern const char shader_cells_wgsl[];
extern const char shader_walk_c[];
extern const char shader_walk_glsl[];
extern const char shader_walk_hlsl[];
extern const char shader_walk_wgsl[];

} // namespace acdf
