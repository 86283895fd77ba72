// SPDX-License-Identifier: MIT
#include "fettle/core/files/nearest_word.hpp"
#include "fettle/design/python/arguments.hpp"
#include "fettle/design/python/bindings.hpp"
#include "fettle/design/python/design_records.hpp"
#include "fettle/design/python/errors.hpp"
#include "fettle/design/reading/design_text.hpp"
#include "fettle/design/reading/expression.hpp"

namespace fettle::design::python {

namespace py = pybind11;
using description::Relation;
using description::RelationValue;

namespace {

// at(p) -> (value, gradient).
std::function<RelationValue(const VectorX&)> relation_function(py::handle callable) {
    return [function = shared_object(callable)](const VectorX& p) {
        const py::gil_scoped_acquire locked;
        const py::object answer = (*function)(p);
        py::detail::make_caster<std::pair<double, VectorX>> found;
        if (!found.load(answer, true))
            refuse(ErrorCode::wrong_type, "Relation.at()", "returned " + shown(answer) + "; (value, gradient) is wanted, both in SI");
        const auto [value, gradient] = py::detail::cast_op<std::pair<double, VectorX>>(found);
        return RelationValue{value, gradient};
    };
}

reading::DesignReadOptions read_options(const std::vector<std::string>& mesh_dirs, bool allow_programs) {
    return {mesh_dirs, allow_programs ? reading::Programs::allowed : reading::Programs::refused};
}

description::Design design_round_trip(description::Design design) { return with_formulas(std::move(design)); }

}  // namespace

void refuse_unit(const std::string& name) {
    std::vector<std::string_view> known;
    for (const Unit& unit : core::base::units()) known.push_back(unit.name);
    refuse(ErrorCode::out_of_range, "unit", "\"" + name + "\" is no unit; " + core::files::did_you_mean(name, known));
}

Relation relation_from_python(py::handle source) {
    Relation relation;
    relation.name = member_of<std::string>(source, "Relation", "name");
    relation.bounds = member_of<description::Bounds>(source, "Relation", "bounds");
    relation.tolerance = member_of<double>(source, "Relation", "tolerance");
    relation.formula = member_of<std::string>(source, "Relation", "formula");
    const py::object at = source.attr("at");
    if (!at.is_none()) relation.at = relation_function(at);
    return relation;
}

py::object relation_to_python(const Relation& relation) {
    py::dict members;
    members["name"] = relation.name;
    members["bounds"] = relation.bounds;
    members["tolerance"] = relation.tolerance;
    members["formula"] = relation.formula;
    if (relation.formula.empty() && relation.at) {
        members["at"] = py::cpp_function([at = relation.at](const VectorX& p) {
            const RelationValue found = at(p);
            return py::make_tuple(found.value, found.gradient);
        });
    }
    return record_class("Relation")(**members);
}

description::Design with_formulas(description::Design design) {
    for (Relation& relation : design.relations) {
        if (relation.at || relation.formula.empty()) continue;
        auto expression = std::make_shared<const reading::Expression>(
            value_or_raise(reading::parse_expression(relation.formula, design.parameters, "relation `" + relation.name + "`")));
        relation.at = [expression](const VectorX& p) { return reading::evaluate(*expression, p); };
    }
    return design;
}

void bind_design(py::module_& module) {
    using Paths = std::vector<std::string>;
    bind_shapes(module);
    bind_quantities(module);
    const py::call_guard<py::gil_scoped_release> unlocked;
    module.def(
        "read_design",
        [](const std::string& path, const Paths& dirs, bool allow_programs) {
            return value_or_raise(reading::read_design(path, read_options(dirs, allow_programs)));
        },
        py::arg("path"), py::arg("mesh_dirs") = Paths(), py::arg("allow_programs") = false, unlocked,
        "The DesignFile of a *.design.json, with its scene. allow_programs: the programs that it names may be run to make its parts.");
    module.def(
        "parse_design",
        [](const std::string& text, const std::string& path, const Paths& dirs, bool allow_programs) {
            return value_or_raise(reading::parse_design(text, path, read_options(dirs, allow_programs)));
        },
        py::arg("text"), py::arg("path"), py::arg("mesh_dirs") = Paths(), py::arg("allow_programs") = false, unlocked,
        "The same of a text; `path` says where its scene is looked for.");
    module.def(
        "design_text",
        [](const reading::DesignFile& file, const VectorX& values, const std::string& directory) {
            check_point(values, static_cast<Eigen::Index>(file.design.parameters.size()));
            return reading::design_text(file, values, directory);
        },
        py::arg("file"), py::arg("values"), py::arg("directory") = ".",
        "The design's file with other values of its parameters (SI), to be written in that folder.");
    module.def("as_library_has_it", &design_round_trip, py::arg("design"), "For tests.");
    module.def(
        "to_si", [](double number, const Unit& unit) { return core::base::to_si(number, unit); }, py::arg("number"), py::arg("unit"));
    module.def("from_si", &description::from_si, py::arg("si"), py::arg("unit"));
}

}  // namespace fettle::design::python
