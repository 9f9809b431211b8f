// A light file by each room beside the reader: rooms LOCAL.acdf.
#include <acdf/product/product.h>
#include <acdf/reader.h>
#include <acdf/shader/tables.h>
#include <acdf/views.h>

#include <cstdio>

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
    acdf::File file;
    if (argc != 2 || !acdf::File::open(argv[1], file).ok() || file.kind() != ACDF_KIND_LOCAL) return 1;
    const acdf::LocalEnvironmentView light = file.local();
    const float up[3] = {0.0f, 0.0f, 1.0f};
    const acdf::ProductSampler sampler(light.data(), acdf::Lobe(Cosine(), straight_up, cosine_pdf));
    const auto point = sampler.at(up, up);
    const acdf::ProductSample s = sampler.sample(point, 0.9, 0.4);
    if (!(s.pdf > 0.0f) || sampler.pdf(point, s.direction) != s.pdf) return 1;
    acdf::ShaderTables tables;
    if (!acdf::ShaderTables::make(file, tables).ok()) return 1;
    std::printf("product and shader: %zu words\n", tables.size());
    return 0;
}
