// SPDX-License-Identifier: MIT
/// How the faults of a drawing name features, lengths and places.
#pragma once

#include <string>

#include "core/base/result.hpp"
#include "core/base/types.hpp"
#include "core/base/units.hpp"
#include "core/parts/facets.hpp"

namespace fettle::core::parts {

inline std::string quoted_or(const std::string& feature, const char* otherwise) {
    return feature.empty() ? otherwise : "`" + feature + "`";
}
inline std::string quoted_curve(const std::string& feature) { return quoted_or(feature, "a curve without a name"); }
inline std::string quoted_outline(const std::string& feature) { return quoted_or(feature, "the outline"); }
inline std::string quoted_profile(const std::string& feature) { return quoted_or(feature, "the profile"); }

inline std::string millimetres(double metres) { return base::format_length(metres, "mm", 4); }
inline std::string place(const Vector2& p) { return "(" + millimetres(p.x()) + ", " + millimetres(p.y()) + ")"; }
inline std::string place(const Vector3& p) {
    return "(" + millimetres(p.x()) + ", " + millimetres(p.y()) + ", " + millimetres(p.z()) + ")";
}

/// The fault of a curve or a turn, quoted, that takes as many segments as are drawn of one, or more.
inline base::Error too_many_segments(const std::string& feature, const std::string& quoted, const Facets& facets) {
    return {base::ErrorCode::out_of_range, feature,
            quoted + " would have " + std::to_string(most_segments) + " segments or more" +
                (facets.chord > 0 ? " to keep a chord of " + millimetres(facets.chord) + ": take a larger chord" : ": take fewer")};
}

}  // namespace fettle::core::parts
