// How exactly floats resolve pdfs of a BRDF.
#pragma once

#include <cmath>

namespace acdf_test {

/// |wo . (wo + wi)|, and |wo + wi|.
struct Halves {
    double dot = 0.0, length = 0.0;
    Halves(const float wo[3], const float wi[3]) {
        for (int k = 0; k < 3; ++k) {
            const double h = double{wo[k]} + double{wi[k]};
            dot += double{wo[k]} * h;
            length += h * h;
        }
        dot = std::fabs(dot);
        length = std::sqrt(length);
    }
    /// What floats round of a pdf, of it.
    double rounded() const { return 1e-5 + 1e-6 * length / dot; }
    /// What rounding the directions changes of it.
    double moved() const { return 1e-6 / dot; }
};

} // namespace acdf_test
