// The module that alone is linked with OpenImageIO.
#include "parts.h"

extern "C" __attribute__((visibility("default"))) const acdf::images::ReaderModule* acdf_images_module() {
    using namespace acdf::images;
    static const ReaderModule functions = {
        ACDF_VERSION, {open_image, close_image, seek_part, read_rows, text_of, integer_of, real_of}};
    return &functions;
}
