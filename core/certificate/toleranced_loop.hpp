// SPDX-License-Identifier: MIT
/// Where a closed loop of joints is, for every position of the joint that drives it and every deviation in a box.
///
/// The tree of the loop's joints without those that close it has coordinates z that depend on the others: they solve F(z; t) = 0, the
/// chosen conditions of the closing joints. With A about the inverse of dF/dz in the middle of the box, and z_lin(t) linear in t,
///   |A F(z_lin(t); t)| + |1 - A dF/dz| w < w   for all t, and all z within w of z_lin (entry by entry)
/// says that z - A F(z; t) maps what is within w of z_lin(t) into itself and contracts there: so that exactly one solution is there, for
/// every t, and it moves continuously with t (Krawczyk). It is then within the left side of z_lin. F is evaluated as Taylor models, in
/// which what is linear in t cancels: the enclosure is of second order.
///
/// The branch. Solutions of two boxes that have a point in common are one branch where at that point the solution of the one is known to
/// be where the other's is the only one. From the start, which is at hand, slices of the driving coordinate are enclosed one after the
/// other so; any other box is compared with the slice that holds its middle.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/certificate/toleranced_chain.hpp"

namespace fettle::core::certificate {

/// A joint that closes a loop, between the ends of two chains from a common parent: both points are one, both axes are parallel.
struct ModelledClosure {
    std::vector<ChainLink> line_a, line_b;
    Model3 point_a, axis_a, point_b, axis_b;  ///< in the frames of the chains' last bodies
};
inline constexpr int closure_rows = 6;  ///< x, y, z of the points' difference; of size times the cross product of the axes

struct ModelledLoop {
    std::vector<ModelledClosure> closures;
    std::vector<int> unknowns;  ///< places in the list of positions
    std::vector<int> rows;      ///< as many conditions: closure_rows * closure + row. The others have to follow from them
    double size = 1;            ///< [m]
};

/// The unknowns over a box of t: linear in t, without a rest; within `rest` of that; and where they are the only solution.
struct LoopEnclosure {
    std::vector<TaylorModel> linear;
    std::vector<double> rest, only;

    std::vector<TaylorModel> positions() const;  ///< with their rests
};

/// Nothing: not found, the box is too large, or conditions that should follow are off by more than a billionth of the size.
/// @param positions  of the box; those of the unknowns count for nothing. @param guess  of the unknowns in the middle of the box
std::optional<LoopEnclosure> enclosed_loop(const ModelledLoop& loop, std::vector<TaylorModel> positions, const std::vector<double>& guess);

/// Is the solution that `of` encloses where `in` has its only one, at a point or over a box that both are models of, in the same variables?
bool is_same_branch(const LoopEnclosure& of, const LoopEnclosure& in);

}  // namespace fettle::core::certificate
