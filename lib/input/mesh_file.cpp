#include "input/mesh_file.h"

#include "input/file_name.h"
#include "input/image.h"
#include "input/instances.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace acdf::input {
namespace {

/// Shows the importer the mesh and nothing else: material libraries that an OBJ names are none of its business.
class OneFile : public Assimp::DefaultIOSystem {
public:
    explicit OneFile(std::string path) : path_(std::move(path)) {}
    bool Exists(const char* path) const override { return path == path_ && DefaultIOSystem::Exists(path); }
    Assimp::IOStream* Open(const char* path, const char* mode) override {
        return path == path_ ? DefaultIOSystem::Open(path, mode) : nullptr;
    }

private:
    std::string path_;
};

/// Refuses a PLY header that claims more elements than the file has bytes, before memory is asked for.
void check_ply_counts(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    char line[1024];
    std::error_code error;
    const std::uint64_t size = std::filesystem::file_size(path, error);
    if (error || !file.getline(line, sizeof line) || std::string(line).substr(0, 3) != "ply")
        throw input_error(path, "it does not begin with \"ply\": no PLY mesh, or damaged");
    while (file.getline(line, sizeof line)) {
        std::istringstream words(line);
        std::string word, name;
        std::uint64_t count = 0;
        words >> word;
        if (word == "end_header") return;
        if (word != "element") continue;
        if (!(words >> name >> count) || count > size)
            throw input_error(path, "its header claims more elements than the file has bytes; it is damaged");
    }
    throw input_error(path, "its header does not end; it is cut short or damaged");
}

const aiScene* read_mesh(Assimp::Importer& importer, const std::string& path) {
    if (lower_extension(path) == ".ply") check_ply_counts(path);
    importer.SetIOHandler(new OneFile(path)); // owned by the importer
    const aiScene* scene = importer.ReadFile(path, 0);
    if (!scene)
        throw input_error(path, std::string("no mesh that can be read (") + importer.GetErrorString() +
                                    "); give triangles or polygons as .obj or .ply");
    return scene;
}

std::vector<Instances> instances_of(const std::string& path) {
    if (is_instances(path)) return read_instances(path);
    return {{path, {Placement{}}}};
}

} // namespace

bool is_mesh(const std::string& path) {
    const std::string end = lower_extension(path);
    return end == ".obj" || end == ".ply" || is_instances(path);
}

void for_each_mesh(const std::string& path, const std::function<void(const aiMesh&, const Placement&)>& take) {
    for (const Instances& instances : instances_of(path)) {
        require_regular_file(instances.mesh, "a mesh");
        Assimp::Importer importer; // logs nowhere but where a program asks it to
        const aiScene* scene = read_mesh(importer, instances.mesh);
        for (const Placement& place : instances.places)
            for (unsigned m = 0; m < scene->mNumMeshes; ++m) take(*scene->mMeshes[m], place);
    }
}

} // namespace acdf::input
