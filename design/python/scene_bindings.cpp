// SPDX-License-Identifier: MIT
#include "core/mesh_files/mesh_reader.hpp"
#include "core/scene_files/scene_reader.hpp"
#include "core/solids/mesh_judgement.hpp"
#include "design/python/arguments.hpp"
#include "design/python/bindings.hpp"
#include "design/python/errors.hpp"
#include "design/python/scene_records.hpp"
#include "design/reading/scene_shapes.hpp"

namespace fettle::design::python {

namespace py = pybind11;
namespace scene = core::scene;

namespace {

using Paths = std::vector<Path>;

reading::Programs programs(bool allowed) { return allowed ? reading::Programs::allowed : reading::Programs::refused; }

scene::Scene read_scene(const Path& path, const Paths& mesh_dirs, bool strict_meshes, bool allow_programs) {
    scene::ReadOptions options = reading::scene_read_options(texts_of(mesh_dirs), programs(allow_programs));
    options.strict_meshes = strict_meshes;
    return value_or_raise(core::scene_files::read_scene(path.string(), options));
}

scene::Scene parse_scene(const std::string& text, const Path& path, const Paths& mesh_dirs, bool allow_programs) {
    return value_or_raise(
        core::scene_files::parse_scene(text, path.string(), reading::scene_read_options(texts_of(mesh_dirs), programs(allow_programs))));
}

core::geometry::Mesh read_mesh(const Path& path, const py::object& unit, bool weld) {
    const double metres = unit_from(unit, core::base::Dimension::length, "unit");
    check_above("unit", metres, 0);
    const py::gil_scoped_release unlocked;
    return value_or_raise(core::mesh_files::read_mesh(path.string(), {metres, weld}));
}

std::vector<std::string> judge_mesh(const core::geometry::Mesh& mesh, bool as_solid) {
    core::solids::MeshFindings findings = core::solids::judge_mesh(mesh, as_solid);
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
    module.def("read_mesh", &read_mesh, py::arg("path"), py::arg("unit") = 1.0, py::arg("weld") = true,
               "The mesh of a file (STL, OBJ, OFF, PLY, 3MF, COLLADA, glTF, 3DS, AMF) [m]. unit: of the file's numbers, \"mm\" or metres.");
    module.def("judge_mesh", &judge_mesh, py::arg("mesh"), py::arg("as_solid") = true, unlocked,
               "What is odd about a mesh, a sentence each. Raises Error if it cannot be used.");
    module.def(
        "parse_quantity",
        [](const std::string& text, core::base::Dimension dimension, const std::string& where) {
            return value_or_raise(core::base::parse_quantity(text, dimension, where));
        },
        py::arg("text"), py::arg("dimension") = core::base::Dimension::length, py::arg("where") = "",
        "The SI value of a number with a unit: \"0.3mm\" of \"length\" is 0.0003. dimension: as units() has them; where: of the error.");
    module.def(
        "units",
        [] {
            py::dict dimensions;
            for (const core::base::Unit& unit : core::base::units()) dimensions[py::str(std::string(unit.name))] = unit.dimension;
            return dimensions;
        },
        "{unit: its dimension}");
}

}  // namespace fettle::design::python
