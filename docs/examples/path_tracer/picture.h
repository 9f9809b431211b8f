// Portable float maps, and one of them as a sky.
#pragma once

#include "vector.h"

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

struct Picture {
    int width = 0, height = 0;
    std::vector<Vec> pixels; ///< row by row from the top

    Vec& at(int x, int y) {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
    const Vec& at(int x, int y) const { return const_cast<Picture*>(this)->at(x, y); }
};

/// Little-endian colour; throws std::runtime_error.
inline Picture read_picture(const std::string& path) {
    Picture picture;
    float scale = 0.0f;
    std::FILE* file = std::fopen(path.c_str(), "rb");
    if (!file || std::fscanf(file, "PF %d %d %f", &picture.width, &picture.height, &scale) != 3 ||
        !(scale < 0.0f) || picture.width < 1 || picture.height < 1 || picture.width > 16384 ||
        picture.height > 16384)
        throw std::runtime_error(path + ": is no little-endian .pfm of three channels");
    std::fgetc(file);
    picture.pixels.resize(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
    for (int y = picture.height - 1; y >= 0; --y)
        if (std::fread(&picture.at(0, y), sizeof(Vec), static_cast<std::size_t>(picture.width), file) !=
            static_cast<std::size_t>(picture.width))
            throw std::runtime_error(path + ": ends early");
    std::fclose(file);
    return picture;
}

inline void write_picture(const std::string& path, const Picture& picture) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (!file) throw std::runtime_error(path + ": cannot be written");
    std::fprintf(file, "PF\n%d %d\n-1.0\n", picture.width, picture.height);
    for (int y = picture.height - 1; y >= 0; --y)
        std::fwrite(&picture.at(0, y), sizeof(Vec), static_cast<std::size_t>(picture.width), file);
    if (std::fclose(file) != 0) throw std::runtime_error(path + ": cannot be written");
}

/// Radiance from a unit direction, of the texel that it falls in: `acdf env --filter nearest` is made for that.
inline Vec radiance(const Picture& sky, Vec d) {
    const float pi = 3.14159265f;
    const float u = 0.5f - std::atan2(d.y, d.x) / (2.0f * pi);
    const float v = std::atan2(std::sqrt(d.x * d.x + d.y * d.y), d.z) / pi;
    return sky.at(std::min(static_cast<int>(u * static_cast<float>(sky.width)), sky.width - 1),
                  std::min(static_cast<int>(v * static_cast<float>(sky.height)), sky.height - 1));
}
