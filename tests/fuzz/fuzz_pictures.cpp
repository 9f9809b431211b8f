// Any bytes, read as the pictures that we parse ourselves: Radiance's and float maps. What opens has a sound
// header, and each row that is read is written whole, the same when it is read again, after others and channel by
// channel.
#include "images/float_map.h"
#include "images/radiance.h"
#include "tests/fuzz/require.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

namespace {

using namespace acdf::images;
using acdf_test::require;

/// Bytes as a file that has a path and lies in memory.
class MemoryFile {
public:
    MemoryFile(const std::uint8_t* data, std::size_t size) : file_(memfd_create("picture", MFD_CLOEXEC)) {
        require(file_ >= 0 && write(file_, data, size) == static_cast<ssize_t>(size));
    }
    ~MemoryFile() { close(file_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

private:
    int file_;
};

struct Picture {
    const ImageReader& reader;
    void* image;
    const Header& header;

    /// A row of some channels; empty where it cannot be read.
    std::vector<float> row(int y, int first_channel, int last_channel) const {
        const int channels = last_channel - first_channel;
        std::vector<float> out(static_cast<std::size_t>(header.data.width) * static_cast<std::size_t>(channels));
        std::memset(out.data(), 0xA5, out.size() * sizeof(float)); // below 0, which Radiance's numbers are not
        const std::ptrdiff_t pixel = channels * static_cast<std::ptrdiff_t>(sizeof(float));
        std::string error;
        if (reader.read(image, {y, y + 1, first_channel, last_channel, pixel, pixel * header.data.width},
                        out.data(), error))
            return out;
        require(!error.empty() && error.find('\n') == std::string::npos);
        return {};
    }
};

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

void require_channels(const Picture& picture, int y, const std::vector<float>& row) {
    const auto channels = static_cast<std::size_t>(picture.header.channel_count);
    for (std::size_t channel = 0; channel < channels; ++channel) {
        const std::vector<float> one = picture.row(y, static_cast<int>(channel), static_cast<int>(channel) + 1);
        require(one.size() * channels == row.size());
        for (std::size_t x = 0; x < one.size(); ++x)
            require(std::memcmp(&one[x], &row[x * channels + channel], sizeof(float)) == 0);
    }
}

void require_rows(const Picture& picture, bool radiance) {
    const int channels = picture.header.channel_count;
    std::vector<float> first;
    int read = 0;
    for (; read < picture.header.data.height; ++read) {
        const std::vector<float> row = picture.row(read, 0, channels);
        if (row.empty()) break;
        if (radiance)
            for (const float value : row) require(value >= 0.0f && std::isfinite(value));
        if (read == 0) first = row;
    }
    if (read == 0) return;
    require(same_bits(picture.row(0, 0, channels), first));
    require_channels(picture, 0, first);
    if (!radiance) require(read == picture.header.data.height); // whose size was compared with the file's
}

void try_reader(const ImageReader& reader, const std::string& path, bool radiance) {
    Header header;
    std::string error;
    void* const image = reader.open(path, 1, header, error);
    if (!image) return;
    require(header.data.width >= 1 && header.data.height >= 1 && header.data == header.display);
    require(header.channel_count >= 1 && header.channel_count <= 4);
    require(static_cast<std::size_t>(header.channel_count) == header.channels.size());
    require_rows({reader, image, header}, radiance);
    reader.close(image);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const MemoryFile file(data, size);
    try_reader(radiance_reader(), file.path(), true);
    try_reader(float_map_reader(), file.path(), false);
    return 0;
}
