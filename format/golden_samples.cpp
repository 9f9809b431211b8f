#include "golden_samples.h"

#include "visibility/visible_view.h"

#include <acdf/curves/curves.h>
#include <acdf/indexed/views.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <cstdio>
#include <stdexcept>
#include <utility>

namespace {

/// The corners, then a sequence with full mantissas (a 64-bit linear congruential generator; Knuth 1997, §3.3.4).
std::vector<std::pair<double, double>> random_numbers() {
    std::vector<std::pair<double, double>> numbers = {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {1.0, 1.0}, {0.5, 0.5}};
    std::uint64_t state = 2005;
    const auto next = [&] {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return static_cast<double>(state >> 11) * 0x1p-53;
    };
    while (numbers.size() < 16) {
        const double u0 = next(), u1 = next();
        numbers.push_back({u0, u1});
    }
    return numbers;
}

/// For each of these normals, of any length, a line `nx ny nz  u0 u1  x y z  pdf`; pdf 0 where nothing is sampled.
constexpr float kNormals[][3] = {{0, 0, 1},  {1, 0, 0},    {-1, -0.001f, 0.5f}, {0.3f, -0.7f, -0.2f},
                                 {-2, 1, 1}, {0, 0.5f, -5}};

/// Of a normal, or of coordinates among maps.
std::string sample_line(const float at[3], double u0, double u1, const acdf::DirectionSample& s) {
    char line[300];
    std::snprintf(line, sizeof line, "%a %a %a  %a %a  %a %a %a  %a\n", double{at[0]}, double{at[1]}, double{at[2]},
                  u0, u1, double{s.direction[0]}, double{s.direction[1]}, double{s.direction[2]}, double{s.pdf});
    return line;
}

std::string local_samples(const acdf::LocalEnvironmentView& view) {
    std::string text;
    for (const auto& n : kNormals)
        for (const auto& [u0, u1] : random_numbers()) {
            const acdf::DirectionSample s = view.sample(n, u0, u1);
            text += sample_line(n, u0, u1, s);
        }
    return text;
}

/// The same with a position of the scene before the normal: in each cell, between them, at the bounds and outside.
constexpr float kPositions[][3] = {{0, 1, 0},       {-1, 1, 1.5f},     {1.5f, 1, 1.5f},
                                   {0.2f, 1, 0.6f}, {0.6f, 2, 0.375f}, {5, 1, 0}};

std::string visibility_samples(const acdf::VisibleLocalView& view) {
    std::string text;
    for (const auto& x : kPositions)
        for (const auto& n : kNormals)
            for (const auto& [u0, u1] : random_numbers()) {
                const acdf::DirectionSample s = view.sample(view.at(x, n), u0, u1);
                char line[400];
                std::snprintf(line, sizeof line, "%a %a %a  %a %a %a  %a %a  %a %a %a  %a\n", double{x[0]},
                              double{x[1]}, double{x[2]}, double{n[0]}, double{n[1]}, double{n[2]}, u0, u1,
                              double{s.direction[0]}, double{s.direction[1]}, double{s.direction[2]},
                              double{s.pdf});
                text += line;
            }
    return text;
}

/// The same with wo: at normal incidence, between and at stored views, grazing.
constexpr float kViews[][3] = {{0, 0, 1},        {0.6f, 0, 0.8f},         {-0.48f, 0.64f, 0.6f},
                               {0, -0.8f, 0.6f}, {-0.96f, -0.28f, 1e-3f}, {0.28f, -0.96f, 0.01f}};

std::string brdf_samples(const acdf::BrdfView& view) {
    std::string text;
    for (const auto& wo : kViews)
        for (const auto& [u0, u1] : random_numbers()) {
            const acdf::DirectionSample s = view.sample(wo, u0, u1);
            char line[300];
            std::snprintf(line, sizeof line, "%a %a %a  %a %a  %a %a %a  %a\n", double{wo[0]}, double{wo[1]},
                          double{wo[2]}, u0, u1, double{s.direction[0]}, double{s.direction[1]},
                          double{s.direction[2]}, double{s.pdf});
            text += line;
        }
    return text;
}

/// The same with coordinates of maps, of as many axes as there are: between maps, at one, and beyond.
constexpr float kCoordinates[][3] = {{6, 1, 0},       {7.5f, 1.75f, 0}, {-0.25f, 2, 0},
                                     {0.5f, 0.5f, 0}, {15, 1.125f, 0},  {30, 1.25f, 0}};

std::string indexed_samples(const std::string& name, const acdf::File& file) {
    acdf::IndexedEnvironment view;
    if (const acdf::Status status = acdf::IndexedEnvironment::open(file, view); !status.ok())
        throw std::runtime_error(name + ": " + status.message);
    std::string text;
    for (const auto& t : kCoordinates)
        for (const auto& [u0, u1] : random_numbers()) {
            const acdf::DirectionSample s = view.at(double{t[0]}, double{t[1]}, double{t[2]}).sample(u0, u1);
            text += sample_line(t, u0, u1, s);
        }
    return text;
}

} // namespace

std::string golden_samples(const std::string& name, const std::vector<std::uint8_t>& bytes) {
    acdf::File file;
    acdf::LoadOptions walked; // as SPEC.md says it, to the last bit
    walked.tables = false;
    const acdf::Status status =
        acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves(walked));
    if (!status.ok()) throw std::runtime_error(name + ": " + status.message);
    if (file.kind() == ACDF_KIND_LOCAL) {
        const acdf::VisibleLocalView view = acdf::visible_view(file);
        return view.has_cells() ? visibility_samples(view) : local_samples(file.local());
    }
    if (file.kind() == ACDF_KIND_BRDF) return brdf_samples(file.brdf());
    if (file.kind() == ACDF_KIND_INDEXED) return indexed_samples(name, file);
    std::string text;
    for (const auto& [u0, u1] : random_numbers()) {
        const acdf::DirectionSample s = file.environment().sample(u0, u1);
        char line[200];
        std::snprintf(line, sizeof line, "%a %a  %a %a %a  %a\n", u0, u1, double{s.direction[0]},
                      double{s.direction[1]}, double{s.direction[2]}, double{s.pdf});
        text += line;
    }
    return text;
}
