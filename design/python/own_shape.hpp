// SPDX-License-Identifier: MIT
/// Shapes between Python and the library. A part of a file is fettle.Part on both sides; an object with `dimensions()` and
/// `at()` (fettle.Shape) is a Shape of the library, called with the interpreter's lock, from several threads one after the other.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "design/description/shape.hpp"

namespace fettle::design::python {

/// Holds a Python object in the library: released with the lock, wherever that happens.
std::shared_ptr<pybind11::object> shared_object(pybind11::handle object);

std::shared_ptr<const description::Shape> shape_from_python(pybind11::handle shape);
pybind11::object shape_to_python(const std::shared_ptr<const description::Shape>& shape);
void bind_shapes(pybind11::module_& module);

}  // namespace fettle::design::python
