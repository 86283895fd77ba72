// SPDX-License-Identifier: MIT
/// Text of the library on its way to Python: what is no UTF-8 (in a path, in words of a file or of another program) is there as "\\xff",
/// where pybind11 would raise UnicodeDecodeError. For every std::string: part of each file of the bindings (CMakeLists.txt includes it).
#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace pybind11::detail {

template <>
inline handle string_caster<std::string>::cast(const std::string& text, return_value_policy, handle) {
    PyObject* const decoded = PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "backslashreplace");
    if (decoded == nullptr) throw error_already_set();
    return decoded;
}

}  // namespace pybind11::detail
