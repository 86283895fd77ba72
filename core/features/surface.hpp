// SPDX-License-Identifier: MIT
/// The surfaces that features have: planes, cylinders, cones, spheres, tori, as numbers. Distances from them, with derivatives;
/// least-squares fits of them to points (fit_surface.hpp).
#pragma once

#include <Eigen/Core>

#include "core/base/types.hpp"
#include "core/parts/surface.hpp"

namespace fettle::core::features {

using parts::SurfaceKind;

/// What the numbers mean stands at parts::SurfaceKind. Which side is material is no part of it.
struct Surface {
    SurfaceKind kind = SurfaceKind::plane;
    Vector3 point = Vector3::Zero(), axis = Vector3::UnitZ();  ///< axis: of length 1
    double radius = 0, slope = 0;
};

/// Signed distance from x [m], positive on the side that the axis, the centre or the tube's middle circle is not on (of a plane: where its
/// axis points). With rho the distance from the line through `point` along `axis`, and z the height above `point` along it:
///     plane  z      cylinder  rho - radius      cone  (rho - radius - slope z) / sqrt(1 + slope^2)
///     sphere  |x - point| - radius      torus  hypot(rho - radius, z) - slope
/// The cone is the double one's half where radius + slope z > 0.
double signed_distance(const Surface& surface, const Vector3& x);

/// The gradient of signed_distance in x: the unit normal of the surface through x. Zero where there is none, such as on an axis.
Vector3 normal_at(const Surface& surface, const Vector3& x);

/// How many numbers a surface of this kind has: 3, 5, 6, 4, 7.
int parameter_count(SurfaceKind kind);

/// At most 7 numbers.
using SurfaceStep = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 7, 1>;

/// Derivative of signed_distance with respect to a surface's own numbers, in the order in which `moved` takes them: with u, v the two
/// directions of across_of(axis),
///     plane     [turn u, turn v, along axis]       cylinder  [along u, along v, turn u, turn v, radius]
///     cone      [as a cylinder's, slope]           sphere    [along x, along y, along z, radius]
///     torus     [along u, along v, along axis, turn u, turn v, radius, slope]
/// `turn u` leans the axis towards u, about `point`. [m/m], [m/rad]; slope of a cone: [m].
SurfaceStep distance_gradient(const Surface& surface, const Vector3& x);
Surface moved(const Surface& surface, const SurfaceStep& step);

/// Two directions across an axis, orthonormal.
struct Across {
    Vector3 u, v;
};
Across across_of(const Vector3& axis);

}  // namespace fettle::core::features
