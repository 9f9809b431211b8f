// Views of memory that was copied elsewhere, whose file is closed.
#include "tests/cuda/moved_views.h"
#include "tests/lib/curves/open.h"
#include "tests/lib/reader/golden_files.h"

#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <new>
#include <optional>
#include <vector>

namespace {

/// Copies as acdf/moved.h asks for them.
class Copies {
public:
    explicit Copies(const acdf::File& file) : count_(file.memory(moves_)) {
        for (int i = 0; i < count_; ++i) {
            constexpr std::size_t line = 64;
            void* block = ::operator new (moves_[i].bytes + 3, std::align_val_t{line});
            std::memcpy(block, moves_[i].from, moves_[i].bytes);
            moves_[i].to = block;
        }
    }
    ~Copies() {
        for (int i = 0; i < count_; ++i) ::operator delete (const_cast<void*>(moves_[i].to), std::align_val_t{64});
    }
    Copies(const Copies&) = delete;
    Copies& operator=(const Copies&) = delete;

    template <class View>
    View operator()(const View& view) const {
        return acdf_test::moved(view, moves_, count_);
    }

private:
    AcdfMove moves_[ACDF_MAX_MOVES];
    int count_;
};

/// Results of a view, for numbers that go through all of it.
std::vector<double> told(const acdf::DirectionSample& s, float pdf) {
    return {double{s.direction[0]}, double{s.direction[1]}, double{s.direction[2]}, double{s.pdf}, double{pdf}};
}
struct Number {
    double u0, u1;
    float normal[3];
};
std::vector<double> told(const acdf::EnvironmentView& view, const Number& n) {
    const acdf::DirectionSample s = view.sample(n.u0, n.u1);
    auto out = told(s, view.pdf(s.direction));
    out.insert(out.end(), {view.total(), double{view.recommended_light_share()}});
    return out;
}
std::vector<double> told(const acdf::LocalEnvironmentView& view, const Number& n) {
    const AcdfLocalPoint point = view.at(n.normal);
    const acdf::DirectionSample s = view.sample(point, n.u0, n.u1);
    auto out = told(s, view.pdf(point, s.direction));
    out.insert(out.end(), {view.irradiance(n.normal), double{view.recommended_light_share(n.normal)}});
    return out;
}
std::vector<double> told(const acdf::BrdfView& view, const Number& n) {
    const acdf::DirectionSample s = view.sample(n.normal, n.u0, n.u1);
    auto out = told(s, view.pdf(n.normal, s.direction));
    out.push_back(view.albedo(n.normal));
    return out;
}
std::vector<double> told(const acdf::TableView& view, const Number& n) {
    const std::uint32_t index[ACDF_MAX_AXES] = {};
    const double u[ACDF_MAX_AXES] = {n.u0, n.u1, n.u1, n.u0, n.u0, n.u1};
    std::vector<double> out(ACDF_MAX_AXES);
    const double density = view.sample(index, u, out.data());
    out.insert(out.end(), {density, view.pdf(index, out.data()), double{view.recommended_light_share(index)}});
    return out;
}

template <class View>
void expect_the_same_moved(std::optional<acdf::File>& file, std::vector<std::uint8_t>& bytes, const View& view) {
    std::vector<Number> numbers;
    for (int i = 0; i < 300; ++i) {
        const double u0 = 0.61803398875 * i, u1 = (i + 0.5) / 300.0, z = 1.0 - 2.0 * u1;
        const double r = std::sqrt(1.0 - z * z), phi = 5.3 * i;
        const float n[3] = {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
                            static_cast<float>(z)};
        numbers.push_back({u0 - std::floor(u0), u1, {n[0], n[1], n[2]}});
    }
    std::vector<std::vector<double>> before;
    for (const Number& n : numbers) before.push_back(told(view, n));
    const Copies copies(*file);
    const View moved = copies(view);
    file.reset();
    bytes.assign(bytes.size(), 0xFF); // which were used in place
    for (std::size_t i = 0; i < numbers.size(); ++i) ASSERT_EQ(told(moved, numbers[i]), before[i]) << i;
}

TEST(MovedViews, SampleWhatTheyDrew) {
    int kinds[8] = {};
    const auto expect = [&](const std::vector<std::uint8_t>& golden) {
        for (const bool tables : {true, false}) {
            std::vector<std::uint8_t> bytes = golden;
            acdf::LoadOptions options;
            options.tables = tables;
            std::optional<acdf::File> file(std::in_place);
            ASSERT_TRUE(
                acdf::File::from_memory(bytes.data(), bytes.size(), *file, acdf::with_curves(options)).ok());
            if (acdf_test::TreeOf(*file).data) continue; // tests/lib/curves/load.cpp
            ++kinds[file->kind()];
            switch (file->kind()) {
            case ACDF_KIND_ENVIRONMENT:
                expect_the_same_moved(file, bytes, file->environment());
                break;
            case ACDF_KIND_LOCAL:
                expect_the_same_moved(file, bytes, file->local());
                break;
            case ACDF_KIND_BRDF:
                expect_the_same_moved(file, bytes, file->brdf());
                break;
            case ACDF_KIND_INDEXED:
                break; // tests/lib/indexed
            default:
                expect_the_same_moved(file, bytes, file->table());
            }
        }
    };
    acdf_test::each_golden_file(expect);
    std::ifstream table(ACDF_TEST_DIR "/../format/vectors/table.acdf", std::ios::binary);
    expect({std::istreambuf_iterator<char>(table), {}});
    EXPECT_TRUE(kinds[ACDF_KIND_ENVIRONMENT] && kinds[ACDF_KIND_LOCAL] && kinds[ACDF_KIND_BRDF] &&
                kinds[ACDF_KIND_TABLE]);
}

TEST(MovedViews, PointNowhereButIntoCopies) {
    const char from[4] = {}, to[4] = {};
    const AcdfMove move = {from, sizeof from, to};
    EXPECT_EQ(acdf_moved(from + 3, &move, 1), to + 3);
    EXPECT_EQ(acdf_moved(from + 4, &move, 1), nullptr);
    EXPECT_EQ(acdf_moved(nullptr, &move, 1), nullptr);
}

} // namespace
