// learn_visibility SKY.acdf OUT.acdf
//
// Learns what a scene hides from the shadow rays of a first pass, without a mesh. SKY.acdf is a file of
// `acdf local`. The scene is a floor between two high walls, a stand-in for that of a renderer. Prints the
// relative variance of a light sample before and after, and writes a file that serves the next frame, or a farm.
#include <acdf/learn.h>
#include <acdf/visibility/visibility.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

// Whether a wall at x = -1 or x = 1, of height 3, is in the way.
bool occluded(const float p[3], const float d[3]) {
    const float t = ((d[0] > 0.0f ? 1.0f : -1.0f) - p[0]) / d[0];
    return p[2] + t * d[2] < 3.0f;
}

int main(int argc, char** argv) {
    if (argc != 3) return std::fprintf(stderr, "usage: learn_visibility SKY.acdf OUT.acdf\n"), 2;
    std::ifstream in(argv[1], std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};

    acdf::builder::LearnOptions options;
    options.low[0] = options.low[1] = -1.0f; // of the floor, z = 0
    options.high[0] = options.high[1] = 1.0f;
    acdf::builder::LearnedVisibility learned;
    acdf::builder::Status status =
        acdf::builder::LearnedVisibility::make(bytes.data(), bytes.size(), options, learned);

    std::mt19937 random(1);
    std::uniform_real_distribution<double> u(0.0, 1.0);
    for (int pass = 0; pass < 2 && status.ok(); ++pass) {
        const auto file = learned.file(); // keeps the view valid
        acdf::VisibleLocalView sky;
        acdf::VisibleLocalView::of(*file, sky);
        double sum = 0.0, squares = 0.0;
        const int count = 200000;
        for (int i = 0; i < count; ++i) { // in a renderer: all vertices, by all threads
            const float position[3] = {float(2.0 * u(random) - 1.0), float(2.0 * u(random) - 1.0), 0.0f};
            const float normal[3] = {0.0f, 0.0f, 1.0f};
            const AcdfVisiblePoint point = sky.at(position, normal);
            const double u0 = u(random), u1 = u(random);
            const acdf::DirectionSample s = sky.sample(point, u0, u1);
            if (!(s.pdf > 0.0f && s.direction[2] > 0.0f)) continue;
            const bool visible = !occluded(position, s.direction);
            if (pass == 0) learned.add(position, normal, s.direction, visible);
            const double light = sky.local().environment().pdf(s.direction); // a renderer looks its map up
            const double estimate = visible ? light * double(s.direction[2]) / double(s.pdf) : 0.0;
            sum += estimate / count;
            squares += estimate * estimate / count;
        }
        std::printf("%s: mean %.4g, relative variance %.4g\n", pass == 0 ? "normals alone" : "learned", sum,
                    squares / (sum * sum) - 1.0);
        if (pass == 0) status = learned.update();
    }
    if (status.ok()) status = learned.save(argv[2]);
    if (!status.ok()) return std::fprintf(stderr, "%s\n", status.message), 1;
}
