// Time of samples and pdfs on a GPU, beside samplers of all texels of a map.
//
//   cuda_bench environments COLUMNS FILE...   environments and their exported tables (.bin); maps of so
//                                             many columns are what they are compared with
//   cuda_bench others FILE...                 local environments and BRDFs, and exported tables (.bin, of
//                                             BRDFs brdf.bin)
//
// Tables in Markdown: ns a call, several million calls a launch, the least of 20. Skips (77) where there is no
// device.
#include "baselines.h"
#include "exported.h"
#include "views_timed.h"

#include "../bench/directions.h"
#include "../bench/full_table.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <random>
#include <string>

namespace {

using namespace acdf_cuda;

/// A row: its name and a time for each column.
struct Row {
    std::string name;
    std::vector<Timed> times;
};

void print(const char* title, const char* columns, const std::vector<Row>& rows) {
    std::printf("\n| %s | %s | registers, local bytes, warps |\n|---|", title, columns);
    for (std::size_t i = 0; i <= rows[0].times.size(); ++i) std::printf("---|");
    std::printf("\n");
    for (const Row& row : rows) {
        std::printf("| %s |", row.name.c_str());
        for (const Timed& t : row.times) {
            if (t.ns > 0.0) std::printf(" %.4f |", t.ns);
            else std::printf(" – |");
        }
        for (const std::size_t i : {std::size_t{0}, row.times.size() - 1})
            std::printf(" %d %d %d%s", row.times[i].kernel.registers, row.times[i].kernel.stack,
                        row.times[i].kernel.warps, i == 0 ? ";" : " |\n");
    }
    std::fflush(stdout);
}

/// Questions of all calls, in the memory of the device. Coherent ones: threads next to each other have numbers next
/// to each other, and each 32 the same normal.
class Questions {
public:
    Questions() {
        std::mt19937 random(7);
        const auto number = [&] { return static_cast<float>(random() >> 8) * 0x1p-24f; };
        std::vector<float2> u(kCalls);
        std::vector<float4> w(kCalls);
        for (float2& v : u) v = {number(), number()};
        numbers_.emplace(u.data(), kCalls);
        constexpr unsigned side = 2048, lines = kCalls / side;
        for (unsigned i = 0; i < kCalls; ++i)
            u[i] = {std::min((static_cast<float>(i % side) + u[i].x) / side, 1.0f - 0x1p-24f),
                    std::min((static_cast<float>(i / side) + u[i].y) / lines, 1.0f - 0x1p-24f)};
        coherent_numbers_.emplace(u.data(), kCalls);
        const acdf_bench::Directions some = acdf_bench::uniform_directions(kCalls, 9);
        for (unsigned i = 0; i < kCalls; ++i) w[i] = {some[i][0], some[i][1], some[i][2], 0.0f};
        directions_.emplace(w.data(), kCalls);
        for (unsigned i = 0; i < kCalls; ++i)
            w[i] = {some[kCalls - 1 - i][0], some[kCalls - 1 - i][1], some[kCalls - 1 - i][2], 0.0f};
        normals_.emplace(w.data(), kCalls);
        for (unsigned i = 0; i < kCalls; ++i) w[i] = {some[i / 32][0], some[i / 32][1], some[i / 32][2], 0.0f};
        coherent_normals_.emplace(w.data(), kCalls);
    }
    Asked any() const { return {numbers_->data(), directions_->data(), normals_->data()}; }
    Asked coherent() const { return {coherent_numbers_->data(), directions_->data(), coherent_normals_->data()}; }

private:
    std::optional<DeviceArray<float2>> numbers_, coherent_numbers_;
    std::optional<DeviceArray<float4>> directions_, normals_, coherent_normals_;
};

/// Nothing but what is asked.
struct Nothing {
    __device__ AcdfDirectionSample sample(float u0, float u1) const { return {{u0, u1, 0.0f}, 0.0f}; }
    __device__ float pdf(const float w[3]) const { return w[0] + w[1] + w[2]; }
};

/// Directions that a sampler samples, for calls that ask for pdfs there.
template <class View>
__global__ void draw_all(View view, const float2* u, float4* out) {
    const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
    const AcdfDirectionSample s = view.sample(u[i].x, u[i].y);
    out[i] = {s.direction[0], s.direction[1], s.direction[2], s.pdf};
}
template <class View>
Asked at_sampled(const View& view, const Asked& asked, const DeviceArray<float4>& place) {
    draw_all<<<kCalls / kThreads, kThreads>>>(view, asked.numbers, place.data());
    require(cudaDeviceSynchronize(), "kernel");
    return {asked.numbers, place.data(), asked.normals};
}

template <class View>
Timed time_pdf_of(const View& view, const Asked& asked) {
    return time(PdfOf<View>{view, asked});
}
template <class View>
Row of_baseline(const char* name, const View& view, const Questions& q, const Asked& sampled) {
    return {name,
            {time(SampleOf<View>{view, q.any()}), time(SampleOf<View>{view, q.coherent()}),
             time_pdf_of(view, q.any()), time_pdf_of(view, sampled)}};
}

std::vector<char> bytes_of(const char* path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}
bool ends_with(const std::string& text, const char* end) {
    const std::size_t size = std::strlen(end);
    return text.size() >= size && text.compare(text.size() - size, size, end) == 0;
}
std::string name_of(const char* path) {
    const std::string name = path;
    const std::size_t begin = name.find_last_of('/') + 1;
    return name.substr(begin, name.find_last_of('.') - begin);
}

/// A file with or without runtime tables, there.
struct Opened {
    acdf::File file;
    std::optional<DeviceFile> there;

    Opened(const char* path, bool tables) {
        acdf::LoadOptions options;
        options.tables = tables;
        if (const acdf::Status status = acdf::File::open(path, file, options); !status.ok()) {
            std::fprintf(stderr, "%s: %s\n", path, status.message);
            std::exit(1);
        }
        there.emplace(file);
    }
};

/// Words that acdf export wrote.
struct Exported {
    std::vector<char> bytes;
    DeviceArray<std::uint32_t> words;
    explicit Exported(const char* path)
        : bytes(bytes_of(path)), words(reinterpret_cast<const std::uint32_t*>(bytes.data()), bytes.size() / 4) {}
};

void environments(std::uint32_t columns, int count, char** paths, const Questions& q) {
    const DeviceArray<float4> place(kCalls);
    std::vector<Row> rows;
    std::optional<Baselines> baselines;
    Asked sampled = q.any();
    if (columns > 0) {
        baselines.emplace(acdf_bench::sky(columns));
        sampled = at_sampled(baselines->alias(), q.any(), place);
        rows.push_back(of_baseline("reading and summing only", Nothing{}, q, sampled));
        rows.push_back(of_baseline("full table", baselines->full(), q, sampled));
        rows.push_back(of_baseline("alias table", baselines->alias(), q, sampled));
        Row warp{"hierarchical warp",
                 {time(SampleOf<WarpTable>{baselines->warp(), q.any()}),
                  time(SampleOf<WarpTable>{baselines->warp(), q.coherent()})}};
        warp.times.resize(4);
        rows.push_back(warp);
    }
    for (int i = 0; i < count; ++i) {
        if (ends_with(paths[i], ".bin")) {
            const Exported exported(paths[i]);
            const std::uint32_t* words = exported.words.data();
            rows.push_back({name_of(paths[i]) + ", exported",
                            {time_exported_sample(words, q.any()), time_exported_sample(words, q.coherent()),
                             time_exported_pdf(words, q.any()), time_exported_pdf(words, sampled)}});
            continue;
        }
        for (const bool tables : {true, false}) {
            const Opened opened(paths[i], tables);
            const acdf::EnvironmentView view = (*opened.there)(opened.file.environment());
            rows.push_back({name_of(paths[i]) + (tables ? "" : ", no tables"),
                            {time_sample(view, q.any()), time_sample(view, q.coherent()), time_pdf(view, q.any()),
                             time_pdf(view, sampled)}});
        }
    }
    print(("ns a call, " + std::to_string(columns) + " columns").c_str(),
          "sample | sample, coherent numbers | pdf of uniform directions | pdf of sampled directions",
          rows);
}

void others(int count, char** paths, const Questions& q) {
    std::vector<Row> local, brdf;
    for (int i = 0; i < count; ++i) {
        if (ends_with(paths[i], ".bin")) {
            const Exported exported(paths[i]);
            const std::uint32_t* words = exported.words.data();
            const bool surface = ends_with(paths[i], "brdf.bin");
            const auto draw = surface ? time_exported_brdf_sample : time_exported_sample;
            const auto density = surface ? time_exported_brdf_pdf : time_exported_pdf;
            Row row{name_of(paths[i]) + ", exported",
                    {draw(words, q.any()), draw(words, q.coherent()), density(words, q.any())}};
            if (!surface) row.times.insert(row.times.begin() + 2, Timed{});
            (surface ? brdf : local).push_back(row);
            continue;
        }
        for (const bool tables : {true, false}) {
            const Opened opened(paths[i], tables);
            const std::string name = name_of(paths[i]) + (tables ? "" : ", no tables");
            if (opened.file.kind() == ACDF_KIND_LOCAL) {
                const acdf::LocalEnvironmentView view = (*opened.there)(opened.file.local());
                local.push_back({name,
                                 {time_sample(view, q.any()), time_sample(view, q.coherent()),
                                  time_samples(view, q.any()), time_pdf(view, q.any())}});
            } else {
                const acdf::BrdfView view = (*opened.there)(opened.file.brdf());
                brdf.push_back(
                    {name, {time_sample(view, q.any()), time_sample(view, q.coherent()), time_pdf(view, q.any())}});
            }
        }
    }
    if (!local.empty())
        print("ns a call, local",
              "point and sample | 32 threads at a normal | sample, 16 per shading point | point and pdf",
              local);
    if (!brdf.empty()) print("ns a call, BRDF", "sample | 32 threads at a view | pdf", brdf);
}

} // namespace

int main(int argc, char** argv) {
    int devices = 0;
    const std::string what = argc > 1 ? argv[1] : "";
    if ((what != "environments" || argc < 4) && (what != "others" || argc < 3)) {
        std::fprintf(stderr, "usage: cuda_bench environments COLUMNS FILE... | others FILE...\n");
        return 2;
    }
    if (cudaGetDeviceCount(&devices) != cudaSuccess || devices == 0) {
        std::fprintf(stderr, "skipped: there is no CUDA device\n");
        return 77;
    }
    cudaDeviceProp device;
    require(cudaGetDeviceProperties(&device, 0), "device");
    std::printf("\n%s\n", device.name);
    const Questions questions;
    if (what == "environments")
        environments(static_cast<std::uint32_t>(std::strtoul(argv[2], nullptr, 10)), argc - 3, argv + 3, questions);
    else others(argc - 2, argv + 2, questions);
    return 0;
}
