// SPDX-License-Identifier: MIT
#include "fettle/design/python/arguments.hpp"

#include <cmath>
#include <cstdio>

#include "fettle/core/base/limits.hpp"
#include "fettle/design/python/errors.hpp"

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
        refuse(ErrorCode::not_finite, where, shown_number(value) + " is no finite number: " + allowed + " is allowed");
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

void check_at_least(const std::string& where, double value, double least) {
    check_number(where, value, value >= least, shown_number(least) + " or more");
}

void check_above(const std::string& where, double value, double least) {
    check_number(where, value, value > least, "more than " + shown_number(least));
}

void check_steps(int steps) {
    if (steps >= -1) return;
    refuse(ErrorCode::out_of_range, "steps", std::to_string(steps) + " is not allowed: 0 or more is, or -1, until the model's end_time");
}

void check_point(const VectorX& p, Eigen::Index parameters) {
    if (p.size() == parameters) return;
    refuse(
        ErrorCode::inconsistent, "p",
        "one value for each of the design's parameters is wanted: " + std::to_string(parameters) + ", found " + std::to_string(p.size()));
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
