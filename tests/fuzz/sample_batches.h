// Batches of any file that was accepted give the bits of single calls.
#pragma once

#include "tests/fuzz/fuzz_random.h"
#include "tests/fuzz/require.h"

#include <acdf/batch/batch.h>

#include <cstring>

namespace acdf_test {

constexpr std::size_t calls_a_batch = 17; // of all instructions a vector at least, and one call beside it

/// Numbers and directions, and what a batch gives.
struct FuzzBatch {
    double u[calls_a_batch][2];
    float given[calls_a_batch][3], directions[calls_a_batch][3], pdfs[calls_a_batch];

    explicit FuzzBatch(FuzzRandom& random) {
        for (auto& pair : u)
            for (double& x : pair) x = random.any_u();
        for (std::size_t i = 0; i < calls_a_batch; ++i) {
            if (i % 4 == 0) random.any_vector(given[i]);
            else random.unit_vector(given[i], false);
        }
    }
    void require_sample(std::size_t i, const acdf::DirectionSample& one) const {
        require(std::memcmp(directions[i], one.direction, sizeof one.direction) == 0 && pdfs[i] == one.pdf);
    }
};

inline void sample_batches(const acdf::EnvironmentView& view, FuzzRandom& random) {
    FuzzBatch batch(random);
    acdf::sample_batch(view, batch.u, calls_a_batch, batch.directions, batch.pdfs);
    for (std::size_t i = 0; i < calls_a_batch; ++i)
        batch.require_sample(i, view.sample(batch.u[i][0], batch.u[i][1]));
    acdf::pdf_batch(view, batch.given, calls_a_batch, batch.pdfs);
    for (std::size_t i = 0; i < calls_a_batch; ++i) require(batch.pdfs[i] == view.pdf(batch.given[i]));
}

/// Local environments and BRDFs, several calls a normal or view.
template <class View>
void sample_batches_at(const View& view, bool upper, FuzzRandom& random) {
    constexpr std::size_t each = 3;
    FuzzBatch batch(random);
    float at[calls_a_batch][3];
    for (std::size_t i = 0; i < calls_a_batch; ++i) random.mostly_unit_vector(static_cast<int>(i), at[i], upper);
    acdf::sample_batch(view, at, each, batch.u, calls_a_batch, batch.directions, batch.pdfs);
    for (std::size_t i = 0; i < calls_a_batch; ++i)
        batch.require_sample(i, view.sample(at[i / each], batch.u[i][0], batch.u[i][1]));
    acdf::pdf_batch(view, at, 1, batch.given, calls_a_batch, batch.pdfs);
    for (std::size_t i = 0; i < calls_a_batch; ++i) require(batch.pdfs[i] == view.pdf(at[i], batch.given[i]));
}
inline void sample_batches(const acdf::LocalEnvironmentView& view, FuzzRandom& random) {
    sample_batches_at(view, false, random);
}
inline void sample_batches(const acdf::BrdfView& view, FuzzRandom& random) {
    sample_batches_at(view, true, random);
}

} // namespace acdf_test
