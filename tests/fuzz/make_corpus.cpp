// Writes the seeds of fuzz_reader, small valid files that use everything, to FOLDER/fuzz_reader: make_corpus FOLDER
// (Those of the other fuzzers are in seeds/.)
#include "tests/lib/curves/planes.h"
#include "tests/lib/indexed/indexed_builder.h"
#include "tests/lib/reader/brdf_builder.h"
#include "tests/lib/reader/local_random.h"
#include "tests/lib/reader/normals_builder.h"
#include "tests/lib/reader/random_halvings.h"

#include <cstdio>
#include <filesystem>
#include <fstream>

using namespace acdf_test;

namespace {

void write(const std::filesystem::path& path, const Bytes& bytes) {
    std::ofstream out(path, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!out) std::fprintf(stderr, "cannot write %s\n", path.c_str());
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) return std::fprintf(stderr, "usage: make_corpus FOLDER\n"), 2;
    const std::filesystem::path folder = std::filesystem::path(argv[1]) / "fuzz_reader";
    std::filesystem::create_directories(folder);
    EnvironmentSpec complete = complete_environment();
    write(folder / "smallest", EnvironmentSpec().encode());
    write(folder / "complete", complete.encode());
    write(folder / "normals", small_normals().encode());
    write(folder / "separate", separate_local().encode());
    write(folder / "visibility", regional_normals().encode());
    write(folder / "portals", windowed_normals().encode());
    write(folder / "brdf", shared_brdf().encode());
    write(folder / "separate_brdf", separate_brdf().encode());
    write(folder / "spare", spare_file().encode());
    write(folder / "table", table_file().encode());
    write(folder / "chain", chain(64).encode());
    complete.zlib = true;
    write(folder / "compressed", complete.encode());
    write(folder / "planes", as_planes(preorder_environment()).encode());
    IndexedSpec maps;
    write(folder / "indexed", maps.encode());
    maps.octahedral = maps.zlib = true;
    write(folder / "indexed_octahedral", maps.encode());
    EnvironmentSpec leaf;
    leaf.halvings.nodes = {{}};
    write(folder / "halvings", leaf.encode());
    for (std::uint32_t seed = 0; seed < 12; ++seed) {
        RandomOptions options;
        options.columns = seed % 2 ? 65536 : 64;
        options.rows = seed % 3 ? 33 : 65536;
        options.depth = 3 + static_cast<int>(seed % 4);
        options.segments = 5;
        options.long_curves = seed % 6 == 5;
        EnvironmentSpec spec = RandomTree(seed, options).make();
        spec.zlib = seed % 4 == 0;
        write(folder / ("tree" + std::to_string(seed)), spec.encode());
        spec = RandomHalvings(seed, options).make();
        spec.zlib = seed % 4 == 1;
        write(folder / ("halvings" + std::to_string(seed)), spec.encode());
        options.octahedral = true;
        write(folder / ("octahedral_halvings" + std::to_string(seed)),
              RandomHalvings(seed, options).make().encode());
        write(folder / ("octahedral_tree" + std::to_string(seed)), RandomTree(seed, options).make().encode());
        options.depth = 3;
        write(folder / ("octahedral_local" + std::to_string(seed)), RandomLocal(seed, options).make().encode());
        write(folder / ("normals" + std::to_string(seed)), random_normals(seed).encode());
        options.octahedral = false;
        LocalSpec local = RandomLocal(seed, options).make();
        local.zlib = seed % 4 == 0;
        write(folder / ("local" + std::to_string(seed)), local.encode());
    }
    return 0;
}
