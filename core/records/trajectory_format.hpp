// SPDX-License-Identifier: MIT
/// What writer and reader of trajectory files agree on (trajectory_io.hpp documents the format).
#pragma once

#include <string_view>
#include <vector>

namespace fettle::core::records {

inline constexpr std::string_view format_key = "fettle_trajectory";
inline constexpr int format_version = 2;

/// In the order of scene::BodyType.
inline const std::vector<std::string_view>& body_type_names() {
    static const std::vector<std::string_view> names{"dynamic", "static", "kinematic"};
    return names;
}

/// In the order of scene::MassKind.
inline const std::vector<std::string_view>& mass_kind_names() {
    static const std::vector<std::string_view> names{"volume", "area", "length", "vertex"};
    return names;
}

}  // namespace fettle::core::records
