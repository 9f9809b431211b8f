// Light and BRDF samples combined, as a path tracer does at every vertex: irradiance on a plane under a ball, lit
// by a probe. Made for files of `acdf local PROBE --mis cosine`; others work, too. Usage: local_mis PROBE.pfm
// FILE.acdf
#include <acdf/reader.h>
#include <acdf/views.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <random>
#include <string>
#include <vector>

constexpr double pi = 3.14159265358979323846;

struct Vec {
    double x, y, z;
};

// The probe, as a renderer has it: a lat-long PFM in colour, looked up bilinearly.
struct Probe {
    int width = 0, height = 0;
    std::vector<float> rgb; // the first row is the lowest, as PFM has it

    bool read(const char* path) {
        std::ifstream file(path, std::ios::binary);
        std::string magic;
        double scale = 0.0; // negative: little-endian
        if (!(file >> magic >> width >> height >> scale) || magic != "PF" || scale >= 0.0) return false;
        if (width < 2 || height < 2 || width > 65536 || height > 32768) return false;
        rgb.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
        file.ignore();
        return static_cast<bool>(file.read(reinterpret_cast<char*>(rgb.data()), std::streamsize(4 * rgb.size())));
    }
    double luminance(int column, int row) const { // row 0 is the highest; columns wrap, rows end
        const int x = (column + width) % width, y = height - 1 - std::clamp(row, 0, height - 1);
        const float* p = &rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + std::size_t(x))];
        return 0.2126 * double(p[0]) + 0.7152 * double(p[1]) + 0.0722 * double(p[2]);
    }
    // docs/conventions.md: the middle of the map is at +x, columns run towards -y, the first row is at +z.
    double radiance(const Vec& d) const {
        const double u = (0.5 - std::atan2(d.y, d.x) / (2.0 * pi)) * width - 0.5;
        const double v = std::acos(std::clamp(d.z, -1.0, 1.0)) / pi * height - 0.5;
        const int column = int(std::floor(u)), row = int(std::floor(v));
        const double a = u - column, b = v - row;
        return (1.0 - b) * ((1.0 - a) * luminance(column, row) + a * luminance(column + 1, row)) +
               b * ((1.0 - a) * luminance(column, row + 1) + a * luminance(column + 1, row + 1));
    }
};

// The scene: the plane z = 0, and a ball above it that hides light.
bool hidden(const Vec& from, const Vec& d) {
    const Vec o = {from.x, from.y, from.z - 1.5}; // from the ball's middle; its radius is 1
    const double along = o.x * d.x + o.y * d.y + o.z * d.z, rest = o.x * o.x + o.y * o.y + o.z * o.z - 1.0;
    return along < 0.0 && along * along > rest;
}

double cosine_pdf(const Vec& d) { return std::max(d.z, 0.0) / pi; } // the plane's normal is +z

Vec cosine_sample(double u0, double u1) {
    const double r = std::sqrt(u1), phi = 2.0 * pi * u0;
    return {r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0 - u1)};
}

int main(int argc, char** argv) {
    if (argc != 3) return std::fputs("usage: local_mis PROBE.pfm FILE.acdf\n", stderr), 2;
    Probe probe;
    if (!probe.read(argv[1])) return std::fprintf(stderr, "%s: no PFM of three channels\n", argv[1]), 1;
    acdf::File file;
    const acdf::Status status = acdf::File::open(argv[2], file);
    if (!status.ok()) return std::fprintf(stderr, "%s\n", status.message), 1;
    if (file.kind() != ACDF_KIND_LOCAL) return std::fputs("not a file of acdf local\n", stderr), 1;
    const acdf::LocalEnvironmentView sky = file.local();

    std::mt19937_64 random(1);
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    const float normal[3] = {0.0f, 0.0f, 1.0f};
    const AcdfLocalPoint point = sky.at(normal); // once a shading point; all points of a plane have one normal
    const int points = 64, samples = 256;
    double sum[2] = {}, squares[2] = {}; // two cosine samples; one of the file and one of the cosine
    for (int i = 0; i < points * samples; ++i) {
        const int p = i / samples;
        const Vec at = {0.5 * (p % 8) - 2.0, 0.5 * (p / 8) - 2.0, 0.0};
        // What a direction brings, over the sum of both samplers' pdfs: the balance heuristic for a sample of each.
        const auto combined = [&](const Vec& d, double light_pdf) {
            const double both = light_pdf + cosine_pdf(d);
            return d.z <= 0.0 || hidden(at, d) ? 0.0 : probe.radiance(d) * d.z / both;
        };
        double estimate[2] = {};
        for (int k = 0; k < 2; ++k) { // both alike: the estimator without the file
            const Vec d = cosine_sample(uniform(), uniform());
            estimate[0] += combined(d, cosine_pdf(d));
            const float direction[3] = {float(d.x), float(d.y), float(d.z)};
            if (k == 0) estimate[1] += combined(d, double(sky.pdf(point, direction)));
        }
        const acdf::DirectionSample s = sky.sample(point, uniform(), uniform());
        const Vec d = {double(s.direction[0]), double(s.direction[1]), double(s.direction[2])};
        if (s.pdf > 0.0f) estimate[1] += combined(d, double(s.pdf)); // 0: the cosine's samples suffice
        for (int k = 0; k < 2; ++k) sum[k] += estimate[k], squares[k] += estimate[k] * estimate[k];
    }
    const double n = points * samples;
    const char* const names[2] = {"two cosine samples", "one of the file, one of the cosine"};
    for (int k = 0; k < 2; ++k) {
        const double mean = sum[k] / n;
        std::printf("%-35s mean irradiance %.3f, relative variance %.3f\n", names[k], mean,
                    squares[k] / n / (mean * mean) - 1.0);
    }
}
