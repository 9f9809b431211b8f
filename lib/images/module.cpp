#include "images/module.h"

#include <dlfcn.h>

#include <cstring>
#include <filesystem>
#include <stdexcept>

// Where the module is, if the program says so: tests do, which lie in many folders.
extern "C" __attribute__((weak)) const char acdf_images_module_path[];

namespace acdf::images {
namespace {

[[noreturn]] void fail(const std::string& path, std::string why) {
    if (why.rfind(path + ": ", 0) == 0) why = why.substr(path.size() + 2);
    throw std::runtime_error(path + ": this module, which reads and writes images, cannot be loaded (" + why +
                             "); install acdf again");
}

// Beside the program as it is installed, wherever that is: never a name that the loader would search for.
std::string module_path() {
    if (acdf_images_module_path) return acdf_images_module_path;
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    if (error) fail(ACDF_IMAGES_MODULE, "/proc/self/exe: " + error.message());
    return (program.parent_path() / ACDF_IMAGES_MODULE).lexically_normal().string();
}

std::string loader_error() {
    const char* text = dlerror();
    return text ? text : "no reason given";
}

const Module& load() {
    const std::string path = module_path();
    void* library = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (!library) fail(path, loader_error());
    void* symbol = dlsym(library, kGetModule);
    if (!symbol) fail(path, loader_error());
    GetModule get = nullptr;
    std::memcpy(&get, &symbol, sizeof get);
    const Module* loaded = get();
    if (std::strcmp(loaded->version, ACDF_VERSION) != 0)
        fail(path, std::string("it is of version ") + loaded->version + ", not " ACDF_VERSION);
    return *loaded;
}

} // namespace

const Module& module() {
    static const Module& loaded = load(); // once in all threads; after a failure the next call tries again
    return loaded;
}

} // namespace acdf::images
