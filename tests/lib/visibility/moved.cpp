// Views of visibility cells whose memory was copied: the same samples.
#include "tests/lib/reader/golden_files.h"

#include <acdf/visibility/visibility.h>
#include <acdf/visibility/visibility_c.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

namespace {

std::vector<double> told(const acdf::VisibleLocalView& view) {
    std::vector<double> out;
    for (int i = 0; i < 300; ++i) {
        const double u0 = std::fmod(0.61803398875 * i, 1.0), u1 = (i + 0.5) / 300.0, z = 1.0 - 2.0 * u1;
        const double r = std::sqrt(1.0 - z * z), phi = 5.3 * i;
        const float n[3] = {float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)};
        const float x[3] = {0.5f * n[1], 0.5f * n[2], 0.5f * n[0]};
        const AcdfVisiblePoint point = view.at(x, n);
        const acdf::DirectionSample s = view.sample(point, u0, u1);
        out.insert(out.end(),
                   {double{s.direction[0]}, double{s.direction[1]}, double{s.direction[2]}, double{s.pdf},
                    double{view.pdf(point, s.direction)}, 1.0 * point.in_cell, 1.0 * point.portals});
    }
    return out;
}

TEST(MovedVisibleViews, SampleWhatTheyDrew) {
    int cells = 0, portals = 0;
    acdf_test::each_golden_file([&](const std::vector<std::uint8_t>& golden) {
        std::vector<std::uint8_t> bytes = golden;
        std::vector<double> before;
        AcdfMove moves[ACDF_MAX_VISIBLE_MOVES];
        std::vector<std::vector<double>> copies(ACDF_MAX_VISIBLE_MOVES);
        AcdfVisibleLocal data;
        int count = 0;
        {
            acdf::File file;
            const acdf::Status status = acdf::File::from_memory(bytes.data(), bytes.size(), file);
            if (status.rule == 5002) return; // curves, whose views are not moved
            ASSERT_TRUE(status.ok()) << status.message;
            if (file.kind() != ACDF_KIND_LOCAL) return;
            acdf::VisibleLocalView view;
            ASSERT_TRUE(acdf::VisibleLocalView::of(file, view).ok());
            cells += view.has_cells();
            portals += view.has_portals();
            before = told(view);
            data = view.data();
            count = acdf_visible_memory(file.get(), moves);
            for (int i = 0; i < count; ++i) { // aligned to 64 bytes
                auto& copy = copies[std::size_t(i)];
                copy.resize(moves[i].bytes / 8 + 10);
                const auto at = reinterpret_cast<std::uintptr_t>(copy.data());
                std::uint8_t* to = reinterpret_cast<std::uint8_t*>(copy.data()) + (64 - at % 64) % 64;
                std::memcpy(to, moves[i].from, moves[i].bytes);
                moves[i].to = to;
            }
        }
        bytes.assign(bytes.size(), 0xFF); // which were used in place
        acdf_move_visible_local(&data, moves, count);
        EXPECT_EQ(told(acdf::VisibleLocalView(data)), before);
    });
    EXPECT_GT(cells, 1);
    EXPECT_GT(portals, 0);
}

} // namespace
