// SPDX-License-Identifier: MIT
#include "core/geometry/predicates.hpp"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/base/contract.hpp"
#include "core/base/rounding.hpp"

namespace fettle::core::geometry {
namespace {

namespace multiprecision = boost::multiprecision;

/// Large enough for sums of six products of three differences of coordinates below 2^160: 3 * 161 + 3 bits. Lives on the stack.
using FixedInteger =
    multiprecision::number<multiprecision::cpp_int_backend<512, 512, multiprecision::signed_magnitude, multiprecision::unchecked, void>>;
using BigInteger = multiprecision::cpp_int;
constexpr int fixed_coordinate_bits = 160;

// Between these the filters below are free of overflow, and what underflow can add is below the absolute term.
constexpr double largest_filtered = 0x1p300;
constexpr double underflow_allowance = 0x1p-760;

int sign_of(double x) { return (x > 0) - (x < 0); }

/// Doubles are integers times powers of two: the smallest exponent among the nonzero ones and the bits that all then need.
struct ExponentRange {
    int lowest = std::numeric_limits<int>::max();
    int highest = std::numeric_limits<int>::min();

    void include(double x) {
        FETTLE_ASSERT(std::isfinite(x), "exact predicates need finite coordinates");
        if (x == 0) return;
        int exponent = 0;
        std::frexp(x, &exponent);  // |x| in [2^(exponent-1), 2^exponent)
        lowest = std::min(lowest, exponent - 53);
        highest = std::max(highest, exponent);
    }
    int bits() const { return highest < lowest ? 0 : highest - lowest; }
};

/// x 2^-lowest, an integer.
template <class Integer>
Integer scaled(double x, int lowest) {
    if (x == 0) return Integer(0);
    int exponent = 0;
    const double mantissa = std::frexp(x, &exponent);
    Integer result(static_cast<std::int64_t>(std::ldexp(mantissa, 53)));
    return result << (exponent - 53 - lowest);
}

template <class Integer>
Integer determinant(const std::array<std::array<Integer, 3>, 3>& m) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) + m[0][1] * (m[1][2] * m[2][0] - m[1][0] * m[2][2]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

template <class Integer>
int exact_orient2d(const std::array<const double*, 3>& x, int lowest) {
    std::array<std::array<Integer, 2>, 2> m;
    for (int j = 0; j < 2; ++j) {
        const Integer origin = scaled<Integer>(x[0][j], lowest);
        for (int i = 0; i < 2; ++i) m[i][j] = scaled<Integer>(x[i + 1][j], lowest) - origin;
    }
    return Integer(m[0][0] * m[1][1] - m[0][1] * m[1][0]).sign();
}

template <class Integer>
int exact_orient3d(const std::array<const double*, 4>& x, int lowest) {
    std::array<std::array<Integer, 3>, 3> m;
    for (int j = 0; j < 3; ++j) {
        const Integer origin = scaled<Integer>(x[0][j], lowest);
        for (int i = 0; i < 3; ++i) m[i][j] = scaled<Integer>(x[i + 1][j], lowest) - origin;
    }
    return determinant(m).sign();
}

int exact_volume_sign(const Matrix3X& vertices, const std::vector<Triangle>& triangles) {
    ExponentRange range;
    for (const Triangle& triangle : triangles) {
        for (const int vertex : triangle) {
            for (int j = 0; j < 3; ++j) range.include(vertices(j, vertex));
        }
    }
    BigInteger sum = 0;
    for (const Triangle& triangle : triangles) {
        std::array<std::array<BigInteger, 3>, 3> m;
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) m[i][j] = scaled<BigInteger>(vertices(j, triangle[i]), range.lowest);
        }
        sum += determinant(m);
    }
    return sum.sign();
}

bool lexicographically_less(const Vector3& a, const Vector3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

/// c, which is on the line a b, within the closed segment a b?
template <class Vector>
bool collinear_between(const Vector& a, const Vector& b, const Vector& c) {
    return (c.array() >= a.array().min(b.array())).all() && (c.array() <= a.array().max(b.array())).all();
}

bool segments_intersect_2d(const Vector2& p0, const Vector2& p1, const Vector2& q0, const Vector2& q1) {
    const int a = orient2d(p0, p1, q0), b = orient2d(p0, p1, q1), c = orient2d(q0, q1, p0), d = orient2d(q0, q1, p1);
    if (a * b < 0 && c * d < 0) return true;
    return (a == 0 && collinear_between(p0, p1, q0)) || (b == 0 && collinear_between(p0, p1, q1)) ||
           (c == 0 && collinear_between(q0, q1, p0)) || (d == 0 && collinear_between(q0, q1, p1));
}

/// t has an area.
bool point_in_triangle_2d(const Vector2& p, const std::array<Vector2, 3>& t) {
    const int a = orient2d(t[0], t[1], p), b = orient2d(t[1], t[2], p), c = orient2d(t[2], t[0], p);
    return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

}  // namespace

int orient2d(const Vector2& a, const Vector2& b, const Vector2& c) {
    const double bx = b.x() - a.x(), by = b.y() - a.y(), cx = c.x() - a.x(), cy = c.y() - a.y();
    const double left = bx * cy, right = by * cx;
    const double value = left - right, magnitude = std::abs(left) + std::abs(right);
    // Two differences, a product and the last difference: |error| <= (1+u)^4 - 1 times the exact sum of magnitudes, which is below
    // magnitude (1-u)^-4. 5u covers it (4u + 26u^2 <= 5u), the bound's own two roundings included.
    const double largest = std::max({std::abs(bx), std::abs(by), std::abs(cx), std::abs(cy)});
    if (largest <= largest_filtered && std::abs(value) > 5 * unit_roundoff * magnitude + underflow_allowance) return sign_of(value);
    if ((bx == 0 && cx == 0) || (by == 0 && cy == 0)) return 0;  // x - y is 0 only for x = y

    const std::array<const double*, 3> x{a.data(), b.data(), c.data()};
    ExponentRange range;
    for (const double* point : x) {
        range.include(point[0]);
        range.include(point[1]);
    }
    return range.bits() <= fixed_coordinate_bits ? exact_orient2d<FixedInteger>(x, range.lowest)
                                                 : exact_orient2d<BigInteger>(x, range.lowest);
}

int orient3d(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
    const double bx = b.x() - a.x(), by = b.y() - a.y(), bz = b.z() - a.z();
    const double cx = c.x() - a.x(), cy = c.y() - a.y(), cz = c.z() - a.z();
    const double dx = d.x() - a.x(), dy = d.y() - a.y(), dz = d.z() - a.z();
    const double yz = by * cz, zy = bz * cy, zx = bz * cx, xz = bx * cz, xy = bx * cy, yx = by * cx;
    const double value = dx * (yz - zy) + dy * (zx - xz) + dz * (xy - yx);
    const double magnitude = std::abs(dx) * (std::abs(yz) + std::abs(zy)) + std::abs(dy) * (std::abs(zx) + std::abs(xz)) +
                             std::abs(dz) * (std::abs(xy) + std::abs(yx));
    // Each of the six products passes at most three coordinate differences, two products and three sums: 8 roundings, so
    // |error| <= ((1+u)^8 - 1) (1-u)^-7 magnitude < 9u magnitude, with room for the bound's own roundings (8u + 100u^2 <= 9u (1-u)^2).
    // Underflow: a product of two is off by up to 2^-1075 and then multiplied by at most 2^300, twelve times (value and magnitude).
    const double largest = std::max(
        {std::abs(bx), std::abs(by), std::abs(bz), std::abs(cx), std::abs(cy), std::abs(cz), std::abs(dx), std::abs(dy), std::abs(dz)});
    if (largest <= largest_filtered && std::abs(value) > 9 * unit_roundoff * magnitude + underflow_allowance) return sign_of(value);
    if ((bx == 0 && cx == 0 && dx == 0) || (by == 0 && cy == 0 && dy == 0) || (bz == 0 && cz == 0 && dz == 0)) return 0;

    const std::array<const double*, 4> x{a.data(), b.data(), c.data(), d.data()};
    ExponentRange range;
    for (const double* point : x) {
        for (int j = 0; j < 3; ++j) range.include(point[j]);
    }
    return range.bits() <= fixed_coordinate_bits ? exact_orient3d<FixedInteger>(x, range.lowest)
                                                 : exact_orient3d<BigInteger>(x, range.lowest);
}

int volume_sign(const Matrix3X& vertices, const std::vector<Triangle>& triangles) {
    // The determinants are taken about the coordinates' origin, not about a nearby vertex: the exact sum does not depend on it for a closed
    // mesh, and the filter only fails more often.
    double sum = 0, magnitude = 0, largest = 0;
    for (const Triangle& triangle : triangles) {
        const Vector3 a = vertices.col(triangle[0]), b = vertices.col(triangle[1]), c = vertices.col(triangle[2]);
        const double yz = b.y() * c.z(), zy = b.z() * c.y(), zx = b.z() * c.x(), xz = b.x() * c.z(), xy = b.x() * c.y(), yx = b.y() * c.x();
        sum += a.x() * (yz - zy) + a.y() * (zx - xz) + a.z() * (xy - yx);
        magnitude += std::abs(a.x()) * (std::abs(yz) + std::abs(zy)) + std::abs(a.y()) * (std::abs(zx) + std::abs(xz)) +
                     std::abs(a.z()) * (std::abs(xy) + std::abs(yx));
        largest = std::max({largest, a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), c.cwiseAbs().maxCoeff()});
    }
    // Five roundings per product and at most one per addition to the sum, twice as much to be safe.
    const double count = static_cast<double>(triangles.size());
    if (largest <= largest_filtered && std::abs(sum) > 2 * (count + 6) * unit_roundoff * magnitude + count * underflow_allowance) {
        return sign_of(sum);
    }
    return exact_volume_sign(vertices, triangles);
}

int projection_axis(const Vector3& a, const Vector3& b, const Vector3& c) {
    // The axis of the largest normal component first: its sign is the one that the filter decides.
    const Vector3 u = b - a, v = c - a;
    const Vector3 normal(std::abs(u.y() * v.z() - u.z() * v.y()), std::abs(u.z() * v.x() - u.x() * v.z()),
                         std::abs(u.x() * v.y() - u.y() * v.x()));
    int first = 0;
    if (normal(1) > normal(first)) first = 1;
    if (normal(2) > normal(first)) first = 2;
    for (int k = 0; k < 3; ++k) {
        const int axis = (first + k) % 3;
        if (orient2d(projected(a, axis), projected(b, axis), projected(c, axis)) != 0) return axis;
    }
    return -1;
}

bool segments_intersect(const Vector3& p0, const Vector3& p1, const Vector3& q0, const Vector3& q1) {
    if (orient3d(p0, p1, q0, q1) != 0) return false;
    // Coplanar: along an axis on which some three of the points span an area the projection of their plane is one to one.
    int axis = projection_axis(p0, p1, q0);
    if (axis < 0) axis = projection_axis(p0, p1, q1);
    if (axis < 0) axis = projection_axis(q0, q1, p0);
    if (axis < 0) axis = projection_axis(q0, q1, p1);
    if (axis >= 0) return segments_intersect_2d(projected(p0, axis), projected(p1, axis), projected(q0, axis), projected(q1, axis));
    // All four on one line, where the lexicographic order is the order along the line.
    const auto [p_low, p_high] = std::minmax(p0, p1, lexicographically_less);
    const auto [q_low, q_high] = std::minmax(q0, q1, lexicographically_less);
    return !lexicographically_less(p_high, q_low) && !lexicographically_less(q_high, p_low);
}

bool segment_intersects_triangle(const Vector3& p0, const Vector3& p1, const std::array<Vector3, 3>& triangle) {
    const auto& [a, b, c] = triangle;
    const int side0 = orient3d(a, b, c, p0), side1 = orient3d(a, b, c, p1);
    if (side0 * side1 > 0) return false;
    if (side0 != 0 || side1 != 0) {  // the line meets the plane in one point, on the segment
        const int ab = orient3d(p0, p1, a, b), bc = orient3d(p0, p1, b, c), ca = orient3d(p0, p1, c, a);
        return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
    }
    const int axis = projection_axis(a, b, c);
    if (axis < 0) {
        const auto [low, high] = std::minmax({a, b, c}, lexicographically_less);
        return segments_intersect(p0, p1, low, high);
    }
    const Vector2 s0 = projected(p0, axis), s1 = projected(p1, axis);
    const std::array<Vector2, 3> t{projected(a, axis), projected(b, axis), projected(c, axis)};
    return point_in_triangle_2d(s0, t) || segments_intersect_2d(s0, s1, t[0], t[1]) || segments_intersect_2d(s0, s1, t[1], t[2]) ||
           segments_intersect_2d(s0, s1, t[2], t[0]);
}

}  // namespace fettle::core::geometry
