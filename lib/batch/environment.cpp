// Environments: descents of a block of calls in turns, between vectors of what is computed before and after.
#include <acdf/batch/batch.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "batch/environment.cpp"
#include <hwy/foreach_target.h>
//
#include "batch/cells-inl.h"

HWY_BEFORE_NAMESPACE();
namespace acdf {
namespace batch {
namespace HWY_NAMESPACE {
#if !ACDF_BATCH_SINGLY

struct EnvironmentBlock {
    HWY_ALIGN double given[2][kBlock]; // random numbers in [0, 1]
    Places places;
    Descents descents;
};

void take_numbers(const double* u, std::size_t count, EnvironmentBlock& block) {
    for (std::size_t i = 0; i < count; i += hn::Lanes(Doubles())) {
        Double u0, u1;
        load_numbers(u + 2 * i, u0, u1);
        hn::Store(u0, Doubles(), block.given[0] + i);
        hn::Store(u1, Doubles(), block.given[1] + i);
        hn::StoreInterleaved2(step_of(u0), step_of(u1), Words(), block.descents.target[i]);
    }
}

// Begins descents at `start` of each call's place in a lookup grid, or at the root.
template <class Start>
void begin(const AcdfEnvironment& env, std::size_t count, Descents& descents, Start&& start) {
    const std::uint32_t resolution[2] = {env.columns, env.rows};
    for (std::size_t i = 0; i < count; ++i) {
        AcdfSpan *steps = descents.steps[i], *box = descents.box[i];
        descents.begin(i, env.halved->bits ? acdf_halvings_begin(start(descents.target[i]), steps, box)
                                           : acdf_halvings_root(env.halved, resolution, 2, steps, box));
    }
}

void samples_of_block(const AcdfEnvironment& env, const double* u, std::size_t count, EnvironmentBlock& block,
                      float* directions, float* pdfs) {
    const AcdfHalvedTree* tree = env.halved;
    const std::uint32_t shift = 31u - tree->bits;
    const Grid grid(env);
    take_numbers(u, count, block);
    begin(env, count, block.descents, [tree, shift](const std::uint32_t number[2]) {
        return acdf_halvings_start(tree, tree->numbers, number[0] >> shift, number[1] >> shift);
    });
    block.descents.sample(acdf_halvings_nodes(tree));
    look_up_heights(env, block.descents, count, block.places);
    for (std::size_t i = 0; i < count; i += hn::Lanes(Doubles())) {
        Word s00, s01, s10, s11, b00, b01, b10, b11; // low and high of axis 0, and of axis 1
        hn::LoadInterleaved4(Words(), block.descents.steps[i][0].end, s00, s01, s10, s11);
        hn::LoadInterleaved4(Words(), block.descents.box[i][0].end, b00, b01, b10, b11);
        const Double w0 = width(s00, s01), w1 = width(s10, s11);
        put_direction(grid, b00, b01, b10, b11, span_fraction(s00, w0, hn::Load(Doubles(), block.given[0] + i)),
                      span_fraction(s10, w1, hn::Load(Doubles(), block.given[1] + i)), block.places, i,
                      directions + 3 * i);
        const Double p = hn::Mul(hn::Mul(w0, set(0x1p-31)), hn::Mul(w1, set(0x1p-31)));
        const Double area = area_of(width(b00, b01), height_of(grid, b10, b11, block.places, i));
        hn::StoreU(float_pdf(hn::Div(hn::Mul(p, set(grid.columns)), area)), Floats(), pdfs + i);
    }
}

void pdfs_of_block(const AcdfEnvironment& env, const float* directions, std::size_t count, EnvironmentBlock& block,
                   float* pdfs) {
    const AcdfHalvedTree* tree = env.halved;
    const Grid grid(env);
    place(grid, directions, count, block.places, block.descents);
    begin(env, count, block.descents,
          [tree](const std::uint32_t square[2]) { return acdf_halvings_start_at(tree, square); });
    block.descents.find(acdf_halvings_nodes(tree));
    look_up_heights(env, block.descents, count, block.places);
    for (std::size_t i = 0; i < count; i += hn::Lanes(Doubles())) {
        Word s00, s01, s10, s11, b00, b01, b10, b11;
        hn::LoadInterleaved4(Words(), block.descents.steps[i][0].end, s00, s01, s10, s11);
        hn::LoadInterleaved4(Words(), block.descents.box[i][0].end, b00, b01, b10, b11);
        const Double p = hn::Mul(hn::Mul(width(s00, s01), set(0x1p-31)), hn::Mul(width(s10, s11), set(0x1p-31)));
        const Double area = area_of(width(b00, b01), height_of(grid, b10, b11, block.places, i));
        const auto pdf = float_pdf(hn::Div(hn::Mul(p, set(grid.columns)), area));
        const auto sure = is_surely_in(grid, b00, b01, b10, b11, block.places, i);
        hn::StoreU(hn::IfThenElse(sure, pdf, hn::Set(Floats(), -1.0f)), Floats(), pdfs + i);
    }
    for (std::size_t i = 0; i < count; ++i)
        if (pdfs[i] < 0.0f) pdfs[i] = acdf_environment_pdf(&env, directions + 3 * i);
}

// How many calls were served by blocks.
std::size_t samples_in_blocks(const AcdfEnvironment& env, const double* u, std::size_t count, float* directions,
                              float* pdfs) {
    EnvironmentBlock block;
    return in_blocks(count, [&](std::size_t i, std::size_t n) {
        samples_of_block(env, u + 2 * i, n, block, directions + 3 * i, pdfs + i);
    });
}
std::size_t pdfs_in_blocks(const AcdfEnvironment& env, const float* directions, std::size_t count, float* pdfs) {
    EnvironmentBlock block;
    return in_blocks(
        count, [&](std::size_t i, std::size_t n) { pdfs_of_block(env, directions + 3 * i, n, block, pdfs + i); });
}

#else

std::size_t samples_in_blocks(const AcdfEnvironment&, const double*, std::size_t, float*, float*) { return 0; }
std::size_t pdfs_in_blocks(const AcdfEnvironment&, const float*, std::size_t, float*) { return 0; }

#endif

void environment_samples(const AcdfEnvironment& env, const double* u, std::size_t count, float* directions,
                         float* pdfs) {
    std::size_t i = env.halved ? samples_in_blocks(env, u, count, directions, pdfs) : 0;
    for (; i < count; ++i)
        put_sample(acdf_environment_sample(&env, u[2 * i], u[2 * i + 1]), directions + 3 * i, pdfs + i);
}

void environment_pdfs(const AcdfEnvironment& env, const float* directions, std::size_t count, float* pdfs) {
    std::size_t i = env.halved ? pdfs_in_blocks(env, directions, count, pdfs) : 0;
    for (; i < count; ++i) pdfs[i] = acdf_environment_pdf(&env, directions + 3 * i);
}

} // namespace HWY_NAMESPACE
} // namespace batch
} // namespace acdf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace acdf {
namespace batch {
HWY_EXPORT(environment_samples);
HWY_EXPORT(environment_pdfs);
} // namespace batch

void sample_batch(const EnvironmentView& view, const double (*u)[2], std::size_t count, float (*directions)[3],
                  float* pdfs) noexcept {
    if (count == 0) return;
    using namespace batch;
    HWY_DYNAMIC_DISPATCH(environment_samples)(view.data(), u[0], count, directions[0], pdfs);
}

void pdf_batch(const EnvironmentView& view, const float (*directions)[3], std::size_t count, float* pdfs) noexcept {
    if (count == 0) return;
    using namespace batch;
    HWY_DYNAMIC_DISPATCH(environment_pdfs)(view.data(), directions[0], count, pdfs);
}

} // namespace acdf
#endif
