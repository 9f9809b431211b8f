// check_files FILE...: batches of all that can be opened give the bits of single calls. For other systems, whose
// test libraries are not there (tests/portability.sh); prints what vectors they have.
#include <acdf/batch/batch.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <hwy/targets.h>

#include <cstdio>
#include <cstring>
#include <random>
#include <vector>

namespace {

constexpr std::size_t kCount = 3001, kEach = 3;

/// Random numbers, and directions all over the sphere.
struct Given {
    std::vector<double> u = std::vector<double>(2 * kCount);
    std::vector<float> at, w;

    Given() {
        std::mt19937_64 random(1);
        const auto uniform = [&random] { return static_cast<double>(random() >> 11) * 0x1p-53; };
        for (double& x : u) x = uniform();
        for (std::vector<float>* vectors : {&at, &w})
            for (std::size_t i = 0; i < kCount; ++i) {
                double direction[3];
                acdf_octahedral_direction(uniform(), uniform(), direction);
                for (const double x : direction) vectors->push_back(static_cast<float>(x));
            }
    }
    const double (*numbers() const)[2] { return reinterpret_cast<const double(*)[2]>(u.data()); }
};

using Vectors = const float (*)[3];

/// How many calls differ; sample(i) and pdf(i) are single ones.
template <class Sample, class Pdf, class Samples, class Pdfs>
int differences(const Sample& sample, const Pdf& pdf, const Samples& samples, const Pdfs& pdfs) {
    std::vector<float> directions(3 * kCount), of_samples(kCount), of_directions(kCount);
    samples(reinterpret_cast<float(*)[3]>(directions.data()), of_samples.data());
    pdfs(of_directions.data());
    int count = 0;
    for (std::size_t i = 0; i < kCount; ++i) {
        const acdf::DirectionSample one = sample(i);
        count += std::memcmp(one.direction, &directions[3 * i], sizeof one.direction) != 0 ||
                 one.pdf != of_samples[i] || pdf(i) != of_directions[i];
    }
    return count;
}

int differences(const acdf::EnvironmentView& view, const Given& given) {
    return differences(
        [&](std::size_t i) { return view.sample(given.u[2 * i], given.u[2 * i + 1]); },
        [&](std::size_t i) { return view.pdf(&given.w[3 * i]); },
        [&](float(*out)[3], float* pdfs) { acdf::sample_batch(view, given.numbers(), kCount, out, pdfs); },
        [&](float* pdfs) { acdf::pdf_batch(view, reinterpret_cast<Vectors>(given.w.data()), kCount, pdfs); });
}

template <class View>
int differences_at(const View& view, const Given& given) {
    const auto at = reinterpret_cast<Vectors>(given.at.data()), w = reinterpret_cast<Vectors>(given.w.data());
    return differences(
        [&](std::size_t i) { return view.sample(at[i / kEach], given.u[2 * i], given.u[2 * i + 1]); },
        [&](std::size_t i) { return view.pdf(at[i / kEach], w[i]); },
        [&](float(*out)[3], float* pdfs) {
            acdf::sample_batch(view, at, kEach, given.numbers(), kCount, out, pdfs);
        },
        [&](float* pdfs) { acdf::pdf_batch(view, at, kEach, w, kCount, pdfs); });
}

} // namespace

int main(int argc, char** argv) {
    const Given given;
    int opened = 0, different = 0;
    for (int k = 1; k < argc; ++k) {
        acdf::File file;
        if (!acdf::File::open(argv[k], file).ok()) continue;
        int found = 0;
        if (file.kind() == ACDF_KIND_ENVIRONMENT) found = differences(file.environment(), given);
        else if (file.kind() == ACDF_KIND_LOCAL) found = differences_at(file.local(), given);
        else if (file.kind() == ACDF_KIND_BRDF) found = differences_at(file.brdf(), given);
        else continue;
        ++opened;
        if (found > 0) std::fprintf(stderr, "%s: %d calls differ\n", argv[k], found);
        different += found;
    }
    std::printf("%s: batches of %d files\n", hwy::TargetName(HWY_STATIC_TARGET), opened);
    return different > 0 || opened < 20 ? 1 : 0;
}
