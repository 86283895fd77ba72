// SPDX-License-Identifier: MIT
/// Reading answers (docs/interface.md) whose keys may be missing.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

namespace fettle::design::report {

inline constexpr double millimetre = 1e-3;  ///< [m]

/// The member of that name of an object; null where there is none.
inline nlohmann::ordered_json member(const nlohmann::ordered_json& object, const std::string& name) {
    const bool there = object.is_object() && object.contains(name);
    return there ? nlohmann::ordered_json(object[name]) : nlohmann::ordered_json();
}

/// The number; null where it is none.
inline nlohmann::ordered_json finite(double x) { return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json(); }

}  // namespace fettle::design::report
