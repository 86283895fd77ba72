// SPDX-License-Identifier: MIT
#include "design/problem/design_problem.hpp"

#include <cmath>

#include "design/python/arguments.hpp"
#include "design/python/bindings.hpp"
#include "design/python/design_records.hpp"
#include "design/python/errors.hpp"
#include "design/python/watch.hpp"
#include "design/reading/design_reader.hpp"

namespace fettle::design::python {

namespace py = pybind11;
using problem::DesignEvaluation;
using problem::DesignProblem;

namespace {

// What a design's file is refused for, and the library takes to have been refused.
void check_numbers(const description::Design& design) {
    for (const description::ObjectiveTerm& term : design.objective) check_above("objective `" + term.name + "`/unit", term.unit, 0);
    for (const description::Constraint& constraint : design.constraints)
        check_above("constraint `" + constraint.name + "`/bounds/unit", constraint.bounds.unit, 0);
    for (const description::Relation& relation : design.relations)
        check_above("relation `" + relation.name + "`/bounds/unit", relation.bounds.unit, 0);
    check_at_least("optimiser/max_evaluations", design.optimiser.max_evaluations, 1);
    check_above("optimiser/tolerance", design.optimiser.tolerance, 0);
}

std::shared_ptr<DesignProblem> create(const description::Design& design) {
    check_numbers(design);
    description::Design whole = with_formulas(design);
    const py::gil_scoped_release unlocked;
    return std::make_shared<DesignProblem>(value_or_raise(DesignProblem::create(std::move(whole))));
}

std::shared_ptr<DesignProblem> of_file(const Path& path, const std::vector<Path>& mesh_dirs, bool allow_programs) {
    const reading::DesignReadOptions options{texts_of(mesh_dirs), allow_programs ? reading::Programs::allowed : reading::Programs::refused};
    const py::gil_scoped_release unlocked;
    return std::make_shared<DesignProblem>(
        value_or_raise(DesignProblem::create(value_or_raise(reading::read_design(path.string(), options)).design)));
}

// A record has no place for the design as made, and would leave the reserves out without a word.
description::Design design_of(const DesignProblem& self) {
    if (self.design().as_made)
        raise_if_any(Errors{{ErrorCode::unsupported, "design",
                             "it asks for numbers over its tolerances (`over_tolerances`), which a fettle.Design does not hold"}});
    return self.design();
}

VectorX checked(const DesignProblem& self, const py::object& given) {
    const VectorX p = point_from(self.design().parameters, given);
    raise_if_any(description::check_values(self.design().parameters, p));
    return p;
}

DesignEvaluation evaluate(const DesignProblem& self, const py::object& given, bool gradients, const py::object& progress) {
    const VectorX p = checked(self, given);
    Watch watch(progress);
    DesignEvaluation evaluation;
    {
        const py::gil_scoped_release unlocked;
        problem::EvaluateOptions options;
        options.gradients = gradients;
        options.on_step = watch.on_step();
        options.should_stop = watch.should_stop();
        evaluation = self.evaluate(p, options);
    }
    watch.end();
    return evaluation;
}

DesignEvaluation usable(DesignEvaluation evaluation) {
    if (evaluation.usable) return evaluation;
    const py::object failure = record_class("EvaluationError");
    PyErr_SetObject(failure.ptr(), failure(evaluation.reason).ptr());
    throw py::error_already_set();
}

VectorX each(const DesignProblem& self, double description::Parameter::*member) {
    VectorX values(self.parameter_count());
    for (Eigen::Index k = 0; k < values.size(); ++k) values[k] = self.design().parameters[k].*member;
    return values;
}

std::vector<std::string> parameter_names(const DesignProblem& self) {
    std::vector<std::string> names;
    for (const auto& parameter : self.design().parameters) names.push_back(parameter.name);
    return names;
}

VectorX values_of(const std::vector<description::Measurement>& measured) {
    VectorX values(measured.size());
    for (std::size_t i = 0; i < measured.size(); ++i) values[i] = measured[i].value;
    return values;
}

}  // namespace

void bind_problem(py::module_& module) {
    using core::model::Model;
    py::class_<DesignProblem, std::shared_ptr<DesignProblem>>(
        module, "DesignProblem",
        "From parameters p to numbers and their gradients. p: SI values, one per parameter, or by name, those "
        "left out as the design has them: {\"radius\": \"9mm\"}. What is farther "
        "beyond its bounds than they are apart is refused: Error, code out_of_range.")
        .def(py::init(&create), py::arg("design"))
        .def_property_readonly("design", &design_of,
                               "A copy. Raises Error where the problem is of a robust design, which only a file can say.")
        .def_static("of_file", &of_file, py::arg("path"), py::arg("mesh_dirs") = std::vector<Path>(), py::arg("allow_programs") = false,
                    "Of a *.design.json, robust ones (`over_tolerances`) too: their values and gradients have the reserves in them.")
        .def_property_readonly("parameter_names", &parameter_names)
        .def_property_readonly(
            "values", [](const DesignProblem& self) { return each(self, &description::Parameter::value); }, "(n), the design's own, SI")
        .def_property_readonly(
            "lower", [](const DesignProblem& self) { return each(self, &description::Parameter::lower); }, "(n), SI")
        .def_property_readonly(
            "upper", [](const DesignProblem& self) { return each(self, &description::Parameter::upper); }, "(n), SI")
        .def_property_readonly("kappa", &DesignProblem::kappa, "Barrier stiffness that all designs are simulated with [N/m].")
        .def_property_readonly("warnings", &DesignProblem::warnings)
        .def("__repr__", [](const py::object& self) { return py::module_::import("fettle._shown").attr("problem_line")(self); })
        .def(
            "_repr_html_", [](const py::object& self) { return py::module_::import("fettle._shown").attr("problem_html")(self); },
            "How a notebook shows it.")
        .def(
            "check", [](const DesignProblem& self, const py::object& p) { checked(self, p); }, py::arg("p"),
            "Raises Error where p has not a finite value for each parameter, or one far outside its bounds. What takes p asks this first.")
        .def(
            "model_at",
            [](const DesignProblem& self, const py::object& given) {
                const VectorX p = checked(self, given);
                const py::gil_scoped_release unlocked;
                return std::make_shared<Model>(value_or_raise(self.model_at(p)));
            },
            py::arg("p"), "The model at p.")
        .def(
            "relations", [](const DesignProblem& self, const py::object& p) { return self.relations(checked(self, p)); }, py::arg("p"),
            "Rows of the relations at p; nothing is built.")
        .def(
            "refusal",
            [](const DesignProblem& self, const py::object& given) {
                const VectorX p = checked(self, given);
                const py::gil_scoped_release unlocked;
                return self.refusal(p);
            },
            py::arg("p"), "Why the design at p cannot be simulated at all; empty: nothing against it.")
        .def("evaluate", &evaluate, py::arg("p"), py::arg("gradients") = true, py::arg("progress") = py::none(),
             "A DesignEvaluation: simulated, measured, and with gradients differentiated.")
        .def(
            "value", [](const DesignProblem& self, const py::object& p) { return usable(evaluate(self, p, false, py::none())).objective; },
            py::arg("p"), "The objective. Raises EvaluationError where there is no design.")
        .def(
            "value_and_gradient",
            [](const DesignProblem& self, const py::object& p) {
                const DesignEvaluation at = usable(evaluate(self, p, true, py::none()));
                return py::make_tuple(at.objective, at.gradient);
            },
            py::arg("p"), "(objective, gradient (n)), per SI unit. Raises EvaluationError where there is no design.")
        .def(
            "values_and_jacobians",
            [](const DesignProblem& self, const py::object& p) {
                const DesignEvaluation at = usable(evaluate(self, p, true, py::none()));
                return py::make_tuple(at.objective, at.gradient, values_of(at.constraints), at.jacobian);
            },
            py::arg("p"), "(objective, gradient (n), constraints (m), their Jacobian (m, n)), SI.");
}

}  // namespace fettle::design::python
