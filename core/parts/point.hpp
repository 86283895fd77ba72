// SPDX-License-Identifier: MIT
/// Points of profiles and solids, in recorded numbers (expression/tape.hpp): a part is drawn once, and its derivatives are on the tape.
/// Lengths in metres, angles in radians, counter-clockwise.
#pragma once

#include <numbers>

#include "core/base/types.hpp"
#include "core/expression/tape.hpp"

namespace fettle::core::parts {

using expression::Number;

inline constexpr double full_turn = 2 * std::numbers::pi;  ///< [rad]
inline constexpr double same_place = 1e-9;                 ///< points of a drawing are one where they are nearer, of its size

/// In the plane of a profile.
struct Point2 {
    Number x, y;
};

/// In the frame of a solid.
struct Point3 {
    Number x, y, z;
};

inline Point2 operator+(const Point2& a, const Point2& b) { return {a.x + b.x, a.y + b.y}; }
inline Point2 operator-(const Point2& a, const Point2& b) { return {a.x - b.x, a.y - b.y}; }
inline Point2 operator*(const Number& s, const Point2& a) { return {s * a.x, s * a.y}; }
inline Point3 operator+(const Point3& a, const Point3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Point3 operator-(const Point3& a, const Point3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Point3 operator*(const Number& s, const Point3& a) { return {s * a.x, s * a.y, s * a.z}; }

inline Number dot(const Point2& a, const Point2& b) { return a.x * b.x + a.y * b.y; }
inline Number dot(const Point3& a, const Point3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
/// Positive where b points to the left of a.
inline Number cross(const Point2& a, const Point2& b) { return a.x * b.y - a.y * b.x; }
inline Point3 cross(const Point3& a, const Point3& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline Number length(const Point2& a) { return hypot(a.x, a.y); }
inline Number length(const Point3& a) { return sqrt(dot(a, a)); }
/// Turned left by a quarter.
inline Point2 left_of(const Point2& a) { return {-a.y, a.x}; }

inline Vector2 value(const Point2& a) { return {a.x.value, a.y.value}; }
inline Vector3 value(const Point3& a) { return {a.x.value, a.y.value, a.z.value}; }
inline Point2 constant(const Vector2& a) { return {a.x(), a.y()}; }
inline Point3 constant(const Vector3& a) { return {a.x(), a.y(), a.z()}; }

/// (cos angle, sin angle). With a constant angle it is exact at multiples of 90 degrees, and symmetric about the axes and diagonals up to
/// the rounding of the angle.
Point2 direction(const Number& angle);
/// The same of the whole circle's fraction k / n, symmetric to the bit where 4 divides n.
Point2 direction(int k, int n);
/// radius * direction(angle).
Point2 polar(const Number& radius, const Number& angle);
/// a, turned about the origin by the angle whose direction is d.
inline Point2 turned(const Point2& a, const Point2& d) { return {d.x * a.x - d.y * a.y, d.y * a.x + d.x * a.y}; }

}  // namespace fettle::core::parts
