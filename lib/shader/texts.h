// acdf/shader/walk.h and acdf/shader/brdf.h in the languages of shaders, with declarations of the tables and the
// functions `acdf_sample` and `acdf_pdf`. The build makes them from these headers; head.txt and walk.txt of each
// language are written by hand.
#pragma once

namespace acdf {

extern const char shader_walk_c[];
extern const char shader_walk_glsl[];
extern const char shader_walk_hlsl[];
extern const char shader_walk_wgsl[];

} // namespace acdf
