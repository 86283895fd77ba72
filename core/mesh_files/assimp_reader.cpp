// SPDX-License-Identifier: MIT
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <minizip/unzip.h>

#include <array>
#include <assimp/Importer.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>

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

/// The node's name (for 3MF "Object_1": assimp keeps the id, not the name), else the mesh's; "<STL_BINARY>" and the like are no names.
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

struct CloseZip {
    void operator()(void* zip) const { unzClose(zip); }
};

/// The beginning of the current file of a zip: enough for the <model> element, which comes first.
std::optional<std::string> beginning_of_current(void* zip) {
    if (unzOpenCurrentFile(zip) != UNZ_OK) return std::nullopt;
    std::string text(65536, '\0');
    std::size_t size = 0;
    int got = 0;
    while (size < text.size() && (got = unzReadCurrentFile(zip, text.data() + size, static_cast<unsigned>(text.size() - size))) > 0) {
        size += static_cast<std::size_t>(got);
    }
    unzCloseCurrentFile(zip);
    if (got < 0) return std::nullopt;
    text.resize(size);
    return text;
}

/// Value of `unit` in the <model> element (with or without a namespace prefix); "millimeter", the format's default, if it is not stated.
std::string model_unit(const std::string& xml) {
    std::size_t start = xml.find("model");
    while (start != std::string::npos && (start == 0 || (xml[start - 1] != '<' && xml[start - 1] != ':')))
        start = xml.find("model", start + 1);
    const std::size_t end = start == std::string::npos ? start : xml.find('>', start);
    if (end == std::string::npos) return "millimeter";
    const std::string element = xml.substr(start, end - start);
    for (std::size_t at = element.find("unit"); at != std::string::npos; at = element.find("unit", at + 4)) {
        if (at == 0 || std::string(" \t\r\n").find(element[at - 1]) == std::string::npos) continue;
        const std::size_t equals = element.find_first_not_of(" \t\r\n", at + 4);
        if (equals == std::string::npos || element[equals] != '=') continue;
        const std::size_t open = element.find_first_of("\"'", equals);
        const std::size_t close = open == std::string::npos ? open : element.find(element[open], open + 1);
        if (close != std::string::npos) return element.substr(open + 1, close - open - 1);
    }
    return "millimeter";
}

std::optional<double> metres_of_3mf_unit(const std::string& unit) {
    constexpr std::array<std::pair<const char*, double>, 6> units = {
        {{"micron", 1e-6}, {"millimeter", 1e-3}, {"centimeter", 1e-2}, {"inch", 0.0254}, {"foot", 0.3048}, {"meter", 1}}};
    for (const auto& [name, metres] : units) {
        if (unit == name) return metres;
    }
    return std::nullopt;
}

/// assimp passes over the unit of a 3MF, so it is read here from the model parts of the zip archive.
Result<double> unit_of_3mf(const std::string& path) {
    const std::unique_ptr<void, CloseZip> zip(unzOpen64(path.c_str()));
    if (!zip) return Error{ErrorCode::parse, path, "is not a 3MF file (not a zip archive)"};
    std::optional<std::string> unit;
    for (int code = unzGoToFirstFile(zip.get()); code == UNZ_OK; code = unzGoToNextFile(zip.get())) {
        char name[1024] = "";
        unzGetCurrentFileInfo64(zip.get(), nullptr, name, sizeof name - 1, nullptr, 0, nullptr, 0);
        const std::string part = name;
        if (part.size() < 6 || part.substr(part.size() - 6) != ".model") continue;
        const auto text = beginning_of_current(zip.get());
        if (!text) return Error{ErrorCode::parse, path, "its part " + part + " cannot be unpacked"};
        const std::string found = model_unit(*text);
        if (unit && *unit != found) {
            return Error{ErrorCode::unsupported, path, "its parts have different units, " + *unit + " and " + found + "; export with one"};
        }
        unit = found;
    }
    if (!unit) return Error{ErrorCode::parse, path, "is not a 3MF file (it has no model part)"};
    const auto metres = metres_of_3mf_unit(*unit);
    if (!metres) {
        return Error{ErrorCode::out_of_range, path, "unit `" + *unit + "` must be micron, millimeter, centimeter, inch, foot or meter"};
    }
    return *metres;
}

}  // namespace

Result<RawMesh> read_by_assimp(const std::string& path) {
    RawMesh mesh;
    const std::string extension = path.size() < 4 ? "" : path.substr(path.size() - 4);
    if (extension == ".3mf" || extension == ".3MF") {
        const auto unit = unit_of_3mf(path);
        if (!unit) return unit.errors();
        mesh.metres_per_unit = *unit;
    }
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
    if (scene == nullptr || scene->mRootNode == nullptr) {
        return Error{ErrorCode::parse, path, std::string("cannot be read as a mesh: ") + importer.GetErrorString()};
    }
    append_node(*scene, *scene->mRootNode, aiMatrix4x4(), mesh);
    return mesh;
}

}  // namespace fettle::core::mesh_files
