// SPDX-License-Identifier: MIT
/// Reading answers (docs/interface.md) and other files whose keys may be missing, or that may be no JSON.
#pragma once

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/files/atomic_file.hpp"
#include "core/files/json_text.hpp"

namespace fettle::design::report {

inline constexpr double millimetre = 1e-3;  ///< [m]

/// The file's text; empty if it cannot be read.
inline std::string text_or_empty(const std::filesystem::path& file) {
    const Result<std::string> text = core::files::read_file(file);
    return text ? *text : std::string();
}

/// Discarded if it is not JSON.
inline nlohmann::ordered_json parsed_json(const std::string& text) {
    using Json = nlohmann::ordered_json;
    return core::files::is_safe_json_text(text) ? Json::parse(text, nullptr, false) : Json(Json::value_t::discarded);
}

/// The member of that name of an object; null where there is none.
inline nlohmann::ordered_json member(const nlohmann::ordered_json& object, const std::string& name) {
    const bool there = object.is_object() && object.contains(name);
    return there ? nlohmann::ordered_json(object[name]) : nlohmann::ordered_json();
}

/// What a scene or design file says in words.
inline std::string description_of(const std::string& text) {
    const nlohmann::ordered_json words = member(parsed_json(text), "description");
    return words.is_string() ? words.get<std::string>() : std::string();
}

/// The number; null where it is none.
inline nlohmann::ordered_json finite(double x) { return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json(); }

}  // namespace fettle::design::report
