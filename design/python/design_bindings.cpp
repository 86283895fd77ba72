// SPDX-License-Identifier: MIT
#include <algorithm>

#include "core/expression/parse_formula.hpp"
#include "core/files/nearest_word.hpp"
#include "design/python/arguments.hpp"
#include "design/python/bindings.hpp"
#include "design/python/design_records.hpp"
#include "design/python/errors.hpp"
#include "design/reading/design_text.hpp"

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
            refuse(ErrorCode::wrong_type, "Relation.at()", "returned " + shown(answer) + "; (value, gradient) is expected, both in SI");
        const auto [value, gradient] = py::detail::cast_op<std::pair<double, VectorX>>(found);
        return RelationValue{value, gradient};
    };
}

reading::DesignReadOptions read_options(const std::vector<Path>& mesh_dirs, bool allow_programs) {
    return {texts_of(mesh_dirs), allow_programs ? reading::Programs::allowed : reading::Programs::refused};
}

}  // namespace

void refuse_unit(const std::string& name) {
    std::vector<std::string_view> known;
    for (const Unit& unit : core::base::units()) known.push_back(unit.name);
    refuse(ErrorCode::out_of_range, "unit", "\"" + name + "\" is not a unit; " + core::files::did_you_mean(name, known));
}

VectorX point_from(const std::vector<description::Parameter>& parameters, py::handle given) {
    const auto value_of = [&](std::size_t k, py::handle value) {
        return quantity_from(value, parameters[k].unit.dimension, "p/" + parameters[k].name);
    };
    if (py::isinstance<py::dict>(given)) {
        VectorX p = description::values_of(parameters);
        std::vector<std::string> names;
        for (const auto& parameter : parameters) names.push_back(parameter.name);
        for (const auto& [key, value] : py::reinterpret_borrow<py::dict>(given)) {
            const std::string name = py::str(key);
            const auto found = std::find(names.begin(), names.end(), name);
            if (found == names.end())
                refuse(ErrorCode::unknown_key, "p/" + name,
                       "there is no such parameter; " + core::files::did_you_mean(name, {names.begin(), names.end()}));
            const auto k = static_cast<std::size_t>(found - names.begin());
            p[k] = value_of(k, value);
        }
        return p;
    }
    const bool listed = py::isinstance<py::list>(given) || py::isinstance<py::tuple>(given);
    if (listed && py::len(given) == parameters.size()) {
        VectorX p(parameters.size());
        for (std::size_t k = 0; k < parameters.size(); ++k) p[k] = value_of(k, given[py::int_(k)]);
        return p;
    }
    py::detail::make_caster<VectorX> numbers;
    if (given.is_none() || !numbers.load(given, true))
        refuse(ErrorCode::wrong_type, "p", shown(given) + ": values of the parameters are expected, in SI, or by name");
    return py::detail::cast_op<VectorX>(numbers);
}

Relation relation_from_python(py::handle source) {
    Relation relation;
    relation.name = member_of<std::string>(source, "Relation", "name");
    relation.bounds = member_of<description::Bounds>(source, "Relation", "bounds");
    relation.tolerance = member_of<double>(source, "Relation", "tolerance");
    const py::object formula = source.attr("formula"), at = source.attr("at");
    if (py::isinstance<py::str>(formula)) {
        const auto text = formula.cast<std::string>();  // no nodes yet: only the design knows its parameters (with_formulas)
        if (!text.empty()) relation.formula = core::expression::Formula{{}, {}, {}, text};
    } else {
        relation.formula = formula_from(formula);
    }
    if (!at.is_none()) relation.at = relation_function(at);
    return relation;
}

py::object relation_to_python(const Relation& relation) {
    py::dict members;
    members["name"] = relation.name;
    members["bounds"] = relation.bounds;
    members["tolerance"] = relation.tolerance;
    if (relation.formula && relation.formula->nodes.empty()) {
        members["formula"] = relation.formula->text;
    } else if (relation.formula) {
        members["formula"] = *relation.formula;
    } else if (relation.at) {
        members["at"] = py::cpp_function([at = relation.at](const VectorX& p) {
            const RelationValue found = at(p);
            return py::make_tuple(found.value, found.gradient);
        });
    }
    return record_class("Relation")(**members);
}

description::Design with_formulas(description::Design design) {
    for (Relation& relation : design.relations) {
        if (relation.at || !relation.formula) continue;
        core::expression::Formula& formula = *relation.formula;
        const core::expression::Scope scope = description::scope_of(design.parameters);
        const std::string where = "relation `" + relation.name + "`";
        if (formula.nodes.empty()) formula = value_or_raise(core::expression::parse_formula(formula.text, scope, where));
        for (const std::string& input : formula.inputs) {
            if (scope.find(input) != nullptr) continue;
            std::vector<std::string_view> known;
            for (const description::Parameter& parameter : design.parameters) known.push_back(parameter.name);
            raise_if_any(Errors{{ErrorCode::out_of_range, where,
                                 "there is no parameter `" + input + "`; " + core::files::did_you_mean(input, known, '`')}});
        }
        relation.at = description::function_of(formula, design.parameters);
    }
    return design;
}

namespace {

// A record has no place for the design as made, and would leave the reserves out without a word.
reading::DesignFile as_drawn(reading::DesignFile file) {
    if (file.design.as_made)
        raise_if_any(Errors{{ErrorCode::unsupported, file.path,
                             "it asks for numbers over its tolerances (`over_tolerances`), which a fettle.Design does not hold: "
                             "DesignProblem.of_file, optimise_file and `fettle optimise` take the file itself; without the key, or with "
                             "\"as_drawn\", it can be read here"}});
    return file;
}

}  // namespace

void bind_design(py::module_& module) {
    using Paths = std::vector<Path>;
    bind_shapes(module);
    bind_quantities(module);
    const py::call_guard<py::gil_scoped_release> unlocked;
    module.def(
        "read_design",
        [](const Path& path, const Paths& dirs, bool allow_programs) {
            return as_drawn(value_or_raise(reading::read_design(path.string(), read_options(dirs, allow_programs))));
        },
        py::arg("path"), py::arg("mesh_dirs") = Paths(), py::arg("allow_programs") = false, unlocked,
        "The DesignFile of a *.design.json, with its scene. allow_programs: the programs that it names may be run to make its parts.");
    module.def(
        "_read_design_and_hash",
        [](const Path& path, const Paths& dirs, bool allow_programs) {
            reading::DesignFile file = as_drawn(value_or_raise(reading::read_design(path.string(), read_options(dirs, allow_programs))));
            std::string hash = reading::design_hash(file);
            return std::pair(std::move(file), std::move(hash));
        },
        py::arg("path"), py::arg("mesh_dirs") = Paths(), py::arg("allow_programs") = false, unlocked,
        "read_design, and a hash of all that its numbers depend on: what stands in every file that was read for it, too.");
    module.def(
        "parse_design",
        [](const std::string& text, const Path& path, const Paths& dirs, bool allow_programs) {
            return as_drawn(value_or_raise(reading::parse_design(text, path.string(), read_options(dirs, allow_programs))));
        },
        py::arg("text"), py::arg("path"), py::arg("mesh_dirs") = Paths(), py::arg("allow_programs") = false, unlocked,
        "The same of a text; `path` says where its scene is looked for.");
    module.def(
        "design_text",
        [](const reading::DesignFile& file, const py::object& values, const Path& directory) {
            const VectorX p = point_from(file.design.parameters, values);
            raise_if_any(description::check_values(file.design.parameters, p));
            return reading::design_text(file, p, directory.string());
        },
        py::arg("file"), py::arg("values"), py::arg("directory") = ".",
        "The design's file with other values of its parameters (as p of DesignProblem), to be written in that folder.");
    module.def(
        "to_si", [](double number, const Unit& unit) { return core::base::to_si(number, unit); }, py::arg("number"), py::arg("unit"));
    module.def("from_si", &description::from_si, py::arg("si"), py::arg("unit"));
}

}  // namespace fettle::design::python
