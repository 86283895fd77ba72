// SPDX-License-Identifier: MIT
/// Errors of the library on their way to Python, as exceptions; their fate there is in errors.hpp.
#pragma once

#include <exception>
#include <utility>

#include "core/base/result.hpp"
#include "core/base/types.hpp"

namespace fettle::design::python {

/// Carries errors to Python. Thrown with or without the interpreter's lock.
class RaisedErrors : public std::exception {
public:
    explicit RaisedErrors(Errors errors) : errors_(std::move(errors)) {}
    const char* what() const noexcept override { return "fettle.Error"; }
    const Errors& errors() const { return errors_; }

private:
    Errors errors_;
};

}  // namespace fettle::design::python
