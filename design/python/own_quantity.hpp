// SPDX-License-Identifier: MIT
/// Quantities of Python's own: an object with `value()` and `gradient()` (fettle.Quantity), and `deviations()` and `deviation_gradient()`
/// where it is a sum of squares, is a Quantity of the library, called with the interpreter's lock. Raises fettle.Error, naming the method,
/// for answers of another type, for a Measurement whose bounds do not hold its value, and for deviations whose squares miss the value by
/// more than rounding.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "design/description/quantity.hpp"
#include "design/python/motion_records.hpp"

namespace fettle::design::python {

std::shared_ptr<const description::Quantity> own_quantity_from_python(pybind11::handle quantity);
/// No object: it is none of Python's own.
pybind11::object own_quantity_to_python(const description::Quantity& quantity);
/// What Python sees of a simulated design.
void bind_simulated(pybind11::module_& module);

}  // namespace fettle::design::python

FETTLE_RECORD(fettle::design::description::Measurement, "Measurement", field("value", &Type::value), field("lower", &Type::lower),
              field("upper", &Type::upper), field("is_proven", &Type::is_proven), field("clearance", &Type::clearance),
              field("fault", &Type::fault))
