// SPDX-License-Identifier: MIT
/// How the axes of a joint's second frame follow those of the first (build_mechanism.cpp, and its derivative).
#pragma once

#include <optional>

#include "core/base/types.hpp"

namespace fettle::core::model {

/// The part of a unit vector x that stands across the unit vector z; none where they are all but parallel: then any axis is as good.
inline std::optional<Vector3> part_across(const Vector3& z, const Vector3& x) {
    constexpr double too_short = 1e-3;
    const Vector3 across = x - z * z.dot(x);
    return across.norm() < too_short ? std::nullopt : std::optional(across);
}

}  // namespace fettle::core::model
