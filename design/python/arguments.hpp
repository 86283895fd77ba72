// SPDX-License-Identifier: MIT
/// Checks of Python's arguments before the library is asked: faults are refused as fettle.Error, whose `where` is the argument, and whose
/// message says what was found and the values that are allowed. The same is allowed as on the command line.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl/filesystem.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/types.hpp"
#include "core/base/units.hpp"
#include "core/model/model.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::design::python {

[[noreturn]] void refuse(ErrorCode code, const std::string& where, const std::string& message);

/// "'a', of type str"; None is "None". Contract: the interpreter's lock is held.
std::string shown(pybind11::handle found);

/// A path of a file or folder: str or os.PathLike.
using Path = std::filesystem::path;
std::vector<std::string> texts_of(const std::vector<Path>& paths);

/// A number in SI, or a text with a unit of that dimension ("0.3mm").
double quantity_from(pybind11::handle given, core::base::Dimension dimension, const std::string& where);
/// The same; the unit's name alone ("mm") is one of it.
double unit_from(pybind11::handle given, core::base::Dimension dimension, const std::string& where);
/// A body's number, or its name.
int body_from(const std::vector<std::string>& names, pybind11::handle given, const std::string& where);

/// Finite, and `least` or more; or more than `least`.
void check_at_least(const std::string& where, double value, double least);
void check_above(const std::string& where, double value, double least);
/// Not negative; -1 of None: until the model's end_time.
int steps_from(const std::optional<int>& steps);
/// Those that are not negative.
std::uint64_t seed_from(std::int64_t seed);
/// Checks that a trajectory is of the given model.
void check_same_bodies(const core::stepper::Trajectory& trajectory, const core::model::Model& model);

}  // namespace fettle::design::python
