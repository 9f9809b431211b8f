// The exported C on a CUDA device: answers to words.bin, directions.bin and normals.bin in FOLDER, as opencl.c
// gives them. Of BRDFs compiled with -DBRDF, of several maps with -DMAPS.
#include "exported.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#ifdef BRDF
#define AT acdf_view(tables, normals[i].x, normals[i].y, normals[i].z),
#define acdf_sample acdf_sample_brdf
#define acdf_pdf acdf_pdf_brdf
#elif defined(MAPS)
#define AT acdf_sky(tables, normals[i].x, normals[i].y, normals[i].z),
#define acdf_sample acdf_sample_sky
#define acdf_pdf acdf_pdf_sky
#else
#define AT acdf_at(tables, normals[i].x, normals[i].y, normals[i].z),
#endif

__global__ void answer(const uint32_t* tables, const uint2* words, const float4* directions, const float4* normals,
                       float4* draws, float2* densities, size_t count) {
    const size_t i = size_t{blockIdx.x} * blockDim.x + threadIdx.x;
    if (i >= count) return;
    const AcdfWalkSample s = acdf_sample(tables, AT words[i].x, words[i].y);
    const float4 d = directions[i];
    draws[i] = {s.x, s.y, s.z, s.pdf};
    densities[i] = {acdf_pdf(tables, AT d.x, d.y, d.z), acdf_pdf(tables, AT s.x, s.y, s.z)};
}

static void require(cudaError_t error, const char* what) {
    if (error == cudaSuccess) return;
    std::fprintf(stderr, "CUDA: %s: %s\n", what, cudaGetErrorString(error));
    std::exit(1);
}

template <class T>
static T* on_device(const std::string& path, size_t* count) {
    std::ifstream in(path, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
    void* out = nullptr;
    require(cudaMalloc(&out, bytes.size()), path.c_str());
    require(cudaMemcpy(out, bytes.data(), bytes.size(), cudaMemcpyHostToDevice), path.c_str());
    *count = bytes.size() / sizeof(T);
    return static_cast<T*>(out);
}

template <class T>
static void write(const std::string& path, const T* device, size_t count) {
    std::vector<T> values(count);
    require(cudaMemcpy(values.data(), device, count * sizeof(T), cudaMemcpyDeviceToHost), path.c_str());
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(count * sizeof(T)));
}

int main(int argc, char** argv) {
    const std::string folder = std::string(argc > 1 ? argv[1] : ".") + "/";
    int devices = 0;
    if (cudaGetDeviceCount(&devices) != cudaSuccess || devices == 0) {
        std::fprintf(stderr, "skipped: there is no CUDA device\n");
        return 77;
    }
    size_t count = 0, words_of_tables = 0;
    const auto* tables = on_device<uint32_t>(folder + "tables.bin", &words_of_tables);
    const auto* words = on_device<uint2>(folder + "words.bin", &count);
    const auto* directions = on_device<float4>(folder + "directions.bin", &count);
    const auto* normals = on_device<float4>(folder + "normals.bin", &count);
    float4* draws = nullptr;
    float2* densities = nullptr;
    require(cudaMalloc(&draws, count * sizeof *draws), "draws");
    require(cudaMalloc(&densities, count * sizeof *densities), "densities");
    answer<<<static_cast<unsigned>((count + 127) / 128), 128>>>(tables, words, directions, normals, draws,
                                                                densities, count);
    require(cudaDeviceSynchronize(), "kernel");
    write(folder + "samples.bin", draws, count);
    write(folder + "densities.bin", densities, count);
    return 0;
}
