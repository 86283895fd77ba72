// SPDX-License-Identifier: MIT
#include "design/python/scene_records.hpp"

#include <algorithm>

namespace fettle::design::python {

namespace py = pybind11;

py::array rows_of(Matrix3X&& columns) {
    auto owned = std::make_unique<Matrix3X>(std::move(columns));
    Matrix3X* data = owned.get();
    const py::capsule owner(owned.release(), [](void* p) { delete static_cast<Matrix3X*>(p); });
    return py::array_t<double>({data->cols(), Eigen::Index{3}}, data->data(), owner);
}

Matrix3X columns_of(py::handle rows, const std::string& where, const char* what) {
    const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(rows);
    if (!array || array.ndim() != 2 || array.shape(1) != 3) refuse(ErrorCode::wrong_type, where, what);
    return Eigen::Map<const Matrix3X>(array.data(), 3, array.shape(0));
}

namespace {

// Edges of the mesh that no triangle has: they stand behind those of the triangles.
std::vector<core::geometry::Edge> loose_edges(const core::geometry::Mesh& mesh) {
    if (mesh.triangles.empty()) return mesh.edges;
    core::geometry::Mesh bare;
    bare.vertices = mesh.vertices;
    bare.triangles = mesh.triangles;
    core::geometry::build_connectivity(bare);
    return {mesh.edges.begin() + static_cast<std::ptrdiff_t>(bare.edges.size()), mesh.edges.end()};
}

template <class Rows>
void check_indices(const Rows& rows, Eigen::Index vertices, const std::string& where, const char* each) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
        for (const int i : rows[k]) {
            if (i >= 0 && i < vertices) continue;
            refuse(ErrorCode::mesh_invalid, where + "/" + std::to_string(k),
                   std::string(each) + " names a vertex that is not there: " + std::to_string(i) + "; the mesh has " +
                       std::to_string(vertices) + ", counted from 0");
        }
    }
}

void check_faces(const core::geometry::Mesh& mesh, const std::string& place) {
    const std::size_t triangles = mesh.triangles.size(), faces = mesh.triangle_face.size();
    if (faces != 0 && faces != triangles) refuse(ErrorCode::inconsistent, place + "/triangle_face", "one for each triangle, or none");
    for (const int face : mesh.triangle_face)
        if (face < 0 || face >= count_of(mesh.face_names))
            refuse(ErrorCode::mesh_invalid, place + "/triangle_face", "a triangle has a face that is not there: " + std::to_string(face));
}

}  // namespace

py::object mesh_to_python(core::geometry::Mesh mesh) {
    py::dict members;
    members["name"] = mesh.name;
    members["triangles"] = index_rows<3>(mesh.triangles);
    members["loose_edges"] = index_rows<2>(loose_edges(mesh));
    members["shell_names"] = mesh.shell_names;
    members["face_names"] = mesh.face_names;
    members["triangle_face"] = mesh.triangle_face;
    members["vertices"] = rows_of(std::move(mesh.vertices));
    members["deviation"] = mesh.deviation;
    members["colour"] = py::none();
    if (mesh.colour) members["colour"] = py::make_tuple((*mesh.colour)[0], (*mesh.colour)[1], (*mesh.colour)[2]);
    return record_class("Mesh")(**members);
}

core::geometry::Mesh mesh_from_python(py::handle source) {
    core::geometry::Mesh mesh;
    mesh.name = member_of<std::string>(source, "Mesh", "name");
    const std::string place = mesh.name.empty() ? "mesh" : "mesh `" + mesh.name + "`";
    mesh.vertices = columns_of(source.attr("vertices"), place + "/vertices", "a mesh has vertices of shape (n, 3)");
    mesh.triangles = rows_from<3>(source.attr("triangles"), place + "/triangles", "a mesh has triangles of shape (m, 3)");
    mesh.shell_names = member_of<std::vector<std::string>>(source, "Mesh", "shell_names");
    mesh.face_names = member_of<std::vector<std::string>>(source, "Mesh", "face_names");
    mesh.triangle_face = member_of<std::vector<int>>(source, "Mesh", "triangle_face");
    check_faces(mesh, place);
    mesh.deviation = member_of<std::optional<core::geometry::Deviation>>(source, "Mesh", "deviation");
    if (const auto colour = member_of<std::optional<std::vector<int>>>(source, "Mesh", "colour")) {
        const bool is_colour =
            colour->size() == 3 && std::all_of(colour->begin(), colour->end(), [](int part) { return part >= 0 && part <= 255; });
        if (!is_colour) refuse(ErrorCode::out_of_range, place + "/colour", "three numbers from 0 to 255");
        mesh.colour.emplace();
        for (std::size_t k = 0; k < 3; ++k) (*mesh.colour)[k] = static_cast<unsigned char>((*colour)[k]);
    }
    const auto edges = rows_from<2>(source.attr("loose_edges"), place + "/loose_edges", "a mesh has loose edges of shape (k, 2)");
    check_indices(mesh.triangles, mesh.vertices.cols(), place + "/triangles", "a triangle of a mesh");
    check_indices(edges, mesh.vertices.cols(), place + "/loose_edges", "a loose edge of a mesh");
    core::geometry::build_connectivity(mesh, edges);
    return mesh;
}

}  // namespace fettle::design::python
