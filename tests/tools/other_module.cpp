// A module of a version that never was.
#include "images/module.h"

extern "C" const acdf::images::Module* acdf_images_module() {
    static acdf::images::Module functions{};
    functions.version = "0.0";
    return &functions;
}
