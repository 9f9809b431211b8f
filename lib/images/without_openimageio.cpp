// What a program that was built without OpenImageIO says of images that it does not read itself.
#include "images/module.h"

#include <cerrno>
#include <cstring>
#include <fstream>

namespace acdf::images {
namespace {

void* refuse(const std::string& path, int, Header&, std::string& error) {
    errno = 0;
    const bool readable = std::ifstream(path).good();
    error = readable || errno == 0
                ? "this acdf was built without OpenImageIO: it reads usual OpenEXR (one part, in rows), "
                  "Radiance and PFM files alone"
                : std::strerror(errno);
    return nullptr;
}

} // namespace

const ReaderModule& module() {
    static const ReaderModule none = {ACDF_VERSION, {refuse, {}, {}, {}, {}, {}, {}}};
    return none;
}

} // namespace acdf::images
