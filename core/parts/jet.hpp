// SPDX-License-Identifier: MIT
/// A value with its first and second derivative in the parameter of a curve: what a law (curve.hpp) is called with where its tangent and
/// bending are wanted. All operations of expression/operation.hpp; mixes with constants and with recorded numbers.
#pragma once

#include "fettle/core/expression/operation.hpp"
#include "fettle/core/expression/tape.hpp"

namespace fettle::core::parts {

/// @tparam T  Number: derivatives are recorded as well; double: at the present values of all dimensions.
template <class T>
struct Jet {
    T value = 0, first = 0, second = 0;

    Jet() = default;
    Jet(double constant) : value(constant) {}  // NOLINT: constants and dimensions mix with what depends on the parameter
    Jet(const expression::Number& dimension);  // NOLINT
    Jet(T v, T d, T dd) : value(v), first(d), second(dd) {}
};

}  // namespace fettle::core::parts
