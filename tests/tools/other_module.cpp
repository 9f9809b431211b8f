// A module of a version that never was, in the place of any.
#include "images/module.h"

extern "C" const acdf::images::OpenExrModule* acdf_openexr_module() {
    static acdf::images::OpenExrModule functions{};
    functions.version = "0.0";
    return &functions;
}

extern "C" const acdf::images::ReaderModule* acdf_images_module() { return acdf_openexr_module(); }

extern "C" const acdf::images::TextModule* acdf_text_module() {
    static acdf::images::TextModule functions{};
    functions.version = "0.0";
    return &functions;
}
