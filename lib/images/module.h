// What the program and the modules that hold OpenImageIO, OpenEXR and FreeType say to each other. OpenImageIO
// brings some 250 shared libraries, which take longer to load than most commands to run: its module is opened when
// the first image is that neither we nor OpenEXR alone can read.
#pragma once

#include "images/picture.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace acdf::images {

/// A rectangle in pixels.
struct Window {
    int x = 0, y = 0, width = 0, height = 0;
    bool operator==(const Window& o) const {
        return x == o.x && y == o.y && width == o.width && height == o.height;
    }
};

/// What a part of an image file says of itself; not checked.
struct Header {
    std::string format; ///< "openexr", "png", ...
    Window data, display;
    int depth = 1;       ///< of a volume
    int tile_height = 0; ///< 0: stored in rows
    int channel_count = 0;
    std::vector<std::string> channels; ///< names
    bool deep = false;
    bool floating = false; ///< of any width; else integers
    int sample_bytes = 0;
    std::vector<int> channel_bytes; ///< of a sample of each channel where they differ
    /// CIE x and y of red, green, blue and white, as the file says them, not checked; empty where it does not.
    std::vector<float> chromaticities;
};

/// Rows and channels of the data window, all from a first to before a last, and the bytes between pixels and rows
/// where they go.
struct Rows {
    int first_row, last_row, first_channel, last_channel;
    std::ptrdiff_t pixel_stride, row_stride;
};

/// How an image file is read, by the module or by ourselves.
struct ImageReader {
    /// Null and `error` where the file cannot be read. `threads` 0: all cores.
    void* (*open)(const std::string& path, int threads, Header& header, std::string& error);
    void (*close)(void* image);
    /// Goes to another part; false where there is none.
    bool (*seek)(void* image, int part, Header& header);
    /// To floats; false and `error` where something is missing.
    bool (*read)(void* image, const Rows& rows, float* to, std::string& error);
    /// Of the part: an attribute, or "" or `otherwise` where it has none.
    std::string (*text)(const void* image, const char* name);
    int (*integer)(const void* image, const char* name, int otherwise);
    float (*real)(const void* image, const char* name, float otherwise);
};

/// A table of functions and plain data, no classes with virtual functions: those would need their type information
/// to be one in program and module. Nothing of ours is thrown through it; what the standard library throws
/// (std::bad_alloc) is.
struct ReaderModule {
    const char* version; ///< of acdf: a module of another version is refused
    ImageReader reader;
};

struct OpenExrModule : ReaderModule {
    /// An image file in memory: floats, a name for each channel of the picture. False and `error` where it cannot
    /// be made.
    bool (*encode)(const Picture& picture, const std::vector<std::string>& channels, const std::vector<Note>& notes,
                   std::vector<std::uint8_t>& bytes, std::string& error);
};

/// Text in ASCII, of `size` pixels, by the font of a file.
struct TextModule {
    const char* version;
    /// Pixels from the pen's position to the end of the text; false where the font cannot be used.
    bool (*width)(const std::string& text, int size, const std::string& font, int& width);
    /// In one colour on RGB; x is where the pen begins, y its baseline.
    void (*draw)(Picture& picture, int x, int y, const std::string& text, int size, const std::string& font,
                 const float colour[3]);
};

/// The module of OpenImageIO, which reads every format. Opened on the first call, by any thread, and kept. The file
/// is at ACDF_IMAGES_FOLDER from the running program's folder; a program that lies elsewhere defines
/// acdf_images_folder (module.cpp). Throws std::runtime_error that names the file where it is missing, damaged or
/// of another version. It exports, as extern "C", a function without arguments that returns a pointer to its table:
/// acdf_images_module. Of a program that was built without OpenImageIO: all functions but `open`, which reports it,
/// are null.
const ReaderModule& module();

/// The same of the module that reads and writes usual OpenEXR files, which exports acdf_openexr_module: opening
/// what else there is returns null.
const OpenExrModule& openexr_module();

/// The same of FreeType's, which exports acdf_text_module.
const TextModule& text_module();

} // namespace acdf::images
