// Files of kind 3 that break one rule each.
#include "tests/lib/reader/brdf_builder.h"
#include "tests/lib/reader/check/cases.h"

#include <limits>

namespace acdf_test {
namespace {

Action<Bytes()> changed(Action<void(BrdfSpec&)> change) {
    return [change] {
        BrdfSpec spec = shared_brdf();
        change(spec);
        return spec.encode();
    };
}

/// One number of a chunk, counted as BrdfSpec::file has them.
Action<Bytes()> field(std::size_t chunk, std::size_t at, int size, std::uint64_t value) {
    return [=] {
        FileSpec file = shared_brdf().file();
        set(file.chunks[chunk].raw, at, size, value);
        return file.encode();
    };
}

constexpr std::size_t axis(std::size_t i) { return 64 + 48 * i; }

} // namespace

std::vector<Case> brdf_cases() {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    return {
        {8001, "three_axes",
         [] {
             FileSpec file = shared_brdf().file();
             DescriptionSpec d = shared_brdf().description();
             d.axes.pop_back();
             file.chunks[0].raw = d.encode();
             return file.encode();
         }},
        {3013, "partner_of_a_brdf",
         [] {
             FileSpec file = shared_brdf().file();
             file.chunks.push_back({"COMP", Bytes(24, 0), 1, false});
             return file.encode();
         }},
        {8001, "name", field(0, axis(1), 1, 'C')},
        {8001, "range_of_views", field(0, axis(2) + 32, 8, 0x3FE0000000000000)},
        {8001, "role", field(0, axis(3) + 16, 4, 0)},
        {8001, "measure", field(0, axis(1) + 20, 4, 0)},
        {8001, "measure_of_curves",
         [] {
             FileSpec file = separate_brdf().file();
             set(file.chunks[0].raw, axis(1) + 20, 4, 2);
             return file.encode();
         }},
        {8001, "range", field(0, axis(1) + 40, 8, 0x3FE0000000000000)},
        {8001, "columns", field(0, axis(0) + 24, 4, 65537)},
        {8001, "rows", field(0, axis(1) + 24, 4, 1024)},
        {8001, "rows_of_curves",
         [] {
             FileSpec file = separate_brdf().file();
             set(file.chunks[0].raw, axis(1) + 24, 4, (1u << 28) + 1);
             return file.encode();
         }},
        {8002, "fewer", changed([](BrdfSpec& s) {
             s.bins.pop_back();
             s.halved.rows.pop_back();
         })},
        {8002, "more", changed([](BrdfSpec& s) {
             s.bins.push_back({0, 0.125f});
         })},
        {8003, "missing",
         [] {
             FileSpec file = shared_brdf().file();
             file.chunks.erase(file.chunks.begin() + 3);
             return file.encode();
         }},
        {8003, "short",
         [] {
             FileSpec file = shared_brdf().file();
             file.chunks[3].raw.resize(15);
             return file.encode();
         }},
        {8003, "long",
         [] {
             FileSpec file = shared_brdf().file();
             file.chunks[3].raw.resize(16 + 13);
             return file.encode();
         }},
        {8003, "count", field(3, 0, 4, 0xFFFFFFFF)},
        {8003, "azimuths", field(3, 4, 4, 2)},
        {8003, "flag", field(3, 8, 4, 3)},
        {8003, "not_mirrored", field(3, 8, 4, 0)},
        {8003, "mirrored",
         [] {
             FileSpec file = separate_brdf().file();
             set(file.chunks[3].raw, 8, 4, 1);
             return file.encode();
         }},
        {8003, "mirrored_azimuths",
         [] {
             BrdfSpec spec = separate_brdf();
             spec.flags = 1;
             return spec.encode();
         }},
        {8004, "equal", changed([](BrdfSpec& s) { s.nodes[1] = s.nodes[0]; })},
        {8004, "falling", changed([](BrdfSpec& s) { s.nodes[2] = 0.25f; })},
        {8004, "negative", changed([](BrdfSpec& s) { s.nodes[0] = -0.5f; })},
        {8004, "above_one", changed([](BrdfSpec& s) { s.nodes[2] = 1.5f; })},
        {8004, "nan", changed([nan](BrdfSpec& s) { s.nodes[1] = nan; })},
        {8005, "one", changed([](BrdfSpec& s) { s.diffuse_share = 1.0f; })},
        {8005, "negative", changed([](BrdfSpec& s) { s.diffuse_share = -0.25f; })},
        {8005, "nan", changed([nan](BrdfSpec& s) { s.diffuse_share = nan; })},
        {8006, "row", changed([](BrdfSpec& s) { s.bins[1].root = no_root; })},
        {3004, "rows_of_a_brdf",
         [] {
             FileSpec file = shared_brdf().file();
             file.chunks.pop_back();
             return file.encode();
         }},
        {6026, "row_of_a_brdf", changed([](BrdfSpec& s) { s.bins[1].root = 3; })},
        {6040, "codes_of_a_brdf",
         [] {
             FileSpec file = shared_brdf().file();
             file.chunks[4].raw.resize(file.chunks[4].raw.size() - 4);
             return file.encode();
         }},
        {8006, "tree",
         [] {
             BrdfSpec spec = separate_brdf();
             spec.bins[5].root = no_root;
             return spec.encode();
         }},
    };
}

} // namespace acdf_test
