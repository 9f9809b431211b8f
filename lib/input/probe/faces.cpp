#include "input/probe/faces.h"

#include "input/error.h"
#include "input/file_name.h"

#include <algorithm>
#include <sstream>
#include <utility>

namespace acdf::input {
namespace {

constexpr std::size_t kFaces = 6;

// By Direct3D's frame: y up, +z ahead.
constexpr const char* kNames[kFaces][7] = {
    {"+x", "px", "posx", "right", "rt", "r", ""}, {"-x", "nx", "negx", "left", "lf", "l", ""},
    {"+y", "py", "posy", "up", "top", "u", ""},   {"-y", "ny", "negy", "down", "bottom", "dn", "d"},
    {"+z", "pz", "posz", "front", "ft", "f", ""}, {"-z", "nz", "negz", "back", "bk", "b", ""}};

/// 0 to 5; -1 where it is no face.
int face_of(const std::string& word) {
    if (word.empty()) return -1;
    for (std::size_t face = 0; face < kFaces; ++face)
        for (const char* const name : kNames[face])
            if (lower(word) == name) return static_cast<int>(face);
    return -1;
}

bool parse_order(const std::string& text, std::array<int, kFaces>& order) {
    std::istringstream words(text);
    std::array<bool, kFaces> seen{};
    std::size_t count = 0;
    for (std::string word; std::getline(words, word, ',');) {
        const int face = face_of(word);
        if (face < 0 || count == kFaces || std::exchange(seen[static_cast<std::size_t>(face)], true)) return false;
        order[count++] = face;
    }
    return count == kFaces;
}

/// Where a face lies on the assembled map, in faces.
struct CrossPosition {
    int column, row;
};

// The horizontal cross has the front face in the middle, left and right beside it, the back face at the end: all as
// Direct3D stores them. In OpenGL's right-handed frame +X is at the left of who looks at +Z.
constexpr CrossPosition kDirectX[kFaces] = {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}};
constexpr CrossPosition kOpenGl[kFaces] = {{0, 1}, {2, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}};
constexpr CrossPosition kOpenExr[kFaces] = {{0, 0}, {0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 5}};

const CrossPosition* cross_positions(Faces::Frame frame) {
    return frame == Faces::Frame::directx ? kDirectX : frame == Faces::Frame::opengl ? kOpenGl : kOpenExr;
}

std::size_t index(const Image& image, int x, int y) {
    return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
}

Image black(int width, int height) {
    Image image;
    image.width = width;
    image.height = height;
    image.rgb.assign(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0.0f);
    return image;
}

bool same_luminance(const Image& a, const Image& b) {
    if (!a.luminance || !b.luminance) return a.luminance.has_value() == b.luminance.has_value();
    return a.luminance->r == b.luminance->r && a.luminance->g == b.luminance->g && a.luminance->b == b.luminance->b;
}

/// Copies n x n texels from (x0, y0) of an image to (x1, y1) of another, maybe from the right to the left.
void copy_face(const Image& from, int x0, int y0, Image& to, int x1, int y1, int n, bool mirrored) {
    for (int y = 0; y < n; ++y) {
        const float* const row = from.rgb.data() + index(from, x0, y0 + y);
        float* const there = to.rgb.data() + index(to, x1, y1 + y);
        if (!mirrored) std::copy_n(row, 3 * n, there);
        else
            for (int x = 0; x < n; ++x) std::copy_n(row + 3 * x, 3, there + 3 * (n - 1 - x));
    }
}

void check_sizes(const std::vector<std::string>& paths, const std::vector<Image>& images) {
    for (std::size_t i = 0; i < images.size(); ++i) {
        const Image& image = images[i];
        const std::string& path = paths[std::min(i, paths.size() - 1)];
        if (image.width != image.height)
            throw input_error(path, shape(image) + " is not square, as the faces of a cube are");
        if (image.width != images[0].width)
            throw input_error(path, shape(image) + " is not as large as the first of the six faces, " +
                                        shape(images[0]) + "; scale it");
        if (!same_luminance(image, images[0]))
            throw input_error(path, "its primaries are not those of the first of the six faces; convert it");
    }
}

} // namespace

bool parse_faces(const std::string& text, Faces& faces) {
    Faces parsed;
    parsed.name = lower(text);
    if (parsed.name == "opengl") parsed.frame = Faces::Frame::opengl;
    else if (parsed.name == "openexr") parsed.frame = Faces::Frame::openexr;
    else if (parsed.name != "directx" && !parse_order(text, parsed.order)) return false;
    faces = parsed;
    return true;
}

Image assemble(const std::vector<std::string>& paths, std::vector<Image> images, const Faces& faces,
               build::Layout& layout) {
    check_sizes(paths, images);
    const int n = images[0].width;
    const bool cross = faces.frame != Faces::Frame::openexr, mirrored = faces.frame == Faces::Frame::opengl;
    layout = cross ? build::Layout::horizontal_cross : build::Layout::stacked_cube;
    Image map = black(cross ? 4 * n : n, cross ? 3 * n : 6 * n);
    map.luminance = images[0].luminance;
    map.half = std::all_of(images.begin(), images.end(), [](const Image& image) { return image.half; });
    for (std::size_t i = 0; i < kFaces; ++i) {
        const CrossPosition at = cross_positions(faces.frame)[faces.order[i]];
        copy_face(images[i], 0, 0, map, at.column * n, at.row * n, n, mirrored);
        for (std::string& warning : images[i].warnings)
            if (std::find(map.warnings.begin(), map.warnings.end(), warning) == map.warnings.end())
                map.warnings.push_back(std::move(warning));
        images[i] = {};
    }
    return map;
}

std::vector<Image> cut_strip(const std::string& path, const Image& strip) {
    for (const int columns : {1, 2, 3, 6}) {
        const int rows = static_cast<int>(kFaces) / columns, n = strip.width / columns;
        if (n < 1 || n * columns != strip.width || n * rows != strip.height) continue;
        std::vector<Image> faces;
        for (int i = 0; i < static_cast<int>(kFaces); ++i) {
            faces.push_back(black(n, n));
            faces.back().half = strip.half;
            faces.back().luminance = strip.luminance;
            copy_face(strip, i % columns * n, i / columns * n, faces.back(), 0, 0, n, false);
        }
        faces[0].warnings = strip.warnings;
        return faces;
    }
    throw input_error(path, shape(strip) +
                                " is not a strip of six squares (1:6, 6:1, 2:3 or 3:2); give six files with "
                                "--faces, or a cube cross without");
}

void hang_back_face(Image& cross) {
    const int n = cross.width / 3;
    Image face = black(n, n);
    copy_face(cross, n, 3 * n, face, 0, 0, n, false);
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
            std::copy_n(face.rgb.data() + index(face, n - 1 - x, n - 1 - y), 3,
                        cross.rgb.data() + index(cross, n + x, 3 * n + y));
}

} // namespace acdf::input
