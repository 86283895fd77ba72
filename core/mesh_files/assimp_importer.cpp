// SPDX-License-Identifier: MIT
// A program of its own, which the library carries (import_process.cpp): reads a mesh file by assimp and writes what is in it to stdout, as
// import_format.hpp says. It may crash, loop and run out of memory with whatever a file makes of assimp; its parent only sees that nothing
// came. Nothing of fettle's libraries is in it.
//
//     mesh_importer FILE SECONDS BYTES      the limits of processor time and of memory
#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/scene.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <new>
#include <string>
#include <vector>

#include "core/mesh_files/import_format.hpp"
#include "core/mesh_files/import_program.hpp"
#include "core/mesh_files/most_placed.hpp"

namespace fettle::core::mesh_files {
namespace {

/// Row after row, in double precision: a chain of nodes is multiplied without further rounding to float.
struct Placement {
    double linear[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    double shift[3] = {0, 0, 0};

    Placement of(const aiMatrix4x4& inner) const {
        Placement out;
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) {
                out.linear[i][j] = 0;
                for (int k = 0; k < 3; ++k) out.linear[i][j] += linear[i][k] * inner[static_cast<unsigned>(k)][j];
            }
            out.shift[i] = shift[i];
            for (int k = 0; k < 3; ++k) out.shift[i] += linear[i][k] * inner[static_cast<unsigned>(k)][3];
        }
        return out;
    }
    bool mirrors() const {
        const auto minor = [&](int a, int b) { return linear[1][a] * linear[2][b] - linear[1][b] * linear[2][a]; };
        return linear[0][0] * minor(1, 2) - linear[0][1] * minor(0, 2) + linear[0][2] * minor(0, 1) < 0;
    }
};

struct Flat {
    std::vector<double> coordinates;
    std::vector<std::int32_t> corners, polygon_ends, polygon_names, edges, points;
    std::vector<std::string> names;
    std::uint64_t placed = 0;  // see most_placed
};

struct TooMuch {};

void count(std::uint64_t more, Flat& to) {
    to.placed += more;
    if (to.placed > most_placed) throw TooMuch();
}

void append_mesh(const aiMesh& from, const Placement& placement, Flat& to) {
    const std::size_t first = to.coordinates.size() / 3;
    count(of_a_placing + from.mNumVertices, to);
    for (unsigned i = 0; i < from.mNumVertices; ++i) {
        const aiVector3D& x = from.mVertices[i];
        for (int k = 0; k < 3; ++k)
            to.coordinates.push_back(placement.linear[k][0] * x.x + placement.linear[k][1] * x.y + placement.linear[k][2] * x.z +
                                     placement.shift[k]);
    }
    const auto index = [&](unsigned corner) { return static_cast<std::int32_t>(first + corner); };
    const bool mirrored = placement.mirrors();  // then it stays a solid with its polygons turned
    for (unsigned f = 0; f < from.mNumFaces; ++f) {
        const aiFace& face = from.mFaces[f];
        count(face.mNumIndices > 3 ? face.mNumIndices - 2 : 1, to);
        // A vertex beyond the mesh's own would be another mesh's: the parent is to see it as beyond all.
        for (unsigned k = 0; k < face.mNumIndices; ++k)
            if (face.mIndices[k] >= from.mNumVertices) throw std::string("a face names a vertex that is not there");
        if (face.mNumIndices == 1) to.points.push_back(index(face.mIndices[0]));
        if (face.mNumIndices == 2) to.edges.insert(to.edges.end(), {index(face.mIndices[0]), index(face.mIndices[1])});
        if (face.mNumIndices < 3) continue;
        for (unsigned k = 0; k < face.mNumIndices; ++k) to.corners.push_back(index(face.mIndices[mirrored ? face.mNumIndices - 1 - k : k]));
        to.polygon_ends.push_back(static_cast<std::int32_t>(to.corners.size()));
        to.polygon_names.push_back(static_cast<std::int32_t>(to.names.size()) - 1);
    }
}

/// The node's name, else the mesh's.
std::string name_of(const aiNode& node, const aiMesh& mesh) {
    return node.mName.length > 0 ? std::string(node.mName.data, node.mName.length) : std::string(mesh.mName.data, mesh.mName.length);
}

void append_node(const aiScene& scene, const aiNode& node, const Placement& around, Flat& to) {
    const Placement placement = around.of(node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
        if (node.mMeshes[i] >= scene.mNumMeshes) throw std::string("a node names a mesh that is not there");
        const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
        to.names.push_back(name_of(node, mesh));
        append_mesh(mesh, placement, to);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) append_node(scene, *node.mChildren[i], placement, to);
}

/// What assimp has turned on the way in is turned back: of 3DS, whose z is up, it makes y.
Placement axes_of_the_file(const aiNode& root) {
    Placement out;
    if (std::string(root.mName.data, root.mName.length) == "<3DSRoot>") {
        out.linear[1][1] = out.linear[2][2] = 0;
        out.linear[1][2] = -1;
        out.linear[2][1] = 1;
    }
    return out;
}

/// Notes that assimp has left out faces: a hole is no part of the file's contents.
void note_left_out(const char* message, char* left_out) {
    const std::string text(message);
    if (text.find("out-of-range") != std::string::npos || text.find("were dropped") != std::string::npos)
        *reinterpret_cast<bool*>(left_out) = true;
}

const aiScene* imported(const char* path, bool& left_out) {
    const aiLogStream log{note_left_out, reinterpret_cast<char*>(&left_out)};
    aiAttachLogStream(&log);
    aiPropertyStore* properties = aiCreatePropertyStore();
    // Axes stay those of the file, in every format.
    aiSetImportPropertyInteger(properties, AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, 1);
    // Polygons are cut into triangles by the reader, exactly; positions are not touched.
    return aiImportFileExWithProperties(path, 0, nullptr, properties);
}

int write_mesh(const Flat& mesh) {
    const ImportHeader header{import_is_mesh,
                              mesh.coordinates.size() / 3,
                              mesh.corners.size(),
                              mesh.polygon_ends.size(),
                              mesh.edges.size() / 2,
                              mesh.points.size(),
                              mesh.names.size(),
                              0,
                              0};
    const ImportPipe pipe;
    const bool good = pipe.write(&header, sizeof header) && pipe.write_list(mesh.coordinates) && pipe.write_list(mesh.corners) &&
                      pipe.write_list(mesh.polygon_ends) && pipe.write_list(mesh.polygon_names) && pipe.write_list(mesh.edges) &&
                      pipe.write_list(mesh.points) && pipe.write_texts(mesh.names) && pipe.write_end();
    return good ? import_written : import_failed;
}

int import(const char* path) {
    try {
        bool left_out = false;
        const aiScene* scene = imported(path, left_out);
        if (scene == nullptr || scene->mRootNode == nullptr) {
            const std::string reason = aiGetErrorString();
            return ImportPipe().write_failure(reason, reason == "std::bad_alloc" ? import_out_of_memory : import_failed);
        }
        if (left_out) throw std::string("a face names a vertex that is not there");
        Flat mesh;
        append_node(*scene, *scene->mRootNode, axes_of_the_file(*scene->mRootNode), mesh);
        return write_mesh(mesh);  // and no more: what assimp holds goes with the process
    } catch (const std::string& fault) {
        return ImportPipe().write_failure(fault, import_failed);
    } catch (const TooMuch&) {
        return ImportPipe().write_failure("", import_too_large);
    } catch (const std::bad_alloc&) {
        return ImportPipe().write_failure("", import_out_of_memory);
    }
}

}  // namespace
}  // namespace fettle::core::mesh_files

int main(int count, char** arguments) {
    using namespace fettle::core::mesh_files;
    if (count != 4) return import_misused;
    take_limits(arguments);
    ::_exit(import(arguments[1]));
}
