// SPDX-License-Identifier: MIT
/// What models and trajectories show as arrays.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "core/model/model.hpp"
#include "core/stepper/trajectory.hpp"
#include "design/python/scene_records.hpp"

namespace fettle::design::python {

/// Throws pybind11::index_error.
const core::model::Body& body_at(const core::model::Model& model, int body);
std::vector<std::string> body_names(const core::model::Model& model);
pybind11::array read_only(pybind11::array array);

/// Views into the model, kept alive by `owner`.
pybind11::array vertices_of(const core::model::Model& model, int body, pybind11::handle owner);
pybind11::array triangles_of(const core::model::Model& model, int body, pybind11::handle owner);
pybind11::array reference_points_of(const core::model::Model& model);

/// (steps + 1, bodies, 3) and (steps + 1, bodies, 3, 3), copies.
pybind11::array positions_of(const core::stepper::Trajectory& trajectory);
pybind11::array rotations_of(const core::stepper::Trajectory& trajectory);
/// (steps + 1) [s].
pybind11::array times_of(const core::stepper::Trajectory& trajectory);

}  // namespace fettle::design::python
