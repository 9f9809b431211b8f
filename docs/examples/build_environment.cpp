#include <acdf/builder.h>

#include <cstdio>
#include <vector>

int main() {
    const int width = 512, height = 256;
    std::vector<float> rgb(3 * width * height, 0.2f); // the program's own pixels: an even sky ...
    rgb[3 * (60 * width + 300)] = 4e4f;               // ... and a red sun

    acdf::builder::Pixels pixels;
    pixels.data = rgb.data();
    pixels.width = width, pixels.height = height;
    acdf::builder::EnvironmentOptions options;
    options.goal = acdf::builder::Goal::of_budget(16 << 10); // at most 16 KiB
    acdf::builder::Environment made;
    const acdf::builder::Status status = acdf::builder::environment(pixels, options, made);
    if (!status.ok()) return std::fprintf(stderr, "%s\n", status.message), 1;

    acdf::File file; // reads made.bytes where they lie
    if (!acdf::File::from_memory(made.bytes.data(), made.bytes.size(), file).ok()) return 1;
    const acdf::DirectionSample s = file.environment().sample(0.5, 0.25);
    std::printf("relative variance %.2g; a direction (%.2f, %.2f, %.2f) of pdf %.3g per steradian\n",
                made.accuracy.relative_variance, double(s.direction[0]), double(s.direction[1]),
                double(s.direction[2]), double(s.pdf));
}
