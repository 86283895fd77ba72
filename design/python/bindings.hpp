// SPDX-License-Identifier: MIT
/// The parts of the Python module `fettle._fettle`, one file each, in the order of the library's layers. No arithmetic: all that is
/// computed is the library's, and what is pleasant is Python's (fettle/).
#pragma once

#include <pybind11/pybind11.h>

#include "core/expression/formula.hpp"

namespace fettle::design::python {

/// What may stand in arithmetic: a formula, a parameter (its name, in its unit), a number (SI where it stands beside a quantity), a text
/// with a unit.
core::expression::Formula formula_from(pybind11::handle given);
/// Does it follow from parameters: is it a formula or a parameter?
bool is_followed(pybind11::handle given);

void bind_formula(pybind11::module_& module);      ///< arithmetic with parameters
void bind_scene(pybind11::module_& module);        ///< meshes and scenes, read
void bind_model(pybind11::module_& module);        ///< Model
void bind_trajectory(pybind11::module_& module);   ///< Trajectory, simulations
void bind_clearance(pybind11::module_& module);    ///< clearances, certificates
void bind_design(pybind11::module_& module);       ///< shapes, quantities, designs, read
void bind_problem(pybind11::module_& module);      ///< DesignProblem
void bind_studies(pybind11::module_& module);      ///< audits, optimisation
void bind_exploration(pybind11::module_& module);  ///< many designs, several at once
void bind_tolerances(pybind11::module_& module);   ///< designs as made
void bind_exports(pybind11::module_& module);      ///< models out, pictures, reports
void bind_session(pybind11::module_& module);      ///< designs and scenes that are open

}  // namespace fettle::design::python
