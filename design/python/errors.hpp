// SPDX-License-Identifier: MIT
/// Errors of the library as Python exceptions: a failed Result is thrown with what it holds, and becomes fettle.Error, whose `errors` have
/// code, where and message.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <utility>
#include <vector>

#include "design/python/raised_errors.hpp"

namespace fettle::design::python {

template <class T>
T value_or_raise(Result<T> result) {
    if (!result) throw RaisedErrors(result.errors());
    return std::move(result).value();
}
inline void raise_if_any(const Errors& errors) {
    if (!errors.empty()) throw RaisedErrors(errors);
}

/// As Python's UserWarning, which may be made to raise. Contract: the interpreter's lock is held.
void warn_of(const std::vector<std::string>& warnings);

/// What a Python callable raised as fettle.Error or ValueError, as errors of the library; others are thrown on.
/// Contract: the interpreter's lock is held.
Errors errors_of(pybind11::error_already_set& raised, const std::string& where);

void bind_errors(pybind11::module_& module);

}  // namespace fettle::design::python
