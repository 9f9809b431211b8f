// The module that writes OpenEXR files (write.cpp) and reads usual ones: one part in rows, of R, G and B, maybe
// with A, in floats. What else there is, and whatever is wrong with a file, is left to OpenImageIO, which takes a
// hundred times longer to load.
#include "images/one_part.h"
#include "threads.h"
#include "write.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <exception>
#include <memory>

namespace acdf::images {
namespace {

Window window_of(const Imath::Box2i& box) {
    return {box.min.x, box.min.y, box.max.x - box.min.x + 1, box.max.y - box.min.y + 1};
}

std::string lower_case(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

template <class Value>
bool says(const Imf::Attribute& attribute, const char* type, const Value& usual) {
    return std::strcmp(attribute.typeName(), type) == 0 && // no dynamic_cast: its types would have to be one
           static_cast<const Imf::TypedAttribute<Value>&>(attribute).value() == usual;
}

/// Whether an attribute says nothing that would change how pixels are taken (lib/input/probe/image.cpp).
bool is_usual(const std::string& name, const Imf::Attribute& attribute) {
    const std::string n = lower_case(name);
    if (n == "orientation") return says(attribute, "int", 1);
    if (n == "oiio:colorspace") return says(attribute, "string", std::string("Linear"));
    return n != "envmap" && n != "textureformat" && n != "oiio:sampleborder" && n != "oiio:gamma";
}

bool attributes_are_usual(const Imf::Header& header) {
    for (auto i = header.begin(); i != header.end(); ++i)
        if (!is_usual(i.name(), i.attribute())) return false;
    return true;
}

/// Names in OpenImageIO's order; none where they are not those that we take.
std::vector<std::string> usual_channels(const Imf::ChannelList& channels) {
    std::vector<std::string> names{"R", "G", "B"};
    if (channels.findChannel("A")) names.emplace_back("A");
    std::size_t found = 0;
    const Imf::Channel* const first = channels.findChannel("R");
    for (auto i = channels.begin(); i != channels.end(); ++i, ++found) {
        const Imf::Channel& channel = i.channel();
        if (!first || std::find(names.begin(), names.end(), i.name()) == names.end() ||
            channel.type != first->type || channel.type == Imf::UINT || channel.xSampling != 1 ||
            channel.ySampling != 1)
            return {};
    }
    return found == names.size() ? names : std::vector<std::string>{};
}

struct OpenExr {
    std::unique_ptr<Imf::InputFile> file;
    std::vector<std::string> channels;
};

bool open_file(const std::string& path, int threads, OpenExr& out) {
    const int count = thread_count(threads);
    out.file = std::make_unique<Imf::InputFile>(path.c_str(), count);
    const Imf::Header& header = out.file->header();
    const Window data = window_of(header.dataWindow());
    start_threads(count, std::int64_t{data.width} * data.height);
    out.channels = usual_channels(header.channels());
    return !header.hasTileDescription() && out.file->isComplete() && !out.channels.empty() &&
           attributes_are_usual(header);
}

void* open(const std::string& path, int threads, Header& header, std::string& error) {
    auto out = std::make_unique<OpenExr>();
    try {
        if (!open_file(path, threads, *out)) return nullptr;
    } catch (const std::exception& e) {
        error = e.what();
        return nullptr;
    }
    const Imf::Header& stored = out->file->header();
    header = {};
    header.format = "openexr";
    header.data = window_of(stored.dataWindow());
    header.display = window_of(stored.displayWindow());
    header.channels = out->channels;
    header.channel_count = static_cast<int>(out->channels.size());
    header.floating = true;
    header.sample_bytes = stored.channels().findChannel("R")->type == Imf::HALF ? 2 : 4;
    return out.release();
}

void close(void* image) { std::unique_ptr<OpenExr>(static_cast<OpenExr*>(image)); }

bool read(void* image, const Rows& rows, float* to, std::string& error) {
    OpenExr& exr = *static_cast<OpenExr*>(image);
    const Imath::Box2i box = exr.file->header().dataWindow();
    const int first = box.min.y + rows.first_row, last = box.min.y + rows.last_row - 1;
    // OpenEXR counts from pixel (0, 0), which may lie far away.
    const std::intptr_t origin =
        std::intptr_t{box.min.x} * rows.pixel_stride + std::intptr_t{first} * rows.row_stride;
    Imf::FrameBuffer buffer;
    for (int channel = rows.first_channel; channel < rows.last_channel; ++channel) {
        const auto at = reinterpret_cast<std::intptr_t>(to + (channel - rows.first_channel));
        buffer.insert(exr.channels[static_cast<std::size_t>(channel)],
                      Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(at - origin),
                                 static_cast<std::size_t>(rows.pixel_stride),
                                 static_cast<std::size_t>(rows.row_stride)));
    }
    try {
        exr.file->setFrameBuffer(buffer);
        exr.file->readPixels(first, last);
        return true;
    } catch (const std::exception& e) {
        error = e.what();
        return false;
    }
}

std::string text(const void*, const char* name) {
    return std::strcmp(name, "oiio:ColorSpace") == 0 ? "Linear" : "";
}

} // namespace
} // namespace acdf::images

extern "C" __attribute__((visibility("default"))) const acdf::images::OpenExrModule* acdf_openexr_module() {
    using namespace acdf::images;
    static const OpenExrModule functions = {
        {ACDF_VERSION, {open, close, seek_one_part, read, text, no_integer, no_real}}, encode_openexr};
    return &functions;
}
