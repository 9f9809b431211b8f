// A light file by each room beside the reader, and one of curves: rooms LOCAL.acdf CURVES.acdf.
#include <acdf/acdf.h>
#include <acdf/arrays/arrays.h>
#if __has_include(<acdf/batch/batch.h>)
#include <acdf/batch/batch.h>
#define BATCH 1
#endif
#include <acdf/curves/curves.h>
#include <acdf/indexed/views.h>
#include <acdf/product/product.h>
#include <acdf/reader.h>
#include <acdf/shader/tables.h>
#include <acdf/views.h>
#include <acdf/visibility/visibility.h>

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

// Arrays give what single calls do.
bool samples_in_arrays(const char* path, const acdf::LocalEnvironmentView& light) {
    const float up[3] = {0.0f, 0.0f, 1.0f};
    const double u[2] = {0.3, 0.4};
    float direction[3], pdf = 0.0f;
    AcdfFile* file = acdf_open(path, nullptr);
    const bool sampled = file && acdf_sample_local_array(file, up, 1, u, 1, direction, &pdf) == 1;
    acdf_close(file);
    return sampled && pdf > 0.0f && pdf == light.sample(up, u[0], u[1]).pdf;
}

} // namespace

int main(int argc, char** argv) {
    acdf::File file, of_curves;
    if (argc != 3 || acdf::File::open(argv[2], of_curves).code != ACDF_UNSUPPORTED ||
        !acdf::File::open(argv[2], of_curves, acdf::with_curves()).ok() ||
        !(of_curves.environment().sample(0.3, 0.4).pdf > 0.0f))
        return 1;
    if (!acdf::File::open(argv[1], file).ok() || file.kind() != ACDF_KIND_LOCAL) return 1;
    const acdf::LocalEnvironmentView light = file.local();
    acdf::VisibleLocalView visible;
    if (!acdf::VisibleLocalView::of(file, visible).ok()) return 1;
    const float up[3] = {0.0f, 0.0f, 1.0f};
    if (visible.sample(visible.at(up, up), 0.9, 0.4).pdf != light.sample(up, 0.9, 0.4).pdf) return 1;
    const acdf::ProductSampler sampler(light.data(), acdf::Lobe(Cosine(), straight_up, cosine_pdf));
    const auto point = sampler.at(up, up);
    const acdf::ProductSample s = sampler.sample(point, 0.9, 0.4);
    if (!(s.pdf > 0.0f) || sampler.pdf(point, s.direction) != s.pdf) return 1;
    if (!samples_in_arrays(argv[1], light)) return 1;
    acdf::IndexedEnvironment maps;
    if (acdf::IndexedEnvironment::open(file, maps).ok() || !maps.empty()) return 1; // it has none
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
