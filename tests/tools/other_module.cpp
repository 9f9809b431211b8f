// A module of a version that never was, in the place of either.
#include "images/module.h"

extern "C" const acdf::images::Module* acdf_images_module() {
    static acdf::images::Module functions{};
    functions.version = "0.0";
    return &functions;
}

extern "C" const acdf::images::ReaderModule* acdf_openexr_module() { return acdf_images_module(); }
