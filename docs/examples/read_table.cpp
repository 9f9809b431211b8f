// Estimates the mean radiance that a camera of light_field.npy sees, from samples of the file that docs/table.md
// makes of it: read_table light_field.acdf
#include <acdf/reader.h>
#include <acdf/views.h>

#include <cmath>
#include <cstdio>
#include <random>

// The same field as light_field.cpp, a stand-in for whatever a renderer would look up.
double spot(double x, double y, double a, double b, double r) {
    const double d = std::hypot(x - a, y - b) / r;
    return 1.0 / (1.0 + d * d * d * d * d * d * d * d);
}
double radiance(double s, double t, double u, double v) {
    const auto x = [&](double z) { return s + z * (u - s); };
    const auto y = [&](double z) { return t + z * (v - t); };
    return 0.2 + 0.1 * std::sin(9.0 * x(3.0)) * std::sin(7.0 * y(3.0)) +
           400.0 * spot(x(1.5), y(1.5), 0.3, 0.2, 0.05) + 15.0 * spot(x(3.0), y(3.0), -0.8, 0.6, 0.4);
}

int main(int argc, char** argv) {
    acdf::File file;
    const acdf::Status status = acdf::File::open(argc == 2 ? argv[1] : "light_field.acdf", file);
    if (!status.ok()) return std::fprintf(stderr, "%s\n", status.message), 1;
    if (file.kind() != ACDF_KIND_TABLE) return std::fputs("no table\n", stderr), 1;
    const acdf::TableView field = file.table();
    if (field.indexed_count() != 2 || field.sampled_count() != 2) return std::fputs("another table\n", stderr), 1;

    std::mt19937_64 random(1);
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    const std::uint32_t camera[2] = {5, 2}; // indices on s and t
    const double s = (camera[0] + 0.5) / 8, t = (camera[1] + 0.5) / 8;
    const int n = 1000;
    double sampled = 0.0, even = 0.0;
    for (int i = 0; i < n; ++i) {
        const double u[2] = {uniform(), uniform()};
        double x[2];
        const double pdf = field.sample(camera, u, x); // x: u and v in [-1, 1]; pdf per unit of u times v
        sampled += radiance(s, t, x[0], x[1]) / pdf / n;
        even += radiance(s, t, 2 * u[0] - 1, 2 * u[1] - 1) * 4 / n;
    }
    const double expected = field.total() * field.share(camera);
    std::printf("the file's integral      %.2f\n", expected);
    std::printf("1000 samples of the file %.2f\n", sampled);
    std::printf("1000 even samples        %.2f\n", even);
}
