// SPDX-License-Identifier: MIT
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <memory>
#include <string>

#include "fettle/core/base/shared_library.hpp"
#include "fettle/core/mesh_files/assimp_library.hpp"

#include "fettle/core/mesh_files/raw_mesh.hpp"

namespace fettle::core::mesh_files {
namespace {

void append_mesh(const aiMesh& from, const aiMatrix4x4& to_world, int group, RawMesh& mesh) {
    const int first = static_cast<int>(mesh.vertices.size());
    for (unsigned i = 0; i < from.mNumVertices; ++i) {
        const aiVector3D x = to_world * from.mVertices[i];
        mesh.vertices.emplace_back(x.x, x.y, x.z);
    }
    for (unsigned f = 0; f < from.mNumFaces; ++f) {
        const aiFace& face = from.mFaces[f];
        if (face.mNumIndices == 2) {
            mesh.edges.push_back({first + static_cast<int>(face.mIndices[0]), first + static_cast<int>(face.mIndices[1])});
        }
        if (face.mNumIndices < 3) continue;
        for (unsigned k = 0; k < face.mNumIndices; ++k) mesh.corners.push_back(first + static_cast<int>(face.mIndices[k]));
        mesh.polygon_ends.push_back(static_cast<int>(mesh.corners.size()));
        mesh.polygon_group.push_back(group);
    }
}

/// The node's name, else the mesh's; "<STL_BINARY>" and the like are no names.
std::string name_of(const aiNode& node, const aiMesh& mesh) {
    for (const aiString* name : {&node.mName, &mesh.mName}) {
        if (name->length > 0 && name->C_Str()[0] != '<') return name->C_Str();
    }
    return "";
}

void append_node(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent_to_world, RawMesh& mesh) {
    const aiMatrix4x4 to_world = parent_to_world * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
        const aiMesh& from = *scene.mMeshes[node.mMeshes[i]];
        mesh.groups.push_back(name_of(node, from));
        append_mesh(from, to_world, static_cast<int>(mesh.groups.size()) - 1, mesh);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) append_node(scene, *node.mChildren[i], to_world, mesh);
}

RawMesh mesh_by(const AssimpLibrary& assimp, const aiScene* scene) {
    const std::unique_ptr<const aiScene, void (*)(const aiScene*)> owner(scene, assimp.release_import);
    RawMesh mesh;
    append_node(*scene, *scene->mRootNode, aiMatrix4x4(), mesh);
    return mesh;
}

}  // namespace

Result<RawMesh> read_by_assimp(const std::string& path) {
    try {
        const AssimpLibrary& assimp = assimp_library();
        const aiScene* scene = assimp.import_file(path.c_str(), aiProcess_Triangulate);
        if (scene == nullptr || scene->mRootNode == nullptr)
            return Error{ErrorCode::parse, path, std::string("cannot be read as a mesh: ") + assimp.error_string()};
        return mesh_by(assimp, scene);
    } catch (const base::MissingLibrary& missing) {
        return Error{ErrorCode::unsupported, path, std::string(missing.what()) + "; .obj, .off and .3mf are read without it"};
    }
}

}  // namespace fettle::core::mesh_files
