// SPDX-License-Identifier: MIT
#include "design/python/arguments.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/base/limits.hpp"
#include "core/files/nearest_word.hpp"
#include "design/python/errors.hpp"

namespace fettle::design::python {

namespace py = pybind11;

namespace {

std::string shown_number(double number) {
    char text[40];
    std::snprintf(text, sizeof text, "%g", number);
    return text;
}

void check_number(const std::string& where, double value, bool fits, const std::string& allowed) {
    if (!std::isfinite(value))
        refuse(ErrorCode::not_finite, where, shown_number(value) + " is not a finite number: " + allowed + " is allowed");
    if (!fits || !core::base::is_usable_number(value))
        refuse(ErrorCode::out_of_range, where, shown_number(value) + " is not allowed: " + allowed + " is");
}

}  // namespace

void refuse(ErrorCode code, const std::string& where, const std::string& message) { throw RaisedErrors({{code, where, message}}); }

std::string shown(py::handle found) {
    if (found.is_none()) return "None";
    const std::string text = py::repr(found), type = py::str(py::type::of(found).attr("__name__"));
    return (text.size() > 60 ? "a value" : text + ",") + " of type " + type;
}

std::vector<std::string> texts_of(const std::vector<Path>& paths) {
    std::vector<std::string> texts;
    for (const Path& path : paths) texts.push_back(path.string());
    return texts;
}

double quantity_from(py::handle given, core::base::Dimension dimension, const std::string& where) {
    if (py::isinstance<py::str>(given)) return value_or_raise(core::base::parse_quantity(given.cast<std::string>(), dimension, where));
    py::detail::make_caster<double> number;
    if (given.is_none() || py::isinstance<py::bool_>(given) || !number.load(given, true))
        refuse(ErrorCode::wrong_type, where,
               shown(given) + ": a number in " + std::string(core::base::si_unit(dimension)) + ", or a text with a unit, is expected");
    return py::detail::cast_op<double>(number);
}

double unit_from(py::handle given, core::base::Dimension dimension, const std::string& where) {
    if (py::isinstance<py::str>(given) && core::base::find_unit(given.cast<std::string>()) != nullptr)
        return value_or_raise(core::base::si_per_unit(given.cast<std::string>(), dimension, where));
    return quantity_from(given, dimension, where);
}

int body_from(const std::vector<std::string>& names, py::handle given, const std::string& where) {
    const auto count = count_of(names);
    if (py::isinstance<py::str>(given)) {
        const auto name = given.cast<std::string>();
        const auto found = std::find(names.begin(), names.end(), name);
        if (found != names.end()) return static_cast<int>(found - names.begin());
        refuse(ErrorCode::out_of_range, where,
               "there is no body \"" + name + "\"; " + core::files::did_you_mean(name, {names.begin(), names.end()}));
    }
    py::detail::make_caster<int> number;
    if (!number.load(given, true)) refuse(ErrorCode::wrong_type, where, shown(given) + ": a body's name or its number is expected");
    const int body = py::detail::cast_op<int>(number);
    if (body < 0 || body >= count)
        throw py::index_error("there is no body " + std::to_string(body) + "; there are " + std::to_string(count) + ", counted from 0");
    return body;
}

void check_at_least(const std::string& where, double value, double least) {
    check_number(where, value, value >= least, shown_number(least) + " or more");
}

void check_above(const std::string& where, double value, double least) {
    check_number(where, value, value > least, "more than " + shown_number(least));
}

int steps_from(const std::optional<int>& steps) {
    if (steps && *steps < 0)
        refuse(ErrorCode::out_of_range, "steps",
               std::to_string(*steps) + " is not allowed: 0 or more is, or None, until the model's end_time");
    return steps.value_or(-1);
}

std::uint64_t seed_from(std::int64_t seed) {
    if (seed < 0) refuse(ErrorCode::out_of_range, "seed", std::to_string(seed) + " is not allowed: 0 or more is");
    return static_cast<std::uint64_t>(seed);
}

void check_same_bodies(const core::stepper::Trajectory& trajectory, const core::model::Model& model) {
    if (trajectory.body_names.size() == model.bodies.size()) return;
    refuse(ErrorCode::inconsistent, "trajectory",
           "the trajectory is not of this model: it has " + std::to_string(trajectory.body_names.size()) + " bodies, the model " +
               std::to_string(model.bodies.size()));
}

}  // namespace fettle::design::python
