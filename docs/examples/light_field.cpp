// Writes light_field.npy, a light field of four axes for docs/table.md: float32 values L[s][t][u][v], what a camera
// at (s, t) on the unit square sees through (u, v) on the square [-1, 1]^2 a distance 1 away.
//
//   c++ -std=c++17 -O2 light_field.cpp -o light_field && ./light_field light_field.npy
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace {

constexpr int cameras = 8, pixels = 64;

// How bright point (x, y) of a surface is, of radius r around (a, b), with a soft edge.
double spot(double x, double y, double a, double b, double r) {
    const double d = std::hypot(x - a, y - b) / r;
    return 1.0 / (1.0 + d * d * d * d * d * d * d * d);
}

// Radiance along the ray through (s, t) and (u, v). What lies at depth z is seen at s + z (u - s).
double radiance(double s, double t, double u, double v) {
    const auto x = [&](double z) { return s + z * (u - s); };
    const auto y = [&](double z) { return t + z * (v - t); };
    const double wall = 0.2 + 0.1 * std::sin(9.0 * x(3.0)) * std::sin(7.0 * y(3.0));
    const double lamp = 400.0 * spot(x(1.5), y(1.5), 0.3, 0.2, 0.05); // near: moves across (u, v) with (s, t)
    const double window = 15.0 * spot(x(3.0), y(3.0), -0.8, 0.6, 0.4);
    return std::round(4096.0 * (wall + lamp + window)) / 4096.0; // the same file with every mathematical library
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) return std::fprintf(stderr, "usage: light_field OUT.npy\n"), 2;
    std::vector<float> values;
    for (int s = 0; s < cameras; ++s)
        for (int t = 0; t < cameras; ++t)
            for (int u = 0; u < pixels; ++u)
                for (int v = 0; v < pixels; ++v)
                    values.push_back(static_cast<float>(radiance((s + 0.5) / cameras, (t + 0.5) / cameras,
                                                                 2.0 * (u + 0.5) / pixels - 1.0,
                                                                 2.0 * (v + 0.5) / pixels - 1.0)));

    // The header of the .npy format, version 1: a Python dict, padded so that the numbers begin at a multiple
    // of 64.
    std::string dict = "{'descr': '<f4', 'fortran_order': False, 'shape': (8, 8, 64, 64), }";
    dict.append(128 - 10 - dict.size() - 1, ' ');
    dict += '\n';
    const unsigned char start[10] = {0x93, 'N', 'U', 'M', 'P', 'Y', 1, 0, static_cast<unsigned char>(dict.size()),
                                     0};
    std::FILE* file = std::fopen(argv[1], "wb");
    bool ok = file && std::fwrite(start, 1, sizeof start, file) == sizeof start &&
              std::fwrite(dict.data(), 1, dict.size(), file) == dict.size() &&
              std::fwrite(values.data(), sizeof(float), values.size(), file) == values.size();
    if (file) ok = std::fclose(file) == 0 && ok;
    if (!ok) std::perror(argv[1]);
    return ok ? 0 : 1;
}
