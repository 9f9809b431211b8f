#include "tests/shaders/check.h"

#include "tests/lib/reader/half_vectors.h"
#include "tests/shaders/answers.h"

#include <acdf/indexed/views.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace acdf_test {

namespace {

// Of a pdf: what floats round. Beyond the second, it is another cell's.
constexpr double kNear = 1e-5, kSame = 1e-3;
// Samples of another cell than the reader's, and directions of another pdf: next to borders.
constexpr double kMostOthers = 1e-4;

struct Differences {
    std::size_t sampled = 0, other_cells = 0, not_told = 0, rounded = 0, other_pdfs = 0;
    double farthest = 0.0, own = 0.0;
};

double relative(double a, double b) { return a == b ? 0.0 : std::fabs(a - b) / std::max(a, b); }

class Reader {
public:
    explicit Reader(const acdf::File& file) : file_(file) { acdf::IndexedEnvironment::open(file, maps_); }
    /// A normal, or of a BRDF a direction of view, of several maps coordinates.
    void at(const float given[3]) {
        if (file_.kind() == ACDF_KIND_LOCAL) point_ = file_.local().at(given);
        if (maps()) sky_ = maps_.at(double{given[0]}, double{given[1]}, double{given[2]});
        std::copy_n(given, 3, wo_);
    }
    acdf::DirectionSample sample(double u0, double u1) const {
        if (brdf()) return file_.brdf().sample(wo_, u0, u1);
        if (maps()) return sky_.sample(u0, u1);
        return file_.kind() == ACDF_KIND_LOCAL ? file_.local().sample(point_, u0, u1)
                                               : file_.environment().sample(u0, u1);
    }
    float pdf(const float d[3]) const {
        if (brdf()) return file_.brdf().pdf(wo_, d);
        if (maps()) return sky_.pdf(d);
        return file_.kind() == ACDF_KIND_LOCAL ? file_.local().pdf(point_, d) : file_.environment().pdf(d);
    }

    /// Of a pdf: what floats round.
    double near(const float d[3]) const {
        if (maps()) return kNear + cone_moves(d);
        return weighed() + (brdf() ? Halves(wo_, d).rounded() : kNear);
    }
    /// Of rows of halvings other numbers lead to a cell than in shaders.
    bool has_rows() const { return rows().count > 0; }
    /// Beyond this it is another cell's.
    double same(const float d[3]) const {
        return kSame + weighed() + (brdf() ? Halves(wo_, d).moved() : maps() ? cone_moves(d) : 0.0);
    }

private:
    bool brdf() const { return file_.kind() == ACDF_KIND_BRDF; }
    /// Those that are mixed; none of other files.
    AcdfRowMixture rows() const {
        AcdfBrdfView view = {};
        if (brdf() && file_.brdf().data().halved) acdf_brdf_view(&file_.brdf().data(), wo_, &view);
        return file_.kind() == ACDF_KIND_LOCAL && point_.what == ACDF_LOCAL_ROWS ? point_.by.rows : view.mix;
    }
    /// The reader rounds weights of rows to whole numbers, out of 2^21.
    double weighed() const {
        const AcdfRowMixture mix = rows();
        double most = 0.0;
        for (int k = 0; k < mix.count; ++k) most = std::max(most, 1.0 / mix.weight[k]);
        return most;
    }
    bool maps() const { return !maps_.empty(); }
    /// Of the pdf: what a step of 2^-20 changes where the cone of the sun falls steeply.
    double cone_moves(const float d[3]) const {
        const AcdfCone& cone = sky_.data().cone;
        const double pdf = double{sky_.pdf(d)};
        if (!(cone.reach > 0.0) || !(pdf > 0.0)) return 0.0;
        return sky_.sun_share() * cone.peak / pdf * 0x1p-20 * 8.0 / std::sqrt(cone.reach);
    }

    const acdf::File& file_;
    AcdfLocalPoint point_ = {};
    acdf::IndexedEnvironment maps_; // empty for other kinds
    acdf::MixedEnvironment sky_;
    float wo_[3] = {};
};

void compare_sample(const Reader& reader, const std::uint32_t* words, const float* draw, double own,
                    Differences& found) {
    const acdf::DirectionSample told = reader.sample(words[0] * 0x1p-32, words[1] * 0x1p-32);
    const double pdf = draw[3];
    if (!(pdf > 0.0)) {
        found.not_told += told.pdf > 0.0f;
        return;
    }
    ++found.sampled;
    found.own = std::max(found.own, relative(pdf, own));
    const double of_reader = relative(pdf, reader.pdf(draw));
    found.not_told += !(of_reader <= reader.same(draw));
    found.rounded += !(of_reader <= reader.near(draw));
    if (reader.has_rows()) return;
    if (!(relative(pdf, told.pdf) <= reader.same(draw))) {
        ++found.other_cells;
        return;
    }
    for (int k = 0; k < 3; ++k)
        found.farthest = std::max(found.farthest, std::fabs(double{told.direction[k]} - draw[k]));
}

} // namespace

int check(const acdf::File& file, std::size_t count, const std::string& folder, double ulps) {
    const auto words = read_all<std::uint32_t>(folder + "/words.bin", 2 * count);
    const auto normals = read_all<float>(folder + "/normals.bin", 4 * count);
    const auto directions = read_all<float>(folder + "/directions.bin", 4 * count);
    const auto draws = read_all<float>(folder + "/samples.bin", 4 * count);
    const auto densities = read_all<float>(folder + "/densities.bin", 2 * count);
    Differences found;
    Reader reader(file);
    for (std::size_t i = 0; i < count; ++i) {
        reader.at(&normals[4 * i]);
        compare_sample(reader, &words[2 * i], &draws[4 * i], densities[2 * i + 1], found);
        const float* direction = &directions[4 * i];
        found.other_pdfs += !(relative(reader.pdf(direction), densities[2 * i]) <= reader.same(direction));
    }
    const double own = found.own * 0x1p24;
    std::printf(
        "%zu samples: %zu of another cell, the others at most %.2g off; %zu whose density the reader does not "
        "have, "
        "%zu by more than is rounded; own density off by %.1f steps of 2^-24\n%zu directions: %zu of another "
        "density\n",
        found.sampled, found.other_cells, found.farthest, found.not_told, found.rounded, own, count,
        found.other_pdfs);
    const double most = kMostOthers * static_cast<double>(count);
    const bool right = static_cast<double>(found.other_cells) <= most &&
                       static_cast<double>(found.not_told) <= most / 10 &&
                       static_cast<double>(found.rounded) <= most &&
                       static_cast<double>(found.other_pdfs) <= most && 2 * found.sampled > count && own <= ulps;
    return right ? 0 : 1;
}

} // namespace acdf_test
