// SPDX-License-Identifier: MIT
#include "fettle/design/python/scene_records.hpp"

namespace fettle::design::python {

namespace py = pybind11;

py::array rows_of(Matrix3X&& columns) {
    auto owned = std::make_unique<Matrix3X>(std::move(columns));
    Matrix3X* data = owned.get();
    const py::capsule owner(owned.release(), [](void* p) { delete static_cast<Matrix3X*>(p); });
    return py::array_t<double>({data->cols(), Eigen::Index{3}}, data->data(), owner);
}

Matrix3X columns_of(py::handle rows, const char* what) {
    const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(rows);
    if (!array || array.ndim() != 2 || array.shape(1) != 3) throw py::value_error(what);
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

void check_indices(const core::geometry::Mesh& mesh, const std::vector<core::geometry::Edge>& edges) {
    const auto valid = [&](int i) { return i >= 0 && i < mesh.vertices.cols(); };
    for (const auto& triangle : mesh.triangles)
        for (const int i : triangle)
            if (!valid(i)) throw py::value_error("a triangle of a mesh names a vertex that is not there");
    for (const auto& edge : edges)
        for (const int i : edge)
            if (!valid(i)) throw py::value_error("a loose edge of a mesh names a vertex that is not there");
}

}  // namespace

py::object mesh_to_python(core::geometry::Mesh mesh) {
    py::dict members;
    members["name"] = mesh.name;
    members["triangles"] = index_rows<3>(mesh.triangles);
    members["loose_edges"] = index_rows<2>(loose_edges(mesh));
    members["shell_names"] = mesh.shell_names;
    members["vertices"] = rows_of(std::move(mesh.vertices));
    return record_class("Mesh")(**members);
}

core::geometry::Mesh mesh_from_python(py::handle source) {
    core::geometry::Mesh mesh;
    mesh.name = source.attr("name").cast<std::string>();
    mesh.vertices = columns_of(source.attr("vertices"), "a mesh has vertices of shape (n, 3)");
    mesh.triangles = rows_from<3>(source.attr("triangles"), "a mesh has triangles of shape (m, 3)");
    mesh.shell_names = source.attr("shell_names").cast<std::vector<std::string>>();
    const auto edges = rows_from<2>(source.attr("loose_edges"), "a mesh has loose edges of shape (k, 2)");
    check_indices(mesh, edges);
    core::geometry::build_connectivity(mesh, edges);
    return mesh;
}

}  // namespace fettle::design::python
