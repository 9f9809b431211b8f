#include "images/module.h"

#include <dlfcn.h>

#include <cstring>
#include <filesystem>
#include <stdexcept>

// Where modules are, if the program says so: tests do, which lie in many folders.
extern "C" __attribute__((weak)) const char acdf_images_folder[];

namespace acdf::images {
namespace {

[[noreturn]] void fail(const std::string& path, std::string why) {
    if (why.rfind(path + ": ", 0) == 0) why = why.substr(path.size() + 2);
    throw std::runtime_error(path + ": this module, which pictures need, cannot be loaded (" + why +
                             "); install acdf again");
}

// Beside the program as it is installed, wherever that is: never a name that the loader would search for.
std::string path_of(const std::string& module) {
    if (acdf_images_folder) return (std::filesystem::path(acdf_images_folder) / module).string();
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    if (error) fail(module, "/proc/self/exe: " + error.message());
    return (program.parent_path() / ACDF_IMAGES_FOLDER / module).lexically_normal().string();
}

std::string loader_error() {
    const char* text = dlerror();
    return text ? text : "no reason given";
}

/// The table of functions of a module whose file is `name`.so.
template <class Table>
const Table& load(const std::string& name) {
    const std::string path = path_of(name + ".so");
    void* library = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (!library) fail(path, loader_error());
    void* symbol = dlsym(library, (name + "_module").c_str());
    if (!symbol) fail(path, loader_error());
    const Table* (*get)() = nullptr;
    std::memcpy(&get, &symbol, sizeof get);
    const Table* loaded = get();
    if (std::strcmp(loaded->version, ACDF_VERSION) != 0)
        fail(path, std::string("it is of version ") + loaded->version + ", not " ACDF_VERSION);
    return *loaded;
}

} // namespace

// Once in all threads; after a failure the next call tries again.
#if ACDF_OPENIMAGEIO
const ReaderModule& module() {
    static const ReaderModule& loaded = load<ReaderModule>("acdf_images");
    return loaded;
}
#endif

const OpenExrModule& openexr_module() {
    static const OpenExrModule& loaded = load<OpenExrModule>("acdf_openexr");
    return loaded;
}

const TextModule& text_module() {
    static const TextModule& loaded = load<TextModule>("acdf_text");
    return loaded;
}

} // namespace acdf::images
