// acdf/shader.h in the languages of shaders, with what declares the tables and the functions `acdf_sample` and
// `acdf_pdf`. Made by the build from that header; head.txt and tail.txt of each language are written by hand.
#pragma once

namespace acdf {

extern const char shader_text_c[];
extern const char shader_text_glsl[];
extern const char shader_text_hlsl[];
extern const char shader_text_wgsl[];

} // namespace acdf
