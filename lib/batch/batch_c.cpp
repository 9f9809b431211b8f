// The C interface of batches. malloc and not new, so that a C program that links it needs no C++ runtime library.
#include "reader/memory.h"

#include <acdf/acdf.h>
#include <acdf/batch/batch.h>
#include <acdf/batch/batch_c.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <utility>

namespace {

using acdf::DirectionSample;

constexpr std::size_t kBatch = 256; // directions and views of so many stay in the first cache

// Calls sample(first, n, out) for `count` items, some of them at once.
template <class Sample>
void sample_in_batches(std::size_t count, float* directions, float* pdfs, Sample&& sample) {
    DirectionSample drawn[kBatch];
    for (std::size_t first = 0; first < count; first += kBatch) {
        const std::size_t n = std::min(kBatch, count - first);
        sample(first, n, drawn);
        for (std::size_t i = 0; i < n; ++i) {
            std::memcpy(directions + 3 * (first + i), drawn[i].direction, sizeof drawn[i].direction);
            pdfs[first + i] = drawn[i].pdf;
        }
    }
}

// Arrays of vectors and of pairs of numbers, from item i on.
const float (*vectors_at(const float* array, std::size_t i))[3] {
    return reinterpret_cast<const float(*)[3]>(array + 3 * i);
}
const double (*pairs_at(const double* array, std::size_t i))[2] {
    return reinterpret_cast<const double(*)[2]>(array + 2 * i);
}

} // namespace

int acdf_local_batch_sample(const AcdfFile* file, const float* normals, size_t each, const double* u, size_t count,
                            float* directions, float* pdfs) {
    AcdfLocal local;
    if (!acdf_local(file, &local) || each == 0) return 0;
    const acdf::LocalEnvironmentView view(local);
    const acdf::LocalBatch batch(view);
    if (each == 1) {
        sample_in_batches(count, directions, pdfs, [&](size_t first, size_t n, DirectionSample* drawn) {
            batch.sample(vectors_at(normals, first), pairs_at(u, first), n, drawn);
        });
        return 1;
    }
    for (size_t j = 0, first = 0; first < count; first += each, ++j) { // a point, looked up once, serves several
        const AcdfLocalPoint point = view.at(normals + 3 * j);
        sample_in_batches(std::min(each, count - first), directions + 3 * first, pdfs + first,
                          [&](size_t from, size_t n, DirectionSample* drawn) {
                              batch.sample(point, pairs_at(u, first + from), n, drawn);
                          });
    }
    return 1;
}

int acdf_local_batch_pdf(const AcdfFile* file, const float* normals, size_t each, const float* directions,
                         size_t count, float* pdfs) {
    AcdfLocal local;
    if (!acdf_local(file, &local) || each == 0) return 0;
    const acdf::LocalEnvironmentView view(local);
    const acdf::LocalBatch batch(view);
    if (each == 1) {
        batch.pdf(vectors_at(normals, 0), vectors_at(directions, 0), count, pdfs);
        return 1;
    }
    for (size_t j = 0, first = 0; first < count; first += each, ++j)
        batch.pdf(view.at(normals + 3 * j), vectors_at(directions, first), std::min(each, count - first),
                  pdfs + first);
    return 1;
}
