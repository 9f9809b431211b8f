#include "input/mesh/file.h"

#include "input/error.h"
#include "input/file_name.h"
#include "input/mesh/instances.h"
#include "input/mesh/ply_counts.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/scene.h>

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
        for (const Placement& placement : instances.placements)
            for (unsigned m = 0; m < scene->mNumMeshes; ++m) take(*scene->mMeshes[m], placement);
    }
}

} // namespace acdf::input
