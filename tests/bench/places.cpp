// How well files of places serve the points that a camera sees, without noise: variances by summation over all texels.
#include "measure/light_samplers.h"
#include "measure/surface_points.h"
#include "tools/render/run.h"
#include "tools/render/sampler_build.h"

#include "build/builder/sources.h"

#include <acdf/builder.h>
#include <acdf/local.h>
#include <acdf/reader.h>

#include <tbb/parallel_for.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

using namespace acdf;

namespace {

std::string text_of(const char* path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

struct Sums {
    double a = 0, b = 0; // sum v f^2/p, sum p
};

// part of a texel by splits that are columns; tile number
struct Where { std::uint32_t part, tile; };

Where where(const AcdfLocal& l, std::uint32_t c, std::uint32_t r) {
    std::uint32_t node = 0, part = 0xFFFFFFFFu;
    const std::uint32_t sq[2] = {c, r};
    while (!(node & ACDF_TILE_FLAG)) {
        if (part == 0xFFFFFFFFu && l.places.header && l.places.columns[node] == ACDF_NO_COLUMN) part = node;
        const AcdfSplit& s = l.blend.splits[node];
        node = s.child[sq[s.place & 7u] >= s.place >> 3];
    }
    if (part == 0xFFFFFFFFu) part = node;
    return {part, node & ~ACDF_TILE_FLAG};
}

} // namespace

int make(char** argv) {
    tools::SceneFile sf = tools::parse_scene(text_of(argv[2]));
    auto scene = tools::load_scene(sf, argv[3]);
    builder::TargetRows rows(builder::TargetOptions{});
    rows.begin(scene->probe.width, scene->probe.height);
    rows.take(0, scene->probe.height, scene->probe.rgb.data());
    const builder::Target target = rows.finish();
    builder::LocalOptions options;
    options.goal = builder::Goal::of_budget(std::strtoull(argv[4], nullptr, 10));
    const compress::PlaceScene ps = measure::place_scene(scene->scene.geometry);
    if (std::strcmp(argv[5], "places") == 0) {
        options.places.point = [&](std::uint64_t index, builder::PlacePoint& out) {
            compress::PlacePoint point;
            if (!ps.points(index, point)) return false;
            std::copy_n(point.position.begin(), 3, out.position);
            std::copy_n(point.normal.begin(), 3, out.normal);
            return true;
        };
        options.places.occluded = [&](const builder::PlacePoint& from, const float direction[3]) {
            compress::PlacePoint point;
            std::copy_n(from.position, 3, point.position.begin());
            std::copy_n(from.normal, 3, point.normal.begin());
            return ps.occluded(point, {direction[0], direction[1], direction[2]});
        };
    }
    builder::Local made;
    const builder::Status status = builder::local(target, options, made);
    if (!status.ok()) return std::puts(status.message), 1;
    std::ofstream(argv[6], std::ios::binary).write(reinterpret_cast<const char*>(made.bytes.data()), std::streamsize(made.bytes.size()));
    return 0;
}

int main(int argc, char** argv) {
    if (argc > 6 && std::strcmp(argv[1], "make") == 0) return make(argv);
    if (argc < 6) return 2;
    std::string dir = argv[2];
    tools::SceneFile sf = tools::parse_scene(text_of(argv[1]));
    unsigned w, h;
    std::sscanf(argv[3], "%ux%u", &w, &h);
    sf.width = w;
    sf.height = h;
    auto scene = tools::load_scene(sf, dir);
    const unsigned each = unsigned(std::atoi(argv[4]));
    std::vector<std::string> data;
    std::vector<File> files(std::size_t(argc - 5));
    for (int i = 5; i < argc; ++i) data.push_back(text_of(argv[i]));
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (!File::from_memory(data[i].data(), data[i].size(), files[i]).ok()) return 1;
    }
    const measure::ProbeLight& light = scene->scene.light;
    std::vector<const measure::ScenePoint*> points;
    for (std::size_t i = 0; i < scene->points.points.size(); i += each) points.push_back(&scene->points.points[i]);
    const std::size_t n = points.size(), m = files.size();
    std::vector<double> I(n), var(n * m), oracle_parts(n), oracle_tiles(n), oracle_none(n), vis(n);
    const AcdfLocal last = files.back().local().data();
    std::vector<Where> ws(std::size_t{light.columns} * light.rows);
    for (std::uint32_t r = 0; r < light.rows; ++r)
        for (std::uint32_t c = 0; c < light.columns; ++c) ws[std::size_t{r} * light.columns + c] = where(last, c, r);
    tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) {
        const measure::ScenePoint& p = *points[i];
        std::vector<double> square(m, 0.0);
        std::vector<AcdfLocalPoint> at(m);
        for (std::size_t k = 0; k < m; ++k)
            at[k] = files[k].local().has_places() ? files[k].local().at(p.shading().position, p.shading().n)
                                                  : files[k].local().at(p.shading().n);
        const AcdfLocalPoint bare = files.back().local().at(p.shading().n);
        std::map<std::uint32_t, Sums> parts;
        std::vector<Sums> tiles(last.blend.tiles->tile_count);
        double sum = 0, all = 0, seen_all = 0;
        for (std::uint32_t r = 0; r < light.rows; ++r) {
            const double above = acdf_row_z(r, light.rows), below = acdf_row_z(r + 1, light.rows);
            const double z = 0.5 * (above + below), rad = std::sqrt((1 - z) * (1 + z));
            const double omega = (above - below) * 2.0 * ACDF_PI / light.columns;
            for (std::uint32_t c = 0; c < light.columns; ++c) {
                double s, co;
                acdf_sincospi(1.0 - 2.0 * (c + 0.5) / light.columns, &s, &co);
                const measure::Vec3 wi{rad * co, rad * s, z};
                const float wf[3] = {float(wi[0]), float(wi[1]), float(wi[2])};
                const double pb = double{files.back().local().pdf(bare, wf)};
                measure::Rgb rho = p.reflected(wi);
                const measure::Rgb L = light.texel(c, r);
                for (int k = 0; k < 3; ++k) rho[std::size_t(k)] *= L[std::size_t(k)];
                const double f = measure::luminance(rho);
                const Where& x = ws[std::size_t{r} * light.columns + c];
                Sums& sp = parts[x.part];
                Sums& st = tiles[x.tile];
                sp.b += pb * omega;
                st.b += pb * omega;
                if (!(f > 0.0)) continue;
                all += f * omega;
                if (p.hidden(wi)) continue;
                sum += f * omega;
                for (std::size_t k = 0; k < m; ++k)
                    square[k] += f * f / double{files[k].local().pdf(at[k], wf)} * omega;
                sp.a += f * f / pb * omega;
                st.a += f * f / pb * omega;
                seen_all += f * f / pb * omega;
            }
        }
        I[i] = sum;
        vis[i] = all > 0 ? sum / all : 0;
        for (std::size_t k = 0; k < m; ++k) var[i * m + k] = square[k] - sum * sum;
        double op = 0, ot = 0;
        for (auto& [key, v] : parts) op += std::sqrt(v.a * v.b);
        for (auto& v : tiles) ot += std::sqrt(v.a * v.b);
        oracle_parts[i] = op * op - sum * sum;
        oracle_tiles[i] = ot * ot - sum * sum;
        oracle_none[i] = seen_all - sum * sum;
    });
    double mean = 0;
    for (double x : I) mean += x / double(n);
    std::vector<double> rel(m + 3, 0.0);
    FILE* out = std::getenv("POINTS") ? std::fopen(std::getenv("POINTS"), "w") : nullptr;
    for (std::size_t i = 0; i < n; ++i) {
        const double scale = I[i] * I[i] + 0.01 * mean * mean;
        for (std::size_t k = 0; k < m; ++k) rel[k] += var[i * m + k] / scale / double(n);
        rel[m] += oracle_parts[i] / scale / double(n);
        rel[m + 1] += oracle_tiles[i] / scale / double(n);
        rel[m + 2] += oracle_none[i] / scale / double(n);
        if (out) {
            const float* x = points[i]->shading().position;
            const float* nn = points[i]->shading().n;
            std::fprintf(out, "%zu %g %g %g  %g %g %g  I %g vis %g", i * each, double(x[0]), double(x[1]), double(x[2]), double(nn[0]), double(nn[1]), double(nn[2]), I[i] / mean, vis[i]);
            for (std::size_t k = 0; k < m; ++k) std::fprintf(out, " %g", var[i * m + k] / scale);
            std::fprintf(out, " | %g %g %g\n", oracle_parts[i] / scale, oracle_tiles[i] / scale, oracle_none[i] / scale);
        }
    }
    if (out) std::fclose(out);
    for (std::size_t k = 0; k < m; ++k) std::printf("%s: %.4g, gain %.3g\n", argv[5 + k], rel[k], rel[0] / rel[k]);
    std::printf("oracle parts %.4g gain %.3g; tiles %.4g gain %.3g (%u tiles); none %.4g\n", rel[m], rel[0] / rel[m], rel[m + 1], rel[0] / rel[m + 1], last.blend.tiles->tile_count, rel[m + 2]);
    return 0;
}
