// A light file by each room beside the reader, and one of curves: rooms LOCAL.acdf CURVES.acdf.
#if __has_include(<acdf/batch/batch.h>)
#include <acdf/batch/batch.h>
#define BATCH 1
#endif
#include <acdf/curves/curves.h>
#include <acdf/product/product.h>
#include <acdf/reader.h>
#include <acdf/shader/tables.h>
#include <acdf/views.h>

#include <cstdio>
#include <cstring>

namespace {

struct Cosine {
    double operator()(const float*, const float*) const { return 1.0; }
};

float cosine_pdf(const float*, const float* wi) { return wi[2] > 0.0f ? wi[2] / float(ACDF_PI) : 0.0f; }

acdf::ProductSample straight_up(const float* wo, double, double) {
    const float up[3] = {0.0f, 0.0f, 1.0f};
    return {{0.0f, 0.0f, 1.0f}, cosine_pdf(wo, up)};
}

} // namespace

int main(int argc, char** argv) {
    acdf::File file, of_curves;
    if (argc != 3 || acdf::File::open(argv[2], of_curves).code != acdf::ErrorCode::unsupported ||
        !acdf::File::open(argv[2], of_curves, acdf::with_curves()).ok() ||
        !(of_curves.environment().sample(0.3, 0.4).pdf > 0.0f))
        return 1;
    if (!acdf::File::open(argv[1], file).ok() || file.kind() != ACDF_KIND_LOCAL) return 1;
    const acdf::LocalEnvironmentView light = file.local();
    const float up[3] = {0.0f, 0.0f, 1.0f};
    const acdf::ProductSampler sampler(light.data(), acdf::Lobe(Cosine(), straight_up, cosine_pdf));
    const auto point = sampler.at(up, up);
    const acdf::ProductSample s = sampler.sample(point, 0.9, 0.4);
    if (!(s.pdf > 0.0f) || sampler.pdf(point, s.direction) != s.pdf) return 1;
    acdf::ShaderTables tables;
    if (!acdf::ShaderTables::make(file, tables).ok()) return 1;
#ifdef BATCH
    const double u[20][2] = {{0.3, 0.4}, {0.7, 0.2}};
    float directions[20][3], pdfs[20];
    acdf::sample_batch(light.environment(), u, 20, directions, pdfs);
    for (int i = 0; i < 20; ++i) {
        const acdf::DirectionSample one = light.environment().sample(u[i][0], u[i][1]);
        if (std::memcmp(one.direction, directions[i], sizeof one.direction) != 0 || one.pdf != pdfs[i]) return 1;
    }
#endif
    std::printf("product and shader: %zu words\n", tables.size());
    return 0;
}
