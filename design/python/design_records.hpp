// SPDX-License-Identifier: MIT
/// The members of the classes that describe a design and its results, for records.hpp.
#pragma once

#include "design/description/design.hpp"
#include "design/problem/design_problem.hpp"
#include "design/python/library_quantities.hpp"
#include "design/python/motion_records.hpp"
#include "design/python/own_quantity.hpp"
#include "design/python/own_shape.hpp"
#include "design/python/scene_records.hpp"
#include "design/reading/design_reader.hpp"

namespace fettle::design::python {

[[noreturn]] void refuse_unit(const std::string& name);

description::Relation relation_from_python(pybind11::handle relation);
pybind11::object relation_to_python(const description::Relation& relation);

/// Values of parameters [SI] as Python gives them: numbers, one for each, or by name ({"height": 9e-3}; those left out as the design has
/// them); texts have units ("9mm"), of the parameter's dimension.
VectorX point_from(const std::vector<description::Parameter>& parameters, pybind11::handle given);

/// Relations that Python gave as formulas get their functions. Throws RaisedErrors for those that cannot be read.
description::Design with_formulas(description::Design design);

}  // namespace fettle::design::python

namespace pybind11::detail {

template <>
class type_caster<fettle::Unit> {
public:
    PYBIND11_TYPE_CASTER(fettle::Unit, const_name("str"));
    bool load(handle source, bool) {
        if (!isinstance<str>(source)) return false;
        const auto name = source.cast<std::string>();
        if (name.empty()) return true;
        const fettle::Unit* unit = fettle::core::base::find_unit(name);
        if (unit == nullptr) fettle::design::python::refuse_unit(name);
        value = *unit;
        return true;
    }
    static handle cast(const fettle::Unit& source, return_value_policy, handle) { return str(std::string(source.name)).release(); }
};

template <>
class type_caster<std::shared_ptr<const fettle::design::description::Shape>> {
public:
    PYBIND11_TYPE_CASTER(std::shared_ptr<const fettle::design::description::Shape>, const_name("Optional[fettle.Shape]"));
    bool load(handle source, bool) {
        value = fettle::design::python::shape_from_python(source);
        return true;
    }
    static handle cast(const std::shared_ptr<const fettle::design::description::Shape>& source, return_value_policy, handle) {
        return fettle::design::python::shape_to_python(source).release();
    }
};

template <>
class type_caster<std::shared_ptr<const fettle::design::description::Quantity>> {
public:
    PYBIND11_TYPE_CASTER(std::shared_ptr<const fettle::design::description::Quantity>, const_name("fettle.Quantity"));
    bool load(handle source, bool) {
        value = fettle::design::python::quantity_from_python(source);
        return true;
    }
    static handle cast(const std::shared_ptr<const fettle::design::description::Quantity>& source, return_value_policy, handle) {
        return fettle::design::python::quantity_to_python(source).release();
    }
};

}  // namespace pybind11::detail

FETTLE_RECORD(fettle::design::description::Parameter, "Parameter", field("name", &Type::name), field("value", &Type::value),
              field("lower", &Type::lower), field("upper", &Type::upper), field("unit", &Type::unit), field("reference", &Type::reference))
FETTLE_RECORD(fettle::design::description::Bounds, "Bounds", field("lower", &Type::lower), field("upper", &Type::upper),
              field("margin", &Type::margin), field("unit", &Type::unit))
FETTLE_RECORD(fettle::design::description::ObjectiveTerm, "ObjectiveTerm", field("name", &Type::name), field("weight", &Type::weight),
              field("unit", &Type::unit), field("quantity", &Type::quantity))
FETTLE_RECORD(fettle::design::description::Constraint, "Constraint", field("name", &Type::name), field("bounds", &Type::bounds),
              field("quantity", &Type::quantity))
FETTLE_RECORD(fettle::design::description::OptimiserSettings, "OptimiserSettings", field("name", &Type::name),
              field("max_evaluations", &Type::max_evaluations), field("tolerance", &Type::tolerance),
              field("keep_sides", &Type::keep_sides))

namespace pybind11::detail {

template <>
class type_caster<fettle::design::description::Relation> {
public:
    PYBIND11_TYPE_CASTER(fettle::design::description::Relation, const_name("fettle.Relation"));
    bool load(handle source, bool) {
        if (!isinstance(source, fettle::design::python::record_class("Relation"))) return false;
        value = fettle::design::python::relation_from_python(source);
        return true;
    }
    static handle cast(const fettle::design::description::Relation& source, return_value_policy, handle) {
        return fettle::design::python::relation_to_python(source).release();
    }
};

}  // namespace pybind11::detail

FETTLE_RECORD(fettle::design::description::Scenario, "Scenario", field("name", &Type::name), field("scene", &Type::scene),
              field("shapes", &Type::shapes), field("numbers", &Type::numbers), field("steps", &Type::steps))
FETTLE_RECORD(fettle::design::description::Design, "Design", field("scene", &Type::scene), field("shapes", &Type::shapes),
              field("steps", &Type::steps), field("clearance_tolerance", &Type::clearance_tolerance),
              field("parameters", &Type::parameters), field("numbers", &Type::numbers), field("scenarios", &Type::scenarios),
              field("objective", &Type::objective), field("constraints", &Type::constraints), field("relations", &Type::relations),
              field("optimiser", &Type::optimiser))
FETTLE_RECORD(fettle::design::reading::DesignFile, "DesignFile", field("design", &Type::design), path_field("path", &Type::path),
              field("text", &Type::text), path_field("scene_path", &Type::scene_path), field("length_unit", &Type::length_unit),
              field("output", &Type::output), field("warnings", &Type::warnings))
FETTLE_RECORD(fettle::design::optimisers::Rows, "Rows", field("values", &Type::values), field("jacobian", &Type::jacobian))
FETTLE_RECORD(fettle::design::problem::Run, "Run", field("simulation", &Type::simulation))
FETTLE_RECORD(fettle::design::problem::DesignEvaluation, "DesignEvaluation", field("usable", &Type::usable), field("reason", &Type::reason),
              field("runs", &Type::runs), field("terms", &Type::terms), field("constraints", &Type::constraints),
              field("relations", &Type::relations), field("objective", &Type::objective), field("violation", &Type::violation),
              field("gradient", &Type::gradient), field("jacobian", &Type::jacobian), field("residuals", &Type::residuals),
              field("residual_jacobian", &Type::residual_jacobian), field("forward_seconds", &Type::forward_seconds),
              field("backward_seconds", &Type::backward_seconds))
