// The loops that tests/bench/python.py is compared with: nanoseconds a call of C++, a million calls over arrays.
#include <acdf/reader.h>
#include <acdf/views.h>

#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <vector>

namespace {

constexpr std::size_t kCalls = 1000000;

double nanoseconds(const std::function<void()>& loop) {
    double least = 1e300;
    for (int i = 0; i < 7; ++i) {
        const std::clock_t begin = std::clock(); // processor time: others may use the machine
        loop();
        const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
        least = std::fmin(least, 1e9 * seconds / static_cast<double>(kCalls));
    }
    return least;
}

} // namespace

// python_arrays SKY LOCAL BRDF
int main(int argc, char** argv) {
    acdf::File files[3];
    for (int i = 0; i < 3; ++i)
        if (argc != 4 || !acdf::File::open(argv[i + 1], files[i]).ok()) return std::fprintf(stderr, "no file\n"), 1;
    const auto sky = files[0].environment();
    const acdf::LocalEnvironmentView local = files[1].local();
    const acdf::BrdfView brdf = files[2].brdf();

    struct Vector {
        float v[3];
    };
    std::vector<double> u(2 * kCalls);
    std::vector<Vector> normals(kCalls), directions(kCalls);
    std::vector<acdf::DirectionSample> sampled(kCalls);
    std::vector<float> pdf(kCalls);
    for (std::size_t i = 0; i < kCalls; ++i) {
        const double x = static_cast<double>(i);
        u[2 * i] = std::fmod(0.7548776662466927 * x, 1.0);
        u[2 * i + 1] = std::fmod(0.5698402909980532 * x, 1.0);
        const double z = 0.05 + 0.95 * u[2 * i], r = std::sqrt(1.0 - z * z), phi = 6.283185307179586 * u[2 * i + 1];
        normals[i] = {
            {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)), static_cast<float>(z)}};
    }
    const auto keep = [&] {
        for (std::size_t i = 0; i < kCalls; ++i)
            for (int k = 0; k < 3; ++k) directions[i].v[k] = sampled[i].direction[k];
    };
    const auto views = reinterpret_cast<const float(*)[3]>(normals.data());
    const auto numbers = reinterpret_cast<const double(*)[2]>(u.data());
    const auto towards = reinterpret_cast<const float(*)[3]>(directions.data());
    std::printf("environment.sample %.1f\n", nanoseconds([&] {
                    for (std::size_t i = 0; i < kCalls; ++i) sampled[i] = sky.sample(numbers[i][0], numbers[i][1]);
                }));
    keep();
    std::printf("environment.pdf %.1f\n", nanoseconds([&] {
                    for (std::size_t i = 0; i < kCalls; ++i) pdf[i] = sky.pdf(towards[i]);
                }));
    std::printf("local.sample %.1f\n", nanoseconds([&] {
                    for (std::size_t i = 0; i < kCalls; ++i)
                        sampled[i] = local.sample(views[i], numbers[i][0], numbers[i][1]);
                }));
    keep();
    std::printf("local.pdf %.1f\n", nanoseconds([&] {
                    for (std::size_t i = 0; i < kCalls; ++i) pdf[i] = local.pdf(views[i], towards[i]);
                }));
    std::printf("brdf.sample %.1f\n", nanoseconds([&] {
                    for (std::size_t i = 0; i < kCalls; ++i)
                        sampled[i] = brdf.sample(views[i], numbers[i][0], numbers[i][1]);
                }));
    keep();
    std::printf("brdf.pdf %.1f\n", nanoseconds([&] {
                    for (std::size_t i = 0; i < kCalls; ++i) pdf[i] = brdf.pdf(views[i], towards[i]);
                }));
}
