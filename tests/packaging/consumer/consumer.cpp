// Samples from an environment file through acdf/reader.h; consumer.c prints the same through the C interface.
#include <acdf/reader.h>
#include <acdf/views.h>

#include <cmath>
#include <cstdio>

int main(int argc, char** argv) {
    if (argc != 2) return std::fprintf(stderr, "usage: consumer FILE.acdf\n"), 2;
    acdf::File file;
    if (const acdf::Status status = acdf::File::open(argv[1], file); !status.ok()) {
        std::fprintf(stderr, "%s: %s\n", argv[1], status.message);
        return 1;
    }
    if (file.kind() != ACDF_KIND_ENVIRONMENT) return 1;
    const acdf::EnvironmentView sky = file.environment();
    std::printf("total %.9g\n", sky.total());
    for (int i = 0; i < 64; ++i) {
        const acdf::DirectionSample s = sky.sample((i % 8 + 0.5) / 8, (i / 8 + 0.5) / 8);
        const float pdf = sky.pdf(s.direction);
        std::printf("%.9g %.9g %.9g %.9g\n", double(s.direction[0]), double(s.direction[1]), double(s.direction[2]),
                    double(s.pdf));
        if (!(s.pdf > 0) || std::fabs(pdf - s.pdf) > 1e-4f * s.pdf) {
            std::fprintf(stderr, "sample %d: density %g when sampled, %g when asked for\n", i, double(s.pdf),
                         double(pdf));
            return 1;
        }
    }
    return 0;
}
