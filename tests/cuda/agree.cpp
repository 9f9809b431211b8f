// Whether a GPU samples what the processor samples, and finds the same pdfs.
//
//   cuda_agree [--exact] COUNT FILE...            environments, local environments, BRDFs and tables
//   cuda_agree [--exact] COUNT --product PARTS LOCAL BRDF
//
// A row of a table in Markdown for each file, by its runtime tables and by traversal: out of COUNT samples and as
// many directions, those that are not the processor's to the bit, by how much they differ at most, and samples
// whose pdf is another one when it is asked for. --exact: fails unless all are the same. Skips (77) where there is
// no device.
#include "device_answers.h"
#include "visibility/visible_view.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

using namespace acdf_cuda;

constexpr std::size_t kBatch = std::size_t{1} << 20;

/// Differences between a GPU's answers and the processor's.
struct Differences {
    std::size_t draws = 0, densities = 0, others = 0; ///< not the same to the bit
    std::size_t own = 0;                              ///< samples whose direction has another pdf
    std::size_t far = 0;                              ///< samples that lie more than 1e-5 away
    double most_own = 0.0, most_other = 0.0;          ///< relative

    static bool same(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }
    static double relative(double a, double b) { return a == b ? 0.0 : std::fabs(a / b - 1.0); }
    void add(const Answer& device, const Answer& host) {
        double away = 0.0;
        bool sampled = true;
        for (int k = 0; k < ACDF_MAX_AXES; ++k) {
            sampled &= same(device.place[k], host.place[k]);
            away = std::max(away, std::fabs(device.place[k] - host.place[k]));
        }
        draws += !sampled;
        far += !(away < 1e-5);
        densities += !same(device.density, host.density);
        others += !same(device.other, host.other);
        own += !same(device.again, device.density);
        most_own = std::max(most_own, relative(device.again, device.density));
        if (!same(device.other, host.other)) most_other = std::max(most_other, relative(device.other, host.other));
    }
    bool none() const { return draws + densities + others == 0; }
};

template <class Call>
bool compare(const std::string& name, const Call& device, const Call& host, const acdf::File& file,
             std::size_t count) {
    Differences found;
    std::size_t host_own = 0;
    for (std::size_t done = 0, batch = 0; done < count; done += kBatch, ++batch) {
        const auto asked = questions(std::min(kBatch, count - done), static_cast<unsigned>(batch), file);
        const auto a = device_answers(device, asked), b = host_answers(host, asked);
        for (std::size_t i = 0; i < asked.size(); ++i) {
            found.add(a[i], b[i]);
            host_own += !Differences::same(b[i].again, b[i].density);
        }
    }
    std::printf("| %s | %zu | %zu | %zu | %zu | %zu (%zu) | %.1e | %zu | %.1e |\n", name.c_str(), count,
                found.draws, found.far, found.densities, found.own, host_own, found.most_own, found.others,
                found.most_other);
    std::fflush(stdout);
    return found.none();
}

bool of_file(const char* path, std::size_t count) {
    bool exact = true;
    for (const bool tables : {true, false}) {
        acdf::LoadOptions options;
        options.tables = tables;
        acdf::File file;
        const acdf::Status status = acdf::File::open(path, file, options);
        if (status.rule == 5002) return true; // curves, which kernels do not take
        if (!status.ok()) {
            std::fprintf(stderr, "%s: %s\n", path, status.message);
            std::exit(1);
        }
        if (tables && file.table_bytes() == 0) continue;
        const DeviceFile device(file);
        std::string name = path;
        name.erase(0, name.find_last_of('/') + 1);
        name += tables ? ", tables" : ", no tables";
        switch (file.kind()) {
        case ACDF_KIND_ENVIRONMENT:
            exact &= compare(name, OfEnvironment{device(file.environment())}, {file.environment()}, file, count);
            break;
        case ACDF_KIND_LOCAL:
            exact &=
                compare(name, OfLocal{device(acdf::visible_view(file))}, {acdf::visible_view(file)}, file, count);
            break;
        case ACDF_KIND_BRDF:
            exact &= compare(name, OfBrdf{device(file.brdf())}, {file.brdf()}, file, count);
            break;
        default:
            exact &= compare(name, OfTable{device(file.table())}, {file.table()}, file, count);
        }
    }
    return exact;
}

bool of_product(int parts, const char* light_path, const char* surface_path, std::size_t count) {
    acdf::File light, surface;
    if (!acdf::File::open(light_path, light).ok() || !acdf::File::open(surface_path, surface).ok() ||
        light.kind() != ACDF_KIND_LOCAL || surface.kind() != ACDF_KIND_BRDF) {
        std::fprintf(stderr, "a product needs a local environment and a BRDF\n");
        std::exit(1);
    }
    const DeviceFile light_there(light), surface_there(surface);
    return compare("product, " + std::to_string(parts) + " sub-regions",
                   OfProduct{light_there(light.local()), surface_there(surface.brdf()), parts},
                   {light.local(), surface.brdf(), parts}, light, count);
}

} // namespace

int main(int argc, char** argv) {
    int at = 1, devices = 0;
    const bool exact = argc > at && std::strcmp(argv[at], "--exact") == 0;
    at += exact;
    if (argc < at + 2) {
        std::fprintf(stderr, "usage: cuda_agree [--exact] COUNT FILE... | --product PARTS LOCAL BRDF\n");
        return 2;
    }
    if (cudaGetDeviceCount(&devices) != cudaSuccess || devices == 0) {
        std::fprintf(stderr, "skipped: there is no CUDA device\n");
        return 77;
    }
    const std::size_t count = std::strtoul(argv[at++], nullptr, 10);
    bool same = true;
    std::printf(
        "| file | samples | other direction | beyond 1e-5 | other pdf | pdf of the sampled direction differs "
        "(processor) | by | directions with another pdf | by |\n|---|---|---|---|---|---|---|---|---|\n");
    if (std::strcmp(argv[at], "--product") == 0 && argc >= at + 4)
        same = of_product(std::atoi(argv[at + 1]), argv[at + 2], argv[at + 3], count);
    else
        for (; at < argc; ++at) same &= of_file(argv[at], count);
    if (exact && !same) std::fprintf(stderr, "some answers are not the processor's to the bit\n");
    return exact && !same;
}
