// Baselines of BRDF files, in floats: an alias table and a hierarchical warp of tabulated slices. A slice is what a
// view reflects, by half-vectors: 256 x 32 steps of theta_h and phi_h, one slice for each of 32 views (the size
// that Lawrence et al. 2005 tabulate), azimuths from the view's. Isotropic BRDFs alone.
#pragma once

#include "compress/brdf/target.h"
#include "measure/samplers/alias_choices.h"

#include <acdf/sample.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace acdf_bench {

/// What both have: slices, and the way from a cell to a direction and back.
class Slices {
public:
    static constexpr std::uint32_t kViewBits = 5, kRowBits = 8, kColumnBits = 5, kCellBits = kRowBits + kColumnBits;
    static constexpr std::uint32_t kViews = 1u << kViewBits, kRows = 1u << kRowBits, kColumns = 1u << kColumnBits,
                                   kCells = 1u << kCellBits;
    static constexpr float kPi = 3.14159265f, kRowStep = 0.5f * kPi / kRows, kColumnStep = 2.0f * kPi / kColumns;

    /// Parts of what a view (cos(theta_o) in the middle of its step of angle) reflects by each cell's half-vector.
    static std::vector<float> slice(const acdf::compress::Reflected& reflected, std::uint32_t view) {
        const double angle = 0.5 * ACDF_PI * (view + 0.5) / kViews, wo[3] = {std::sin(angle), 0.0, std::cos(angle)};
        std::vector<float> mass(kCells);
        double sum = 0.0;
        for (std::uint32_t cell = 0; cell < kCells; ++cell) {
            const double theta = kRowStep * (cell / kColumns + 0.5),
                         phi = kColumnStep * (cell % kColumns + 0.5) - ACDF_PI;
            const double h[3] = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
            const double dot = wo[0] * h[0] + wo[1] * h[1] + wo[2] * h[2];
            const double wi[3] = {2.0 * dot * h[0] - wo[0], 2.0 * dot * h[1] - wo[1], 2.0 * dot * h[2] - wo[2]};
            if (dot > 0.0 && wi[2] > 0.0)
                mass[cell] = static_cast<float>(reflected(wo, wi) * 4.0 * dot * std::sin(theta));
            sum += double{mass[cell]};
        }
        for (float& m : mass) m = static_cast<float>(m / sum);
        return mass;
    }
    static std::uint32_t view_of(const float wo[3]) {
        const float step = std::acos(std::min(wo[2], 1.0f)) * (kViews / (0.5f * kPi));
        return std::min(static_cast<std::uint32_t>(step), kViews - 1);
    }
    static float solid_angle(std::uint32_t cell) {
        const float middle = kRowStep * (static_cast<float>(cell / kColumns) + 0.5f);
        return 2.0f * std::sin(middle) * std::sin(0.5f * kRowStep) * kColumnStep;
    }
    /// wo reflected at fractions s and t of a cell that has a part of all.
    static AcdfDirectionSample place(const float wo[3], std::uint32_t cell, float s, float t, float part) {
        const float theta = kRowStep * (static_cast<float>(cell / kColumns) + t);
        const float phi = kColumnStep * (static_cast<float>(cell % kColumns) + s) - kPi + std::atan2(wo[1], wo[0]);
        const float sine = std::sin(theta), h[3] = {sine * std::cos(phi), sine * std::sin(phi), std::cos(theta)};
        const float dot = wo[0] * h[0] + wo[1] * h[1] + wo[2] * h[2];
        return {{2.0f * dot * h[0] - wo[0], 2.0f * dot * h[1] - wo[1], 2.0f * dot * h[2] - wo[2]},
                part / (solid_angle(cell) * 4.0f * dot)};
    }
    /// The cell of the half-vector, and its cosine to wo.
    static std::uint32_t cell_of(const float wo[3], const float wi[3], float& dot) {
        const float h[3] = {wo[0] + wi[0], wo[1] + wi[1], wo[2] + wi[2]}, sin2 = h[0] * h[0] + h[1] * h[1];
        const float theta = std::atan2(std::sqrt(sin2), h[2]);
        float turn = (std::atan2(h[1], h[0]) - std::atan2(wo[1], wo[0]) + kPi) * (1.0f / (2.0f * kPi));
        turn -= std::floor(turn);
        dot = 0.5f * std::sqrt(sin2 + h[2] * h[2]);
        return std::min(static_cast<std::uint32_t>(theta * (1.0f / kRowStep)), kRows - 1) * kColumns +
               std::min(static_cast<std::uint32_t>(turn * kColumns), kColumns - 1);
    }
};

/// The alias method: the cell by one number, the choice by the other; the rest of each is the position in the cell.
class AliasSlices {
public:
    explicit AliasSlices(const acdf::compress::Reflected& reflected) {
        for (std::uint32_t view = 0; view < Slices::kViews; ++view) add(Slices::slice(reflected, view));
    }
    AcdfDirectionSample sample(const float wo[3], const double u[2]) const {
        const float at = static_cast<float>(u[0]) * Slices::kCells, v = static_cast<float>(u[1]);
        std::uint32_t cell = std::min(static_cast<std::uint32_t>(at), Slices::kCells - 1);
        const float s = at - static_cast<float>(cell);
        const std::size_t first = std::size_t{Slices::view_of(wo)} << Slices::kCellBits;
        const Entry& entry = entries_[first + cell];
        float t = v / entry.keep;
        if (v >= entry.keep) {
            t = (v - entry.keep) / (1.0f - entry.keep);
            cell = entry.alias;
        }
        return Slices::place(wo, cell, s, t, entries_[first + cell].part);
    }
    float pdf(const float wo[3], const float wi[3]) const {
        float dot;
        const std::uint32_t cell = Slices::cell_of(wo, wi, dot);
        const std::size_t first = std::size_t{Slices::view_of(wo)} << Slices::kCellBits;
        return entries_[first + cell].part / (Slices::solid_angle(cell) * 4.0f * dot);
    }

private:
    struct Entry {
        float keep;
        std::uint32_t alias;
        float part;
    };
    void add(const std::vector<float>& mass) {
        std::vector<double> scaled;
        for (const float m : mass) scaled.push_back(double{m} * static_cast<double>(mass.size()));
        const std::vector<acdf::measure::AliasChoice> choices = acdf::measure::alias_choices(std::move(scaled));
        for (std::size_t i = 0; i < mass.size(); ++i)
            entries_.push_back({choices[i].keep, choices[i].alias, mass[i]});
    }
    std::vector<Entry> entries_;
};

/// Clarberg's hierarchical warp with halves instead of quarters: three of theta_h, then both angles in turns.
class WarpSlices {
public:
    explicit WarpSlices(const acdf::compress::Reflected& reflected) {
        for (std::uint32_t view = 0; view < Slices::kViews; ++view) {
            const std::vector<float> mass = Slices::slice(reflected, view);
            std::vector<float> heap(2 * Slices::kCells);
            for (std::uint32_t cell = 0; cell < Slices::kCells; ++cell)
                heap[Slices::kCells | leaf_of(cell)] = mass[cell];
            for (std::uint32_t i = Slices::kCells - 1; i > 0; --i) heap[i] = heap[2 * i] + heap[2 * i + 1];
            heaps_.insert(heaps_.end(), heap.begin(), heap.end());
        }
    }
    AcdfDirectionSample sample(const float wo[3], const double u[2]) const {
        const float* const heap = heap_of(wo);
        float left[2] = {static_cast<float>(u[0]), static_cast<float>(u[1])};
        std::uint32_t node = 1, step[2] = {0, 0};
        for (std::uint32_t level = 0; level < Slices::kCellBits; ++level) {
            const int axis = axis_of(level);
            const float below = heap[2 * node] / heap[node];
            const bool upper = left[axis] >= below;
            left[axis] = std::min(upper ? (left[axis] - below) / (1.0f - below) : left[axis] / below, 0.99999994f);
            step[axis] = 2 * step[axis] + upper;
            node = 2 * node + upper;
        }
        return Slices::place(wo, step[1] * Slices::kColumns + step[0], left[0], left[1], heap[node]);
    }
    float pdf(const float wo[3], const float wi[3]) const {
        float dot;
        const std::uint32_t cell = Slices::cell_of(wo, wi, dot);
        return heap_of(wo)[Slices::kCells | leaf_of(cell)] / (Slices::solid_angle(cell) * 4.0f * dot);
    }

private:
    /// Levels of theta_h first, as it has more steps.
    static int axis_of(std::uint32_t level) {
        constexpr std::uint32_t first = Slices::kRowBits - Slices::kColumnBits;
        return level < first || (level - first) % 2 == 1 ? 1 : 0;
    }
    static std::uint32_t leaf_of(std::uint32_t cell) {
        std::uint32_t left[2] = {Slices::kColumnBits, Slices::kRowBits}, leaf = 0;
        const std::uint32_t step[2] = {cell % Slices::kColumns, cell / Slices::kColumns};
        for (std::uint32_t level = 0; level < Slices::kCellBits; ++level) {
            const int axis = axis_of(level);
            leaf = 2 * leaf + (step[axis] >> --left[axis] & 1u);
        }
        return leaf;
    }
    const float* heap_of(const float wo[3]) const {
        return &heaps_[std::size_t{Slices::view_of(wo)} << (Slices::kCellBits + 1)];
    }
    std::vector<float> heaps_;
};

} // namespace acdf_bench
