// SPDX-License-Identifier: MIT
#include "fettle/core/geometry/mesh_judgement.hpp"
#include "fettle/core/mesh_files/mesh_reader.hpp"
#include "fettle/core/scene/scene_reader.hpp"
#include "fettle/design/python/arguments.hpp"
#include "fettle/design/python/bindings.hpp"
#include "fettle/design/python/errors.hpp"
#include "fettle/design/python/scene_records.hpp"
#include "fettle/design/reading/scene_shapes.hpp"

namespace fettle::design::python {

namespace py = pybind11;
namespace scene = core::scene;

namespace {

using Paths = std::vector<std::string>;

reading::Programs programs(bool allowed) { return allowed ? reading::Programs::allowed : reading::Programs::refused; }

scene::Scene read_scene(const std::string& path, const Paths& mesh_dirs, bool strict_meshes, bool allow_programs) {
    scene::ReadOptions options = reading::scene_read_options(mesh_dirs, programs(allow_programs));
    options.strict_meshes = strict_meshes;
    return value_or_raise(scene::read_scene(path, options));
}

scene::Scene parse_scene(const std::string& text, const std::string& path, const Paths& mesh_dirs, bool allow_programs) {
    return value_or_raise(scene::parse_scene(text, path, reading::scene_read_options(mesh_dirs, programs(allow_programs))));
}

core::geometry::Mesh read_mesh(const std::string& path, double unit, bool weld) {
    check_above("unit", unit, 0);
    return value_or_raise(core::mesh_files::read_mesh(path, {unit, weld}));
}

std::vector<std::string> judge_mesh(const core::geometry::Mesh& mesh, bool as_solid) {
    core::geometry::MeshFindings findings = core::geometry::judge_mesh(mesh, as_solid);
    raise_if_any(findings.errors);
    return std::move(findings.warnings);
}

}  // namespace

void bind_scene(py::module_& module) {
    const py::call_guard<py::gil_scoped_release> unlocked;
    module.def("read_scene", &read_scene, py::arg("path"), py::arg("mesh_dirs") = Paths(), py::arg("strict_meshes") = false,
               py::arg("allow_programs") = false, unlocked,
               "The scene of a file, SI units. allow_programs: the programs that it names may be run to make its parts.");
    module.def("parse_scene", &parse_scene, py::arg("text"), py::arg("path") = "", py::arg("mesh_dirs") = Paths(),
               py::arg("allow_programs") = false, unlocked, "The scene of a text; meshes are looked for as if it came from `path`.");
    module.def("read_mesh", &read_mesh, py::arg("path"), py::arg("unit") = 1.0, py::arg("weld") = true, unlocked,
               "The mesh of a file (.stl .obj .off .ply .3mf) [m]. unit: metres per unit of the file.");
    module.def("judge_mesh", &judge_mesh, py::arg("mesh"), py::arg("as_solid") = true, unlocked,
               "What is odd about a mesh, a sentence each. Raises Error if it cannot be used.");
    module.def(
        "scene_round_trip", [](const scene::Scene& s) { return s; }, "As the library has it; for tests.");
}

}  // namespace fettle::design::python
