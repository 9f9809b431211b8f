#include "write.h"

#include "threads.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <exception>

namespace acdf::images {
namespace {

/// A file in memory, so that pictures go to pipes too, and are written as all other output is.
class Memory : public Imf::OStream {
public:
    explicit Memory(std::vector<std::uint8_t>& bytes) : Imf::OStream("picture.exr"), bytes_(bytes) {}

    void write(const char from[], int count) override {
        const std::size_t end = at_ + static_cast<std::size_t>(count);
        if (bytes_.size() < end) bytes_.resize(end);
        std::copy(from, from + count, bytes_.begin() + static_cast<std::ptrdiff_t>(at_));
        at_ = end;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t position) override { at_ = position; }

private:
    std::vector<std::uint8_t>& bytes_;
    std::size_t at_ = 0;
};

Imf::Header header_of(const Picture& picture, const std::vector<std::string>& channels,
                      const std::vector<Note>& notes) {
    Imf::Header header(picture.width, picture.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const std::string& channel : channels) header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    for (const Note& note : notes) {
        const std::string name = note.name == "Description" ? "comments" : note.name; // OpenEXR's own for that
        header.insert(name, Imf::StringAttribute(note.text));
    }
    return header;
}

void write_file(const Picture& picture, const std::vector<std::string>& channels, const Imf::Header& header,
                Imf::OStream& to) {
    const std::size_t pixel = sizeof(float) * static_cast<std::size_t>(picture.channels);
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < channels.size(); ++c)
        buffer.insert(channels[c],
                      Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(const_cast<float*>(picture.values.data() + c)),
                                 pixel, pixel * static_cast<std::size_t>(picture.width)));
    const int threads = thread_count(0);
    start_threads(threads, std::int64_t{picture.width} * picture.height);
    Imf::OutputFile file(to, header, threads);
    file.setFrameBuffer(buffer);
    file.writePixels(picture.height);
}

} // namespace

bool encode_openexr(const Picture& picture, const std::vector<std::string>& channels,
                    const std::vector<Note>& notes, std::vector<std::uint8_t>& bytes, std::string& error) {
    try {
        bytes.clear();
        Memory memory(bytes);
        write_file(picture, channels, header_of(picture, channels, notes), memory);
        return true;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {
        error = e.what();
        return false;
    }
}

} // namespace acdf::images
