// path_tracer SAMPLER FILE.acdf SKY.pfm OUT.pfm SAMPLES WIDTH
//
// Paths of three bounces under an environment. SAMPLER: cosine, environment, local or product. At each point light
// is sampled from the file, or from the surface's own lobe, and both are combined by the balance heuristic. Prints
// the mean of the picture and the variance of a sample of it.
#include "picture.h"
#include "scene.h"

#include <acdf/product/product.h>
#include <acdf/reader.h>
#include <acdf/views.h>
#include <acdf/visibility/visibility.h>

#include <atomic>
#include <cstdlib>
#include <thread>
#include <utility>

namespace {

constexpr float pi = 3.14159265f;

/// PCG, 32 bits.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15u + 1) { next(); }
    double next() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        const auto word = static_cast<std::uint32_t>(((state_ >> 18) ^ state_) >> 27);
        const auto turn = static_cast<std::uint32_t>(state_ >> 59);
        return ((word >> turn) | (word << (-turn & 31))) * 0x1p-32;
    }

private:
    std::uint64_t state_;
};

// ---- the surface: a diffuse and a Phong lobe, in the frame whose z is the normal

float phong(const Material& m, const float wo[3], const float wi[3]) {
    const float along = wo[2] * wi[2] - wo[0] * wi[0] - wo[1] * wi[1]; // of the mirrored wo
    return along > 0.0f ? std::pow(along, m.exponent) : 0.0f;
}

Vec brdf(const Material& m, const float wo[3], const float wi[3]) {
    if (wi[2] <= 0.0f) return {};
    const float lobe = m.glossy * (m.exponent + 2.0f) / (2.0f * pi) * phong(m, wo, wi);
    return m.diffuse * (1.0f / pi) + Vec{lobe, lobe, lobe};
}

float brdf_pdf(const Material& m, const float wo[3], const float wi[3]) {
    const float cosine = wi[2] > 0.0f ? wi[2] / pi : 0.0f;
    return (1.0f - m.glossy) * cosine + m.glossy * (m.exponent + 1.0f) / (2.0f * pi) * phong(m, wo, wi);
}

acdf::ProductSample brdf_sample(const Material& m, const float wo[3], double u0, double u1) {
    const bool glossy = u0 < static_cast<double>(m.glossy);
    u0 = glossy ? u0 / static_cast<double>(m.glossy)
                : (u0 - static_cast<double>(m.glossy)) / (1.0 - static_cast<double>(m.glossy));
    const float cosine = static_cast<float>(
        glossy ? std::pow(1.0 - u1, 1.0 / (static_cast<double>(m.exponent) + 1.0)) : std::sqrt(1.0 - u1));
    const float sine = std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)), phi = 2.0f * pi * static_cast<float>(u0);
    acdf::ProductSample s = {{sine * std::cos(phi), sine * std::sin(phi), cosine}, 0.0f};
    if (glossy) {
        const float mirrored[3] = {-wo[0], -wo[1], wo[2]};
        const float sampled[3] = {s.direction[0], s.direction[1], s.direction[2]};
        acdf::surface_frame(mirrored).to_world(sampled, s.direction);
    }
    s.pdf = brdf_pdf(m, wo, s.direction);
    return s;
}

// ---- where light is sampled from

/// A shading point: its surface, and where it is seen from.
struct Point {
    const Hit& hit;
    acdf::SurfaceFrame frame;
    float wo[3]; ///< in the frame
};

/// No light is sampled: the surface's lobe finds it or does not.
struct NoLight {
    static constexpr bool draws = false;
    struct At {
        acdf::DirectionSample sample(double, double) const { return {}; }
        float pdf(const float[3]) const { return 0.0f; }
    };
    At at(const Point&) const { return {}; }
};

/// `acdf env`: the same light everywhere.
struct EnvironmentLight {
    static constexpr bool draws = true;
    acdf::EnvironmentView view;
    acdf::EnvironmentView at(const Point&) const { return view; }
};

/// `acdf local`: what is above the surface's horizon, times the cosine; of files made for the scene, what is seen
/// from the position.
struct LocalLight {
    static constexpr bool draws = true;
    acdf::VisibleLocalView view;
    struct At {
        const acdf::VisibleLocalView& view;
        AcdfVisiblePoint point;
        acdf::DirectionSample sample(double u0, double u1) const { return view.sample(point, u0, u1); }
        float pdf(const float d[3]) const { return view.pdf(point, d); }
    };
    At at(const Point& point) const {
        const float position[3] = {point.hit.point.x, point.hit.point.y, point.hit.point.z};
        return {view, view.at(position, point.frame.normal)};
    }
};

/// A surface's lobe as acdf/product/product.h asks for one, with light that follows it.
auto product_of(const AcdfLocal& light, const Material* m) {
    return acdf::ProductSampler(
        light, acdf::Lobe([m](const float wo[3], const float wi[3]) { return luminance(brdf(*m, wo, wi)); },
                          [m](const float wo[3], double u0, double u1) { return brdf_sample(*m, wo, u0, u1); },
                          [m](const float wo[3], const float wi[3]) { return brdf_pdf(*m, wo, wi); }));
}

/// `acdf local` times the surface's lobe.
struct ProductLight {
    using Sampler = decltype(product_of(AcdfLocal{}, nullptr));
    static constexpr bool draws = true;
    acdf::LocalEnvironmentView view;
    struct At {
        Sampler product;
        Sampler::Point point;
        acdf::DirectionSample sample(double u0, double u1) const { return product.sample(point, u0, u1); }
        float pdf(const float d[3]) const { return product.pdf(point, d); }
    };
    At at(const Point& point) const {
        const Sampler product = product_of(view.data(), point.hit.material);
        float wo[3];
        point.frame.to_world(point.wo, wo);
        return {product, product.at(point.frame, wo)};
    }
};

// ---- paths

/// Light that reaches the eye along a ray: what the sky shows, and what is sampled at each of three points.
template <class Light>
Vec path(const Scene& scene, const Picture& sky, const Light& light, Vec from, Vec towards, Random& random) {
    Hit hit = scene.intersect(from, towards);
    if (!hit.any) return radiance(sky, towards);
    Vec sum, throughput = {1.0f, 1.0f, 1.0f};
    for (int bounce = 0; bounce < 3; ++bounce) {
        const float normal[3] = {hit.normal.x, hit.normal.y, hit.normal.z},
                    back[3] = {-towards.x, -towards.y, -towards.z};
        Point point = {hit, acdf::surface_frame(normal), {}};
        point.frame.to_local(back, point.wo);
        const auto lit = light.at(point);
        float wi[3];
        if (Light::draws) {
            const acdf::DirectionSample s = lit.sample(random.next(), random.next());
            point.frame.to_local(s.direction, wi);
            const Vec d = {s.direction[0], s.direction[1], s.direction[2]};
            if (s.pdf > 0.0f && wi[2] > 0.0f && !scene.hidden(hit.point, d)) {
                const float both = s.pdf + brdf_pdf(*hit.material, point.wo, wi); // the balance heuristic
                sum = sum + throughput * brdf(*hit.material, point.wo, wi) * radiance(sky, d) * (wi[2] / both);
            }
        }
        const double u0 = random.next(), u1 = random.next();
        const acdf::ProductSample s = brdf_sample(*hit.material, point.wo, u0, u1);
        if (!(s.pdf > 0.0f) || s.direction[2] <= 0.0f) break;
        throughput = throughput * brdf(*hit.material, point.wo, s.direction) * (s.direction[2] / s.pdf);
        float world[3];
        point.frame.to_world(s.direction, world);
        towards = {world[0], world[1], world[2]};
        const Hit next = scene.intersect(hit.point, towards);
        if (!next.any) {
            const float weight = s.pdf / (s.pdf + (Light::draws ? lit.pdf(world) : 0.0f));
            return sum + throughput * radiance(sky, towards) * weight;
        }
        hit = next;
    }
    return sum;
}

struct Camera {
    Vec eye = {1.5f, -7.0f, 2.2f}, ahead, right, up;
    Camera(int width, int height) {
        ahead = normalized(Vec{0.0f, 0.0f, 0.8f} - eye);
        right = normalized(cross(ahead, {0.0f, 0.0f, 1.0f})) *
                (0.45f * static_cast<float>(width) / static_cast<float>(height));
        up = cross(right, ahead) * (0.45f / std::sqrt(dot(right, right)));
    }
    Vec towards(double x, double y) const { // from -1 to 1
        return normalized(ahead + right * static_cast<float>(x) + up * static_cast<float>(y));
    }
};

struct Statistics {
    double mean = 0.0, variance = 0.0; ///< of pixels; of one sample of them
};

/// Rows go to threads as they come; each pixel has random numbers of its own, so that pictures are always the same.
template <class Light>
Statistics render(const Picture& sky, const Light& light, int samples, Picture& out) {
    const Scene scene;
    const Camera camera(out.width, out.height);
    std::vector<Statistics> rows(static_cast<std::size_t>(out.height));
    std::atomic<int> next{0};
    const auto work = [&] {
        for (int y = next++; y < out.height; y = next++)
            for (int x = 0; x < out.width; ++x) {
                Random random(static_cast<std::uint64_t>(y) * 65536 + static_cast<std::uint64_t>(x));
                double sum = 0.0, squares = 0.0;
                for (int i = 0; i < samples; ++i) {
                    const double px = (x + random.next()) / out.width, py = (y + random.next()) / out.height;
                    const Vec c =
                        path(scene, sky, light, camera.eye, camera.towards(2 * px - 1, 1 - 2 * py), random);
                    out.at(x, y) = out.at(x, y) + c * (1.0f / static_cast<float>(samples));
                    sum += static_cast<double>(luminance(c));
                    squares += static_cast<double>(luminance(c)) * static_cast<double>(luminance(c));
                }
                Statistics& row = rows[static_cast<std::size_t>(y)];
                row.mean += sum / samples / out.width;
                row.variance += (squares - sum * sum / samples) / (samples - 1) / out.width;
            }
    };
    std::vector<std::thread> threads;
    for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i) threads.emplace_back(work);
    for (std::thread& thread : threads) thread.join();
    Statistics all;
    for (const Statistics& row : rows) {
        all.mean += row.mean / out.height;
        all.variance += row.variance / out.height;
    }
    return all;
}

Statistics run(const std::string& sampler, const std::string& light, const std::string& map, int samples,
               Picture& out) {
    const Picture sky = read_picture(map);
    acdf::File file;
    if (sampler == "cosine") return render(sky, NoLight{}, samples, out);
    if (const acdf::Status status = acdf::File::open(light.c_str(), file); !status.ok())
        throw std::runtime_error(status.message);
    if (sampler == "environment" && file.kind() == ACDF_KIND_ENVIRONMENT)
        return render(sky, EnvironmentLight{file.environment()}, samples, out);
    if (sampler == "local" && file.kind() == ACDF_KIND_LOCAL) {
        acdf::VisibleLocalView view;
        if (const acdf::Status status = acdf::VisibleLocalView::of(file, view); !status.ok())
            throw std::runtime_error(status.message);
        return render(sky, LocalLight{view}, samples, out);
    }
    if (sampler == "product" && file.kind() == ACDF_KIND_LOCAL)
        return render(sky, ProductLight{file.local()}, samples, out);
    throw std::runtime_error(light + ": is not a file for " + sampler);
}

} // namespace

int main(int argc, char** argv) {
    try {
        if (argc != 7)
            throw std::runtime_error("usage: path_tracer SAMPLER FILE.acdf SKY.pfm OUT.pfm SAMPLES WIDTH");
        const int samples = std::max(std::atoi(argv[5]), 2), width = std::clamp(std::atoi(argv[6]), 8, 8192);
        Picture out{width, width * 5 / 8,
                    std::vector<Vec>(static_cast<std::size_t>(width) * static_cast<std::size_t>(width * 5 / 8))};
        const Statistics found = run(argv[1], argv[2], argv[3], samples, out);
        write_picture(argv[4], out);
        std::printf("mean %.6g variance %.6g\n", found.mean, found.variance);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "path_tracer: %s\n", error.what());
        return 1;
    }
}
