// SPDX-License-Identifier: MIT
#include "design/python/errors.hpp"

#include <pybind11/stl.h>

#include "core/base/text.hpp"
#include "design/python/records.hpp"

FETTLE_WORDS(fettle::core::base::ErrorCode, "file_not_found", "file_unreadable", "file_unwritable", "out_of_memory", "parse", "unknown_key",
             "missing_key", "wrong_type", "out_of_range", "not_finite", "mesh_invalid", "bodies_intersect", "inconsistent", "unsupported")
FETTLE_RECORD(fettle::core::base::Error, "Fault", field("code", &Type::code), field("where", &Type::where),
              field("message", &Type::message))

namespace fettle::design::python {

namespace py = pybind11;

void warn_of(const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings)
        if (PyErr_WarnEx(PyExc_UserWarning, core::base::shown(warning).c_str(), 1) != 0) throw py::error_already_set();
}

Errors errors_of(py::error_already_set& raised, const std::string& where) {
    const py::object error_class = record_class("Error");
    if (raised.matches(error_class)) {
        const py::object errors = raised.value().attr("errors");
        return errors.cast<Errors>();
    }
    if (!raised.matches(PyExc_ValueError)) throw;  // NOLINT: called where it has been caught
    return {{ErrorCode::out_of_range, where, py::str(raised.value())}};
}

void bind_errors(py::module_&) {
    py::register_local_exception_translator([](std::exception_ptr thrown) {
        if (!thrown) return;
        try {
            std::rethrow_exception(thrown);
        } catch (const RaisedErrors& raised) {
            const py::object error_class = record_class("Error");
            PyErr_SetObject(error_class.ptr(), error_class(py::cast(raised.errors())).ptr());
        }
    });
}

}  // namespace fettle::design::python
