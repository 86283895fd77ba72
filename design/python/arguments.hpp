// SPDX-License-Identifier: MIT
/// What Python gave, looked at before the library is asked: refused as fettle.Error, whose `where` is the argument, and whose message says
/// what was found and what is allowed. The same is allowed as on the command line.
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <string>

#include "fettle/core/base/result.hpp"
#include "fettle/core/base/types.hpp"
#include "fettle/core/model/model.hpp"
#include "fettle/core/stepper/trajectory.hpp"

namespace fettle::design::python {

[[noreturn]] void refuse(ErrorCode code, const std::string& where, const std::string& message);

/// "'a', of type str"; None is "None". Contract: the interpreter's lock is held.
std::string shown(pybind11::handle found);

/// Finite, and `least` or more; or more than `least`.
void check_at_least(const std::string& where, double value, double least);
void check_above(const std::string& where, double value, double least);
/// -1: until the model's end_time.
void check_steps(int steps);
/// @param p  SI, one value for each of the design's parameters.
void check_point(const VectorX& p, Eigen::Index parameters);
/// Those that are not negative.
std::uint64_t seed_from(std::int64_t seed);
/// Of a trajectory and the model that it is said to be of.
void check_same_bodies(const core::stepper::Trajectory& trajectory, const core::model::Model& model);

}  // namespace fettle::design::python
