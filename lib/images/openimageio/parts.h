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

} // namespace acdf::images
