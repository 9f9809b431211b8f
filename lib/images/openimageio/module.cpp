// The module that alone is linked with OpenImageIO.
#include "parts.h"

extern "C" __attribute__((visibility("default"))) const acdf::images::Module* acdf_images_module() {
    using namespace acdf::images;
    static const Module functions = {
        {ACDF_VERSION, {open_image, close_image, seek_part, read_rows, text_of, integer_of, real_of}},
        encode_picture,
        map_colours,
        width_of_text,
        draw_text_in};
    return &functions;
}
