// SPDX-License-Identifier: MIT
/// Which joints parts have that fit each other, as assembled (docs/method/features.md): proposals, each with what it follows from.
///
///     const std::vector<Fit> fits = find_fits(parts);
///     const int ground = proposed_ground(placed);
///     for (const ProposedJoint& joint : propose_joints(placed, parts, fits, ground))
///         std::printf("%d-%d: %s\n", joint.a, joint.b, to_string(joint.kind));
///
/// Parts that sit on one line (a pin in the bores of a base and a lid) turn about it, each against the one of them that is nearest to the
/// ground. One line: cylindrical; revolute, where flat faces stop the slide both ways; fixed, where all that holds it is a press fit. Two
/// parallel lines: prismatic, fixed if stopped both ways; others: fixed. A ball in a socket: ball; two: revolute about both centres.
/// Without any of these, flat faces close by on both sides in two directions: prismatic.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/features/facing.hpp"
#include "core/features/fits.hpp"

namespace fettle::core::features {

enum class JointKind { revolute, cylindrical, prismatic, ball, fixed };
const char* to_string(JointKind kind);

/// A flat face of b against one of another part.
struct Stop {
    FeatureOf of_b, against;
    double gap = 0;  ///< [m]
};

struct ProposedJoint {
    int a = 0, b = 0;  ///< bodies: a is nearer to the ground
    JointKind kind = JointKind::revolute;
    Vector3 point = Vector3::Zero(), axis = Vector3::UnitZ();  ///< of ball and fixed joints no axis
    std::vector<int> fits{};                                   ///< of the list, that it follows from
    bool is_pressed = false;                                   ///< fixed by interference alone
    std::array<std::optional<Stop>, 2> stops{};                ///< that stop b along -axis, along axis
    std::vector<Stop> guides{};                                ///< flat faces that leave one direction: prismatic
};

/// The part with the largest box; of equal ones the first. Contract: not empty.
int proposed_ground(const std::vector<geometry::Mesh>& placed);

/// @param placed  Meshes as assembled. Contract: one for each of `parts`, which are their features; `fits` are theirs.
/// Joints in the order of their distance from the ground, then of b and a. No two are of the same two parts.
std::vector<ProposedJoint> propose_joints(const std::vector<geometry::Mesh>& placed, const std::vector<Features>& parts,
                                          const std::vector<Fit>& fits, int ground);

}  // namespace fettle::core::features
