// SPDX-License-Identifier: MIT
/// How far a flat triangle is from the surface that its corners lie on, as a bound: docs/method/step.md.
///
/// Where facets of a cylinder, a cone or a sphere are compared with the surface by rays from its axis or centre, everything else is by the
/// surface's own parameters:
///     |S(u, v) - linear interpolation| <= (M_uu du^2 + 2 M_uv du dv + M_vv dv^2) / 8 + (J_u du + J_v dv) / 4
/// with the largest norms M of second derivatives over the triangle's box du x dv in (u, v), and jumps J of first derivatives where pieces
/// of a spline meet. (Taylor about the point: each corner's remainder, weighted by barycentric coordinates, whose variance in u is du^2 / 4
/// at most.)
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <variant>
#include <vector>

#include "core/step_importer/bezier.hpp"

namespace fettle::core::step_importer {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// A curve, as far as bounds need it.
struct CurveShape {
    enum class Kind { line, circle, ellipse, parabola, hyperbola, spline, unknown } kind = Kind::unknown;
    double a = 0, b = 0;  ///< line: speed. circle: radius. ellipse, hyperbola: both radii. parabola: focal length
    std::vector<BezierCurve> pieces;
    double period = 0;  ///< of a spline; 0: none
};
/// Largest norms over [from, to]; nothing: not known.
std::optional<CurveSuprema> suprema(const CurveShape& curve, double from, double to);
/// A bound of the distance of C(t) from the point of the chord of [from, to] at the same share of it; nothing: not known.
std::optional<double> chord_bound(const CurveShape& curve, double from, double to);

/// A surface, as far as bounds need it, in the frame of the triangles' corners.
struct SurfaceShape {
    enum class Kind { plane, cylinder, cone, sphere, torus, extrusion, revolution, spline, unknown } kind = Kind::unknown;
    Vector3d point = Vector3d::Zero(), axis = Vector3d::UnitZ();  ///< of what has an axis; a sphere's centre
    double radius = 0, minor = 0;                                 ///< of cylinder, sphere; of torus both
    CurveShape profile;                                           ///< of extrusion (over u) and revolution (over v)
    std::vector<Vector3d> profile_hull;                           ///< of a revolution: points whose hull its profile lies in
    PatchGrid grid;                                               ///< of a spline
    bool is_recognised = false;    ///< a spline that is the plane, cylinder or sphere above: (u, v) are those of the spline
    double recognised_within = 0;  ///< how far the spline is from it, at most

    /// Are facets compared with it by rays?
    bool is_radial() const { return kind == Kind::cylinder || kind == Kind::cone || kind == Kind::sphere; }
};
const char* name_of(SurfaceShape::Kind kind);

struct Corner {
    Vector3d place;
    Vector2d uv;
};
/// A bound for the flat triangle; nothing: not known. Radial: every point of it is within this of where its ray meets the surface.
std::optional<double> triangle_bound(const SurfaceShape& surface, const std::array<Corner, 3>& corners);
/// Largest norms over the box of (u, v); nothing: not known, or the surface is radial or a plane and needs none.
std::optional<SurfaceSuprema> suprema(const SurfaceShape& surface, const Vector2d& low, const Vector2d& high);
/// Takes a spline for a plane, a cylinder or a sphere where its control net proves that it is one to within `tolerance`: of the candidate's
/// equation q(S) = 0, as in |S - c|^2 - r^2, W^2 q(N / W) is a polynomial whose Bernstein coefficients bound it.
/// @param places, normals  of some points of the surface: the candidate is fitted to them.
void recognise(SurfaceShape& surface, const std::vector<Vector3d>& places, const std::vector<Vector3d>& normals, double tolerance);

/// From the axis or the centre: outwards along the ray of a radial surface.
Vector3d ray_at(const SurfaceShape& surface, const Vector3d& place);

}  // namespace fettle::core::step_importer
