// Light that is not infinitely far, at any point: samples directions from the light field of docs/table.md between
// its cameras, with their exact pdf, and estimates the irradiance there: light_at_point light_field.acdf
#include <acdf/reader.h>
#include <acdf/views.h>

#include <algorithm>
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

constexpr int cameras = 8; // along s and along t

// The four cameras around a point, and how likely each is sampled from.
struct Slice {
    std::uint32_t camera[4][2];
    double share[4]; // their sum is 1, or 0 where nothing arrives
};

// Of the point (s, t): bilinear weights times how much light each camera sees.
Slice slice_at(const acdf::TableView& field, double s, double t) {
    const double place[2] = {s * cameras - 0.5, t * cameras - 0.5};
    Slice out;
    double sum = 0.0;
    for (int k = 0; k < 4; ++k) {
        double weight = 1.0;
        for (int axis = 0; axis < 2; ++axis) {
            const double low = std::min(std::max(std::floor(place[axis]), 0.0), cameras - 2.0);
            const double along = std::min(std::max(place[axis] - low, 0.0), 1.0);
            const int upper = k >> axis & 1;
            out.camera[k][axis] = static_cast<std::uint32_t>(low) + static_cast<std::uint32_t>(upper);
            weight *= upper ? along : 1.0 - along;
        }
        sum += out.share[k] = weight * field.share(out.camera[k]);
    }
    for (double& share : out.share) share = sum > 0.0 ? share / sum : 0.0;
    return out;
}

// Per unit of u times v: of all cameras, whichever was sampled from.
double pdf(const acdf::TableView& field, const Slice& slice, const double x[2]) {
    double sum = 0.0;
    for (int k = 0; k < 4; ++k) sum += slice.share[k] * field.pdf(slice.camera[k], x);
    return sum;
}

// u0 chooses the camera first; what is left of it samples.
double sample(const acdf::TableView& field, const Slice& slice, double u0, double u1, double x[2]) {
    int k = 0;
    while (k < 3 && !(u0 < slice.share[k])) u0 -= slice.share[k++];
    const double u[2] = {std::min(1.0, u0 / slice.share[k]), u1};
    field.sample(slice.camera[k], u, x);
    return pdf(field, slice, x);
}

int main(int argc, char** argv) {
    acdf::File file;
    const acdf::Status status = acdf::File::open(argc == 2 ? argv[1] : "light_field.acdf", file);
    if (!status.ok()) return std::fprintf(stderr, "%s\n", status.message), 1;
    if (file.kind() != ACDF_KIND_TABLE) return std::fputs("no table\n", stderr), 1;
    const acdf::TableView field = file.table();
    if (field.indexed_count() != 2 || field.sampled_count() != 2) return std::fputs("another table\n", stderr), 1;

    const double s = 0.61, t = 0.28; // between cameras
    const Slice slice = slice_at(field, s, t);
    // The plane of u and v is at distance 1: a steradian shows r^3 of it, and the cosine is 1 / r.
    const auto radius = [&](const double x[2]) { return std::hypot(x[0] - s, x[1] - t, 1.0); };

    std::mt19937_64 random(1);
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    const int n = 10000, grid = 512;
    double sampled = 0.0, even = 0.0, exact = 0.0, whole = 0.0;
    for (int i = 0; i < n; ++i) {
        const double u0 = uniform(), u1 = uniform();
        double x[2];
        const double per_area = sample(field, slice, u0, u1, x), r = radius(x);
        const double per_steradian = per_area * r * r * r; // what multiple importance sampling asks for
        sampled += radiance(s, t, x[0], x[1]) / r / per_steradian / n;
        const double y[2] = {2.0 * u0 - 1.0, 2.0 * u1 - 1.0}, q = radius(y);
        even += radiance(s, t, y[0], y[1]) / (q * q * q * q) * 4.0 / n;
    }
    for (int i = 0; i < grid * grid; ++i) {
        const double x[2] = {(2.0 * (i % grid) + 1.0) / grid - 1.0, (2.0 * (i / grid) + 1.0) / grid - 1.0};
        const double r = radius(x), area = 4.0 / (grid * grid);
        exact += radiance(s, t, x[0], x[1]) / (r * r * r * r) * area;
        whole += pdf(field, slice, x) * area;
    }
    std::printf("irradiance at the point   %.2f\n", exact);
    std::printf("10000 samples of the file %.2f\n", sampled);
    std::printf("10000 even samples        %.2f\n", even);
    std::printf("the integral of the pdf   %.3f\n", whole);
}
