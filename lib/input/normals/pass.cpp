#include "images/image_file.h"
#include "input/error.h"
#include "input/file_name.h"
#include "input/line_ends.h"
#include "input/normals/sources.h"

#include <algorithm>
#include <array>
#include <optional>

namespace acdf::input {
namespace {

constexpr std::int64_t kMaxPixels = std::int64_t{1} << 30;
constexpr int kMaxSide = 1 << 18;

bool ends_in(const std::string& text, const std::string& end) {
    return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Whether a layer (lower case, with the layers that it is part of) holds normals: "n", "ns", "view.normal", ...
bool is_normal_layer(const std::string& layer) {
    const std::string last = layer.substr(layer.rfind('.') + 1);
    return last == "n" || last == "ns" || ends_in(last, "normal") || ends_in(last, "normals");
}

using NormalChannels = std::array<int, 3>;

std::optional<NormalChannels> find_triple(const std::vector<std::string>& names,
                                          const std::array<std::string, 3>& triple) {
    NormalChannels out{};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto found = std::find(names.begin(), names.end(), triple[i]);
        if (found == names.end()) return std::nullopt;
        out[i] = static_cast<int>(found - names.begin());
    }
    return out;
}

std::optional<NormalChannels> find_normals(std::vector<std::string> names, bool rgb) {
    for (std::string& name : names) name = lower(name);
    for (const std::string& name : names) {
        const std::string stem = name.substr(0, name.size() - std::min<std::size_t>(name.size(), 1));
        if (ends_in(name, ".x") && is_normal_layer(stem.substr(0, stem.size() - 1)))
            if (const auto found = find_triple(names, {stem + "x", stem + "y", stem + "z"})) return found;
        if (ends_in(name, ".r") && is_normal_layer(stem.substr(0, stem.size() - 1)))
            if (const auto found = find_triple(names, {stem + "r", stem + "g", stem + "b"})) return found;
        if (ends_in(name, "x") && !ends_in(name, ".x") && is_normal_layer(stem))
            if (const auto found = find_triple(names, {stem + "x", stem + "y", stem + "z"})) return found;
    }
    return rgb ? find_triple(names, {"r", "g", "b"}) : std::nullopt;
}

class PassReader {
public:
    explicit PassReader(const std::string& path) : path_(path), file_(path, 1) {
        if (!file_.is_open())
            fail("neither a mesh (.obj, .ply, .instances), nor a list of normals (.txt, .csv), nor an image that "
                 "can be read (" +
                 file_.error() + ")");
    }

    void add(bool rgb, NormalHistogram& histogram) {
        const NormalChannels channels = seek_normals(rgb);
        check_spec();
        const int height = header().data.height;
        const int rows = header().tile_height > 0 ? header().tile_height : std::min(height, 64);
        for (int y = 0; y < height; y += rows) add_rows(y, std::min(y + rows, height), channels, histogram);
    }

private:
    [[noreturn]] void fail(const std::string& what) const { throw input_error(path_, what); }
    const images::Header& header() const { return file_.header(); }

    /// Goes to the first part that has normals.
    NormalChannels seek_normals(bool rgb) {
        std::string names;
        for (int part = 0; file_.seek(part); ++part) {
            if (const auto found = find_normals(header().channels, rgb)) return *found;
            for (const std::string& name : header().channels)
                if (names.size() < 200) names += (names.empty() ? "" : ", ") + name;
        }
        fail("its channels are " + names +
             ", and none are N.X, N.Y, N.Z or the like; rename them (oiiotool IN --ch N.X=R,N.Y=G,N.Z=B -o "
             "OUT.exr)");
    }

    void check_spec() const {
        const images::Header& s = header();
        if (s.deep || s.depth > 1)
            fail("it is a deep image or a volume; flatten it (oiiotool IN --flatten -o OUT)");
        if (!s.floating)
            fail(
                "it holds integers, which cannot be normals from -1 to 1; write the pass as a floating-point .exr");
        const int width = s.data.width, height = s.data.height;
        if (width <= 0 || height <= 0 || width > kMaxSide || height > kMaxSide || s.tile_height > kMaxSide ||
            std::int64_t{width} * height > kMaxPixels)
            fail("its size " + std::to_string(width) + "x" + std::to_string(height) +
                 " is not that of an image that can be read; at most 2^30 pixels");
    }

    /// Rows [begin, end) of the data window, counted from its top; what lies outside it is background.
    void add_rows(int begin, int end, const NormalChannels& channels, NormalHistogram& histogram) {
        const auto [first, last] = std::minmax_element(channels.begin(), channels.end());
        const int low = *first, high = *last + 1, count = high - low;
        const std::size_t pixels =
            static_cast<std::size_t>(header().data.width) * static_cast<std::size_t>(end - begin);
        const bool far_apart = count > 16; // among very many channels each is read on its own
        buffer_.resize(pixels * (far_apart ? 3 : static_cast<std::size_t>(count)));
        std::array<std::size_t, 3> at{};
        if (far_apart) {
            for (std::size_t i = 0; i < 3; ++i) {
                read(begin, end, channels[i], channels[i] + 1, buffer_.data() + i, 3);
                at[i] = i;
            }
        } else {
            read(begin, end, low, high, buffer_.data(), count);
            for (std::size_t i = 0; i < 3; ++i) at[i] = static_cast<std::size_t>(channels[i] - low);
        }
        const std::size_t stride = far_apart ? 3 : static_cast<std::size_t>(count);
        for (const float* pixel = buffer_.data(); pixel != buffer_.data() + pixels * stride; pixel += stride)
            histogram.add(double{pixel[at[0]]}, double{pixel[at[1]]}, double{pixel[at[2]]}, 1.0);
    }

    void read(int begin, int end, int channel0, int channel1, float* at, int stride) {
        const auto pixel = static_cast<std::ptrdiff_t>(sizeof(float)) * stride;
        if (!file_.read({begin, end, channel0, channel1, pixel, pixel * header().data.width}, at))
            fail("its pixels cannot be read (" + file_.error() + "); the file is cut short or damaged");
    }

    std::string path_;
    images::ImageFile file_;
    std::vector<float> buffer_;
};

} // namespace

void add_pixel_normals(const std::string& path, bool rgb, NormalHistogram& histogram) {
    refuse_converted_line_ends(path);
    PassReader(path).add(rgb, histogram);
}

} // namespace acdf::input
