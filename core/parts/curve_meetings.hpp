// SPDX-License-Identifier: MIT
/// Where two curves meet. Lines and arcs in closed form; other curves by roots on plain numbers, from which one recorded step of Newton's
/// method gives the derivative (implicit function theorem).
#pragma once

#include <vector>

#include "core/parts/curve_geometry.hpp"

namespace fettle::core::parts {

struct Meeting {
    Cut on_a, on_b;  ///< their points are the same
};

/// Every point that two curves have in common within `tolerance` [m], ends that lie on the other curve included: there the point is that
/// end. The ends of stretches in common are given.
std::vector<Meeting> meetings(const Curve& a, const Curve& b, double tolerance);

/// Crossings of the whole line and whole circles of which lines and arcs are parts, and of general curves as they are; u may be outside of
/// [0, 1]. For corners.
std::vector<Meeting> extended_meetings(const Curve& a, const Curve& b, double tolerance);

}  // namespace fettle::core::parts
