// SPDX-License-Identifier: MIT
#include "fettle/design/python/records.hpp"

namespace fettle::design::python {

namespace py = pybind11;

py::object record_class(const char* name) { return py::module_::import("fettle").attr(name); }

void refuse_type(const char* record, const char* member, py::handle found) {
    const std::string type = py::str(py::type::of(found).attr("__name__"));
    throw py::type_error(std::string(record) + "." + member + ": a value of type " + type + " is not what belongs there");
}

}  // namespace fettle::design::python
