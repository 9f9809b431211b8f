// What must hold of every file, whatever fit, order and target made it.
#pragma once

#include "compress/fit/fit.h"
#include "compress/target.h"

#include <cstdint>
#include <string>
#include <vector>

namespace acdf_test {

struct NamedFit {
    std::string name;
    acdf::compress::FitOptions options;
};

/// Every fit in every variant, both orders; `columns` and `rows` segments a curve, `cells` for variance.
std::vector<NamedFit> all_fits(std::uint32_t columns, std::uint32_t rows, std::uint32_t cells);

/// Fits, stores, reads back and checks with EXPECT_: the file is accepted; no support violation; no cell
/// without energy has probability; the pdf integrates to 1 within 1e-5, over cells and over texel centres;
/// sample().pdf equals pdf(direction), bit for bit where no tilt magnifies rounding; chi-square of samples over
/// equal-area bins and over cells; the Monte Carlo estimate of the integral is within five of the standard errors
/// that relative_variance predicts.
void check_fit(const acdf::compress::Target& target, const NamedFit& fit);

} // namespace acdf_test
