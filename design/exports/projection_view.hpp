// SPDX-License-Identifier: MIT
/// From where a picture is drawn: orthographic views by name or by angles.
#pragma once

#include <string>

#include "core/base/result.hpp"
#include "core/base/types.hpp"

namespace fettle::design::exports {

/// Orthonormal, right-handed, world axes: a point x of the world is at (right . x, up . x) of the picture, `towards` points to the viewer.
struct ProjectionView {
    Vector3 right = Vector3::UnitX(), up = Vector3::UnitZ(), towards = -Vector3::UnitY();
};

/// @param name   iso, front, back, left, right, top, bottom; or "azimuth,elevation" [degrees]: where the viewer stands, from the front to
/// the
///               right and up. iso is 45,35.264: all three axes equally long. Z up, front is against -Y; Y up, front is against +Z.
/// @param up     The world's up, a unit vector.
/// @param where  for messages.
/// Errors: out_of_range (a name that is none, with the nearest; an elevation beyond 90).
Result<ProjectionView> projection_view(const std::string& name, const Vector3& up, const std::string& where);

}  // namespace fettle::design::exports
