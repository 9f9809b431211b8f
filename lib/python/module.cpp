// acdf._acdf: what the Python package acdf is made over. It is not to be used by itself.
#include "python/file.h"
#include "python/options.h"

PYBIND11_MODULE(_acdf, module) {
    module.attr("__version__") = ACDF_VERSION;
    module.attr("format_version") = std::to_string(ACDF_VERSION_MAJOR) + "." + std::to_string(ACDF_VERSION_MINOR);
    acdf::python::add_file(module);
    acdf::python::add_indexed(module);
    acdf::python::add_build(module);
    acdf::python::add_renderers(module);
}
