// SPDX-License-Identifier: MIT
#include "design/python/records.hpp"

#include <cctype>

#include "core/base/text.hpp"
#include "core/files/nearest_word.hpp"

namespace fettle::design::python {

namespace py = pybind11;

py::object record_class(const char* name) { return py::module_::import("fettle").attr(name); }

py::object record_list(py::object list) { return py::module_::import("fettle._record").attr("Records")(std::move(list)); }

namespace {

// py::getattr with a default, and py::hasattr, would swallow whatever is raised meanwhile: Ctrl-C too, which comes where Python code runs.
py::object attribute_or_none(py::handle of, const char* name) {
    if (PyObject* const found = PyObject_GetAttrString(of.ptr(), name)) return py::reinterpret_steal<py::object>(found);
    if (PyErr_ExceptionMatches(PyExc_AttributeError) == 0) throw py::error_already_set();
    PyErr_Clear();
    return py::none();
}

}  // namespace

py::object prepared(py::handle record) {
    const py::object prepare = attribute_or_none(record, "_prepared");
    return prepare.is_none() ? py::reinterpret_borrow<py::object>(record) : prepare();
}

py::object paths_as_text(py::object given) {
    if (!attribute_or_none(given, "__fspath__").is_none()) return py::module_::import("os").attr("fspath")(given);
    if (!py::isinstance<py::list>(given) && !py::isinstance<py::tuple>(given)) return given;
    py::list texts;
    for (const py::handle each : given) texts.append(paths_as_text(py::reinterpret_borrow<py::object>(each)));
    return std::move(texts);
}

void refuse_type(const char* record, const char* member, py::handle found, const std::string& wanted) {
    const std::string type = py::str(py::type::of(found).attr("__name__"));
    throw py::type_error(std::string(record) + "." + member + ": a value of type " + type + " is not what belongs there" +
                         (wanted.empty() ? "" : ": " + wanted + (wanted.starts_with("three") ? " are expected" : " is expected")));
}

void refuse_word(const std::string& word, std::span<const std::string_view> known) {
    const auto nearest = core::files::nearest_word(word, {known.begin(), known.end()});
    throw RaisedErrors(
        {{ErrorCode::out_of_range, "",
          "\"" + word + "\" is none of: " + core::base::joined(known) + (nearest ? "; did you mean \"" + *nearest + "\"?" : "")}});
}

void refuse_nan() { throw RaisedErrors({{ErrorCode::not_finite, "", "it is NaN, or has one in it; numbers are expected"}}); }

namespace {

// "PairRequest" -> "pair request", and its name, if it has one.
std::string place_of(py::handle record, const char* record_name) {
    std::string place;
    for (const char* c = record_name; *c != '\0'; ++c) {
        if (std::isupper(*c) != 0 && !place.empty()) place += ' ';
        place += static_cast<char>(std::tolower(*c));
    }
    const py::object name = attribute_or_none(record, "name");
    if (py::isinstance<py::str>(name) && py::len(name) > 0) place += " `" + name.cast<std::string>() + "`";
    return place;
}

}  // namespace

void refuse_member(const Errors& errors, py::handle record, const char* record_name, const char* member) {
    const std::string place = place_of(record, record_name) + "/" + member;
    Errors placed = errors;
    for (Error& error : placed) {
        if (error.where.find('`') != std::string::npos) continue;  // what has a name is found by it
        const std::size_t slash = error.where.find('/');
        error.where = place + (slash == std::string::npos ? "" : error.where.substr(slash));
    }
    throw RaisedErrors(std::move(placed));
}

}  // namespace fettle::design::python
