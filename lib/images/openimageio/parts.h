// The module's functions; images/module.h says what they do.
#pragma once

#include "images/module.h"

namespace acdf::images {

void* open_image(const std::string& path, int threads, Header& header, std::string& error);
void close_image(void* image);
bool seek_part(void* image, int part, Header& header);
bool read_rows(void* image, const Rows& rows, float* to, std::string& error);
std::string text_of(const void* image, const char* name);
int integer_of(const void* image, const char* name, int otherwise);
float real_of(const void* image, const char* name, float otherwise);

bool encode_picture(const Picture& picture, const Encoding& encoding, std::vector<std::uint8_t>& bytes,
                    std::string& error);

bool map_colours(const Picture& positions, const std::string& name, const std::vector<float>& knots,
                 Picture& colours, std::string& error);
bool width_of_text(const std::string& text, int size, const std::string& font, int& width);
void draw_text_in(Picture& picture, int x, int y, const std::string& text, int size, const std::string& font,
                  const float colour[3]);

} // namespace acdf::images
