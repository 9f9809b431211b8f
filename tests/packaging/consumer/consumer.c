/* Samples from an environment file through acdf/acdf.h and acdf/sample.h; consumer.cpp prints the same. */
#include <acdf/acdf.h>

#include <math.h>
#include <stdio.h>

static int draw(const AcdfEnvironment* sky) {
    int i;
    printf("total %.9g\n", sky->total);
    for (i = 0; i < 64; ++i) {
        const AcdfDirectionSample s = acdf_environment_sample(sky, (i % 8 + 0.5) / 8, (i / 8 + 0.5) / 8);
        const float pdf = acdf_environment_pdf(sky, s.direction);
        printf("%.9g %.9g %.9g %.9g\n", (double)s.direction[0], (double)s.direction[1], (double)s.direction[2],
               (double)s.pdf);
        if (!(s.pdf > 0) || fabs((double)(pdf - s.pdf)) > 1e-4 * (double)s.pdf) {
            fprintf(stderr, "sample %d: density %g when sampled, %g when asked for\n", i, (double)s.pdf,
                    (double)pdf);
            return 1;
        }
    }
    return 0;
}

int main(int argc, char** argv) {
    AcdfError error;
    AcdfEnvironment sky;
    AcdfFile* file;
    int status;
    if (argc != 2) {
        fprintf(stderr, "usage: consumer FILE.acdf\n");
        return 2;
    }
    file = acdf_open(argv[1], &error);
    if (!file) {
        fprintf(stderr, "%s: %s\n", argv[1], error.message);
        return 1;
    }
    status = acdf_environment(file, &sky) ? draw(&sky) : 1;
    acdf_close(file);
    return status;
}
