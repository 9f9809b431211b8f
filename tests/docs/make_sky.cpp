// Writes the sky that the program in docs/guide.md looks up, as a lat-long map: make_guide_sky OUT.exr
#include "images/image_file.h"

#include <cmath>
#include <cstdio>

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    constexpr int width = 256, height = 128;
    constexpr double pi = 3.14159265358979323846;
    acdf::images::Picture sky(width, height);
    for (int r = 0; r < height; ++r)
        for (int c = 0; c < width; ++c) {
            const double theta = pi * (r + 0.5) / height, phi = pi * (1.0 - 2.0 * (c + 0.5) / width);
            const double value = theta < 0.5 * pi ? 1.0 + std::sin(theta) * std::cos(phi) : 0.1;
            for (int i = 0; i < 3; ++i) sky.at(c, r)[i] = static_cast<float>(value);
        }
    const auto bytes = acdf::images::encode(sky, {argv[1], false, {}, {}});
    std::FILE* file = std::fopen(argv[1], "wb");
    return file && std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size() && std::fclose(file) == 0 ? 0
                                                                                                              : 1;
}
