// SPDX-License-Identifier: MIT
/// Quantities between Python and the library. Those of ../quantities are dataclasses of fettle/design.py, by a table; others are Python's
/// own (own_quantity.hpp), or handed through. Add one: a row, and its dataclass.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "design/description/quantity.hpp"

namespace fettle::design::python {

std::shared_ptr<const description::Quantity> quantity_from_python(pybind11::handle quantity);
pybind11::object quantity_to_python(const std::shared_ptr<const description::Quantity>& quantity);
void bind_quantities(pybind11::module_& module);

}  // namespace fettle::design::python
