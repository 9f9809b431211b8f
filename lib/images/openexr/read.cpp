// The module that writes OpenEXR files (write.cpp) and reads usual ones: one part in rows, of R, G and B, maybe
// with A, in floats. It also reads luminance beside chroma that is stored for every other pixel alone, which
// OpenImageIO refuses. What else there is, and whatever is wrong with a file, is left to OpenImageIO, which takes a
// hundred times longer to load.
#include "images/one_part.h"
#include "threads.h"
#include "write.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfEnvmapAttribute.h>
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

/// The value of an attribute of a type; null where it has another. No dynamic_cast: its types would have to be one.
template <class Value>
const Value* value_of(const Imf::Attribute& attribute, const char* type) {
    if (std::strcmp(attribute.typeName(), type) != 0) return nullptr;
    return &static_cast<const Imf::TypedAttribute<Value>&>(attribute).value();
}

template <class Value>
bool says(const Imf::Attribute& attribute, const char* type, const Value& usual) {
    const Value* value = value_of<Value>(attribute, type);
    return value && *value == usual;
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

bool ends_in(const std::string& text, const std::string& end) {
    return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Those that have all pixels, where others are chroma: RY and BY, of every other pixel. None where there is no
/// such chroma.
std::vector<std::string> channels_beside_chroma(const Imf::ChannelList& channels) {
    std::vector<std::string> names;
    bool chroma = false;
    for (auto i = channels.begin(); i != channels.end(); ++i) {
        const Imf::Channel& channel = i.channel();
        const std::string name = lower_case(i.name());
        if (channel.xSampling == 1 && channel.ySampling == 1) {
            if (channel.type == Imf::UINT) return {};
            names.emplace_back(i.name());
        } else if (ends_in(name, "ry") || ends_in(name, "by")) {
            chroma = true;
        } else {
            return {};
        }
    }
    return chroma ? names : std::vector<std::string>{};
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
    if (attributes_are_usual(header)) out.channels = usual_channels(header.channels());
    if (out.channels.empty()) out.channels = channels_beside_chroma(header.channels());
    return !header.hasTileDescription() && out.file->isComplete() && !out.channels.empty();
}

/// The value of an attribute of a type; null where there is none.
template <class Value>
const Value* attribute_of(const Imf::Header& header, const char* name, const char* type) {
    const auto found = header.find(name);
    return found == header.end() ? nullptr : value_of<Value>(found.attribute(), type);
}

std::vector<float> chromaticities_of(const Imf::Header& header) {
    const auto* c = attribute_of<Imf::Chromaticities>(header, "chromaticities", "chromaticities");
    if (!c) return {};
    return {c->red.x, c->red.y, c->green.x, c->green.y, c->blue.x, c->blue.y, c->white.x, c->white.y};
}

int bytes_of(const Imf::Header& header, const std::string& channel) {
    return header.channels().findChannel(channel)->type == Imf::HALF ? 2 : 4;
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
    for (const std::string& channel : out->channels) header.channel_bytes.push_back(bytes_of(stored, channel));
    header.sample_bytes = *std::max_element(header.channel_bytes.begin(), header.channel_bytes.end());
    header.chromaticities = chromaticities_of(stored);
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

/// In OpenImageIO's words.
std::string text(const void* image, const char* name) {
    if (std::strcmp(name, "oiio:ColorSpace") == 0) return "Linear";
    if (std::strcmp(name, "textureformat") != 0) return "";
    const Imf::Header& header = static_cast<const OpenExr*>(image)->file->header();
    const auto* map = attribute_of<Imf::Envmap>(header, "envmap", "envmap");
    return !map ? "" : *map == Imf::ENVMAP_CUBE ? "CubeFace Environment" : "LatLong Environment";
}

int integer(const void* image, const char* name, int otherwise) {
    if (std::strcmp(name, "Orientation") != 0) return otherwise;
    const auto* found = attribute_of<int>(static_cast<const OpenExr*>(image)->file->header(), "Orientation", "int");
    return found ? *found : otherwise;
}

} // namespace
} // namespace acdf::images

extern "C" __attribute__((visibility("default"))) const acdf::images::OpenExrModule* acdf_openexr_module() {
    using namespace acdf::images;
    static const OpenExrModule functions = {
        {ACDF_VERSION, {open, close, seek_one_part, read, text, integer, no_real}}, encode_openexr};
    return &functions;
}
