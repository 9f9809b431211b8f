// Writes test vectors for readers of .acdf files: for each file NAME.acdf a NAME.csv of what is sampled from it and
// of densities (format/vectors/README.md), and table.acdf, which golden files lack.
//
//   make_vectors OUTDIR FILE.acdf...
#include "compress/store/store.h"
#include "visibility/visible_view.h"
#include "write_file.h"

#include <acdf/curves/curves.h>
#include <acdf/indexed/views.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace acdf::compress;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN(),
                 kInfinity = std::numeric_limits<double>::infinity();
constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();

using Direction = acdf::DirectionSample;

/// Random numbers with full mantissas (a 64-bit linear congruential generator; Knuth 1997, §3.3.4).
class Random {
public:
    double next() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return static_cast<double>(state_ >> 11) * 0x1p-53;
    }

private:
    std::uint64_t state_ = 1997;
};

std::string number(double v) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", v);
    return text;
}
/// Of a float as few digits as tell it from all others.
std::string number(float v) {
    char text[40];
    std::snprintf(text, sizeof text, "%.9g", static_cast<double>(v));
    return text;
}

template <class... T>
std::string row(const char* call, const T&... cells) {
    std::string text = call;
    ((text += ',', text += cells), ...);
    return text + '\n';
}
std::string cells(const float v[3]) { return number(v[0]) + ',' + number(v[1]) + ',' + number(v[2]); }

/// The corners, numbers that a reader clamps, and others.
std::vector<std::pair<double, double>> random_numbers(int count) {
    std::vector<std::pair<double, double>> out = {
        {0.0, 0.0}, {1.0, 1.0}, {0.5, 0.5}, {-1.0, 2.0}, {kNan, kInfinity}};
    Random random;
    while (static_cast<int>(out.size()) < count) {
        const double u0 = random.next(), u1 = random.next();
        out.push_back({u0, u1});
    }
    return out;
}

/// On axes, the seam and diagonals, of lengths next to 1 and not, not a number, and others.
std::vector<std::vector<float>> directions(int count) {
    std::vector<std::vector<float>> out = {
        {1, 0, 0},       {-1, 0, 0},       {-1, -0.0f, 0},  {0, 0, 1},          {-0.0f, 0, -1},     {0, -1, 0},
        {0.6f, 0.8f, 0}, {0, 0.6f, -0.8f}, {0, 0, 1.0004f}, {-0.6f, 0, 0.801f}, {0.5f, 0.5f, 0.5f}, {kNanF, 0, 1}};
    Random random;
    while (static_cast<int>(out.size()) < count) {
        const double z = 2.0 * random.next() - 1.0, phi = 2.0 * ACDF_PI * random.next(), r = std::sqrt(1.0 - z * z);
        out.push_back(
            {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)), static_cast<float>(z)});
    }
    return out;
}

std::string environment_rows(const acdf::EnvironmentView& view) {
    std::string text = "call,u0,u1,x,y,z,pdf\n";
    for (const auto& [u0, u1] : random_numbers(24)) {
        const Direction s = view.sample(u0, u1);
        text += row("sample", number(u0), number(u1), cells(s.direction), number(s.pdf));
    }
    for (const auto& d : directions(24)) text += row("pdf", "", "", cells(d.data()), number(view.pdf(d.data())));
    return text;
}

/// Of local environments and BRDFs: `given` are normals or views.
template <class View>
std::string conditional_rows(const View& view, const std::vector<std::vector<float>>& given, const char* names) {
    std::string text = std::string("call,") + names + ",u0,u1,x,y,z,pdf\n";
    int offset = 0;
    for (const auto& g : given) {
        const auto numbers = random_numbers(40);
        for (int i = 0; i < 12; ++i) {
            const auto& [u0, u1] = i < 3 ? numbers[static_cast<std::size_t>(i)]
                                         : numbers[static_cast<std::size_t>(3 + (offset + i) % 37)];
            const Direction s = view.sample(g.data(), u0, u1);
            text += row("sample", cells(g.data()), number(u0), number(u1), cells(s.direction), number(s.pdf));
        }
        const auto all = directions(40);
        for (int i = 0; i < 10; ++i) {
            const auto& d = all[static_cast<std::size_t>(offset + i) % all.size()];
            text += row("pdf", cells(g.data()), "", "", cells(d.data()), number(view.pdf(g.data(), d.data())));
        }
        offset += 7;
    }
    return text;
}

const std::vector<std::vector<float>> kNormals = {{0, 0, 1},
                                                  {1, 0, 0},
                                                  {-2, 1, 1},
                                                  {0, 0.5f, -5},
                                                  {0.3f, -0.7f, -0.2f},
                                                  {-1, -0.001f, 0.5f},
                                                  {0, 0, 0},
                                                  {kNanF, 0, 1},
                                                  {1e-30f, 2e-30f, -1e-30f}};
/// Of a file with visibility cells: in its cells, on their borders, at the bounds of all, outside, and not a
/// number.
const std::vector<std::vector<float>> kPositions = {{0, 1, 0},    {-1, 1, 1.5f}, {0.2f, 1, 0.6f}, {0.6f, 2, 0.375f},
                                                    {2, 4, 2.5f}, {5, 1, 0},     {kNanF, 0, 1}};
const std::vector<std::vector<float>> kViews = {{0, 0, 1},        {0.6f, 0, 0.8f},         {-0.48f, 0.64f, 0.6f},
                                                {0, -0.8f, 0.6f}, {-0.96f, -0.28f, 1e-3f}, {0.28f, -0.96f, 0.01f},
                                                {0, 0, -1},       {0.6f, 0, 0.6f}};

/// As conditional_rows, of a local environment with visibility cells: a position comes before each normal.
std::string visibility_rows(const acdf::VisibleLocalView& view) {
    std::string text = "call,px,py,pz,nx,ny,nz,u0,u1,x,y,z,pdf\n";
    std::size_t offset = 0;
    const auto numbers = random_numbers(40);
    const auto all = directions(40);
    for (const auto& p : kPositions)
        for (const auto& n : kNormals) {
            const AcdfVisiblePoint point = view.at(p.data(), n.data());
            for (std::size_t i = 0; i < 4; ++i) {
                const auto& [u0, u1] = numbers[(offset + i) % numbers.size()];
                const Direction s = view.sample(point, u0, u1);
                text += row("sample", cells(p.data()), cells(n.data()), number(u0), number(u1), cells(s.direction),
                            number(s.pdf));
                const auto& d = all[(offset + i) % all.size()];
                text += row("pdf", cells(p.data()), cells(n.data()), "", "", cells(d.data()),
                            number(view.pdf(point, d.data())));
            }
            offset += 7;
        }
    return text;
}

/// Of several maps: coordinates at a map, between, beyond, and not a number.
std::string indexed_rows(const acdf::File& file) {
    acdf::IndexedEnvironment view;
    if (const acdf::Status status = acdf::IndexedEnvironment::open(file, view); !status.ok())
        throw std::runtime_error(status.message);
    const AcdfIndexed& data = view.data();
    std::string text = "call,";
    for (std::uint32_t axis = 0; axis < data.axes; ++axis) text += "t" + std::to_string(axis) + ",";
    text += "u0,u1,x,y,z,pdf\n";
    Random random;
    const auto numbers = random_numbers(40);
    const auto all = directions(40);
    for (std::size_t place = 0; place < 8; ++place) {
        double at[ACDF_MOST_INDEXED_AXES] = {};
        std::string given;
        const double* of_axis = data.coordinates;
        for (std::uint32_t axis = 0; axis < data.axes; of_axis += data.counts[axis++]) {
            const double low = of_axis[0], high = of_axis[data.counts[axis] - 1];
            at[axis] = place == 0 ? low : place == 1 ? of_axis[1] : low + (high - low) * random.next();
            if (place == 2 && axis == 0) at[axis] = high + 1.0;
            if (place == 3 && axis + 1 == data.axes) at[axis] = kNan;
            given += (axis ? "," : "") + number(at[axis]);
        }
        const acdf::MixedEnvironment sky = view.at(at);
        for (std::size_t i = 0; i < 16; ++i) {
            const auto& [u0, u1] = numbers[(7 * place + i) % numbers.size()];
            const Direction s = sky.sample(u0, u1);
            text += row("sample", given, number(u0), number(u1), cells(s.direction), number(s.pdf));
            const auto& d = all[(7 * place + i) % all.size()];
            text += row("pdf", given, "", "", cells(d.data()), number(sky.pdf(d.data())));
        }
    }
    return text;
}

// ---- tables ---------------------------------------------------------------------------------------------

/// Two by two bins over three axes: one without energy, one of one cell; a falling range, a dark half.
std::vector<std::uint8_t> table_file() {
    Halvings trees;
    trees.code_bits = 6;
    trees.axis_bits = 2;
    trees.axes = {0, 1, 2, -1, -1, 1, -1, -1, 2, 2, -1, -1, -1, -1, 2, 2, 2, 2, -1, -1, -1, -1, -1};
    trees.codes = {20, 41, 1, 63, 30, 55, 62, 10, 33, 5};
    const std::vector<std::uint32_t> roots = {0, ACDF_NO_ROOT, 6, ACDF_NO_ROOT};
    Description d;
    d.kind = ACDF_KIND_TABLE;
    d.parameterization = ACDF_PARAM_TABLE;
    d.total = 2.5;
    d.channel_weights[0] = 1.0;
    d.channel_weights[1] = d.channel_weights[2] = 0.0;
    d.axes = {{"material", ACDF_AXIS_INDEXED, ACDF_MEASURE_LINEAR, 2, 0.0, 2.0},
              {"hour", ACDF_AXIS_INDEXED, ACDF_MEASURE_LINEAR, 2, 6.0, 18.0},
              {"x", ACDF_AXIS_SAMPLED, ACDF_MEASURE_LINEAR, 7, -1.0, 1.0},
              {"depth", ACDF_AXIS_SAMPLED, ACDF_MEASURE_LINEAR, 8, 0.1, -0.7},
              {"nm", ACDF_AXIS_SAMPLED, ACDF_MEASURE_LINEAR, 31, 380.0, 730.0}};
    d.shares = {0.5f, 0.25f, 0.25f, 0.0f};
    return store(trees, roots, d);
}

std::string joined(const std::vector<double>& values) {
    std::string text;
    for (const double v : values) text += (text.empty() ? "" : ",") + number(v);
    return text;
}

/// Names of columns: name0 to name(count - 1), each before a comma.
std::string columns(const char* name, std::uint32_t count) {
    std::string text;
    for (std::uint32_t i = 0; i < count; ++i) text += name + std::to_string(i) + ',';
    return text;
}

/// The first bin, the last, some between, and one that there is not.
std::vector<std::vector<std::uint32_t>> table_bins(const AcdfTable& table) {
    std::vector<std::vector<std::uint32_t>> out;
    for (std::uint32_t part = 0; part <= 4; ++part) {
        std::vector<std::uint32_t> index;
        for (std::uint32_t axis = 0; axis < table.indexed_count; ++axis)
            index.push_back((table.axes[axis].resolution - 1) * (axis % 2 ? part * 3 % 5 : part) / 4);
        out.push_back(index);
        if (table.indexed_count == 0) return out;
    }
    out.push_back(out.back());
    out.back()[0] = table.axes[0].resolution;
    return out;
}

/// Points from one end to the other, just outside, not a number, and anywhere.
std::vector<std::vector<double>> table_points(const AcdfTable& table, Random& random) {
    std::vector<std::vector<double>> out;
    for (int i = 0; i < 10; ++i) {
        std::vector<double> x;
        for (std::uint32_t axis = table.indexed_count; axis < table.axis_count; ++axis) {
            const AcdfAxis& a = table.axes[axis];
            const double t = i == 0 ? 0.0 : i == 2 ? 0.5 : random.next();
            x.push_back(i == 1 ? a.high : a.low + (a.high - a.low) * t);
        }
        const AcdfAxis& first = table.axes[table.indexed_count];
        if (i == 3) x[0] = std::nextafter(first.high, first.high > first.low ? kInfinity : -kInfinity);
        if (i == 4) x.back() = kNan;
        out.push_back(x);
    }
    return out;
}

std::string table_rows(const acdf::TableView& view) {
    const AcdfTable& table = view.data();
    const std::uint32_t sampled = table.axis_count - table.indexed_count;
    std::string text =
        "call," + columns("i", table.indexed_count) + columns("u", sampled) + columns("x", sampled) + "pdf\n";
    Random random;
    for (const auto& index : table_bins(table)) {
        std::string bin;
        for (const std::uint32_t i : index) bin += std::to_string(i) + ',';
        for (const auto& [u0, u1] : random_numbers(12)) {
            std::vector<double> u(sampled), x(sampled, 0.0); // nothing is sampled
            for (std::uint32_t axis = 0; axis < sampled; ++axis)
                u[axis] = axis == 0 ? u0 : axis == 1 ? u1 : random.next();
            const double pdf = view.sample(index.data(), u.data(), x.data());
            text += row(("sample," + bin + joined(u)).c_str(), joined(x), number(pdf));
        }
        for (const auto& x : table_points(table, random))
            text += row(("pdf," + bin + std::string(sampled - 1, ',')).c_str(), joined(x),
                        number(view.pdf(index.data(), x.data())));
    }
    return text;
}

// ---- files ----------------------------------------------------------------------------------------------

std::string rows_of(const acdf::File& file) {
    switch (file.kind()) {
    case ACDF_KIND_LOCAL:
        if (const auto view = acdf::visible_view(file); view.has_cells()) return visibility_rows(view);
        return conditional_rows(file.local(), kNormals, "nx,ny,nz");
    case ACDF_KIND_BRDF:
        return conditional_rows(file.brdf(), kViews, "ox,oy,oz");
    case ACDF_KIND_TABLE:
        return table_rows(file.table());
    case ACDF_KIND_INDEXED:
        return indexed_rows(file);
    default:
        return environment_rows(file.environment());
    }
}

} // namespace

int main(int argc, char** argv) try {
    if (argc < 2) {
        std::fprintf(stderr, "usage: make_vectors OUTDIR [FILE.acdf...] (OUTDIR exists)\n");
        return 2;
    }
    const std::string folder = std::string(argv[1]) + "/";
    if (argc == 2) {
        const auto table = table_file();
        write_file(folder + "table.acdf", table.data(), table.size());
    }
    for (int i = 2; i < argc; ++i) {
        acdf::File file;
        const std::string path = argv[i], name = path.substr(path.rfind('/') + 1);
        acdf::LoadOptions walked; // as SPEC.md says it, to the last bit
        walked.tables = false;
        const acdf::Status status = acdf::File::open(path.c_str(), file, acdf::with_curves(walked));
        if (!status.ok()) throw std::runtime_error(status.message);
        const std::string text = rows_of(file);
        write_file(folder + name.substr(0, name.rfind('.')) + ".csv", text.data(), text.size());
    }
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "make_vectors: %s\n", error.what());
    return 1;
}
