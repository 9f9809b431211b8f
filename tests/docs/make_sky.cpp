// Writes the sky that the program in docs/guide.md looks up, as a lat-long map: make_guide_sky OUT.exr|OUT.pfm
#include "tests/inputs/write_rgb.h"

#include <cmath>

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    constexpr int width = 256, height = 128;
    constexpr double pi = 3.14159265358979323846;
    std::vector<float> rgb;
    for (int r = 0; r < height; ++r)
        for (int c = 0; c < width; ++c) {
            const double theta = pi * (r + 0.5) / height, phi = pi * (1.0 - 2.0 * (c + 0.5) / width);
            const double value = theta < 0.5 * pi ? 1.0 + std::sin(theta) * std::cos(phi) : 0.1;
            rgb.insert(rgb.end(), 3, static_cast<float>(value));
        }
    acdf::test::write_rgb(argv[1], width, height, rgb);
    return std::filesystem::exists(argv[1]) ? 0 : 1;
}
